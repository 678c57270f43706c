#!/bin/sh
# tools/install_packages.sh [test|docs]: installs the Debian packages of packages.txt that are missing. Without a word, what building needs;
# `test`: also what testing needs; `docs`: only what the documentation's site needs.
set -eu
list="$(dirname "$0")/../packages.txt"
case "${1:-}" in
  '') wanted=$(sed '/^# \[test\]/,$d' "$list" | grep -v '^#') ;;
  test) wanted=$(sed '/^# \[docs\]/,$d' "$list" | grep -v '^#') ;;
  docs) wanted=$(sed '1,/^# \[docs\]/d' "$list" | grep -v '^#') ;;
  *) echo "millscope: tools/install_packages.sh knows no '$1'; give nothing, test or docs" >&2; exit 2 ;;
esac

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "millscope: this is no Debian, so nothing is installed; needed are:" $wanted >&2
  exit 0
fi

# A release carries the report page as it is built, and needs no Node.js for it.
[ ! -f "$(dirname "$0")/../studies/report/page.html" ] || wanted=$(echo "$wanted" | grep -v '^nodejs?\|^npm?')

missing=""
for package in $wanted; do
  # npm?npm: only where there is no such command; another Node.js than Debian's will do.
  command=${package#*\?}
  [ "$command" = "$package" ] || { package=${package%\?*}; ! command -v "$command" >/dev/null || continue; }
  case "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)" in
    installed) ;;
    *) missing="$missing $package" ;;
  esac
done
[ -n "$missing" ] || exit 0

as_root=""
if [ "$(id -u)" != 0 ]; then
  as_root="sudo"
  if ! command -v sudo >/dev/null; then
    echo "millscope: cannot install packages without root or sudo; as root: apt-get install -y --no-install-recommends$missing" >&2
    exit 1
  fi
fi
echo "installing from Debian:$missing"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
install() { $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing >"$log" 2>&1; }
if install || { $as_root apt-get update >"$log" 2>&1 && install; }; then
  exit 0
fi
tail -n 5 "$log" >&2
echo "millscope: apt-get failed; when it works again: apt-get install -y --no-install-recommends$missing" >&2
exit 1
