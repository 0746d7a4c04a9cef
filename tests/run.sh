#!/usr/bin/env bash
# Installs what is missing, builds Sprung and runs all its tests. Arguments go to ctest: run.sh --tests-regex SpringForce
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

examples/install_packages.sh run test
if command -v ccache >/dev/null; then  # another clone, or another branch, then compiles what is new
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros
fi
cmake --preset release
cmake --build --preset release
ctest --preset release --parallel "$(nproc)" "$@"
