# shellcheck shell=sh
# Shared by the scripts of this folder, which source it.

root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)

# build_programs FOLDER EXAMPLES PROGRAM...: configured as users build; EXAMPLES is ON or OFF.
build_programs() {
  folder=$1 examples=$2
  shift 2
  mkdir -p "$folder"
  cmake -S "$root" -B "$folder" -DCMAKE_BUILD_TYPE=Release '-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG' \
    -DTEXTPLANE_BUILD_BENCH=ON -DTEXTPLANE_BUILD_TESTS=OFF -DTEXTPLANE_BUILD_PYTHON=OFF "-DTEXTPLANE_BUILD_EXAMPLES=$examples" >"$folder.log" 2>&1 ||
    { cat "$folder.log"; exit 1; }
  cmake --build "$folder" --parallel "$(nproc 2>/dev/null || echo 2)" --target "$@"
}

# Before a command that is to run on one core; empty where that cannot be.
pin=
if command -v taskset >/dev/null 2>&1; then pin='taskset -c 1'; fi
if ! $pin true 2>/dev/null; then pin=; fi

# The CPU's name; Google Benchmark takes neither commas nor equal signs.
cpu=$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1 | tr ',=' '  ')
cpu=${cpu:-unknown CPU}

# measure OUTPUT PIN TIME REPETITIONS FILTER: benchmarks of $build, to OUTPUT.json. All repetitions run in random order,
# so that load from outside hits ours and the peers alike.
measure() {
  # shellcheck disable=SC2086  # a command and its words, or nothing
  $2 "$build/bin/textplane_bench" --benchmark_filter="$5" --benchmark_enable_random_interleaving=true \
    --benchmark_repetitions="$4" --benchmark_min_time="$3" --benchmark_context=cpu="$cpu" \
    --benchmark_out="$1.json" --benchmark_out_format=json >"$1.txt" 2>&1 || { tail -n 20 "$1.txt"; exit 1; }
}
