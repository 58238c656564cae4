#!/usr/bin/env bash
# Counts the returns of the landscape by range in the demo with its plants and without them:
# draw_plants.sh OUT [FRAMES]. Writes the chart OUT/images/plants.png, a picture of both clouds
# OUT/images/plants_clouds.png and the table OUT/plants.md. Needs a release build, gnuplot and Xvfb.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

if (($# < 1 || $# > 2)); then
  echo "usage: draw_plants.sh OUT [FRAMES]" >&2
  exit 2
fi
frames=${2:-20}
mkdir -p "$1/images"
out=$(realpath "$1")
generate=build/release/generator/railcast-generate
runs=$(mktemp -d)
trap 'rm -rf "$runs"' EXIT

"$generate" check scenarios/st_gallen_approach.json --resolved - > "$runs/with.json"
python3 - "$runs" << 'PYTHON'
import json
import sys

scenario = json.load(open(f"{sys.argv[1]}/with.json", encoding="utf-8"))
scenario["world"]["vegetation"].update(trees_per_hectare=0, grass=False)
json.dump(scenario, open(f"{sys.argv[1]}/without.json", "w", encoding="utf-8"))
PYTHON
for plants in with without; do
  "$generate" sequence "$runs/$plants.json" --out "$runs/${plants}_plants" --frames "$frames"
  build/release/analysis/railcast-analyze stats "$runs/${plants}_plants" --out "$runs/stats_$plants"
done > "$runs/log.txt"

scripts/dev/plants_by_range.py "$runs/stats_with" "$runs/stats_without" "$runs/plants.dat" > "$out/plants.md"
gnuplot << GNUPLOT
set terminal pngcairo noenhanced rounded size 1280,760 fontscale 2 linewidth 2 font 'sans-serif,10'
set output '$out/images/plants.png'
set border 1
set key outside top left Left reverse horizontal samplen 1.5 maxrows 2
set xlabel 'Range (m)'
set ylabel 'Points a frame and bin'
set logscale x
set xrange [8:300]
set xtics nomirror scale 0.4 (8, 16, 32, 64, 128, 256)
set ytics nomirror scale 0.4
set grid ytics back linetype 1 linewidth 0.8 linecolor rgb '#dddddd'
set style fill solid 0.85 noborder
plants = '$runs/plants.dat'
plot plants using 1:(\$3 + \$4 + \$5):1:2:(0):(\$3 + \$4 + \$5) with boxxyerror linecolor rgb '#009e73' title 'trees', \
     plants using 1:(\$3 + \$4):1:2:(0):(\$3 + \$4) with boxxyerror linecolor rgb '#e69f00' title 'grass', \
     plants using 1:3:1:2:(0):3 with boxxyerror linecolor rgb '#b0a090' title 'ground between them', \
     plants using 1:6 with steps linewidth 1.5 linecolor rgb '#000000' title 'ground, without plants'
GNUPLOT

# In the folder of the runs, so that the picture shows no temporary path.
repository=$PWD
(cd "$runs" && xvfb-run --auto-servernum --server-args="-noreset -screen 0 1920x1080x24" \
  "$repository/build/release/viewer/railcast-view" with_plants --compare without_plants \
  --frame "$((frames > 20 ? 20 : frames - 1))" --camera driver --color-by label \
  --screenshot "$out/images/plants_clouds.png" > view.txt)
cat "$out/plants.md"
