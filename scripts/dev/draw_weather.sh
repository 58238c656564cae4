#!/usr/bin/env bash
# Measures the demo in clear air, fog, rain and snow on rungs `plausibility` and `surface` and draws
# dropout, density on the ground and range noise against range: draw_weather.sh OUT [FRAMES]. Writes
# OUT/images/weather_dropout.png, weather_density.png, weather_noise.png and the table
# OUT/weather.md. Needs a release build and gnuplot.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

if (($# < 1 || $# > 2)); then
  echo "usage: draw_weather.sh OUT [FRAMES]" >&2
  exit 2
fi
frames=${2:-20}
mkdir -p "$1/images"
out=$(realpath "$1")
runs=$(mktemp -d)
trap 'rm -rf "$runs"' EXIT

declare -A weathers=(
  [clear]='{}'
  [fog]="\"$PWD/scenarios/weather/fog.json\""
  [rain]="\"$PWD/scenarios/weather/heavy_rain.json\""
  [snow]="\"$PWD/scenarios/weather/snow.json\""
)
for rung in plausibility surface; do
  for weather in clear fog rain snow; do
    run=$runs/${rung}_$weather
    printf '{"version": 1, "file": "%s", "fidelity": "%s", "weather": %s}' \
      "$PWD/scenarios/st_gallen_approach.json" "$rung" "${weathers[$weather]}" > "$run.json"
    build/release/generator/railcast-generate sequence "$run.json" --out "$run" --frames "$frames"
    build/release/analysis/railcast-analyze stats "$run" --out "${run}_stats"
    rm -r "$run"
  done
done > "$runs/log.txt"
scripts/dev/weather_by_range.py "$runs" > "$out/weather.md"

# draw NAME LABEL SETTING...: a panel per rung, a curve per weather, with 95 % intervals.
draw() {
  local name=$1 label=$2
  shift 2
  gnuplot << GNUPLOT
set terminal pngcairo noenhanced rounded size 1280,640 fontscale 1.7 linewidth 2 font 'sans-serif,10'
set output '$out/images/weather_$name.png'
set border 1
set xlabel 'Range (m)'
set logscale x
set xrange [6:300]
set xtics nomirror scale 0.4 (8, 16, 32, 64, 128, 256)
set ytics nomirror scale 0.4
set grid ytics back linetype 1 linewidth 0.8 linecolor rgb '#dddddd'
array colors[4] = ['#000000', '#999999', '#0072b2', '#d55e00']
weathers = 'clear fog rain snow'
$(printf '%s\n' "$@")
set multiplot layout 1,2 margins 0.10,0.985,0.17,0.80 spacing 0.07,0.1
set ylabel '$label'
set title 'plausibility'
set key at screen 0.10,0.98 left top horizontal Left reverse samplen 1.5
plot for [i=1:4] '$runs/$name.dat' index i-1 with yerrorlines linecolor rgb colors[i] pointtype 7 pointsize 0.8 title word(weathers, i)
unset key
unset ylabel
set title 'surface'
plot for [i=1:4] '$runs/$name.dat' index i+3 with yerrorlines linecolor rgb colors[i] pointtype 7 pointsize 0.8
unset multiplot
GNUPLOT
}
draw dropout 'Dropout (%)' 'set yrange [0:100]'
draw density 'Points on a square metre of ground' 'set logscale y' 'set yrange [0.005:200]' \
  'set format y "%g"'
draw noise 'Standard deviation of the range (mm)' 'set yrange [0:60]'
cat "$out/weather.md"
