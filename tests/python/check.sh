#!/usr/bin/env bash
# check.sh SUITE: runs SUITE_test.py with the module that was built, or checks stubs or the notebook. Needs SPRUNG_PYTHON, the
# interpreter. Exits with 77 where a package is missing, unless SPRUNG_NO_SKIPS is set.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

skip_without() {
  for package in "$@"; do
    "$SPRUNG_PYTHON" -c "import $package" > /dev/null 2>&1 && continue
    echo "skipped: the Python package $package is missing; examples/install_packages.sh python python-test installs it"
    [[ -n ${SPRUNG_NO_SKIPS:-} ]] && exit 1
    exit 77
  done
}

# A notebook and matplotlib write into the home folder, which need not exist.
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export HOME=$scratch MPLCONFIGDIR=$scratch IPYTHONDIR=$scratch PYTHONDONTWRITEBYTECODE=1

case $1 in
  stubs)
    skip_without mypy
    cd "$scratch"
    "$SPRUNG_PYTHON" -m mypy.stubtest sprung --allowlist "$here/stubtest_allowlist.txt"
    # -P would not find the package: mypy reads it where it lies.
    MYPYPATH=${PYTHONPATH%%:*} "$SPRUNG_PYTHON" -m mypy --strict --cache-dir "$scratch/cache" "$here/typed_program.py"
    ;;
  examples) skip_without numpy scipy ;;&
  notebook) skip_without numpy scipy matplotlib nbclient nbformat ipykernel ;;&
  *)
    skip_without numpy
    cd "$scratch"
    "$SPRUNG_PYTHON" -W error::RuntimeWarning -m unittest -v "$1_test"
    ;;
esac
