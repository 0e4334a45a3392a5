# shellcheck shell=sh disable=SC2034
# Shared by the scripts of this folder, which source it.

root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
jobs=$(nproc 2>/dev/null || getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)

# A compiler cache is used where there is one, never asked for.
if [ -z "${CMAKE_CXX_COMPILER_LAUNCHER:-}" ] && command -v ccache >/dev/null 2>&1; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi

# Ninja compiles what uses a library while the library is compiled; make waits for it. It is used where there is one, in
# new build folders. Asked again after packages were installed.
use_ninja() {
  if [ -z "${CMAKE_GENERATOR:-}" ] && command -v ninja >/dev/null 2>&1; then
    export CMAKE_GENERATOR=Ninja
  fi
}
use_ninja

# Debian and Ubuntu package names. "a|b": either will do; a gets installed. A rendered room uses the fonts that it finds on its
# signs, and tests and measurements need the same four everywhere: hence both packages of fonts.
packages_build='cmake g++ make libeigen3-dev'
packages_demo="$packages_build libjpeg-dev|libjpeg62-turbo-dev|libjpeg-turbo8-dev libpng-dev libstb-dev libcli11-dev
  nlohmann-json3-dev libyaml-cpp-dev libsqlite3-dev fonts-dejavu-core fonts-dejavu-extra"
packages_page='cmake g++ make libeigen3-dev emscripten node-acorn nlohmann-json3-dev libstb-dev'
packages_test="$packages_build libgtest-dev"
packages_ci="$packages_demo ninja-build libgtest-dev libopencv-dev libceres-dev librapidcheck-dev clang libclang-rt-dev binutils qemu-user
  libsimde-dev g++-aarch64-linux-gnu googletest chromium valgrind doxygen
  clang-format pybind11-dev python3-dev python3-numpy python3-setuptools python3-wheel
  python3-pip python3-pytest mypy"
packages_all="$packages_ci pandoc libjs-katex fonts-katex python3-sympy python3-matplotlib libpq-dev postgresql libtesseract-dev tesseract-ocr-eng gcovr cppcheck clang-tidy g++-12-multilib
  g++-11-s390x-linux-gnu g++-riscv64-linux-gnu lld wasi-libc libc++-dev-wasm32 libclang-rt-dev-wasm32
  clang-19 lld-19 libclang-rt-19-dev-wasm32 nodejs
  g++-mingw-w64-x86-64-posix wine64 wine emscripten node-acorn ffmpeg
  lintian colcon python3-colcon-ros python3-colcon-recursive-crawl"

say() { printf '\n== %s\n' "$*"; }
warn() { printf '%s: %s\n' "${0##*/}" "$*" >&2; }
die() {
  warn "$*"
  exit 2
}

is_installed() {
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null || true)" = installed ]
}

# missing_packages LIST: the packages of LIST that are not installed, on standard output.
missing_packages() {
  for entry in $1; do
    found=no
    for name in $(printf '%s' "$entry" | tr '|' ' '); do
      if is_installed "$name"; then found=yes; fi
    done
    if [ "$found" = no ]; then printf '%s ' "${entry%%|*}"; fi
  done
}

# apt_get ARGUMENTS: apt-get that asks no questions, through sudo where we are not root.
apt_get() {
  if [ "$(id -u)" -eq 0 ]; then
    DEBIAN_FRONTEND=noninteractive apt-get "$@"
  elif [ -t 0 ]; then
    sudo DEBIAN_FRONTEND=noninteractive apt-get "$@"
  else
    sudo -n DEBIAN_FRONTEND=noninteractive apt-get "$@"
  fi
}

# install_packages LIST: installs with apt what is missing. If it cannot, it names the packages and goes on: CMake finds the
# libraries, or says which one it misses.
install_packages() {
  if ! command -v dpkg-query >/dev/null 2>&1 || ! command -v apt-get >/dev/null 2>&1; then
    warn "no apt here: make sure that the equivalents of these Debian packages are installed:"
    warn "$(printf '%s' "$1" | tr -s ' \n' ' ' | sed 's/|[^ ]*//g')"
    return 0
  fi
  missing=$(missing_packages "$1")
  if [ -z "$missing" ]; then return 0; fi
  say "installing: $missing"
  if [ "$(id -u)" -ne 0 ] && ! command -v sudo >/dev/null 2>&1; then
    warn "not root and no sudo: install them yourself if the build does not find them"
    return 0
  fi
  apt_get update -qq || warn "apt-get update failed, trying with the package lists at hand"
  # shellcheck disable=SC2086  # a list of words
  apt_get install -y -qq --no-install-recommends $missing ||
    warn "apt could not install all of them: install them yourself if the build does not find them"
  use_ninja
}

# build_page: the preset page. A node that is not Debian's looks elsewhere for Debian's modules, which Emscripten needs.
build_page() {
  export NODE_PATH="${NODE_PATH:-/usr/share/nodejs}"
  cmake -S "$root" --preset page && cmake --build "$root/build/page" --target page --parallel "$jobs"
}
