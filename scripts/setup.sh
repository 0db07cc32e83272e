#!/usr/bin/env bash
# Installs what is missing for the named groups, and nothing else:
#   scripts/setup.sh build   what a build and the demo need
#   scripts/setup.sh test    build, and what `make test` needs besides
#   scripts/setup.sh web     build, and what compiles the package for JavaScript
#   scripts/setup.sh tidy    build, and clang-tidy
#   scripts/setup.sh aarch64 test, and what compiles and runs programs for 64-bit ARM
#   scripts/setup.sh python  the Python environment in build/venv alone
#   scripts/setup.sh wheel   python, and what makes the wheel
#   scripts/setup.sh docs    python, and what reads the headers for the site
# Does nothing, quickly, when all of it is there. Works as root or through sudo.
set -euo pipefail
cd "$(dirname "$0")/.."

build_packages=(build-essential cmake ninja-build ccache libeigen3-dev
  libcli11-dev nlohmann-json3-dev zlib1g-dev libopenvdb-dev
  libtbb-dev libboost-dev libimath-dev)
test_packages=(git clang-14 libclang-rt-14-dev libpng-dev libgtest-dev libgmock-dev librapidcheck-dev
  liblemon-dev libbenchmark-dev python3-venv chromium doxygen)
web_packages=(emscripten libfast-float-dev)
arm_packages=(g++-aarch64-linux-gnu qemu-user libpng-dev:arm64 zlib1g-dev:arm64 libgtest-dev:arm64
  libgmock-dev:arm64 librapidcheck-dev:arm64)
oldest_node=18

die() { echo "setup: error: $*" >&2; exit 1; }

# For this machine's architecture, or the one that is named: that of another may be installed beside it.
is_installed() {
  local architecture
  case "$1" in *:*) architecture=${1#*:} ;; *) architecture=$(dpkg --print-architecture) ;; esac
  dpkg-query -W -f '${Architecture} ${db:Status-Status}\n' "$1" 2>/dev/null |
    grep -qE "^($architecture|all) installed$"
}

# Releases that no longer carry version 14 of Clang take their default one instead.
substitute() {
  case "$1" in
    clang-14) echo clang ;;
    libclang-rt-14-dev) echo "libclang-rt-$(default_clang)-dev" ;;
    clang-tidy-14) echo clang-tidy ;;
    *) return 1 ;;
  esac
}
default_clang() { apt-cache depends clang | sed -n 's/.*Depends: clang-\([0-9]*\)$/\1/p' | head -n 1; }

# Node is often installed from elsewhere: a working one is never touched.
node_packages() {
  local major=0
  if command -v node >/dev/null; then
    major=$(node -p 'process.versions.node.split(".")[0]' 2>/dev/null || echo 0)
  fi
  if [ "$major" -lt "$oldest_node" ]; then
    echo nodejs npm
  elif ! command -v npm >/dev/null; then
    is_installed nodejs || die "node is at $(command -v node), but there is no npm beside it;" \
      "the viewer needs both"
    echo npm
  fi
}

as_root() {
  if [ "$(id -u)" = 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    die "these packages are missing, and there is neither root nor sudo to install them: ${missing[*]}"
  fi
}

install_packages() {
  local missing=() package other
  for package in "$@"; do
    is_installed "$package" && continue
    if other=$(substitute "$package") && is_installed "$other"; then continue; fi
    missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  command -v apt-get >/dev/null ||
    die "this is not Debian or Ubuntu; install what corresponds to: ${missing[*]}"
  echo "setup: installing ${missing[*]}"
  as_root apt-get update -qq
  local available=()
  for package in "${missing[@]}"; do
    if ! apt-cache show "$package" >/dev/null 2>&1; then
      other=$(substitute "$package") || die "apt knows no package $package"
      package=$other
    fi
    available+=("$package")
  done
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
    "${available[@]}" >/dev/null
}

makes_environments() { "$1" -c 'import ensurepip, venv' 2>/dev/null; }

# build/venv holds the pinned tools; the stamp names the requirements and the Python it was made for.
python_environment() {
  local python=python3 stamp
  makes_environments "$python" || python=/usr/bin/python3
  stamp="$("$python" --version) $(sha256sum <requirements-dev.txt)"
  [ "$(cat build/venv/stamp 2>/dev/null)" != "$stamp" ] || return 0
  echo "setup: Python environment in build/venv"
  rm -rf build/venv
  mkdir -p build
  "$python" -m venv build/venv
  pip_install requirements-dev.txt
  echo "$stamp" >build/venv/stamp
}
pip_install() { build/venv/bin/python -m pip install --quiet --disable-pip-version-check -r "$1"; }

case "${1:-}" in
  build) install_packages "${build_packages[@]}" $(node_packages) ;;
  test)
    environment=
    if makes_environments python3; then  # pip beside apt: both wait for the network
      python_environment &
      environment=$!
      trap wait EXIT  # pip ends before this does, also where apt fails
    fi
    install_packages "${build_packages[@]}" $(node_packages) "${test_packages[@]}" "${web_packages[@]}"
    if [ -n "$environment" ]; then wait "$environment"; else python_environment; fi
    ;;
  web) install_packages "${build_packages[@]}" $(node_packages) "${web_packages[@]}" ;;
  tidy) install_packages "${build_packages[@]}" clang-tidy-14 ;;
  aarch64)
    if command -v dpkg >/dev/null && ! dpkg --print-foreign-architectures | grep -qx arm64; then
      missing=(libpng-dev:arm64)
      as_root dpkg --add-architecture arm64
    fi
    install_packages "${build_packages[@]}" "${test_packages[@]}" "${arm_packages[@]}"
    ;;
  python)
    install_packages python3-venv
    python_environment
    ;;
  wheel)
    install_packages python3-venv
    python_environment
    if ! cmp -s requirements-wheel.txt build/venv/requirements-wheel.txt; then
      echo "setup: what makes the wheel, into build/venv"
      pip_install requirements-wheel.txt
      cp requirements-wheel.txt build/venv
    fi
    ;;
  docs)
    install_packages python3-venv doxygen
    python_environment
    ;;
  *) die "usage: scripts/setup.sh build|test|web|tidy|aarch64|python|wheel|docs" ;;
esac
