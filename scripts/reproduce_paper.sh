#!/usr/bin/env bash
# Reproduces the evaluation of the publication that describes Vir2Rail, as far as this project can,
# on one page, OUT/reproduction.md, with its pictures in OUT/images:
#
#   reproduce_paper.sh OUT          in some minutes, with few scans and frames
#   reproduce_paper.sh --full OUT   with as many as the figures in docs/results/published.md were made with
#
# Installs missing packages and builds what it needs. Timings need an otherwise idle machine.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

scans=20
turns=5
if [[ "${1:-}" == --full ]]; then
  scans=1000
  turns=100
  shift
fi
if (($# != 1)) || [[ "$1" == -* ]]; then
  sed -n '2,/^set /{/^# \?/s///p}' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
install_packages "${build_packages[@]}" "${display_packages[@]}" "${paper_packages[@]}"
scripts/build.sh railcast-generate railcast-analyze railcast-view railcast-measure

mkdir -p "$1/images"
out=$(realpath "$1")
images=$out/images
repository=$PWD
generate=build/release/generator/railcast-generate
runs=$(mktemp -d)
trap 'rm -rf "$runs"' EXIT

# draw NAME OPTION...: in the folder of the runs, so that no picture shows a temporary path.
draw() {
  local name=$1
  shift
  (cd "$runs" && xvfb-run --auto-servernum --server-args="-noreset -screen 0 1920x1080x24" \
    "$repository/build/release/viewer/railcast-view" --screenshot "$images/$name.png" "$@" > view.txt)
}

echo "Tables 1 and 2"
build/release/tests/bench/railcast-measure modules --scans "$scans" > "$runs/modules.md"
build/release/tests/bench/railcast-measure settings --turns "$turns" > "$runs/settings.md"

echo "Figures"
printf '{"version": 1, "file": "%s", "camera": {"width_px": 600, "height_px": 375,
  "horizontal_fov_deg": 60, "mount": {"position_m": [2.2, 0, 2.5]}}}' \
  "$PWD/scenarios/st_gallen_approach.json" > "$runs/demo.json"
"$generate" sequence "$runs/demo.json" --out "$runs/demo" --frames 21 > "$runs/log.txt"
"$generate" sequence scenarios/parallel_wagons.json --out "$runs/wagons" --frames 60 >> "$runs/log.txt"
draw published_overview demo --image off --frame 10 --accumulate 11 --show boxes,track \
  --eye=-35,-30,28 --target=45,4,-2
draw published_wagons wagons --size 880x495 --frame 59 --accumulate 60 --color-by intensity \
  --select wagon,person --eye=8,-6,7 --target=32,4,0
draw published_ego demo --image off --size 600x375 --frame 20 --camera driver
cp "$runs/demo/camera/camera/color/000020.png" "$images/published_camera.png"
dot -T svg docs/images/architecture.dot -o "$images/architecture.svg"

echo "Landscape and weather"
scripts/dev/draw_plants.sh "$out" > "$runs/log.txt"
scripts/dev/draw_weather.sh "$out" > "$runs/log.txt"

{
  cat << PAGE
# Reproduction of the published evaluation

Made by \`scripts/reproduce_paper.sh\` with $(build/release/generator/railcast-generate --version).
docs/results/published.md explains the tables and pictures and says what differs.

## Table 1: the four modules

\`build/release/tests/bench/railcast-measure modules --scans $scans\`

$(cat "$runs/modules.md")

## Table 2: the settings

\`build/release/tests/bench/railcast-measure settings --turns $turns\`

$(cat "$runs/settings.md")

## Figures

![Overview of the line](images/published_overview.png)

![Rolling stock](images/published_wagons.png)

| cloud of the sensor's own view | camera |
|---|---|
| ![cloud](images/published_ego.png) | ![image](images/published_camera.png) |

![Architecture](images/architecture.svg)

## Plants

![Points of the landscape by range](images/plants.png)

![Clouds with plants and without](images/plants_clouds.png)

$(cat "$out/plants.md")

## Clear air, fog, rain and snow

![Dropout against range](images/weather_dropout.png)

![Density against range](images/weather_density.png)

![Range noise against range](images/weather_noise.png)

$(cat "$out/weather.md")
PAGE
} > "$out/reproduction.md"
rm "$out/plants.md" "$out/weather.md"
echo "Look at $out/reproduction.md"
