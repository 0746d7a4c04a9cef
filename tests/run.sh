#!/usr/bin/env bash
# Installs what is missing, builds Sprung and runs all its tests. Arguments go to ctest: run.sh --tests-regex SpringForce
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

examples/install_packages.sh run test
cmake --preset release
cmake --build --preset release
ctest --preset release --parallel "$(nproc)" "$@"
