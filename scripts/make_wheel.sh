#!/usr/bin/env bash
# Makes the wheel of the Python package, with the libraries it is linked to inside.
# usage: scripts/make_wheel.sh FOLDER PROCESSOR BUILD [ARGUMENT_OF_PIP...]
#   PROCESSOR   x86_64 or aarch64; what is not this machine's is cross-compiled
#   BUILD       the folder to compile in
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$1
processor=$2
build=$3
shift 3
scripts/setup.sh wheel
raw=$(mktemp -d)
trap 'rm -rf "$raw"' EXIT
settings=(-Cbuild-dir="$build" -Ccmake.define.LITTORAL_MANYLINUX=ON "$@")
if [ "$processor" != "$(uname -m)" ]; then
  export _PYTHON_HOST_PLATFORM=linux-$processor CMAKE_TOOLCHAIN_FILE=$PWD/cmake/$processor.cmake
  # The toolchain's is for programs without shared libraries.
  settings+=(-Ccmake.define.ZLIB_LIBRARY_RELEASE="/usr/lib/$processor-linux-gnu/libz.so")
fi
build/venv/bin/pip wheel . --no-deps --no-build-isolation --disable-pip-version-check -q -w "$raw" \
  "${settings[@]}"
PATH="$PWD/build/venv/bin:$PATH" \
  build/venv/bin/auditwheel repair -w "$raw/repaired" "$raw"/littoral-*.whl >"$raw/log" 2>&1 ||
  { cat "$raw/log" >&2; exit 1; }
case $(ls "$raw/repaired") in
  *manylinux_2_1[0-9]_"$processor"* | *manylinux_2_2[0-8]_"$processor"*) ;;
  *) echo "not for glibc 2.28: $(ls "$raw/repaired")" >&2; exit 1 ;;
esac
# Wheels are built below a temporary folder; what is loaded from one may be anybody's.
python3 -m zipfile -e "$raw"/repaired/*.whl "$raw/unpacked"
if grep -rlF "$(python3 -c 'import tempfile; print(tempfile.gettempdir())')/tmp" "$raw/unpacked" >&2; then
  echo "the files above name a temporary folder" >&2
  exit 1
fi
mkdir -p "$folder"
mv "$raw"/repaired/* "$folder"
