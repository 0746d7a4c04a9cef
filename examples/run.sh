#!/usr/bin/env bash
# Installs what is missing, builds Sprung and simulates a scene of this folder: run.sh [SCENE [OUTPUT_FOLDER]]
set -euo pipefail

scene="$(basename "${1:-cloth_on_bunny}" .json)"
frames="$(realpath --canonicalize-missing "${2:-"$(dirname "${BASH_SOURCE[0]}")/../build/frames/$scene"}")"
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [[ ! -f examples/$scene.json ]]; then
  echo "There is no example '$scene'. There are:" >&2
  (cd examples && printf '  %s\n' *.json) >&2
  exit 2
fi

examples/install_packages.sh run
[[ -f build/release/build.ninja ]] || cmake --preset release -DBUILD_TESTING=OFF
cmake --build --preset release --target sprung

status=0
build/release/bin/sprung run "examples/$scene.json" --out "$frames" --overwrite --mesh-path /usr/share/glmark2/models || status=$?
diverged=4  # frames before that are kept
((status == 0 || status == diverged)) || exit $status

last="$(find "$frames" -mindepth 2 -maxdepth 2 -name '*.obj' -not -path '*/obstacles/*' | sort | tail -n 1)"
cat <<END

The frames are in $frames: a folder a body, an OBJ file a frame; beside them the obstacles as placed.
  The last frame:  f3d --up=+Y "$last"    (from Debian's package f3d)
  A picture:       HIDE=floor examples/picture.sh "$frames" picture.png 1 $(find "$(dirname "$last")" -name '*.obj' | wc -l)
  The animation:   in Blender, import the sequence with the add-on Stop-motion-OBJ and the obstacles as Wavefront (.obj).
END
exit $status
