#!/bin/sh
# tools/package.sh BUILD OUT: Debian packages of a finished build, and the sources with the report page as it is built, so that whoever
# builds from them needs no Node.js. OUT/*.deb, OUT/millscope-VERSION.tar.xz
set -eu
build=$1 out=$2
fail() { echo "millscope: $1" >&2; exit 1; }
command -v dpkg-shlibdeps >/dev/null || fail "packages need dpkg-shlibdeps: apt-get install dpkg-dev"
[ -z "$(git status --porcelain)" ] || fail "packages are made of a commit, and files differ from it: commit or stash them ('git status' lists them)"
page=$(sed -n 's/^MILLSCOPE_PAGE:[A-Z]*=\(.\+\)$/\1/p' "$build/CMakeCache.txt")
page=${page:-$build/studies/report/page.html}
[ -f "$page" ] || fail "$page is not there: build first (make install or make test)"
grep -q 'CPACK_COMPONENTS_ALL .*step' "$build/CPackConfig.cmake" ||
  echo "millscope: there will be no package millscope-step, for OpenCASCADE is not installed: apt-get install libocct-data-exchange-dev, and build again" >&2
mkdir -p "$out"
rm -f "$out"/millscope*.deb "$out"/python3-millscope*.deb "$out"/millscope-*.tar.xz
umask 022
cpack --config "$build/CPackConfig.cmake" -B "$out" >"$out/log" 2>&1 || { tail -n 20 "$out/log" >&2; exit 1; }
rm -rf "$out/_CPack_Packages" "$out/log"

version=$(sed -n 's/^set(CPACK_PACKAGE_VERSION "\(.*\)")$/\1/p' "$build/CPackConfig.cmake")
name=millscope-$version
git archive --prefix="$name/" HEAD >"$out/$name.tar"
tar -C "$(dirname "$page")" -rf "$out/$name.tar" --transform "s|^.*$|$name/studies/report/page.html|" "$(basename "$page")"
xz -f "$out/$name.tar"
ls -l "$out"
