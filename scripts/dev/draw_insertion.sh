#!/usr/bin/env bash
# Prints the tables of docs/results/insertion.md, "Against reality", and draws docs/images/insertion_real.png. Needs
# the test program generator_extras_tests of a release build, the real captures that it reads, and gnuplot.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

runs=$(mktemp -d)
trap 'rm -rf "$runs"' EXIT
build/release/tests/generator/extras/generator_extras_tests --gtest_filter='InsertAblation.*:InsertedThings.*:RealThings.*' | tee "$runs/log.txt"
if ! grep -q '^across: ' "$runs/log.txt"; then
  echo "draw_insertion.sh: the real captures are not there" >&2
  exit 1
fi
sed -n 's/^across: //p' "$runs/log.txt" > "$runs/across.dat"
# Number, thing, edges by beams and by rays.
grep -E '^\| [^|]+ \| [^|]*(pole|post|bin|person|box|panel)[^|]* \| .* m \|' "$runs/log.txt" |
  awk -F ' *[|] *' '{printf "%d \"%s, %s\" %s %s\n", NR, $2, $3, $11, $12}' > "$runs/edges.dat"

gnuplot << GNUPLOT
set terminal pngcairo noenhanced rounded size 1280,640 fontscale 1.4 linewidth 2 font 'sans-serif,10'
set output 'docs/images/insertion_real.png'
set grid linetype 1 linewidth 0.8 linecolor rgb '#dddddd'
set multiplot layout 1,2
set border 1
set ytics nomirror scale 0.4
set xtics nomirror scale 0.4
set key top left reverse Left samplen 1
set title 'How much further rows reach than real ones'
set xlabel 'Firings at each end'
set xrange [-2:1]
set yrange [$(($(wc -l < "$runs/edges.dat") + 1)):-1.5]
set arrow from 0, graph 0 to 0, graph 1 nohead linecolor rgb '#000000'
plot '$runs/edges.dat' using 4:1:ytic(2) with points pointtype 6 linecolor rgb '#d55e00' title 'thin rays', \
  '' using 3:1 with points pointtype 7 linecolor rgb '#0072b2' title 'beams'
unset arrow
set title 'Intensity across poles of the VLS-128'
set xlabel 'From the left edge to the right one'
set xrange [0:1]
set yrange [0:2.5]
set ytics auto
set key top left
plot '$runs/across.dat' using ((\$1+0.5)/11):2 with linespoints pointtype 7 linecolor rgb '#000000' title 'real', \
  '' using ((\$1+0.5)/11):3 with linespoints pointtype 7 linecolor rgb '#0072b2' title 'beams'
unset multiplot
GNUPLOT
