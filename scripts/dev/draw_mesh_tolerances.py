#!/usr/bin/env python3
"""Charts what simplifying five meshes of the shared data set gains, and two of them made as dense as
a scan, for docs/results/detail.md.

    scripts/dev/draw_mesh_tolerances.py BUILD PICTURE

BUILD has the benchmark tests/bench/railcast-measure. Prints its lines, too.
"""

import subprocess
import sys
from pathlib import Path

DATA = Path(__file__).resolve().parents[3] / "shared/data"
# File, and the options that give its unit and upward axis.
MESHES = {
    "mannequinMale": ("meshes_sweethome3d/Scopia/mannequinMale.obj", ["--up", "y", "--unit", "0.01"]),
    "deer": ("meshes_sweethome3d/BlendSwap-CC-0/deer.obj", ["--up", "y", "--unit", "0.14"]),
    "ICE4": ("meshes_rail_libretrainsim/ICE4.obj", ["--up", "y"]),
    "JFR1_Wagon_1": ("meshes_rail_libretrainsim/JFR1_Wagon_1.obj", ["--up", "y"]),
    "fire_truck": ("meshes_gazebo/fire_truck__fire_truck.obj", ["--unit", "0.0254"]),
    "fire_truck, dense": ("meshes_gazebo/fire_truck__fire_truck.obj",
                          ["--unit", "0.0254", "--subdivide", "2"]),
    "mannequinMale, dense": ("meshes_sweethome3d/Scopia/mannequinMale.obj",
                             ["--up", "y", "--unit", "0.01", "--subdivide", "2", "--noise", "0.1"]),
}


def measure(build, name):
    """[(tolerance in mm, share of triangles, time of a ray relative to the mesh as it is)]."""
    file, options = MESHES[name]
    done = subprocess.run([build / "tests/bench/railcast-measure", "meshes", DATA / file, *options,
                           "--tolerances", "0,2.5,5,10,20"],
                          check=True, capture_output=True, text=True)
    print(done.stdout, end="", flush=True)
    rows = [line.split("\t")[1:] for line in done.stdout.splitlines()]
    whole = rows[0]
    return [(float(r[0]), float(r[1]) / float(whole[1]), float(r[6]) / float(whole[6]))
            for r in rows]


def block_of(name):
    """The name of gnuplot's data block."""
    return "$" + "".join(letter for letter in name if letter.isalnum())


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    script = [f'set terminal pngcairo size 900,420 font "sans,10"; set output "{sys.argv[2]}"',
              "set multiplot layout 1,2; set key outside bottom center horizontal; set xlabel 'tolerance in mm'",
              "set xrange [0:20]; set yrange [0:1.3]; set grid"]
    for name in MESHES:
        rows = measure(Path(sys.argv[1]), name)
        lines = "\n".join(" ".join(map(str, row)) for row in rows)
        script.append(f"{block_of(name)} << E\n{lines}\nE")
    for column, what in ((2, "triangles / those of the mesh as it is"),
                         (3, "time of a ray / that on the mesh as it is")):
        curves = ", ".join(f'{block_of(name)} using 1:{column} with linespoints title "{name}" noenhanced'
                           for name in MESHES)
        script.append(f"set ylabel '{what}'; plot {curves}")
    subprocess.run(["gnuplot"], input="\n".join(script), text=True, check=True)


if __name__ == "__main__":
    main()
