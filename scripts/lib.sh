# shellcheck shell=sh disable=SC2034
# Shared by the scripts of this folder and of tests/, which source it.

# The project's folder: above the script, wherever that is.
root=$(CDPATH='' cd -- "$(dirname -- "$0")" && while [ ! -e CMakePresets.json ] && [ "$PWD" != / ]; do cd ..; done && pwd)
jobs=$(nproc 2>/dev/null || getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)
# Of a unity build. Large units take less time in all, and more memory each (1.8 GB); small ones keep many processors busy.
files_in_a_unit=8
if [ "$jobs" -le 2 ]; then files_in_a_unit=24; fi

# Where packages of other releases of Debian come from.
mirror=${TEXTPLANE_DEBIAN_MIRROR:-http://deb.debian.org/debian}

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
# npm comes with some builds of node; Debian's package of it is refused beside these.
package_npm=$(command -v npm >/dev/null 2>&1 || echo npm)
packages_page="cmake g++ make libeigen3-dev emscripten node-acorn $package_npm nlohmann-json3-dev libstb-dev xz-utils"
packages_test="$packages_build libgtest-dev"
packages_ci="$packages_demo ninja-build libgtest-dev libopencv-dev libceres-dev librapidcheck-dev clang libclang-rt-dev binutils qemu-user
  libsimde-dev g++-aarch64-linux-gnu googletest valgrind doxygen
  clang-format pybind11-dev python3-dev python3-numpy python3-setuptools python3-wheel
  python3-pip python3-pytest mypy"
packages_all="$packages_ci chromium pandoc libjs-katex fonts-katex python3-sympy python3-matplotlib libpq-dev postgresql libtesseract-dev tesseract-ocr-eng gcovr cppcheck clang-tidy g++-12-multilib
  g++-11-s390x-linux-gnu g++-riscv64-linux-gnu lld wasi-libc libc++-dev-wasm32 libclang-rt-dev-wasm32
  g++-11 clang-13 clang-15 clang-16 clang-19 lld-19 libclang-rt-19-dev-wasm32 nodejs debootstrap
  g++-mingw-w64-x86-64-posix wine64 wine emscripten node-acorn $package_npm xz-utils ffmpeg
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

# fetch_npm PACKAGE SHA256 FOLDER MEMBER...: members of an npm package, into the folder as they lie in it.
fetch_npm() {
  command -v npm >/dev/null 2>&1 || die "npm is not installed (Debian: npm)${npm_hint:-}"
  rm -f "$3"/*.tgz
  (cd "$3" && npm pack --silent "$1" >/dev/null) || die "npm could not fetch $1"
  packed=$(find "$3" -maxdepth 1 -name '*.tgz')
  [ "$(sha256sum "$packed" | cut -d ' ' -f 1)" = "$2" ] || die "$1 is not the package that this script knows: wrong checksum"
  into=$3
  shift 3
  tar -xzf "$packed" -C "$into" "$@"
  rm -f "$packed"
}

# get_sqlite: SQLite's source (public domain), for the page; the npm package is one that carries it whole.
get_sqlite() {
  sqlite=$root/build/sqlite
  if [ -f "$sqlite/sqlite3.c" ]; then return 0; fi
  mkdir -p "$sqlite"
  fetch_npm better-sqlite3@12.9.0 ad0e29650140c49d0335b1d356596aa8166f12b758f418a98446130e3278f250 "$sqlite" \
    package/deps/sqlite3/sqlite3.c package/deps/sqlite3/sqlite3.h
  mv "$sqlite/package/deps/sqlite3/sqlite3.h" "$sqlite/package/deps/sqlite3/sqlite3.c" "$sqlite"
  rm -r "$sqlite/package"
}

# get_yaml_cpp: its source (MIT), for the page, as Debian 12 compiles it.
get_yaml_cpp() {
  yaml_cpp=$root/build/yaml-cpp
  if [ -d "$yaml_cpp/src" ]; then return 0; fi
  mkdir -p "$yaml_cpp"
  apt_helper=/usr/lib/apt/apt-helper
  [ -x "$apt_helper" ] || die "no apt here: unpack yaml-cpp's source to $yaml_cpp"
  "$apt_helper" download-file "$mirror/pool/main/y/yaml-cpp/yaml-cpp_0.7.0+dfsg.orig.tar.xz" \
    "$yaml_cpp/source.tar.xz" SHA256:dc63708605404e0b963e0ca3a9619d1c8270eda2839603e6fa0384e5e51e5312 ||
    die "could not fetch yaml-cpp's source"
  tar -xJf "$yaml_cpp/source.tar.xz" -C "$yaml_cpp" --strip-components 1
  rm "$yaml_cpp/source.tar.xz"
}

# build_page: the preset page. A node that is not Debian's looks elsewhere for Debian's modules, which Emscripten needs.
build_page() {
  export NODE_PATH="${NODE_PATH:-/usr/share/nodejs}"
  get_sqlite
  get_yaml_cpp
  cmake -S "$root" --preset page && cmake --build "$root/build/page" --target page --parallel "$jobs"
}
