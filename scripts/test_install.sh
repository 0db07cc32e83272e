#!/usr/bin/env bash
# Installs a build into an empty prefix, builds examples/ against it and runs what came out; then sees that examples/ configures with the sources, too.
# usage: scripts/test_install.sh BUILD
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1
here="$PWD/build/install-test"
prefix="$here/prefix"
out="$here/out"
rm -rf "$here"
mkdir -p "$out"

cmake --install "$build" --prefix "$prefix" >/dev/null
cp -r examples "$here/examples"
cmake -S "$here/examples" -B "$here/build" -G Ninja -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS="-Wall -Wextra -Wpedantic -Wshadow -Werror" -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
cmake --build "$here/build"
mesh=examples/data/spot.obj curves=examples/data/spot-jersey.txt
expect() {  # words that the output must hold, then the command
  local words=$1
  shift
  local said
  said=$("$@") || { echo "$1 failed" >&2; exit 1; }
  grep -qF "$words" <<<"$said" || { echo "$1 did not say '$words': $said" >&2; exit 1; }
}
expect "441 vertices" "$here/build/hello"
expect "between three points" "$here/build/many_sources" "$mesh"
expect "bounding" "$here/build/regions" "$mesh" "$curves" "$out"
expect "100 %" "$here/build/offset" "$mesh" "$out"
expect "overlap" "$here/build/clearance" "$mesh" "$mesh"
expect "from pole to pole" "$here/build/cloud"
expect "from its boundary" "$here/build/tets"
expect "inside, nearest face" "$here/build/from_cgal" "$mesh" "$out/closed.ply"
for file in distance.ply distance.png regions.txt shell.ply closed.ply difference.ply distance.nrrd; do
  [ -s "$out/$file" ] || { echo "the examples did not write $file" >&2; exit 1; }
done
"$prefix/bin/littoral" --help >/dev/null
for file in man/man1/littoral.1 man/man1/littoral-sdf.1 bash-completion/completions/littoral \
  zsh/site-functions/_littoral fish/vendor_completions.d/littoral.fish; do
  [ -s "$prefix/share/$file" ] || { echo "share/$file is not installed" >&2; exit 1; }
done

[ "$(cd "$prefix/include" && find . -name '*.h' | grep -cv '^./littoral/')" = 0 ] ||
  { echo "headers outside include/littoral are installed" >&2; exit 1; }
if grep -rIlF "$PWD" "$prefix/lib" "$prefix/include" --include='*.cmake' --include='*.h' ; then
  echo "the installed files above name the build machine's folders" >&2
  exit 1
fi
cmake -S "$here/examples" -B "$here/sources" -G Ninja -DLITTORAL_SOURCES="$PWD" \
  -DLITTORAL_VIEWER=OFF >/dev/null
cmake --build "$here/sources" --target help | grep -q '^littoral: ' ||
  { echo "add_subdirectory has no target littoral" >&2; exit 1; }
echo "install: the package is found, its examples build, run and write; sources are found, too"
