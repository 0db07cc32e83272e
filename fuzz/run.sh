#!/bin/sh
# Runs every fuzz target of a build for a bounded time and fails if one crashes, hangs or eats memory.
# Usage: fuzz/run.sh BUILD_DIR SECONDS
#   cmake -S . -B BUILD_DIR -DLITTORAL_FUZZ=ON -DCMAKE_CXX_COMPILER=clang++ && \
#   cmake --build BUILD_DIR --target fuzzers
# Inputs found on the way, and those that failed, go to BUILD_DIR/fuzz/NAME.
set -eu
if [ $# -ne 2 ]; then
  echo "usage: $0 BUILD_DIR SECONDS" >&2
  exit 2
fi
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
status=0
for name in obj off ply stl pc xyz pcd vti nrrd npy vol mesh tet vtk sources; do
  found="$build/fuzz/$name"
  mkdir -p "$found/corpus" "$found/failed"
  echo "== $name"
  "$build/fuzz/fuzz_$name" -max_total_time="$2" -rss_limit_mb=512 -timeout=5 -max_len=4096 \
    -print_final_stats=1 -verbosity=0 -artifact_prefix="$found/failed/" \
    "$found/corpus" "$here/corpus/$name" || status=1
done
exit $status
