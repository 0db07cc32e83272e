#!/usr/bin/env bash
# Makes the wheel of the Python package, with the libraries it is linked to inside.
# usage: scripts/make_wheel.sh FOLDER [ARGUMENT_OF_PIP...]
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$1
shift
raw=$(mktemp -d)
trap 'rm -rf "$raw"' EXIT
build/venv/bin/pip wheel . --no-deps --no-build-isolation --disable-pip-version-check -q -w "$raw" "$@"
PATH="$PWD/build/venv/bin:$PATH" build/venv/bin/auditwheel repair -w "$folder" "$raw"/littoral-*.whl >"$raw/log" 2>&1 ||
  { cat "$raw/log" >&2; exit 1; }
