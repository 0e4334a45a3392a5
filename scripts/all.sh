# shellcheck shell=sh disable=SC2154,SC2034
# The stages of `scripts/test --all` after those of --ci, sourced by it: stage(), note() and the lists are there.

# needs STAGE PROGRAM...: whether the programs are there; if not, a line of the summary says so.
needs() {
  wanted "$1" || return 1
  name=$1
  shift
  for program in "$@"; do
    if command -v "$program" >/dev/null 2>&1 || [ -e "$program" ]; then continue; fi
    note "$name" 0 "left out: $program is missing"
    return 1
  done
}

# checked NAME COMMAND...: a stage whose last line of output is its line of the summary.
checked() {
  wanted "$1" || return 0
  name=$1
  shift
  begin=$(date +%s)
  say "$name"
  log=$root/build/$name.log
  mkdir -p "$root/build"
  if "$@" >"$log" 2>&1; then outcome=; else outcome='FAILED: ' result=1; fi
  cat "$log"
  note "$name" "$(($(date +%s) - begin))" "$outcome$(tail -n 1 "$log")"
}

library_tests="$library_tests test_landmarks"
library_only='-DTEXTPLANE_BUILD_EXAMPLES=OFF -DTEXTPLANE_TEST_TIER=library'

# Memory errors under valgrind, which has AVX2. Seven groups of kernel tests, as it takes fifty times as long.
memcheck() {
  for kernels in 'ResidualKernels.EveryNumberOfPixels' 'WarpKernels.*' 'HalveKernels.*' 'FastKernel.*' 'BatchKernels.*' \
    'SamplePoints.*' 'EsmKernels.*'; do
    TEXTPLANE_TEST_TARGET=${TEXTPLANE_TEST_TARGET:-avx2} valgrind --quiet --error-exitcode=9 --leak-check=full "$1" \
      --gtest_brief=1 --gtest_filter="$kernels" || return 1
  done
  valgrind --quiet --error-exitcode=9 --leak-check=full "$2" --gtest_brief=1 --gtest_filter='Threads.EachGets*' ||
    return 1
  echo 'memcheck: no errors in seven groups of kernel tests on avx2, nor in one of all kernels and the pose solver'
}

cpp_check() {
  cppcheck --std=c++17 --language=c++ --enable=warning,performance,portability --inline-suppr --quiet \
    --error-exitcode=9 --suppressions-list="$root/.cppcheck" -DTEXTPLANE_EXTERN_KERNELS -D__GNUC__=12 -D__x86_64__ -I "$root/include" \
    "$root/tests/everything.cpp" || return 1
  echo 'cppcheck: no findings'
}

clang_tidy() {
  clang-tidy --quiet --warnings-as-errors='*' "$root/tests/everything.cpp" -- -std=c++17 -DTEXTPLANE_EXTERN_KERNELS \
    -I"$root/include" -isystem /usr/include/eigen3 || return 1
  echo 'clang-tidy: no findings'
}

# covered STAGE WHAT GCOVR_OPTION...: lines that the stage's tests ran, on all targets of this machine together.
covered() {
  build=$root/build/$1
  what=$2
  shift 2
  rm -f "$build.txt"
  gcovr -r "$root" "$@" --exclude-throw-branches --object-directory "$build" --fail-under-line 95 -o "$build.txt" "$build"
  outcome=$?
  sed -n "s/^TOTAL */coverage of $what (lines, run, share): /p" "$build.txt"
  return $outcome
}

# textslam in the browser, driven in headless Chromium.
page() {
  build_page || return 1
  "$root/tests/page/run"
}

fuzz_seconds=${TEXTPLANE_FUZZ_SECONDS:-900}

all_stages() {
  stage tsan '-DTEXTPLANE_BUILD_EXAMPLES=OFF' '-L ^threads$' 'test_threads adjuster_alone_test'
  set -- "$root/build/dev/bin/test_simd" "$root/build/dev/bin/test_threads"
  if needs memcheck valgrind "$@"; then checked memcheck memcheck "$@"; fi
  if needs i386 /usr/lib/gcc/x86_64-linux-gnu/12/32 /usr/src/googletest; then
    stage i386 '-DTEXTPLANE_BUILD_EXAMPLES=OFF' ''
  fi
  if needs s390x s390x-linux-gnu-g++-11 qemu-s390x /usr/src/googletest; then
    stage s390x '-DTEXTPLANE_BUILD_EXAMPLES=OFF' ''
  fi
  if needs riscv64 riscv64-linux-gnu-g++ qemu-riscv64 /usr/src/googletest; then
    stage riscv64 '-DTEXTPLANE_BUILD_EXAMPLES=OFF' ''
  fi
  set -- clang++ wasm-ld node /usr/include/wasm32-wasi/c++ /usr/src/googletest
  if needs wasm "$@"; then stage wasm '-DTEXTPLANE_BUILD_EXAMPLES=OFF' ''; fi
  if needs wasm-scalar "$@"; then stage wasm-scalar '-DTEXTPLANE_BUILD_EXAMPLES=OFF' ''; fi
  if needs wasm-relaxed clang++-19 wasm-ld-19 "$@"; then stage wasm-relaxed '-DTEXTPLANE_BUILD_EXAMPLES=OFF' ''; fi
  if needs mingw x86_64-w64-mingw32-g++-posix wine /usr/src/googletest; then
    stage mingw '-DTEXTPLANE_BUILD_EXAMPLES=OFF' ''
  fi
  if needs page em++ node chromium "$root/build/dev/bin/textslam"; then checked page page; fi
  stage unoptimised "$library_only" '-L ^library$' "$library_tests"
  stage fast-math "$library_only" '-L ^fast_math$' "$library_tests"
  stage cxx20 "$library_only" '-L ^library$' "$library_tests"
  stage cxx23 "$library_only" '-L ^library$' "$library_tests"
  if needs compilers apt-get dpkg-deb; then checked compilers "$root/tests/compilers/run" --older; fi
  # The newest of everything that Debian has.
  if needs debian-forky debootstrap; then checked debian-forky "$root/tests/debian/run" forky; fi
  if needs clang-tidy clang-tidy; then checked clang-tidy clang_tidy; fi
  if needs cppcheck cppcheck; then checked cppcheck cpp_check; fi
  if needs coverage gcovr; then
    stage coverage "$library_only" '-L ^library$' "$library_tests"
    checked coverage covered coverage include --filter "$root/include/" --exclude '.*/adapters/' --exclude '.*(neon|simd128).*'
  fi
  if needs coverage-python gcovr; then
    find "$root/build/coverage-python" -name '*.gcda' -delete 2>/dev/null || :
    stage coverage-python '-DTEXTPLANE_BUILD_PYTHON=ON' '-R ^python[.]package$' 'textplane_python python_numbers'
    # The package's Python files are a few dozen lines.
    checked coverage-python covered coverage-python 'the Python modules' --filter "$root/bindings/"
  fi
  checked mutants "$root/tests/mutants/run"
  checked mutants-drawn "$root/tests/mutants/run" --drawn 300 --least 90 --build "$root/build/mutants-drawn"
  if needs fuzz-fast clang++; then checked fuzz-fast "$root/tests/fuzz/run" --fast --seconds "$fuzz_seconds"; fi
  if needs fuzz clang++; then checked fuzz "$root/tests/fuzz/run" --seconds "$fuzz_seconds"; fi
  # Debian keeps the server's programs out of PATH, in a folder for each version.
  set -- /usr/lib/postgresql/*/bin/initdb
  if needs map-server "$1" "$root/build/dev/bin/textslam-map"; then
    checked map-server "$root/tests/map_server/run" --build "$root/build/dev"
  fi
  if needs soak "$root/build/dev/bin/textslam"; then checked soak "$root/tests/soak/run" --build "$root/build/dev"; fi
}
