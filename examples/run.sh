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

build/release/bin/sprung run "examples/$scene.json" --out "$frames" --overwrite --mesh-path /usr/share/glmark2/models

cat <<END

The frames are in $frames, one folder a body, one OBJ a frame, beside the obstacles as placed.
To look at one:           f3d --up=+Y \$(ls -d "$frames"/*/*.0001.obj | head -n 1) (Debian's package f3d)
To play them in Blender:  import the sequence with the add-on Stop-motion-OBJ, obstacles with File > Import > Wavefront.
END
