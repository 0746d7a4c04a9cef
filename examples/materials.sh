#!/usr/bin/env bash
# Drapes the cloth of materials.json with each of some materials and makes the pictures of README.md: materials.sh [MATERIAL...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
examples/install_packages.sh run
[[ -f build/release/build.ninja ]] || cmake --preset release -DBUILD_TESTING=OFF
cmake --build --preset release --target sprung

mkdir -p examples/pictures
(($#)) || set -- silk cotton denim rubber_sheet paper
for material in "$@"; do
  output="build/frames/materials_$material"
  build/release/bin/sprung run examples/materials.json --out "$output" --overwrite --mesh-path /usr/share/glmark2/models \
    --set "bodies.cloth.material=$material"
  HIDE=floor SIZE=360,340 examples/picture.sh "$output" "examples/pictures/materials_$material.png" 31
done
