#!/bin/sh
# tools/tidy.sh BUILD [FILE…]: clang-format and clang-tidy over all sources, or those named. Needs BUILD/compile_commands.json.
set -eu
cd "$(dirname "$0")/.."
build=$1
shift
# wide.cpp is written in g++'s vector types, which clang cannot read.
[ $# -gt 0 ] || set -- $(git ls-files '*.cpp' ':!kernel/dem/wide.cpp')
for tool in clang-tidy clang-format; do
  command -v $tool >/dev/null || { echo "millscope: $tool is missing; apt-get install clang-tidy clang-format" >&2; exit 1; }
done
clang-format --dry-run --Werror "$@"
printf '%s\n' "$@" | xargs -P "${JOBS:-$(nproc)}" -n 1 clang-tidy --quiet -p "$build"
