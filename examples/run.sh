#!/usr/bin/env bash
# Installs missing packages, builds Sprung and runs a scene of this folder: run.sh [SCENE [OUTPUT_FOLDER]]
# Default: cloth_on_bunny, written to build/frames/cloth_on_bunny.
set -euo pipefail

scene="$(basename "${1:-cloth_on_bunny}" .json)"
frames="$(realpath --canonicalize-missing "${2:-"$(dirname "${BASH_SOURCE[0]}")/../build/frames/$scene"}")"
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [[ ! -f examples/$scene.json ]]; then
  echo "There is no example '$scene'. The examples are:" >&2
  (cd examples && printf '  %s\n' *.json) >&2
  exit 2
fi

examples/install_packages.sh run
[[ -f build/release/build.ninja ]] || cmake --preset release -DBUILD_TESTING=OFF
cmake --build --preset release --target sprung

status=0
build/release/bin/sprung run "examples/$scene.json" --out "$frames" --overwrite --mesh-path /usr/share/glmark2/models || status=$?
diverged=4  # this exit code keeps the frames before the divergence
((status == 0 || status == diverged)) || exit $status

last="$(find "$frames" -mindepth 2 -maxdepth 2 -name '*.obj' -not -path '*/obstacles/*' | sort | tail -n 1)"
cat <<END

The frames are in $frames: a folder for each body and each moving obstacle, with an OBJ file for each frame.
Fixed obstacles are in the folder obstacles.
  The last frame:  f3d --up=+Y "$last"    (Debian package f3d)
  A picture:       HIDE=floor examples/picture.sh "$frames" picture.png 1 $(find "$(dirname "$last")" -name '*.obj' | wc -l)    (installs packages of 340 MB)
  The animation:   in Blender, import the frames with the add-on Stop-motion-OBJ, and the obstacles as Wavefront (.obj).
END
exit $status
