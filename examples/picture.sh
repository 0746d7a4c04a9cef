#!/usr/bin/env bash
# Makes a picture of some frames of a run, side by side. Installs the packages for it. Bodies are red, obstacles grey.
#   examples/picture.sh FRAMES_FOLDER PICTURE.png FRAME...
# Environment variables: SHIFT [m] draws all frames in one view at one scale, this distance apart; without it each frame has its own
# view. HIDE="floor wall" hides obstacles. AZIMUTH and ELEVATION [degrees] turn the camera. RADIUS [m] is the radius of the tubes that
# show ropes. SIZE is the size of a view in pixels, for example 360,320.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
if (($# < 3)); then
  sed -n '2,6s/^# //p' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
folder=$1 picture=$2
shift 2
[ -f "$folder/run.json" ] || { echo "picture.sh: $folder: not the output folder of a run (it has no run.json)" >&2; exit 2; }
"$here/install_packages.sh" picture
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cat > "$work/scene.mtl" <<'TXT'
newmtl body
Kd 0.80 0.18 0.12
newmtl obstacle
Kd 0.75 0.74 0.70
TXT

hidden() { case " ${HIDE:-} " in *" $1 "*) return 0 ;; *) return 1 ;; esac; }

# The file of a frame in the folder of a body or a moving obstacle. The number of digits may vary.
frame_file() { find "$1" -name "$(basename "$1").*.obj" | grep -E "\.0*$2\.obj$" || true; }

for frame in "$@"; do
  for path in "$folder"/*/; do
    if [ "$(basename "$path")" = obstacles ] || [ -n "$(frame_file "${path%/}" "$frame")" ]; then continue; fi
    echo "picture.sh: $path: there is no frame $frame" >&2
    exit 2
  done
done

# All bodies and obstacles of a frame, as input of picture.awk.
frame_parts() {
  local frame=$1 path name
  for path in "$folder"/*/ "$folder"/obstacles/*; do
    [ -e "$path" ] || continue
    name=$(basename "$path" .obj)
    if [ "$name" = obstacles ] || hidden "$name"; then continue; fi
    case $path in "$folder"/obstacles/*) echo "usemtl obstacle" ;; *) echo "usemtl body" ;; esac
    if [ -d "$path" ]; then path=$(frame_file "${path%/}" "$frame"); fi
    cat "$path"
  done
}

# Draws standard input as a picture.
render() {
  { echo "mtllib scene.mtl"; awk -v radius="${RADIUS:-0.01}" -f "$here/picture.awk"; } > "$work/scene.obj"
  xvfb-run -a f3d --output="$1" --resolution="${SIZE:-360,320}" --up=+Y --bg-color=1,1,1 --fxaa --ssao --tone-mapping --quiet \
    --camera-azimuth-angle="${AZIMUTH:--30}" --camera-elevation-angle="${ELEVATION:-15}" "$work/scene.obj"
}

views=()
if [ -n "${SHIFT:-}" ]; then
  views=("$work/all.png")
  for frame in "$@"; do frame_parts "$frame"; echo "shift $SHIFT"; done | render "${views[0]}"
else
  for frame in "$@"; do
    frame_parts "$frame" | render "$work/$frame.png"
    views+=("$work/$frame.png")
  done
fi
montage "${views[@]}" -tile "x1" -geometry +0+0 -colors 64 - | convert - -trim -bordercolor white -border 10 -define png:exclude-chunks=date,time "$picture"
