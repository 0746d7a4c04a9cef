#!/usr/bin/env bash
# check.sh headless [TEST...] and check.sh interface install the add-on from its zip into a folder of its own, and test it in Blender.
# check.sh pictures FOLDER takes the pictures of src/blender/README.md; it needs ImageMagick.
# Needs SPRUNG_PROGRAM, SPRUNG_SOURCE_DIR and a folder to work in, SPRUNG_OUT.
# Exits with 77 where a program is missing, unless SPRUNG_NO_SKIPS is set.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

skip_without() {
  "$@" > /dev/null 2>&1 && return
  echo "skipped: \"$*\" fails; examples/install_packages.sh format-test installs it"
  [[ -n ${SPRUNG_NO_SKIPS:-} ]] && exit 1
  exit 77
}

part=$1
shift
skip_without blender --version
rm -rf "$SPRUNG_OUT"
export BLENDER_USER_SCRIPTS=$SPRUNG_OUT/scripts BLENDER_USER_CONFIG=$SPRUNG_OUT/config
mkdir -p "$BLENDER_USER_SCRIPTS" "$BLENDER_USER_CONFIG"
cmake -DZIP="$SPRUNG_OUT/sprung_blender.zip" -P "$SPRUNG_SOURCE_DIR/src/blender/zip.cmake"
in_window() {
  skip_without xvfb-run --help
  xvfb-run --auto-servernum --server-args="-screen 0 1280x960x24" blender --factory-startup --no-window-focus "$@"
}

case $part in
  headless) blender -b --factory-startup --python-exit-code 1 -P "$here/headless.py" -- "$@" ;;
  interface) in_window --window-geometry 0 0 1280 960 --python-exit-code 1 -P "$here/interface.py" ;;
  pictures)
    in_window --window-geometry 0 0 1040 720 --python-exit-code 1 -P "$here/pictures.py" -- "$1"
    mogrify +dither -colors 96 -define png:exclude-chunks=date,time "$1"/*.png
    ;;
  *) echo "unknown: $part" >&2; exit 2 ;;
esac
