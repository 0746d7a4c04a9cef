#!/usr/bin/env bash
# Builds and runs tests with sanitizers: unit tests with the address and undefined-behaviour sanitizers, and tests that run with
# several threads with the thread sanitizer. Needs what tests/run.sh installs.
#
#   tests/sanitize.sh [address|thread]    # both without argument
#
# Scenarios, examples and tests of the project's own files are left out to stay within half an hour on two cores; the presets asan
# and tsan build them too, and tests/night.sh runs them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Adds the tests of the viewer to `folders` where they are built: add_viewer BUILD_FOLDER
add_viewer() {
  if grep --quiet '^SPRUNG_VIEWER_IS_BUILT:INTERNAL=ON' "$1/CMakeCache.txt"; then folders+=(viewer); fi
}

address() {
  local folders=(base geometry network collision dynamics simulation scene output app)
  cmake --preset asan
  add_viewer build/asan
  cmake --build --preset asan --target "${folders[@]/%/_tests}"
  # Programs that are not built register a test named ..._NOT_BUILT.
  ctest --preset asan --parallel "$(nproc)" --exclude-regex '^Style\.|^Install\.|^Meshes\.|^Page\.|_NOT_BUILT'
}

# Sources that choose a number of threads hold the tests that run with more than one; the viewer's server and session have their own.
thread() {
  local folders=(base collision dynamics simulation)
  cmake --preset tsan -B build/tsan-threads -DSPRUNG_TEST_SOURCES_WITH='ThreadLimit|ServingServer'
  add_viewer build/tsan-threads
  cmake --build build/tsan-threads --target "${folders[@]/%/_tests}"
  TSAN_OPTIONS="suppressions=$PWD/tests/project/races_of_libraries.txt" ctest --test-dir build/tsan-threads --output-on-failure \
    --no-tests=error --parallel "$(nproc)" --tests-regex 'Thread|Parallel|LiveViewer|RecordedCloth' --exclude-regex '_NOT_BUILT'
}

case ${1:-all} in
  address) address ;;
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
