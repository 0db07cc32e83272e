#!/usr/bin/env bash
# Makes the wheel of a build, installs it into an empty environment and runs the tests of the package
# there, with no compiler in sight.
# usage: scripts/test_wheel.sh BUILD [PYTHON...]    interpreters to try it with (python3)
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1
shift
[ $# -gt 0 ] || set -- build/venv/bin/python
out="$PWD/build/wheel-test"
rm -rf "$out"
mkdir -p "$out"

# The build stays as it is, for other stages read it: a folder of the wheel's own links its library.
# What compiles is the same, so that ccache has all of it.
kept=("-Ccmake.define.LITTORAL_LIBRARY=$PWD/$build/liblittoral.a")
for name in CMAKE_CXX_COMPILER LITTORAL_WERROR; do
  value=$(sed -n "s/^$name:[A-Z]*=//p" "$build/CMakeCache.txt")
  kept+=("-Ccmake.define.$name=$value")
done
scripts/make_wheel.sh "$out" "$(uname -m)" "$build-wheel" "${kept[@]}"
wheel=$(ls "$out"/littoral-*.whl)
case "$wheel" in *-cp310-abi3-*) ;; *) echo "$wheel is not for the stable ABI" >&2; exit 1 ;; esac
if python3 -m zipfile -l "$wheel" | grep -E '\.(a|h|cmake)  |lib64|/bin/'; then
  echo "the wheel holds the files above, which belong to C++" >&2
  exit 1
fi

for python in "$@"; do
  venv="$out/venv"
  rm -rf "$venv"
  "$python" -m venv "$venv"
  tools=$(grep -E '^(hypothesis|pytest)==' requirements-dev.txt)
  # Their pinned versions are for the Python of build/venv and later.
  if "$python" -c 'import sys; sys.exit(sys.version_info >= (3, 11))'; then tools="hypothesis pytest"; fi
  "$venv/bin/pip" install --disable-pip-version-check -q "$wheel" $tools scipy
  env -i HOME="$out" PATH="$venv/bin" LITTORAL_SHARED="${LITTORAL_SHARED:-}" \
    python -m pytest -q -rs -p no:cacheprovider --rootdir python/tests --junitxml "$out/tests.xml" python/tests
  env -i HOME="$out" PATH="$venv/bin" \
    python -m pytest -q -p no:cacheprovider --doctest-modules --pyargs littoral \
    --ignore-glob='*/littoral/torch.py' --ignore-glob='*/littoral/pyvista.py' \
    --ignore-glob='*/littoral/dask.py' --ignore-glob='*/littoral/ray.py'
done
echo "wheel: $(stat -c %s "$wheel") bytes, installed and tested with $*"
