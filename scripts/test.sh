#!/usr/bin/env bash
# Runs the test suite, stage by stage, and prints what passed and how long it took.
#   scripts/test.sh            every stage
#   scripts/test.sh STAGE...   these only, e.g. `scripts/test.sh release cli`
# A stage that fails does not stop the others; the exit status tells whether any did.
# LITTORAL_SHARED names a larger collection of test data (by default ../shared beside the checkout);
# tests that need it are reported as skipped where it is absent.
# FUZZ_SECONDS: time for each fuzz target (10).   JOBS: processes at once (all cores).
set -uo pipefail
cd "$(dirname "$0")/.."
export LITTORAL_SHARED="${LITTORAL_SHARED:-$(dirname "$PWD")/shared}"
jobs="${JOBS:-$(nproc)}"
venv="$PWD/build/venv/bin"
logs="$PWD/build/test-logs"
all_stages=(files format tools release cli install permissive sanitize fuzz viewer docs)

configure_and_build() {  # preset, further arguments of cmake
  local preset=$1
  shift
  cmake --preset "$preset" -DLITTORAL_WERROR=ON "$@" && cmake --build "build/$preset" -j "$jobs"
}

run_ctest() {  # preset, further arguments of ctest
  local preset=$1
  shift
  ctest --test-dir "build/$preset" --no-tests=error --output-on-failure -j "$jobs" "$@" |
    grep --line-buffered -vE '^ +Start +[0-9]+: |^ *[0-9]+/[0-9]+ Test +#.* Passed '
}

stage_files() {  # layers, lengths and paths
  "$venv/python" scripts/check_layers.py && "$venv/python" scripts/check_files.py
}

stage_format() {
  git ls-files '*.h' '*.cpp' | xargs "$venv/clang-format" --dry-run -Werror &&
    "$venv/ruff" check . && "$venv/ruff" format --check . && "$venv/mypy"
}

stage_tools() { "$venv/python" -m pytest -q tests/tools; }  # tests of the checks themselves

stage_release() { configure_and_build release && run_ctest release; }

stage_cli() {
  configure_and_build release &&
    LITTORAL="$PWD/build/release/littoral" "$venv/python" -m pytest -q -rs tests/cli
}

stage_install() { configure_and_build release && scripts/test_install.sh build/release; }

stage_permissive() { configure_and_build permissive && run_ctest permissive; }

# The presets name Clang 14, Debian 12's; newer releases have theirs under the plain name.
clang=()
command -v clang++-14 >/dev/null || clang=(-DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++)

# Address and undefined-behaviour sanitizers; suites named *Slow* would take too long under them.
stage_sanitize() {
  cmake --preset asan -DLITTORAL_WERROR=ON "${clang[@]}" &&
    cmake --build build/asan -j "$jobs" --target littoral_tests && run_ctest asan -E Slow
}

stage_fuzz() {
  cmake --preset fuzz -DLITTORAL_WERROR=ON "${clang[@]}" &&
    cmake --build build/fuzz -j "$jobs" --target fuzzers && fuzz/run.sh build/fuzz "${FUZZ_SECONDS:-10}"
}

stage_viewer() {
  local page="$PWD/build/viewer-test.html" volume="$PWD/build/viewer-volume-test.html" trace="$PWD/build/viewer-trace-test.html"
  configure_and_build release &&
    LITTORAL_PAGE_OUT="$page" LITTORAL_VOLUME_PAGE_OUT="$volume" LITTORAL_TRACE_PAGE_OUT="$trace" build/release/tests/littoral_tests --gtest_brief=1 --gtest_filter='*BrowserTest*' &&
    (cd viewer && npm ci --no-audit --no-fund --loglevel=error && PAGE="$page" VOLUME_PAGE="$volume" TRACE_PAGE="$trace" npm test)
}

stage_docs() { "$venv/mkdocs" build --strict --quiet --site-dir build/site; }

stages=("$@")
[ ${#stages[@]} -gt 0 ] || stages=("${all_stages[@]}")
for stage in "${stages[@]}"; do
  [[ " ${all_stages[*]} " == *" $stage "* ]] ||
    { echo "there is no stage '$stage'; there are: ${all_stages[*]}" >&2; exit 2; }
done

mkdir -p "$logs"
summary="" failed=0 begin=$SECONDS
for stage in "${stages[@]}"; do
  echo "==== $stage"
  start=$SECONDS
  if "stage_$stage" 2>&1 | tee "$logs/$stage.log"; then result=passed; else result=FAILED failed=$((failed + 1)); fi
  echo "stage $stage $result" >>"$logs/$stage.log"
  summary+=$(printf '%-12s %-8s %5d s' "$stage" "$result" $((SECONDS - start)))$'\n'
done

# ctest and pytest state their counts in their closing lines.
logs_run=("${stages[@]/#/$logs/}")
counts=$(python3 scripts/count_tests.py "${logs_run[@]/%/.log}")
echo "==== summary"
printf '%s' "$summary"
echo "stages: $((${#stages[@]} - failed)) passed, $failed failed (${stages[*]})"
echo "==== $counts in $((SECONDS - begin)).00s ===="
[ "$failed" = 0 ]
