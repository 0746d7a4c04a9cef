#!/usr/bin/env bash
# Installs the missing packages of sections of packages.txt: install_packages.sh run test
set -euo pipefail

list="$(dirname "${BASH_SOURCE[0]}")/packages.txt"

packages_of() {
  awk -v wanted="[$1]" '/^\[/ { inside = $0 == wanted; next } inside && NF && !/^#/' "$list"
}

# Also the names that other packages stand in for: some Node.js packages bring npm.
installed="$(dpkg-query --show --showformat '${db:Status-Status}, ${Package}, ${Provides}\n' | sed -n 's/^installed, //p' |
  tr ',' '\n' | sed 's/^ *//; s/ .*//')"

is_installed() {
  grep --quiet --line-regexp --fixed-strings "$1" <<<"$installed"
}

missing=()
for section in "$@"; do
  for package in $(packages_of "$section"); do
    is_installed "$package" || missing+=("$package")
  done
done
((${#missing[@]})) || exit 0

echo "Installing ${missing[*]}"
as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "Debian packages are missing, and only root can install them. Run this as root:" >&2
    echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get --quiet --yes "$@"; }
apt update
apt install --no-install-recommends "${missing[@]}"
