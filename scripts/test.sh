#!/usr/bin/env bash
# Runs checks and tests, stage by stage, and prints what passed and how long it took.
#   scripts/test.sh            every stage of `make test`
#   scripts/test.sh check      the tier of `make check`: what takes a few minutes
#   scripts/test.sh long       the tier of `make test-long`: what takes hours
#   scripts/test.sh STAGE...   these only, e.g. `scripts/test.sh release cli`
# A stage that fails does not stop the others; the exit status tells whether any did. Stages that use one
# core run beside those that use all; what they say is printed when they have ended.
# LITTORAL_SHARED names a larger collection of test data (by default ../shared beside the checkout);
# tests that need it are reported as skipped where it is absent.
# FUZZ_SECONDS: time for each fuzz target (3; 300 in the long tier).   JOBS: processes at once (all cores).
# SOAK_SECONDS: how long batches run in the long tier (3600).
# FUZZ_CASES: random cases of all methods, by seeds, in the long tier (1000000).
# MUTATIONS, MUTATE_SEED: how many changes to the sources, and which, in the long tier (100, 1).
set -uo pipefail
cd "$(dirname "$0")/.."
export LITTORAL_SHARED="${LITTORAL_SHARED:-$(dirname "$PWD")/shared}"
jobs="${JOBS:-$(nproc)}"
venv="$PWD/build/venv/bin"
logs="$PWD/build/test-logs"
check_stages=(files format tools docs quick package pages)
test_stages=(files format tools docs release cli install wheel pages sanitize threads fuzz web viewer)
long_stages=(slow sanitize_slow sanitize_package clusters soak fuzz_long mutate firefox studies single aarch64)
all_stages=("${test_stages[@]}" quick package "${long_stages[@]}")

# Suites that take longer than a few seconds each; `quick` leaves them out.
slow='Slow|^Cases/|^Domains/OnEveryDomain|^(Multigrid|Regularized[A-Za-z]*|AllPairs|HeatPoints|Sharpen|SignedHeatTets|Picture|Repair|RepairWalls|TracedScene|Quadratic[A-Za-z]*|SignedQuadratic)\.'
# Suites that several threads work in.
shared_between_threads='Beside|HeatWindows|Parallel|Thread|Registry|Solver'

build() {  # preset, further arguments of cmake --build
  local preset=$1
  shift
  (
    flock 9 && cmake --preset "$preset" ${compilers[@]+"${compilers[@]}"} >/dev/null &&
      nice -n 3 cmake --build "build/$preset" -j "$jobs" "$@"  # tests that run beside go first
  ) 9>"build/$preset.lock"
}
compilers=()
# The build that most stages test, with the module of the Python package: the release, or where stages of
# `make check` are all, one that is quicker to compile. What has been built whole in this run stays
# as it is: stages that run side by side read it.
main=check
build_main() {
  local compilers=(-DLITTORAL_PYTHON=ON -DPython_EXECUTABLE="$venv/python")
  [[ -f $logs/main.built ]] && return
  case "$main" in
    release) compilers+=(-DLITTORAL_TESTS=OFF) && build release "$@" ;;
    *) with_clang "$main" "$@" ;;
  esac && { [ $# -gt 0 ] || touch "$logs/main.built"; }
}
# The tests of that release, in its folder: Clang compiles them in less than half the time.
release_tests() { build_main && with_clang tests; }
viewer_packages() {  # once, as `npm ci` takes away what another stage may be running
  flock build/viewer.lock sh -c 'cd viewer && [ node_modules/.package-lock.json -nt package-lock.json ] ||
    npm ci --no-audit --no-fund --loglevel=error'
}
# The presets name Clang 14, Debian 12's; newer releases have theirs under the plain name.
with_clang() {
  command -v clang++-14 >/dev/null || local compilers=(${compilers[@]+"${compilers[@]}"} -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++)
  build "$@"
}

run_tests() {  # program below build/, further arguments of run_tests.py
  local program=$1
  shift
  "$venv/python" scripts/run_tests.py "build/$program" --jobs "$jobs" "$@"
}

stage_files() {  # layers, lengths, paths, repeated lines
  "$venv/python" scripts/check_layers.py && "$venv/python" scripts/check_files.py
}

stage_format() {
  git ls-files '*.h' '*.cpp' | xargs "$venv/clang-format" --dry-run -Werror &&
    "$venv/ruff" check . && "$venv/ruff" format --check . && "$venv/mypy"
}

# Where stages of `make check` are all, Python's tests that are marked as slow are left out.
run_pytest() {
  local selected=()
  [ "$main" = release ] || selected=(-m "not slow")
  "$venv/python" -m pytest -q -rs ${selected[@]+"${selected[@]}"} "$@"
}

stage_tools() { run_pytest tests/tools; }  # tests of the checks themselves

stage_docs() { "$venv/mkdocs" build --strict --quiet --site-dir build/site; }

stage_quick() { build_main && run_tests "$main/tests/littoral_tests" --without "$slow"; }

stage_release() { release_tests && run_tests release/tests/littoral_tests; }

stage_cli() {
  build_main && LITTORAL="$PWD/build/release/littoral" run_pytest tests/cli
}

# The Python package as it lies in the build: its stubs, and its tests; arguments: of pytest.
stage_package() {
  local package="$PWD/build/$main/python"
  build_main &&
    PYTHONPATH="$package" "$venv/python" -m nanobind.stubgen -q -m littoral._core -o build/_core.pyi &&
    "$venv/ruff" format -q --config 'extend-exclude = []' build/_core.pyi && diff build/_core.pyi python/littoral/_core.pyi &&
    LITTORAL="$PWD/build/$main/littoral" PYTHONPATH="$package" run_pytest python/tests "$@"
}

# The code on the pages of the documentation.
stage_pages() {
  build_main && LITTORAL="$PWD/build/$main/littoral" PYTHONPATH="$PWD/build/$main/python" run_pytest tests/pages
}

# The wheel in an empty environment; then of the package's tests those that need more than that.
stage_wheel() {
  build_main && scripts/test_wheel.sh build/release &&
    stage_package --but-passed-in build/wheel-test/tests.xml
}

stage_install() { build_main && scripts/test_install.sh build/release; }

# Address and undefined-behaviour sanitizers; the suites named *Slow* wait for `make test-long`.
# The library is what they watch: its tests are those that the stage `release` runs, linked with it.
stage_sanitize() {
  with_clang tests --target littoral_test_files &&
    sanitized_tests "$PWD/build/tests/tests/liblittoral_test_files.a" &&
    run_tests asan/tests/littoral_tests --without Slow
}
sanitized_tests() {
  local compilers=(-DLITTORAL_TEST_ARCHIVE="$1")
  with_clang asan --target littoral_tests
}

stage_threads() {  # ThreadSanitizer
  with_clang tsan --target littoral_tests &&
    TSAN_OPTIONS=halt_on_error=1 run_tests tsan/tests/littoral_tests --only "$shared_between_threads" --without Slow
}

stage_fuzz() {
  with_clang asan --target fuzzers && JOBS="$jobs" fuzz/run.sh build/asan "${FUZZ_SECONDS:-3}"
}

# The viewer's tests on pages of this build; arguments: what they are run by.
viewer_tests() {
  local page="$PWD/build/viewer-test.html" volume="$PWD/build/viewer-volume-test.html" trace="$PWD/build/viewer-trace-test.html"
  release_tests &&
    LITTORAL_PAGE_OUT="$page" LITTORAL_VOLUME_PAGE_OUT="$volume" LITTORAL_TRACE_PAGE_OUT="$trace" build/release/tests/littoral_tests --gtest_brief=1 --gtest_filter='*BrowserTest*' &&
    viewer_packages && (cd viewer && PAGE="$page" VOLUME_PAGE="$volume" TRACE_PAGE="$trace" "$@" npm test)
}

stage_viewer() { viewer_tests env; }

# The package for JavaScript and the studio beside the program, in Node and in Chromium.
stage_web() {
  local dist="$PWD/build/web/dist"
  build web && build_main --target littoral_cli && node web/build.mjs build/web "$dist" &&
    viewer_packages &&
    DIST="$dist" TOOLS="$PWD/build/web/node_modules" LITTORAL="$PWD/build/release/littoral" \
      node --test web/test/package.test.mjs web/test/browser.test.mjs &&
    (cd web/studio && npm ci --no-audit --no-fund --loglevel=error && npm run --silent check &&
      node build.mjs "$dist" "$dist/inline.js" &&
      STUDIO="$dist/studio.html" LITTORAL="$OLDPWD/build/release/littoral" npm test)
}

# What follows makes up the long tier.
stage_slow() { release_tests && run_tests release/tests/littoral_tests --only Slow --limit 3600; }

# The tests are watched by the sanitizers, too.
stage_sanitize_slow() {
  sanitized_tests "" &&
    run_tests asan/tests/littoral_tests --only Slow --limit 7200
}

# Arrays of all kinds through the module of the Python package: its tests, and cases of fuzz/arrays.py.
stage_sanitize_package() {
  local compilers=(-DLITTORAL_PYTHON=ON -DPython_EXECUTABLE="$venv/python")
  with_clang asan --target littoral_package &&
    LD_PRELOAD=$(clang++-14 -print-file-name=libclang_rt.asan-x86_64.so) ASAN_OPTIONS=detect_leaks=0 \
      PYTHONPATH="$PWD/build/asan/python" "$venv/python" -m pytest -q -p no:cacheprovider \
      python/tests/test_arrays.py python/tests/test_surfaces.py python/tests/test_space.py \
      python/tests/test_operators.py --deselect python/tests/test_surfaces.py::test_many_calls_do_not_grow &&
    LD_PRELOAD=$(clang++-14 -print-file-name=libclang_rt.asan-x86_64.so) ASAN_OPTIONS=detect_leaks=0 \
      PYTHONPATH="$PWD/build/asan/python" "$venv/python" -W ignore fuzz/arrays.py 3000
}

# Batches on local clusters of Ray and Dask, one of whose workers is killed, and in an object store.
stage_clusters() {
  build_main && python3 -m venv build/clusters &&
    build/clusters/bin/pip install --quiet -r requirements-dev.txt -r requirements-clusters.txt &&
    LITTORAL="$PWD/build/release/littoral" PYTHONPATH="$PWD/build/release/python" \
      build/clusters/bin/python -m pytest -q -rs python/tests/test_batch.py python/tests/test_samples.py
}

# Batches of damaged inputs for an hour, or SOAK_SECONDS: nothing is lost, memory stays flat.
stage_soak() {
  build_main && PYTHONPATH="$PWD/build/release/python" "$venv/python" bench/batch/soak.py \
    build/release/littoral examples/data build/soak "${SOAK_SECONDS:-3600}"
}

stage_fuzz_long() {
  with_clang asan --target fuzzers && JOBS="$jobs" fuzz/run.sh build/asan "${FUZZ_SECONDS:-300}" &&
    many_cases "${FUZZ_CASES:-1000000}"
}

# Methods on random domains, by seeds; each process takes its share.
many_cases() {
  release_tests &&
    seq 0 $((jobs - 1)) | xargs -P "$jobs" -I{} sh -c '
      share=$(($1 / $2))
      LITTORAL_CASES=$(({} * share)):$share exec build/release/tests/littoral_tests --gtest_brief=1 \
        --gtest_filter=MethodCases.KeepWhatIsPromised' _ "$1" "$jobs"
}

# Would the tests notice random changes to the sources?
stage_mutate() {
  local compilers=(-DLITTORAL_TESTS=ON)
  build release --target littoral_tests &&
    "$venv/python" scripts/mutate.py --count "${MUTATIONS:-100}" --seed "${MUTATE_SEED:-1}"
}

# The same in Firefox, on a display that nobody sees.
stage_firefox() {
  local firefox
  if firefox=$(command -v firefox-esr || command -v firefox) && command -v xvfb-run >/dev/null; then
    viewer_tests env FIREFOX="$firefox" xvfb-run -a
  else
    printf '%s\n' "Firefox or xvfb-run is not installed" "# skipped 1"
  fi
}

stage_studies() { build bench; }  # benchmarks and studies compile

stage_single() { build single; }  # every file on its own, so that none lives off its neighbours

stage_aarch64() {  # QEMU does not hold programs to the memory that they may have
  scripts/setup.sh aarch64 && build aarch64 &&
    run_tests aarch64/tests/littoral_tests --without "$slow|^ForkServer.LimitsMemory$" --limit 1800 \
      --run "qemu-aarch64 -L /usr/aarch64-linux-gnu" &&
    qemu-aarch64 -L /usr/aarch64-linux-gnu build/aarch64/littoral --help >/dev/null
}

stages=()
for name in "$@"; do
  case "$name" in
    check) stages+=("${check_stages[@]}") ;;
    test) stages+=("${test_stages[@]}") ;;
    long) stages+=("${long_stages[@]}") ;;
    *) stages+=("$name") ;;
  esac
done
[ ${#stages[@]} -gt 0 ] || stages=("${test_stages[@]}")
for stage in "${stages[@]}"; do
  [[ " ${check_stages[*]} " == *" $stage "* ]] || main=release
  [[ " ${all_stages[*]} " == *" $stage "* ]] ||
    { echo "there is no stage '$stage'; there are: check test long ${all_stages[*]}" >&2; exit 2; }
done

mkdir -p "$logs"
rm -rf "$logs"/*.result "$logs"/*.taken "$logs/main.built"
begin=$SECONDS
run_stage() {  # its output goes to its log, too; how it ended, and its times by the clock and of processors, to its result
  local stage=$1 start=$SECONDS result=FAILED
  (
    "stage_$stage"
    status=$?
    times >"$logs/$stage.times"
    exit $status
  ) 2>&1 | tee "$logs/$stage.log" && result=passed
  echo "stage $stage $result" >>"$logs/$stage.log"
  printf '%-14s %-8s from %5d s on, %5d s, processors %5d s\n' "$stage" "$result" $((start - begin)) \
    $((SECONDS - start)) "$(awk -F '[ms ]+' 'END { print int($1 * 60 + $2 + $3 * 60 + $4) }' "$logs/$stage.times")" \
    >"$logs/$stage.result"
}
# Three lanes: what waits for one core most of the time, and the build for browsers, run beside what
# keeps all cores busy. All may use the main build, but only the first lane while it builds it, which is
# the first thing it does. When the first lane has no more, it takes of the others what only reads there.
busy=() beside=() browsers=() other=()
for stage in "${stages[@]}"; do
  case "$stage" in
    release | quick | sanitize | threads | fuzz) busy+=("$stage") ;;
    files | format | tools | docs | cli | install | package | wheel | pages) beside+=("$stage") ;;
    web | viewer) browsers+=("$stage") ;;
    *) other+=("$stage") ;;
  esac
done
take() { mkdir "$logs/$1.taken" 2>/dev/null; }  # by the lane that comes first
run_beside() {
  local stage before
  for stage in "$@"; do
    take "$stage" || continue
    case "$stage" in
      files | format | tools | docs) ;;
      *) for before in "${busy[@]}"; do
           while [[ $before =~ ^(release|quick)$ && ! -f $logs/main.built && ! -f $logs/$before.result ]]; do sleep 1; done
         done ;;
    esac
    run_stage "$stage" >/dev/null
    flock "$logs" sh -c 'echo "==== $1, run beside" && cat "$2" && echo "==== end of $1"' _ \
      "$stage" "$logs/$stage.log"
  done
}
n_beside=$((${#beside[@]} + ${#browsers[@]}))
if [ ${#busy[@]} -gt 0 ] && [ $n_beside -gt 0 ] && [ ${#other[@]} = 0 ] && [ "$jobs" -gt 1 ]; then
  trap 'trap - INT; kill 0' INT  # jobs in the background would go on
  run_beside ${beside[@]+"${beside[@]}"} &
  run_beside ${browsers[@]+"${browsers[@]}"} &
  in_turn=("${busy[@]}") after=(viewer cli)
  [[ " ${stages[*]} " == *" wheel "* ]] || after+=(pages)  # it links the package again
else
  in_turn=("${stages[@]}") after=()
fi
run_aloud() {
  echo "==== $1"
  run_stage "$1"
}
for stage in "${in_turn[@]}"; do run_aloud "$stage"; done
for stage in ${after[@]+"${after[@]}"}; do
  if [[ " ${beside[*]} ${browsers[*]} " == *" $stage "* ]] && take "$stage"; then run_aloud "$stage"; fi
done
wait
results=("${stages[@]/#/$logs/}")
failed=$(cat "${results[@]/%/.result}" | grep -c ' FAILED ')

# The test programs state their counts in their closing lines.
counts=$(python3 scripts/count_tests.py "${results[@]/%/.log}")
echo "==== summary"
cat "${results[@]/%/.result}"
echo "stages: $((${#stages[@]} - failed)) passed, $failed failed (${stages[*]})"
echo "==== $counts in $((SECONDS - begin)).00s ===="
[ "$failed" = 0 ]
