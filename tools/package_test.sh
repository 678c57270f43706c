#!/bin/sh
# tools/package_test.sh [PACKAGES] [ROOT]: installs the packages into an empty Debian 12 below ROOT (made with debootstrap; root's rights
# needed), without compiler, sources or Node.js, and goes from nothing to a page, and from a STEP drawing to the power. Says how long each takes.
set -eu
packages=${1:-build/packages} root=${2:-build/debian12}
here=$(cd "$(dirname "$0")/.." && pwd)
fail() { echo "millscope: $1" >&2; exit 1; }
[ "$(id -u)" = 0 ] || fail "a root of its own needs root's rights; run it with sudo"
command -v debootstrap >/dev/null || fail "apt-get install debootstrap"
marker=made_by_package_test  # nothing is removed or installed in a folder that this script has not made
if [ ! -e "$root" ]; then
  mirror=$(sed -n 's/^URIs: *//p; s/^deb \(\[[^]]*\] \)\?\([^ ]*\) .*/\2/p' /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null | head -n 1)
  rm -rf "$root.new"
  debootstrap --variant=minbase bookworm "$root.new" "$mirror" >"$root.log" 2>&1 || { tail -n 3 "$root.log" >&2; fail "debootstrap failed"; }
  touch "$root.new/$marker"
  mv "$root.new" "$root"
fi
[ -f "$root/$marker" ] || fail "$root was not made by this script; name a folder that does not exist"

step() {  # step NAME COMMAND…: in the root, timed, with the last lines of what it says
  name=$1; shift
  begin=$(date +%s)
  if ! chroot "$root" sh -c "cd /root && $*" >"$root/log" 2>&1; then tail -n 20 "$root/log" >&2; fail "'$name' failed"; fi
  echo "$name: $(($(date +%s) - begin)) s"
}

mount -t proc proc "$root/proc"
trap 'umount "$root/proc"' EXIT
trap 'exit 130' INT TERM
cp -f /etc/resolv.conf "$root/etc/"
rm -rf "$root/root/"*
cp "$packages"/*.deb "$here/examples/liner.step" "$root/root/"
export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8
step "apt-get update" apt-get update
step "install millscope" "apt-get install -y --no-install-recommends ./millscope_*.deb"
step "no compiler, no Node.js" "! command -v g++ && ! command -v cc && ! command -v node && ! command -v npm"
step "new" millscope new mill --yes
step "run" millscope run mill/case.yaml -o first
step "analyze" millscope analyze first -o first-maps
step "report" "millscope report first first-maps -o first.html && test \$(stat -c %s first.html) -gt 100000"
step "install millscope-step" "apt-get install -y --no-install-recommends ./millscope-step_*.deb"
step "new from STEP" millscope new stepped --liner liner.step --bead-size "\"10 mm\"" --yes
step "run from STEP" millscope run stepped/case.yaml -o second
step "install python3-millscope" "apt-get install -y --no-install-recommends ./python3-millscope_*.deb"
step "read from Python" "python3 -c 'import millscope; print(millscope.open_run(\"first\").power)'"
chroot "$root" sh -c "cd /root && grep -A 6 power_W second/summary.json"
