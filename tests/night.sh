#!/usr/bin/env bash
# Searches for faults that CI's fixed seeds do not show, for as long as it is told: tests/night.sh MINUTES
#
# A quarter of the time each goes to the thread sanitizer over all tests, to the address sanitizer over those of the viewer and of
# sweeps, to the fuzzers with new seeds, and to the Debian packages (about fifteen minutes) and random tests with new seeds. Builds
# count. Prints for each failure the command that repeats it, and at the end how many there were; exit status 1 when there were any.
# Needs what tests/run.sh installs. Logs stay in build/night/.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
if [[ ! ${1:-} =~ ^[1-9][0-9]*$ ]]; then
  echo "usage: tests/night.sh MINUTES" >&2
  exit 2
fi

SECONDS=0
total=$((60 * $1))
logs=build/night
failures=0
mkdir -p $logs

report() {
  echo "FAILED, to repeat: $1    (log: $2)"
  failures=$((failures + 1))
}

# Runs a command until this second of the night; 124 when it was stopped, 125 when no time was left.
until_second() {
  local left=$(($1 - SECONDS))
  shift
  if [[ $left -le 0 ]]; then return 125; fi
  timeout "$left" "$@"
}

# Reports each test that ctest's log names as failed, also when ctest was stopped: failed_tests LOG PREFIX PRESET
failed_tests() {
  local name
  while read -r name; do
    report "$2ctest --preset $3 --tests-regex '^${name//[^[:alnum:]_\/]/.}\$'" "$1"
  done < <(sed -nE 's/^ *[0-9]+\/[0-9]+ Test +#[0-9]+: (.*[^ .]) *\.*\*\*\*(Failed|Exception|Timeout).*/\1/p' "$1")
}

# Configures and builds a preset until that second: build_preset SECOND PRESET
build_preset() {
  local log=$logs/build_$2.txt code=0
  { until_second "$1" cmake --preset "$2" && until_second "$1" cmake --build --preset "$2"; } > "$log" 2>&1 || code=$?
  case $code in
    0) return 0 ;;
    124 | 125) echo "$2: the time did not suffice for the build" ;;
    *) report "cmake --build --preset $2" "$log" ;;
  esac
  return 1
}

quarter=$((total / 4))
if build_preset $quarter tsan; then
  until_second $quarter ctest --preset tsan --parallel "$(nproc)" > $logs/tsan.txt 2>&1
  failed_tests $logs/tsan.txt "" tsan
  echo "thread sanitizer: $(grep -c ' Passed ' $logs/tsan.txt) tests passed"
fi

code=0
until_second $((2 * quarter)) tests/sanitize.sh address sweep viewer > $logs/asan.txt 2>&1 || code=$?
case $code in
  0) echo "address sanitizer: $(grep -c ' Passed ' $logs/asan.txt) tests passed" ;;
  124 | 125) echo "address sanitizer: the time did not suffice" ;;
  *) report "tests/sanitize.sh address sweep viewer" $logs/asan.txt ;;
esac

if examples/install_packages.sh run fuzz > $logs/packages.txt 2>&1 && build_preset $((3 * quarter)) fuzz; then
  targets=$(tests/fuzz.sh --list | wc -l)
  each=$(((3 * quarter - SECONDS) / targets)) # seconds
  if [[ $each -gt 0 ]] && ! tests/fuzz.sh $each > $logs/fuzz.txt 2>&1; then
    commands=$(sed -n 's/.* failed\. .*To repeat: //p' $logs/fuzz.txt)
    while read -r command; do report "$command" $logs/fuzz.txt; done <<< "${commands:-tests/fuzz.sh $each}"
  fi
  echo "fuzzers: $targets targets, $each s each"
fi

if [[ $EUID -eq 0 ]]; then
  code=0
  { examples/install_packages.sh package-test && SPRUNG_NO_SKIPS=1 until_second $total tests/packages/check.sh; } \
    > $logs/debian_packages.txt 2>&1 || code=$?
  case $code in
    0) echo "Debian packages: they work" ;;
    124 | 125) echo "Debian packages: the time did not suffice" ;;
    *) report "tests/packages/check.sh" $logs/debian_packages.txt ;;
  esac
else
  echo "Debian packages: skipped, because only root can make a clean Debian"
fi

seeds=0
if build_preset $total release; then
  while [[ $SECONDS -lt $total ]]; do
    seed=$(od -An -N4 -tu4 /dev/urandom | tr -d ' ')
    log=$logs/seed_$seed.txt
    scenes=$seed-$((seed + 99)) # 100 of each scheme
    SPRUNG_TEST_SEED=$seed SPRUNG_RANDOM_SCENES=$scenes until_second $total ctest --preset release --parallel "$(nproc)" \
      --tests-regex '^(Blocks/RandomScenes|RandomLoads|PairSeparation)\.' > "$log" 2>&1
    code=$?
    if [[ $code -eq 0 ]]; then rm "$log"; fi
    if [[ $code -ne 124 && $code -ne 125 ]]; then seeds=$((seeds + 1)); fi
    if [[ $code -ne 0 && $code -ne 124 && $code -ne 125 ]]; then
      grep --only-matching 'SPRUNG_RANDOM_SCENES=[0-9]* .*' "$log" # a scene each
      failed_tests "$log" "SPRUNG_TEST_SEED=$seed SPRUNG_RANDOM_SCENES=$scenes " release
    fi
  done
fi
echo "random tests: $seeds new seeds"
echo "$failures failures"
[[ $failures -eq 0 ]]
