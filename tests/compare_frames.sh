#!/usr/bin/env bash
# Runs scenes with two builds of the program and compares all frames bit for bit: the OBJ files, and diagnostics.csv by position of its
# columns, without their names and without frame_ms. Use it to show that a change of the code changes no result.
#
#   tests/compare_frames.sh [--frames N] [--jobs N] BEFORE AFTER [SCENE...]
#
# BEFORE and AFTER are two programs `sprung`. Without SCENE, all scenes of examples/ and tests/scenarios/scenes/ run; --frames limits
# each of them. A scene that both programs refuse, or that diverges at the same frame in both, is the same. Prints one line a scene;
# exit status 1 when any differs. tests/compare_scenarios.sh does the same for scenarios that the tests build in C++.
set -uo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
usage() { sed -n '2,8s/^# \{0,1\}//p' "$0" >&2; exit 2; }

# The first particle whose line differs between two OBJ files, or what else does.
first_difference() {
  awk 'NR == FNR { line[FNR] = $0; count = FNR; next }
       $1 == "v" { ++particle }
       $0 != line[FNR] { print ($1 == "v" ? "particle " particle : "line " FNR); found = 1; exit }
       END { if (!found && FNR != count) print "number of lines" }' "$1" "$2"
}

# Diagnostics without names and frame_ms.
numbers() {
  awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k == "frame_ms") skip = k; next }
           { line = ""; for (k = 1; k <= NF; ++k) if (k != skip) line = line "," $k; print line }' "$1"
}

# Runs a scene with both programs and prints what differs, or nothing.
difference() {
  local work=$1 scene=$2 codes=() side frames frame
  for side in before after; do
    local program=$before
    [[ $side == after ]] && program=$after
    "$program" run "$scene" --out "$work/$side" --quiet ${limit:+--frames "$limit"} --mesh-path "$root/meshes" \
      --mesh-path /usr/share/glmark2/models > "$work/$side.text" 2>&1
    codes+=($?)
    mkdir -p "$work/$side"
  done
  frames=$(cd "$work" && find before after -name '*.obj' -printf '%P\n' | sort -u)
  while read -r frame; do
    for side in before after; do
      if [[ ! -e $work/$side/$frame ]]; then echo "$frame is missing $side"; return; fi
    done
    if ! cmp -s "$work/before/$frame" "$work/after/$frame"; then
      echo "$frame, $(first_difference "$work/before/$frame" "$work/after/$frame")"
      return
    fi
  done < <(awk -F. 'NF > 1 { print $(NF - 1), $0 }' <<< "$frames" | sort -n | cut -d ' ' -f 2-)  # in the order of frames
  if [[ ${codes[0]} != "${codes[1]}" ]]; then echo "exit codes ${codes[0]} and ${codes[1]}"; return; fi
  if [[ -e $work/before/diagnostics.csv || -e $work/after/diagnostics.csv ]]; then
    cmp <(numbers "$work/before/diagnostics.csv") <(numbers "$work/after/diagnostics.csv") > /dev/null || echo "diagnostics.csv"
  fi
}

compare_scene() {
  local work text
  work=$(mktemp -d)
  text=$(difference "$work" "$1")
  rm -rf "$work"
  if [[ -z $text ]]; then echo "same    ${1#"$root"/}"; else echo "DIFFERS ${1#"$root"/}: $text"; fi
  [[ -z $text ]]
}

limit=
jobs=1
while [[ ${1:-} == --* ]]; do
  [[ $# -lt 2 ]] && usage
  case $1 in
    --frames) limit=$2 ;;
    --jobs) jobs=$2 ;;
    *) usage ;;
  esac
  shift 2
done
[[ $# -lt 2 ]] && usage
before=$1
after=$2
shift 2
for program in "$before" "$after"; do
  if [[ ! -x $program ]]; then echo "$program is not a program" >&2; exit 2; fi
done
if [[ $# -eq 0 ]]; then set -- "$root"/examples/*.json "$root"/tests/scenarios/scenes/*.json; fi

export before after root limit
export -f compare_scene difference first_difference numbers
# xargs ends with 123 when any scene differs.
printf '%s\0' "$@" | xargs -0 -P "$jobs" -I '{}' bash -c 'compare_scene "$1"' compare '{}' || exit 1
