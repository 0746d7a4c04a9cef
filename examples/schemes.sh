#!/usr/bin/env bash
# Runs six_schemes.json with each integrator and plots the change of energy: examples/pictures/six_schemes.png
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
examples/install_packages.sh run picture
[[ -f build/release/build.ninja ]] || cmake --preset release -DBUILD_TESTING=OFF
cmake --build --preset release --target sprung

schemes=(explicit_euler symplectic_euler verlet velocity_verlet rk4 implicit_euler)
frames=build/frames/schemes
picture=examples/pictures/six_schemes.png
for scheme in "${schemes[@]}"; do
  if [[ $scheme == explicit_euler ]]; then echo "Explicit Euler diverges, as expected. The frames before the divergence are kept:"; fi
  build/release/bin/sprung run examples/six_schemes.json --out "$frames/$scheme" --overwrite --quiet \
    --set "integrator.type=$scheme" || (($? == 4))
done

mkdir -p examples/pictures
gnuplot <<TXT | convert - -colors 64 -define png:exclude-chunks=date,time "$picture"
set terminal pngcairo size 1000,400 font "sans,11"
set output
set datafile separator ","
set multiplot layout 1,2
set xlabel "time [s]"
set ylabel "energy gained [J]"
set grid
schemes = "${schemes[*]}"
colors = "#d62728 #ff7f0e #2ca02c #9467bd #000000 #1f77b4"
energy(k) = column("kinetic_energy") + column("elastic_energy") + column("gravity_energy")
set key bottom left
set yrange [-2:1]
plot for [k = 1:6] "$frames/".word(schemes, k)."/diagnostics.csv" using "time":(energy(k)) \
  with lines lw 1.5 lc rgb word(colors, k) title word(schemes, k) noenhanced
set yrange [-0.1:0.1]
unset key
replot
TXT
echo "The plot is $picture."
