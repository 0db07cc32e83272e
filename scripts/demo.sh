#!/usr/bin/env bash
# Builds littoral and computes signed distance to a broken curve on the shipped cow.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh build
cmake --preset release -DLITTORAL_TESTS=OFF >/dev/null
cmake --build build/release --target littoral_cli

mkdir -p out
rm -f out/demo.*
build/release/littoral distance examples/data/spot.obj --sources examples/data/spot-jersey.txt \
  -o out/demo.ply -o out/demo.html -o out/demo.png

echo
echo "Signed distance to the broken outline of a jersey, on the surface of a cow."
echo "out/demo.html is a page to turn it in, out/demo.png a picture, out/demo.ply the mesh with its distances:"
ls -lh out/demo.html out/demo.png out/demo.ply
