#!/usr/bin/env bash
# Installs missing packages, builds all that `cmake --install` installs, simulates 50 frames of an
# on-sight approach on the St.Gallen - Wil line into out/demo, draws one of them (out/demo.png) and
# analyses all of them (out/stats).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

install_packages "${build_packages[@]}" "${display_packages[@]}" "${python_packages[@]}"
scripts/build.sh installed

rm -rf out/demo out/demo.png out/stats
mkdir -p out
build/release/generator/railcast-generate sequence scenarios/st_gallen_approach.json \
  --out out/demo --frames 50
xvfb-run --auto-servernum --server-args="-noreset -screen 0 1920x1080x24" \
  build/release/viewer/railcast-view out/demo --frame 36 --camera driver --color-by label \
  --screenshot out/demo.png
build/release/analysis/railcast-analyze stats out/demo --out out/stats

cat <<TEXT

Look at
  $PWD/out/demo.png              frame 36: wagons and a person, points coloured by label
  $PWD/out/stats/report.html     dropout, density, noise, intensity: open it in a browser
  $PWD/out/demo/frames/          50 labelled point clouds, PCD: pcl_viewer, Open3D
  $PWD/out/demo/objects.jsonl    every object's box, points and occlusion, a line per frame
  $PWD/out/demo/poses.csv        where the sensor was
  $PWD/out/demo/manifest.json    version, seed and counts
TEXT
