#!/usr/bin/env bash
# Runs the examples and makes all pictures and the animation of README.md and of this folder by render.sh: pictures.sh [NAME...]
# NAME is an example, materials, or animation. All of them took 80 minutes on two busy cores. SAMPLES=16 is quicker.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
samples=${SAMPLES:-64}
pictures=examples/pictures

# The moments that tell most, and how render.sh looks at them. RUN holds options of sprung run: finer meshes than the quick examples have.
declare -A frames=(
  [cloth_on_bunny]="34"
  [jelly_on_stairs]="19"
  [horse_on_stairs]="37"
  [dress]="47"
  [balloon_on_spike]="11"
  [cloth_on_waves]="66"
  [hanging_cloth]="24"
  [flag_in_gusts]="140"
  [rope_over_torus]="20"
  [gripper]="28 68 82"
  [rope_bridge]="31"
  [torn_cloth]="44"
  [lab_rope]="12 24 90"
  [two_masses]="1 8 15"
  [heavy_mass]="1 14 27"
  [five_node_rope]="300"
  [too_large_step_warned]="1 2"
)
declare -A look=(
  [cloth_on_bunny]="--azimuth -35"
  [dress]="--size 540x720 --elevation 8"
  [jelly_on_stairs]="--camera 3.6,2.2,2.2,1.05,1.05,-0.15"
  [horse_on_stairs]="--camera 3.3,2.0,2.4,1.15,0.9,0.1"
  [cloth_on_waves]="--elevation 28 --obstacles #4d87a3"
  [rope_bridge]="--zoom 1.35"
  [flag_in_gusts]="--elevation 6"
  [rope_over_torus]="--elevation 32"
  [gripper]="--size 420x560 --elevation 8"
  [torn_cloth]="--elevation 38"
  [lab_rope]="--size 420x420 --azimuth 0 --elevation 4 --radius 0.03"
  [two_masses]="--size 240x480 --azimuth 0 --elevation 4 --radius 0.04"
  [heavy_mass]="--size 240x480 --azimuth 0 --elevation 4 --radius 0.04"
  [five_node_rope]="--azimuth 0 --elevation 4 --radius 0.1"
  [too_large_step_warned]="--size 240x480 --azimuth 0 --elevation 4 --radius 0.04"
)
declare -A run=(
  [cloth_on_bunny]="--frames 34 --set bodies.cloth.shape.resolution=[128,128]"
  [hanging_cloth]="--frames 24 --set bodies.cloth.shape.resolution=[64,64]"
  [flag_in_gusts]="--frames 140 --set bodies.flag.shape.resolution=[61,41]"
  [gripper]="--frames 82 --set bodies.towel.shape.resolution=[41,61]"
)

simulate() { # EXAMPLE FOLDER [OPTION...]
  local scene=$1 output=$2
  shift 2
  # A scene that diverges (exit code 4) keeps the frames before. too_large_step_warned is meant to diverge.
  build/release/bin/sprung run "examples/$scene.json" --out "$output" --overwrite --mesh-path /usr/share/glmark2/models "$@" || (($? == 4))
}

# Noise replaces dithering: a palette makes the files a third as large.
shrink() { mogrify -strip +dither -colors 256 -define png:exclude-chunks=date,time "$1"; }

# The same drape of each fabric.
materials() {
  local material output
  for material in silk cotton wool denim rubber_sheet paper; do
    output=build/frames/materials_$material
    simulate materials "$output" --frames 60 --set "bodies.cloth.material=$material" --set "bodies.cloth.shape.resolution=[128,128]"
    examples/render.sh "$output" --out "$pictures/materials_$material.png" --size 480x420 --samples "$samples" 60
    shrink "$pictures/materials_$material.png"
  done
}

animation() {
  local output=build/frames/animation
  simulate cloth_on_bunny "$output" --frames 75 --set "bodies.cloth.shape.resolution=[128,128]"
  examples/render.sh "$output" --out "$pictures/cloth_on_bunny.webp" --size 720x540 --azimuth -35 --samples "$((samples * 3 / 4))"
}

examples/install_packages.sh run render
[[ -f build/release/build.ninja ]] || cmake --preset release -DBUILD_TESTING=OFF
cmake --build --preset release --target sprung
mkdir -p "$pictures"
(($#)) || set -- "${!frames[@]}" materials animation
for name in "$@"; do
  case $name in
    materials | animation) "$name" ;;
    *)
      # shellcheck disable=SC2086
      simulate "$name" "build/frames/$name" ${run[$name]:-}
      # shellcheck disable=SC2086
      examples/render.sh "build/frames/$name" --out "$pictures/$name.png" --size 720x540 --samples "$samples" ${look[$name]:-} ${frames[$name]}
      shrink "$pictures/$name.png"
      ;;
  esac
done
du -sh "$pictures"
