#!/bin/sh
# The benchmark: bench/run.sh BUILD_DIR [options]; bench/run.sh --help lists them.
exec python3 "$(dirname "$0")/run.py" "$@"
