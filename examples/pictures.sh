#!/usr/bin/env bash
# Runs the examples and makes the pictures of examples/README.md: pictures.sh [SCENE...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
examples/install_packages.sh run
[[ -f build/release/build.ninja ]] || cmake --preset release -DBUILD_TESTING=OFF
cmake --build --preset release --target sprung

declare -A frames=(
  [cloth_on_bunny]="1 12 121"
  [jelly_on_stairs]="1 25 36 45"
  [horse_on_stairs]="1 14 30 91"
  [dress]="1 19 38 47 60"
  [balloon_on_spike]="1 9 11 14 20 28"
  [cloth_on_waves]="1 12 66 78"
  [hanging_cloth]="1 12 24 121"
  [flag_in_gusts]="1 60 100 140 180"
  [rope_over_torus]="1 10 20 91"
  [lab_rope]="1 12 38 76 151"
  [gripper]="1 28 68 82 121"
  [rope_bridge]="1 16 31 56"
  [torn_cloth]="1 34 44 76 145"
  [two_masses]="1 8 15 301"
  [heavy_mass]="1 14 27 301"
  [five_node_rope]="1 100 300 601"
  [too_large_step_warned]="1 2"
)
declare -A look=(
  [cloth_on_bunny]="HIDE=floor SIZE=600,460"
  [jelly_on_stairs]="HIDE=floor"
  [horse_on_stairs]="HIDE=floor"
  [dress]="AZIMUTH=-8 ELEVATION=10 SHIFT=1.2 SIZE=2800,1000"
  [balloon_on_spike]="HIDE=floor ELEVATION=20 SIZE=300,300"
  [cloth_on_waves]="ELEVATION=30 SIZE=400,270"
  [hanging_cloth]="AZIMUTH=25"
  [flag_in_gusts]="AZIMUTH=25 ELEVATION=5 HIDE=floor SHIFT=2.1 SIZE=1400,500"
  [gripper]="AZIMUTH=25 ELEVATION=5 HIDE=floor SHIFT=1 SIZE=1400,500"
  [rope_bridge]="HIDE=floor RADIUS=0.008 AZIMUTH=-25 ELEVATION=20 SIZE=460,460"
  [torn_cloth]="ELEVATION=40 RADIUS=0.001 SIZE=360,320"
  [rope_over_torus]="HIDE=floor RADIUS=0.012 ELEVATION=30"
  [lab_rope]="AZIMUTH=0 ELEVATION=0 RADIUS=0.03 SHIFT=5 SIZE=1400,500"
  [two_masses]="AZIMUTH=0 ELEVATION=0 RADIUS=0.04 SHIFT=0.6 SIZE=400,400"
  [heavy_mass]="AZIMUTH=0 ELEVATION=0 RADIUS=0.04 SHIFT=0.6 SIZE=400,400"
  [five_node_rope]="AZIMUTH=0 ELEVATION=0 RADIUS=0.12 SHIFT=14 SIZE=1400,400"
  [too_large_step_warned]="AZIMUTH=0 ELEVATION=0 RADIUS=0.04 SHIFT=0.6 SIZE=400,400"
)

mkdir -p examples/pictures
(($#)) || set -- "${!frames[@]}"
for scene in "$@"; do
  output="build/frames/$scene"
  # A scene that diverges (exit code 4) keeps the frames before. too_large_step_warned is meant to diverge.
  build/release/bin/sprung run "examples/$scene.json" --out "$output" --overwrite --mesh-path /usr/share/glmark2/models || (($? == 4))
  # shellcheck disable=SC2086
  env ${look[$scene]} examples/picture.sh "$output" "examples/pictures/$scene.png" ${frames[$scene]}
done
