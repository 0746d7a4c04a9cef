#!/usr/bin/env bash
# Installs missing packages, builds Sprung and runs a scene: run.sh [SCENE [OUTPUT_FOLDER]]
# SCENE is the name of an example, such as hanging_cloth, or a scene file. Default: cloth_on_bunny.
# The frames are written to OUTPUT_FOLDER, by default build/frames/NAME_OF_THE_SCENE; those of an earlier run are replaced.
set -euo pipefail

case "${1:-}" in
  -h | --help)
    sed -n '2,4s/^# //p' "${BASH_SOURCE[0]}"
    exit 0
    ;;
esac
if [[ "${1:-}" == -* ]] || (($# > 2)); then
  sed -n '2,4s/^# //p' "${BASH_SOURCE[0]}" >&2
  exit 2
fi

here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
root="$(dirname "$here")"
scene="$("$here/scene_file.sh" "${1:-cloth_on_bunny}")"
frames="$(realpath --canonicalize-missing "${2:-"$root/build/frames/$(basename "$scene" .json)"}")"

"$here/install_packages.sh" run
cd "$root"
[[ -f build/release/build.ninja ]] || cmake --preset release -DBUILD_TESTING=OFF
cmake --build --preset release --target sprung
cd - >/dev/null

status=0
"$root/build/release/bin/sprung" run "$scene" --out "$frames" --overwrite --mesh-path /usr/share/glmark2/models || status=$?
diverged=4  # this exit code keeps the frames before the divergence
((status == 0 || status == diverged)) || exit $status

# A path as one types it where the user is, in quotes if it needs them.
typed() { printf '%q' "$(realpath --relative-base="$PWD" "$1")"; }
sprung="$(typed "$root/build/release/bin/sprung")"
if [[ "$(realpath "$(command -v sprung || true)" 2>/dev/null)" == "$root/build/release/bin/sprung" ]]; then sprung=sprung; fi
view="$sprung view $(typed "$frames")"
grep --quiet '^SPRUNG_VIEWER_IS_BUILT:INTERNAL=ON' "$root/build/release/CMakeCache.txt" ||
  view="$(typed "$here/view.sh") $(typed "$frames")    (builds the viewer first, for the next line too)"
last="$(find "$frames" -mindepth 2 -maxdepth 2 -name '*.obj' -not -path "$frames/obstacles/*" | sort | tail -n 1)"
cat <<END

The frames are in $frames: a folder for each body and each moving obstacle, with an OBJ file for each frame.
Fixed obstacles are in the folder obstacles.
  In the browser:  $view
  One HTML file:   $sprung export $(typed "$frames") --format html
  The last frame:  f3d --up=+Y $(typed "$last")    (Debian package f3d)
  A picture:       HIDE=floor $(typed "$here/picture.sh") $(typed "$frames") picture.png 1 $(find "$(dirname "$last")" -name '*.obj' | wc -l)    (installs packages of 340 MB)
  The animation:   in Blender, import the frames with the add-on Stop-motion-OBJ, and the obstacles as Wavefront (.obj).
END
exit $status
