#!/usr/bin/env bash
# check.sh write: runs a few scenes with all formats, exports the same runs from their records, and compares the bytes.
# check.sh numpy|vtk|blender|three: reads the files back with a program that others wrote.
# Needs SPRUNG_PROGRAM, SPRUNG_SOURCE_DIR, SPRUNG_TEST_MESHES, SPRUNG_THREE (the folder of three) and a folder to work in, SPRUNG_OUT.
# Exits with 77 where the program is missing, unless SPRUNG_NO_SKIPS is set.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
formats=obj,ply,vtk,pc2,mdd,gltf,npz,usda
# Cloths that tear, moving obstacles, ropes, a lattice with a rope, a mesh with UVs, an obstacle that deforms.
scenes=(torn_cloth gripper rope_over_torus horse_on_stairs dress cloth_on_waves)
frames=6
export SPRUNG_MESH_PATH=$SPRUNG_TEST_MESHES

write() {
  rm -rf "$SPRUNG_OUT"
  for scene in "${scenes[@]}"; do
    local file=$SPRUNG_SOURCE_DIR/examples/$scene.json
    "$SPRUNG_PROGRAM" run "$file" --frames $frames --out "$SPRUNG_OUT/$scene/run" --format $formats --quiet 2> /dev/null
    "$SPRUNG_PROGRAM" run "$file" --frames $frames --out "$SPRUNG_OUT/$scene/record" --format none --quiet 2> /dev/null
    "$SPRUNG_PROGRAM" export "$SPRUNG_OUT/$scene/record" --out "$SPRUNG_OUT/$scene/export" --format $formats 2> /dev/null
    "$SPRUNG_PROGRAM" export "$SPRUNG_OUT/$scene/record" --out "$SPRUNG_OUT/$scene/run/doubles" --format npz64 2> /dev/null
    (cd "$SPRUNG_OUT/$scene/export" && find . -type f | sort) | while read -r name; do
      cmp "$SPRUNG_OUT/$scene/run/$name" "$SPRUNG_OUT/$scene/export/$name"
    done
  done
}

skip_without() {
  "$@" > /dev/null 2>&1 && return
  echo "skipped: \"$*\" fails; examples/install_packages.sh format-test installs it"
  [[ -n ${SPRUNG_NO_SKIPS:-} ]] && exit 1
  exit 77
}

each() { for scene in "${scenes[@]}"; do echo "$scene"; "$@" "$SPRUNG_OUT/$scene/run" "$SPRUNG_OUT/$scene/run"; done; }

python=/usr/bin/python3 # that of Debian's packages
case $1 in
  write) write ;;
  numpy) skip_without $python -c "import numpy"; each $python "$here/read_numpy.py" ;;
  vtk) skip_without $python -c "import numpy, vtkmodules.vtkIOXML"; each $python "$here/read_vtk.py" ;;
  blender) skip_without blender --version; each blender -b --factory-startup --python-exit-code 1 -P "$here/read_blender.py" -- ;;
  three) skip_without node --version; skip_without test -d "$SPRUNG_THREE"; each node "$here/read_three.mjs" "$SPRUNG_THREE" ;;
  *) echo "unknown: $1" >&2; exit 2 ;;
esac
