#!/bin/sh
# Fails where a kernel executes more instructions than its budget: a slowdown that no clock has to notice.
#
#   check.sh PROGRAM BUDGETS [--update]
#
# Runs PROGRAM (kernel_calls) under callgrind on the avx2 target, which counts the same instructions at every run, and compares
# with BUDGETS, lines of "kernel instructions". --update writes the counts, with 3 % to spare, in place of the budgets.
# Exit code 77 (skipped) without valgrind or AVX2.
set -eu
program=$1
budgets=$2
if ! command -v valgrind >/dev/null 2>&1; then
  echo "skipped: valgrind is not installed"
  exit 77
fi
if ! grep -qw avx2 /proc/cpuinfo 2>/dev/null; then
  echo "skipped: this CPU has no AVX2"
  exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
TEXTPLANE_FORCE_TARGET=avx2 valgrind --tool=callgrind --instr-atstart=no --callgrind-out-file="$folder/out" "$program" \
  >"$folder/log" 2>&1 || {
  cat "$folder/log"
  exit 1
}
for dump in "$folder"/out.*; do
  awk '/^desc: Trigger: Client Request:/ { name = $NF } /^(summary|totals):/ { n = $2 } END { if (name != "") print name, n }' "$dump"
done | sort >"$folder/counts"
if [ ! -s "$folder/counts" ]; then
  cat "$folder/log"
  echo "callgrind gave no counts"
  exit 1
fi
if [ "${3:-}" = --update ]; then
  {
    grep '^#' "$budgets"
    awk '{ printf "%s %d\n", $1, $2 * 1.03 }' "$folder/counts"
  } >"$folder/new"
  cp "$folder/new" "$budgets"
fi
awk '
  FNR == NR { if ($1 !~ /^#/) budget[$1] = $2; next }
  {
    seen[$1] = 1
    known = $1 in budget
    verdict = !known ? "has no budget" : $2 > budget[$1] ? "OVER BUDGET" : ""
    if (verdict != "") bad = 1
    printf "%-24s %9d of %9s %s\n", $1, $2, known ? budget[$1] : "-", verdict
  }
  END {
    for (name in budget) if (!(name in seen)) { print name " was not counted"; bad = 1 }
    exit bad
  }' "$budgets" "$folder/counts"
