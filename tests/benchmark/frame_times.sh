#!/usr/bin/env bash
# Compares the times of a frame that `sprung validate` prints with those of runs: frame_times.sh PROGRAM [SCENE...]
# Default: all examples, and scenes of tests/benchmark/scenes with stacked cloths and implicit Euler. One thread. Prints a row of
# README.md's table for each scene. The median frame in motion of a run should lie between half of the free time and twice the time
# in full contact; the last column says so. Stops a run after LIMIT (default 300) seconds and takes the frames until then. Ends with 1 if a
# scene breaks the law. Other programs on the machine would disturb wall times, so the program gets processor times from its clock.
set -euo pipefail

program="$(realpath "$1")"
shift
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
if (($# == 0)); then set -- examples/*.json tests/benchmark/scenes/{stacked_cloths,implicit_*}.json; fi
folder="$(mktemp --directory)"
trap 'rm -rf "$folder"' EXIT

cc -shared -fPIC -O2 -x c -o "$folder/clock.so" - <<'END'
#define _GNU_SOURCE
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>
int clock_gettime(clockid_t id, struct timespec* time) {
  return (int)syscall(SYS_clock_gettime, id == CLOCK_MONOTONIC ? CLOCK_PROCESS_CPUTIME_ID : id, time);
}
END
options=(--threads 1 --mesh-path /usr/share/glmark2/models)

# The median of the column frame_ms over frames in motion: those with a thousandth of the largest kinetic energy or more. Not the
# state at time 0.
median() {
  awk -F, '
    NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i }
    NR > 2 { time[NR] = $column["frame_ms"]; energy[NR] = $column["kinetic_energy"] + 0; if (energy[NR] > most) most = energy[NR] }
    END { for (row in time) if (energy[row] >= most / 1000) print time[row] }' "$1" |
    sort --general-numeric-sort | awk '{ value[NR] = $1 } END { if (NR > 0) print value[int((NR + 1) / 2)] }'
}

status=0
echo '| scene | free | in full contact | median frame | within the law |'
echo '|---|---|---|---|---|'
for scene in "$@"; do
  name="$(basename "$scene" .json)"
  cost="$(LD_PRELOAD="$folder/clock.so" "$program" validate "$scene" "${options[@]}" 2>/dev/null | sed -n 's/^cost *//p')" || true
  free="$(sed -nE 's/^free ((more than |below )?[0-9.]+ m?s).*/\1/p' <<<"$cost")"
  if [[ -z $free ]]; then
    echo "| $name | | | | refused, or diverges at once |"
    continue
  fi
  full="$(sed -nE 's/.*(in full contact|at work) ((below )?[0-9.]+ m?s).*/\2/p' <<<"$cost")"
  timeout --signal INT "${LIMIT:-300}" env LD_PRELOAD="$folder/clock.so" \
    "$program" run "$scene" "${options[@]}" --quiet --out "$folder/$name" >/dev/null 2>&1 || true
  row="$(awk -v name="$name" -v free="$free" -v full="${full:-$free}" -v ms="$(median "$folder/$name/diagnostics.csv")" '
    function milliseconds(text) { return (match(text, /[0-9.]+/) ? substr(text, RSTART) : 0) * (text ~ / s$/ ? 1000 : 1) }
    BEGIN {
      least = free ~ /below/ ? 0 : milliseconds(free) / 2
      within = ms != "" && ms >= least && ms <= 2 * milliseconds(full)
      printf "| %s | %s | %s | " (ms < 10 ? "%.2g" : "%.0f") " ms | %s |", name, free, full, ms, within ? "yes" : "no"
    }')"
  rm -rf "${folder:?}/$name"
  echo "$row"
  [[ $row == *"yes |" ]] || status=1
done
exit $status
