#!/bin/sh
# bench/look.sh BUILD [BENCH]: the cost of one look at a simulation of the mill of the story (241 beads, 4 s), seen as 40 beads were
# recorded for 10 s each. BENCH: millscope_look_bench of another build; the two take turns in five pairs, and the ratio of each is told.
set -eu
build=$(cd "$1" && pwd) other=${2:-}
here=$(cd "$(dirname "$0")/.." && pwd)
story=$here/configs/story
work=$build/bench-look
millscope=$build/bin/millscope
mkdir -p "$work"
# What was recorded, and one simulation of it as a campaign makes it: the user's mill without the rolling resistance of the real one.
if [ ! -e "$work/recording.yaml" ]; then
  rm -rf "$work/recorded"
  "$millscope" run "$story/recorded.yaml" -o "$work/recorded" --threads 1 --quiet
  "$millscope" pept synthesize "$work/recorded" -o "$work/recording.a" --camera "$here/configs/cameras/study.yaml" --seed 1 > /dev/null
fi
if [ ! -e "$work/run/summary.json" ]; then
  rm -rf "$work/run"
  "$millscope" run "$story/mill.yaml" -o "$work/run" --threads 1 --quiet --set 'time={end_s: 4, analyze_from_s: 1}' \
    --set output.frames.every_s=0.005
fi

cat > "$work/study.yaml" <<END
base: $story/mill.yaml
conditions:
  speed75: {set: {mill.speed: 75 %critical, time.end_s: 4, time.analyze_from_s: 1}, recording: recording.yaml, role: fit}
parameters: {pairs.glass~glass.static_friction: {range: [0.1, 0.6]}}
observe: {beads: 150}
END

look() { "$1" "$work/study.yaml" --run "$work/run" --looks 10 --values "$work/$2.txt"; }
if [ -z "$other" ]; then
  look "$build/bin/millscope_look_bench" values
  exit
fi
for pair in 1 2 3 4 5; do
  before=$(look "$other" other | sed -n 's/^a look: \([0-9.]*\).*/\1/p')
  now=$(look "$build/bin/millscope_look_bench" values | sed -n 's/^a look: \([0-9.]*\).*/\1/p')
  awk -v b="$before" -v n="$now" 'BEGIN { printf "%s s before, %s s now, ratio %.2f\n", b, n, b / n }'
done
cmp "$work/other.txt" "$work/values.txt" && echo "every number is the same, to the last bit"
