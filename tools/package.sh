#!/bin/sh
# tools/package.sh BUILD OUT: Debian packages of a finished build, and the sources with the report page as it is built, so that whoever
# builds from them needs no Node.js. OUT/*.deb, OUT/millscope-VERSION.tar.xz
set -eu
build=$1 out=$2
command -v dpkg-shlibdeps >/dev/null || { echo "millscope: packages need dpkg-shlibdeps: apt-get install dpkg-dev" >&2; exit 1; }
rm -rf "$out"
mkdir -p "$out"
umask 022
cpack --config "$build/CPackConfig.cmake" -B "$out" >"$out/log" 2>&1 || { tail -n 20 "$out/log" >&2; exit 1; }
rm -rf "$out/_CPack_Packages" "$out/log"

version=$(sed -n 's/^set(CPACK_PACKAGE_VERSION "\(.*\)")$/\1/p' "$build/CPackConfig.cmake")
name=millscope-$version
git archive --prefix="$name/" HEAD >"$out/$name.tar"
page=$build/studies/report/page.html
tar -C "$build/studies/report" -rf "$out/$name.tar" --transform "s|^page.html|$name/studies/report/page.html|" "$(basename "$page")"
xz -f "$out/$name.tar"
ls -l "$out"
