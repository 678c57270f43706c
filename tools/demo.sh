#!/bin/sh
# tools/demo.sh BUILD OUT: a mill is recorded that resists rolling, which nobody told the simulation; friction is retuned, what differs
# is shown, the physics is found, and one page tells it all. SEED=n plays another recording. Nothing is precomputed.
set -eu
build=$1 out=$2 seed=${SEED:-1}
case $seed in *[!0-9]* | '') echo "SEED=$seed: give a whole number" >&2; exit 2 ;; esac
story=$(cd "$(dirname "$0")/../configs" && pwd)/story
millscope=$(cd "$build" && pwd)/bin/millscope
mkdir -p "$out"
cd "$out"
out=$(pwd)
start=$(date +%s)

chapter() { printf '\n%3d s  %s\n' $(($(date +%s) - start)) "$1"; }
# What a command has to say while it works goes to the log; it is shown where the command fails.
quietly() { "$millscope" "$@" >>log.txt 2>&1 || { tail -n 3 log.txt >&2; exit 1; }; }

chapter "A tracker follows 40 beads of a real mill for 10 s each, at 75 and 55 % of critical"
for speed in 75 55; do
  quietly run "$story/recorded.yaml" -o mill$speed --threads 1 --set "mill.speed=$speed %critical" --set "seed=$((100 * seed + speed))" &
done
wait
for speed in 75 55; do
  [ -e mill$speed/summary.json ] || { tail -n 3 log.txt >&2; exit 1; }
  quietly pept synthesize mill$speed -o recording$speed.a --camera "$story/../cameras/study.yaml" --seed "$seed"
done
set -- --cache cache --set "conditions.speed75.recording=$out/recording75.yaml" --set "conditions.speed55.recording=$out/recording55.yaml"

chapter "Practice: retune the friction of the simulation until it fits the recording at 75 %"
quietly calibrate "$story/study.yaml" -o retuned "$@"
quietly validate "$story/study.yaml" --calibration retuned/calibration.json -o retuned-at-55 "$@"
grep -E '^(parameter|bead_friction)  ' log.txt
grep '^no parameters fit' log.txt || true
grep '^note: bead_friction' log.txt || true
echo "(Practice fits some numbers of one speed. The diagnosis below fits all numbers of it, so its frictions differ from these.)"

chapter "What differs at 55 %, which was not fitted"
grep -E '^The simulation (agrees|and)' log.txt || true
quietly run retuned/calibrated.yaml -o retuned-mill --set "mill.speed=55 %critical" --set "time={end_s: 11, analyze_from_s: 1}" \
  --set "output.tracks={beads: 40, every_s: 0.0005}"
quietly pept synthesize retuned-mill -o retuned.a --camera "$story/../cameras/study.yaml"
quietly analyze recording55.yaml -o as-recorded --no-pictures
quietly analyze retuned.yaml -o as-retuned --no-pictures
"$millscope" compare as-recorded as-retuned -o difference -q

chapter "Which physics was left out (a minute or two)"
quietly diagnose "$story/study.yaml" -o diagnosis "$@"
sed -n 3p diagnosis/diagnosis.md

chapter "The corrected mill, and the page"
if [ -e diagnosis/corrected/case.yaml ]; then
  quietly run diagnosis/corrected/case.yaml -o corrected-mill --set "name=The corrected mill at 55 %" --set "mill.speed=55 %critical" --set "time={end_s: 3, analyze_from_s: 1}" \
    --set "output.frames={every_s: 0.02, from_s: 0}" --set "output.vtk={every_s: 0.05}"
fi
for folder in corrected-mill as-recorded difference retuned retuned-at-55 diagnosis; do
  [ ! -d $folder ] || set -- "$@" $folder
done
shift 6
quietly report "$@" -o report.html --title "The mill that resists rolling"
chapter "done"
echo
echo "Open:"
echo "  $out/report.html            the answer, then the whole story, in any browser, no network needed"
echo "  $out/diagnosis/diagnosis.md the verdict in words; diagnosis/corrected: a case with what was found"
[ ! -e corrected-mill/vtk/beads.pvd ] || echo "  $out/corrected-mill/vtk/beads.pvd ParaView, then Apply and Play"
