#!/usr/bin/env bash
# Installs missing packages, builds Sprung and makes its Debian packages in build/package: package.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

examples/install_packages.sh run view python package
rm -f build/package/*.deb # of another version
cmake --workflow --preset package
echo
echo "To install them:  apt install ./build/package/*_$(dpkg --print-architecture).deb"
