#!/usr/bin/env bash
# Feeds the readers of meshes and scenes with damaged files: fuzz.sh [SECONDS]. Without an argument each reader gets a fixed number
# of files from a fixed seed, as in CI; with one, it gets files for that many seconds from a new seed, and what was found is kept
# for the next time. The environment variable SEED repeats a run, TARGETS="ply scene" runs some of the readers. fuzz.sh --list
# prints their names.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly targets="${TARGETS:-obj stl ply off gltf glb 3ds msh vtk node ele scene}"
if [[ "${1:-}" == --list ]]; then
  tr ' ' '\n' <<<"$targets"
  exit
fi
readonly seconds="${1:-}"
readonly programs=build/fuzz/bin
readonly corpus=build/fuzz/corpus
readonly found=build/fuzz/found
readonly crashes=build/fuzz/crashes

examples/install_packages.sh run fuzz
cmake --preset fuzz
read -ra names <<<"$targets"
cmake --build build/fuzz --target fuzz_corpus "${names[@]/#/fuzz_}"

if [[ -n "$seconds" ]]; then
  seed="${SEED:-$(od -An -N4 -tu4 /dev/urandom | tr -d ' ')}"
  amount=(-max_total_time="$seconds")
  echo "Seed $seed; to repeat: SEED=$seed tests/fuzz.sh $seconds"
else
  seed="${SEED:-1}"
  rm -rf "$found" # what was found before would change what is tried now
fi

mkdir -p "$crashes"
failed=()
for target in $targets; do
  mkdir -p "$found/$target"
  # A scene, and a body beside an environment, take longer than a mesh of four triangles.
  runs=12000
  [[ "$target" != scene && "$target" != obj ]] || runs=2500
  [[ -n "$seconds" ]] || amount=(-runs="$runs")
  longest=$([[ "$target" == scene ]] && echo 8192 || echo 4096)
  prefix="$crashes/$target-"
  echo "== $target"
  # assimp leaks what it had read when it gives a file up, so leaks are left to tests/sanitize.sh.
  if ! "$programs/fuzz_$target" -seed="$seed" "${amount[@]}" -max_len="$longest" -timeout=20 -rss_limit_mb=2048 -detect_leaks=0 \
    -artifact_prefix="$prefix" -print_final_stats=1 "$found/$target" "$corpus/$target" >"$crashes/$target.log" 2>&1; then
    failed+=("$target")
    tail -n 40 "$crashes/$target.log"
    input="$(sed -n 's/.*Test unit written to //p' "$crashes/$target.log" | tail -n 1)"
    echo "$target failed. The input is kept: ${input:-none was written}. To repeat: $programs/fuzz_$target ${input:-}"
  else
    grep -E "^stat::(number_of_executed_units|average_exec_per_sec)" "$crashes/$target.log"
  fi
done
((${#failed[@]} == 0)) || { echo "Failed: ${failed[*]} (seed $seed)"; exit 1; }
