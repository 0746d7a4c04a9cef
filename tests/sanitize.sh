#!/usr/bin/env bash
# Builds and runs tests with sanitizers: unit tests with the address and undefined-behaviour sanitizers, and tests that run with
# several threads with the thread sanitizer. Needs what tests/run.sh installs.
#
#   tests/sanitize.sh [thread|address [FOLDER...]]    # both, with all folders, without argument
#
# All folders take 25 to 45 minutes with the address sanitizer on two cores, base, geometry and network ten; the thread sanitizer takes
# ten. CI has no time for them: its fuzzers run the readers with the address sanitizer.
# Scenarios, examples, tests of the project's own files and a few long tests of laws of motion are left out. The presets asan and tsan
# build them too, and tests/night.sh runs them with the thread sanitizer.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

address() {
  local folders=("$@")
  cmake --preset asan
  if ((${#folders[@]} == 0)); then
    folders=(base geometry network collision dynamics simulation scene output sweep app)
    # Only where Boost and npm are installed.
    if grep --quiet '^SPRUNG_VIEWER_IS_BUILT:INTERNAL=ON' build/asan/CMakeCache.txt; then folders+=(viewer); fi
  fi
  cmake --build --preset asan --target "${folders[@]/%/_tests}"
  # Laws of motion over many steps of the same code; they take a third of the time.
  local long='^(LimitEnergy|LimitMotion|Materials|ImplicitEuler|HangingChain|AngleBends|CollidingBodies)\.'
  # Programs that are not built register a test named ..._NOT_BUILT.
  ctest --preset asan --parallel "$(nproc)" --exclude-regex "$long|^Style\.|^Install\.|^Meshes\.|^Page\.|^Example\.|^Blender\.|^Completion\.|^Formats\.|OnSlurm|_NOT_BUILT"
}

# Sources that choose a number of threads hold the tests that run with more than one.
thread() {
  local folders=(base collision dynamics simulation)
  cmake --preset tsan -B build/tsan-threads -DSPRUNG_TEST_SOURCES_WITH=ThreadLimit -DSPRUNG_VIEWER=OFF
  cmake --build build/tsan-threads --target "${folders[@]/%/_tests}"
  TSAN_OPTIONS="suppressions=$PWD/tests/project/races_of_libraries.txt" ctest --test-dir build/tsan-threads --output-on-failure \
    --no-tests=error --parallel "$(nproc)" --tests-regex 'Thread|Parallel' --exclude-regex '_NOT_BUILT'
}

case ${1:-all} in
  address)
    shift
    address "$@"
    ;;
  thread) thread ;;
  all)
    address
    thread
    ;;
  *)
    sed -n '2,8s/^# \{0,1\}//p' "$0" >&2
    exit 2
    ;;
esac
