#!/usr/bin/env bash
# Installs missing packages, builds Sprung with its viewer and shows a scene live in the browser: view.sh [SCENE [OPTION...]]
# SCENE is the name of an example, a scene file, or the folder of a run. Default: hanging_cloth. Options go to `sprung view`.
set -euo pipefail

case "${1:-}" in
  -h | --help)
    sed -n '2,3s/^# //p' "${BASH_SOURCE[0]}"
    exit 0
    ;;
esac

scene="${1:-hanging_cloth}"
shift $(($# > 0))
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
[[ -e "$scene" ]] || scene="$("$here/scene_file.sh" "$scene")"

"$here/install_packages.sh" run view
cd "$here/.."
new=()
[[ -f build/release/build.ninja ]] || new=(-DBUILD_TESTING=OFF)
cmake --preset release "${new[@]}"
cmake --build --preset release --target sprung
cd - >/dev/null
exec "$here/../build/release/bin/sprung" view "$scene" --mesh-path /usr/share/glmark2/models "$@"
