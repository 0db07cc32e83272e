#!/usr/bin/env bash
# Installs a build into an empty prefix, builds examples/ against it and runs what came out.
# usage: scripts/test_install.sh BUILD
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1
prefix="$PWD/build/install-test/prefix"
examples="$PWD/build/install-test/examples"
rm -rf build/install-test

cmake --install "$build" --prefix "$prefix" >/dev/null
cmake -S examples -B "$examples" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
cmake --build "$examples"
"$examples/hello"
"$prefix/bin/littoral" --help >/dev/null

if grep -rIlF "$PWD" "$prefix/lib" "$prefix/include" --include='*.cmake' --include='*.h' ; then
  echo "the installed files above name the build machine's folders" >&2
  exit 1
fi
echo "install: the package is found, links and runs"
