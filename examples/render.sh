#!/usr/bin/env bash
# Renders frames of a run with Blender's Cycles: render.sh DIR [OPTION...] [FRAME...]
#   DIR              the folder of a run, with OBJ files; FRAME: frames to render, all without one
#   --out PATH       PATH.png: one picture, with several frames side by side; PATH.webp or PATH.mp4: an animation; else a folder for
#                    a picture for each frame. Default: DIR/render. An animation keeps its pictures in DIR/render: a second call renders
#                    only those that are missing
#   --size WxH       of each picture, 960x720 by default; --samples N: 64 by default, fewer are noisier
#   --azimuth D, --elevation D [degrees], --zoom F   turn the camera, which shows all of the run; --camera X,Y,Z,TX,TY,TZ puts it at a
#                    point of the scene and lets it look at another [m]
#   --hide "A B"     hides bodies and obstacles; --obstacles #RRGGBB: their colour; --radius R: of ropes [m]; --threads N
# A picture of 960 x 720 takes about a minute on two cores. Colours and weave follow the material presets. Installs Blender first.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
usage() { sed -n '2,/^set/{/^# /s/^# //p}' "${BASH_SOURCE[0]}"; }

refuse() {
  echo "render.sh: $1" >&2
  exit 2
}

options=() frames=() out="" folder=""
while (($#)); do
  case $1 in
    -h | --help) usage; exit 0 ;;
    --*) (($# > 1)) || refuse "$1: needs a value, or is unknown; see render.sh --help" ;;&
    --out) out=$2; shift ;;
    --size | --samples | --azimuth | --elevation | --zoom | --camera | --hide | --obstacles | --radius | --threads) options+=("$1=$2"); shift ;;
    -*) refuse "$1: no such option; see render.sh --help" ;;
    *) if [[ -z $folder ]]; then folder=$1; else frames+=("$1"); fi ;;
  esac
  shift
done
[[ -n $folder ]] || { usage >&2; exit 2; }
[[ -f $folder/run.json ]] || refuse "$folder: not the output folder of a run (it has no run.json)"
[[ -z $out || -d $(dirname "$out") ]] || refuse "--out $out: there is no folder $(dirname "$out")"
case $out in
  *.png) ((${#frames[@]})) || refuse "--out $out: one picture shows the frames that you name, as in: render.sh $folder --out $out 30" ;;
  *.jpg | *.jpeg | *.gif | *.mov | *.avi) refuse "--out $out: must end in .png, .webp or .mp4, or be a folder" ;;
esac
"$here/install_packages.sh" render

render() { # FOLDER FRAME...
  local pictures=$1
  shift
  mkdir -p "$pictures"
  blender -b --factory-startup -P "$here/render.py" -- "$folder" "$@" --pictures "$pictures" "${options[@]}" > /dev/null
}

# Frames of the run, in order.
all_frames() { seq 1 "$(sed -n 's/^ *"frames_written": \([0-9]*\),*/\1/p' "$folder/run.json")"; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
case $out in
  *.png)
    render "$work" "${frames[@]}"
    pictures=()
    for frame in "${frames[@]}"; do pictures+=("$(printf '%s/%04d.png' "$work" "$frame")"); done
    convert "${pictures[@]}" +append -strip -define png:exclude-chunks=date,time "$out"
    ;;
  *.webp | *.mp4)
    ((${#frames[@]})) || mapfile -t frames < <(all_frames)
    missing=()
    for frame in "${frames[@]}"; do [[ -f $(printf '%s/render/%04d.png' "$folder" "$frame") ]] || missing+=("$frame"); done
    if ((${#missing[@]})); then render "$folder/render" "${missing[@]}"; fi
    rate=$(sed -n 's/^ *"frame_rate": \([0-9.]*\),*/\1/p' "$folder/run.json" | head -n 1)
    codec=(-c:v libx264 -crf 20 -pix_fmt yuv420p -movflags +faststart)
    if [[ $out == *.webp ]]; then codec=(-c:v libwebp_anim -quality 80 -loop 0); fi
    number=0
    for frame in "${frames[@]}"; do
      ln -s "$(realpath "$(printf '%s/render/%04d.png' "$folder" "$frame")")" "$work/$((number++)).png"
    done
    ffmpeg -y -loglevel error -framerate "$rate" -i "$work/%d.png" "${codec[@]}" "$out"
    ;;
  *) render "${out:-$folder/render}" "${frames[@]}" ;;
esac
