#!/bin/bash
# inside.sh, in a clean Debian as root: installs the packages that lie beside it, uses each as a user would, and removes them.
set -Eeuo pipefail
trap 'echo "inside.sh:$LINENO failed: $BASH_COMMAND" >&2' ERR
export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 HOME=/root
cd /packages
install() { apt-get --quiet --quiet --yes install --no-install-recommends "$@" >/packages/apt.txt 2>&1 || { cat /packages/apt.txt; exit 1; }; }
user() { setpriv --reuid 65534 --regid 65534 --clear-groups env --chdir /scratch HOME=/scratch "$@"; }
mkdir --mode 1777 /scratch
apt-get --quiet --quiet update

echo "program: it runs an example, as any user"
install ./sprung_*.deb ./libsprung0*.deb man-db bash-completion
user sprung run /usr/share/sprung/examples/rope_over_torus.json --frames 3 --out rope
[[ -s /scratch/rope/rope/rope.0003.obj ]]
user sprung run /usr/share/sprung/examples/lessons/1_mass_on_a_spring.json --frames 2 --out lesson --quiet
grep --quiet '"bodies"' /usr/share/sprung/scene.schema.json

echo "man page and completion"
man sprung >/scratch/man.txt 2>/scratch/warnings.txt
grep --quiet -e '--mesh-path DIR' /scratch/man.txt
[[ ! -s /scratch/warnings.txt ]]
completions=$(bash -c '. /usr/share/bash-completion/bash_completion; _completion_loader sprung; COMP_WORDS=(sprung exp); COMP_CWORD=1
                       _sprung sprung exp sprung; echo "${COMPREPLY[@]}"')
[[ $completions == export ]]

echo "headers: a program finds the library by CMake and by pkg-config"
install ./libsprung-dev_*.deb g++ cmake make pkg-config
mkdir /scratch/consumer
cp CMakeLists.txt /scratch/consumer
user cmake -S consumer -B built -DPROGRAM=/packages/hello.cpp >/scratch/cmake.txt
user cmake --build built >>/scratch/cmake.txt
by_cmake=$(user built/hello)
user sh -c 'g++ -std=c++20 /packages/hello.cpp -o hello $(pkg-config --cflags --libs sprung)'
by_pkg_config=$(user ./hello)
[[ $by_cmake == "after 2 s the bob is at "* && $by_pkg_config == "$by_cmake" ]]

echo "Python"
install ./python3-sprung_*.deb
user python3 -c '
import sprung
simulator = sprung.load("/usr/share/sprung/examples/hanging_cloth.json").simulator()
simulator.step(2)
assert simulator.bodies["cloth"].particles.shape[1] == 3'

echo "one version"
version=$(dpkg-query --show --showformat '${Version}' sprung)
version=${version%-*}
[[ $(sprung --version) == "sprung $version" ]]
[[ $(python3 -c 'import sprung; print(sprung.__version__)') == "$version" ]]
[[ $(pkg-config --modversion sprung) == "$version" ]]
[[ $(tail -n 1 /scratch/man.txt) == "sprung $version"* ]]

echo "nothing stays"
mapfile -t ours < <(dpkg-query --show --showformat '${Package}\n' '*sprung*')
apt-get --quiet --quiet --yes purge "${ours[@]}" >/packages/apt.txt 2>&1
left=$(find / -xdev \( -path /packages -o -path /scratch -o -path /proc -o -path /var/cache/man \) -prune -o -iname '*sprung*' -print)
[[ -z $left ]] || { echo "$left"; exit 1; }
echo "the packages work"
