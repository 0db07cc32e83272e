#!/usr/bin/env bash
# Makes the wheel of the Python package.
# usage: scripts/make_wheel.sh FOLDER                         for any Linux of glibc 2.28 or later, by zig
#                                                             where scripts/setup.sh zig put it, else as below
#        scripts/make_wheel.sh FOLDER aarch64                 the same for 64-bit ARM, by zig
#        scripts/make_wheel.sh FOLDER ARGUMENT_OF_PIP...      by this machine's compiler, for its glibc
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$1
shift
venv="$PWD/build/venv/bin"
glibc=2.28  # nanobind-backend, which the wheel needs, is for 2.27 (x86-64) and 2.26 (ARM)
zig=$("$venv/python" -c 'import ziglang; print(ziglang.__path__[0])' 2>/dev/null)/zig || true
metis="$PWD/build/zig/metis"

machine=
if [ $# = 0 ] && [ -x "$zig" ] && [ -d "$metis" ]; then machine=$(uname -m); fi
if [ "${1:-}" = aarch64 ]; then
  machine=$1
  shift
  [ -x "$zig" ] && [ -d "$metis" ] || { echo "64-bit ARM needs zig: scripts/setup.sh zig" >&2; exit 1; }
fi
if [ -n "$machine" ]; then
  export _PYTHON_HOST_PLATFORM=linux-$machine
  set -- -Cbuild-dir="build/zig/$machine" -Ccmake.define.Metis_SOURCE_DIR="$metis" \
    -Ccmake.define.CMAKE_TOOLCHAIN_FILE="$PWD/cmake/zig.cmake" -Ccmake.define.LITTORAL_ZIG="$zig" \
    -Ccmake.define.LITTORAL_ZIG_TARGET="$machine-linux-gnu.$glibc"
fi
raw=$(mktemp -d)
trap 'rm -rf "$raw"' EXIT
"$venv/pip" wheel . --no-deps --no-build-isolation --disable-pip-version-check -q -w "$raw" "$@"
# Puts shared libraries into the wheel, if there are any, and names the oldest glibc that will do.
PATH="$venv:$PATH" "$venv/auditwheel" repair -w "$folder" "$raw"/littoral-*.whl >"$raw/log" 2>&1 ||
  { cat "$raw/log" >&2; exit 1; }
