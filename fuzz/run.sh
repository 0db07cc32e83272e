#!/bin/sh
# Runs every fuzz target of a build for a bounded time and fails if one crashes, hangs or eats memory.
# Usage: fuzz/run.sh BUILD_DIR SECONDS      JOBS: targets at once (all cores)
#   cmake --preset asan && cmake --build build/asan --target fuzzers && fuzz/run.sh build/asan 10
# Inputs found on the way, and those that failed, go to BUILD_DIR/fuzz/NAME.
set -eu
if [ $# -ne 2 ]; then
  echo "usage: $0 BUILD_DIR SECONDS" >&2
  exit 2
fi
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
export here build seconds="$2"
targets="obj off ply stl glb gltf 3mf pc xyz pcd npy_cloud npz_cloud vtp vtk_surface vti nrrd npy npz
  vtk_volume vol mesh tet vtk msh vtu sources"
# A case of `methods` takes a tenth of a second: in a short run the seeds of MethodCases see more.
if [ "$2" -ge 60 ]; then targets="$targets methods"; fi
# Each prints when it is done, so that the outputs do not mix.
printf '%s\n' $targets |
  xargs -P "${JOBS:-$(nproc)}" -n 1 sh -c '
    found="$build/fuzz/$0"
    mkdir -p "$found/corpus" "$found/failed"
    memory=512
    if [ "$0" = methods ]; then memory=2048; fi  # the sanitizer keeps what was freed for a while
    if "$build/fuzz/fuzz_$0" -max_total_time="$seconds" -rss_limit_mb="$memory" -timeout=5 -max_len=4096 \
      -print_final_stats=1 -verbosity=0 -artifact_prefix="$found/failed/" \
      "$found/corpus" "$here/corpus/$0" >"$found/log" 2>&1
    then echo "== $0"; cat "$found/log"
    else echo "== $0 FAILED"; cat "$found/log"; exit 1; fi'
