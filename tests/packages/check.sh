#!/usr/bin/env bash
# check.sh: makes the Debian packages, installs them in a clean Debian of the same release, and uses them there as inside.sh says.
# The clean Debian is made by debootstrap from the package sources of this machine, in build/package/clean_debian, and removed at the end.
# Skipped with 77, with the reason, where it cannot be made, unless SPRUNG_NO_SKIPS is set. The build takes about 6 minutes, the rest 3.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

skip() {
  echo "skipped: $1"
  if [[ -n ${SPRUNG_NO_SKIPS:-} ]]; then exit 1; fi
  exit 77
}

((EUID == 0)) || skip "only root can make a clean Debian"
command -v debootstrap >/dev/null || skip "debootstrap is missing; examples/install_packages.sh package-test installs it"
release=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' "Codename: $release" 'Component: main' | head -n 1)
[[ -n $mirror ]] || skip "apt knows no packages of $release; run apt-get update"

examples/package.sh
debian=$PWD/build/package/clean_debian
log=$PWD/build/package/clean_debian.txt
rm -rf --one-file-system "$debian"
trap 'rm -rf --one-file-system "$debian"' EXIT
echo "debootstrap: its log is $log"
debootstrap --variant=minbase "$release" "$debian" "$mirror" >"$log"

# The same package sources, with all that apt needs for them.
rm -rf "$debian/etc/apt"
cp -a /etc/apt "$debian/etc/apt"
cp --dereference /etc/resolv.conf /etc/hosts "$debian/etc/"
cp -a --parents /usr/share/keyrings "$debian"
install -D --target-directory "$debian/packages" build/package/*.deb tests/packages/inside.sh examples/hello.cpp \
  tests/project/consumer/CMakeLists.txt

# What is mounted is gone with the last process.
unshare --mount --pid --fork --kill-child bash -c 'mount -t proc proc "$1/proc" && exec chroot "$1" /packages/inside.sh' _ "$debian"
