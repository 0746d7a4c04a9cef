#!/usr/bin/env bash
# Makes a picture of some frames of a run, side by side: bodies red, obstacles grey, ropes and loose particles as tubes and beads.
#   examples/picture.sh FRAMES_FOLDER PICTURE.png FRAME...
# HIDE="floor wall" leaves obstacles out; AZIMUTH and ELEVATION turn the camera [degrees]; RADIUS is a tube's [m]; SIZE a frame's.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=$1 picture=$2
shift 2
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

# The file of a body's or a moving obstacle's folder that holds a frame, whatever the number of its digits.
frame_file() { find "$1" -name "$(basename "$1").*.obj" | grep -E "\.0*$2\.obj$"; }

tiles=()
for frame in "$@"; do
  files=()
  for body in "$folder"/*/; do
    body=${body%/}
    [ "$(basename "$body")" = obstacles ] || files+=("body=$(frame_file "$body" "$frame")")
  done
  for obstacle in "$folder"/obstacles/*; do
    [ -e "$obstacle" ] || continue
    hidden "$(basename "$obstacle" .obj)" && continue
    if [ -d "$obstacle" ]; then obstacle=$(frame_file "$obstacle" "$frame"); fi
    files+=("obstacle=$obstacle")
  done
  { echo "mtllib scene.mtl"
    for file in "${files[@]}"; do
      echo "usemtl ${file%%=*}"
      cat "${file#*=}"
    done | awk -v radius="${RADIUS:-0.01}" -f "$here/picture.awk"
  } > "$work/scene.obj"
  tile="$work/$frame.png"
  xvfb-run -a f3d --output="$tile" --resolution="${SIZE:-480,420}" --up=+Y --bg-color=1,1,1 --fxaa --ssao --tone-mapping --quiet \
    --camera-azimuth-angle="${AZIMUTH:--30}" --camera-elevation-angle="${ELEVATION:-15}" "$work/scene.obj"
  tiles+=("$tile")
done
montage "${tiles[@]}" -tile "x1" -geometry +0+0 -colors 64 "$picture"
