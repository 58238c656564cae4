#!/usr/bin/env python3
"""Charts what the size of surfels costs and gains, for docs/results/surveys.md.

    scripts/dev/draw_survey_sizes.py BUILD PICTURE

Accuracy is that of tests/generator/generator_tests, which makes the scenes; cost are the instructions a
firing of `Simulator::Scan` on them, counted by callgrind, relative to the same frame of
scenarios/station.json as it is built. Both are the same on a busy machine. Prints the table, too.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from effects_table import instructions

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"
FRAME = "3"


def made_sizes(build, folder):
    """[(cube and size, surfels, hit %, median error on ground in cm, within 0.3 m %)], with scenes in the folder."""
    run = subprocess.run([build.resolve() / "tests/generator/generator_tests", "--gtest_filter=SurfelSize.*"],
                         env=os.environ | {"RAILCAST_SURVEY_SIZES": str(folder)},
                         check=True, capture_output=True, text=True)
    rows = [line.split("\t") for line in run.stdout.splitlines() if "\t" in line]
    return [(name, int(surfels), float(hit), float(error), float(near))
            for name, surfels, hit, error, near in rows]


def with_survey(scene):
    """The station's line with a survey in place of what stands there."""
    scenario = station()
    world = scenario["world"] | {"survey": str(scene)}
    del world["structures"], world["objects"]
    return scenario | {"world": world}


def station():
    """The scenario with files by their whole paths, without things, on the rung of the proof."""
    scenario = json.loads((SCENARIOS / "station.json").read_text())
    scenario["fidelity"] = "geometry"
    scenario["lidar"]["file"] = str(SCENARIOS / scenario["lidar"]["file"])
    for key in ("materials", "labels"):
        scenario[key] = str(SCENARIOS / scenario[key])
    scenario["world"] = {key: value for key, value in scenario["world"].items() if key != "objects"}
    del scenario["$schema"]
    return scenario


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    build = Path(sys.argv[1])
    curves = {}
    with tempfile.TemporaryDirectory() as folder:
        built = instructions(build, station(), FRAME)
        print("| cubes, size | surfels | hit % | within 0.3 m % | median error on ground cm | instructions / those without a survey |")
        print("|---|---|---|---|---|---|")
        for name, surfels, hit, error, near in made_sizes(build, Path(folder)):
            cost = instructions(build, with_survey(Path(folder) / f"{name}.survey"), FRAME) / built
            voxel, size = name.split("_")
            print(f"| {voxel} m, {size} | {surfels:,} | {hit:.1f} | {near:.1f} | {error:.1f} | {cost:.2f} |", flush=True)
            curves.setdefault(voxel, []).append((float(size), cost, error, 100 - near))
    script = [f'set terminal pngcairo size 900,420 font "sans,10"; set output "{sys.argv[2]}"',
              "set multiplot layout 1,2; set key outside bottom center horizontal; set grid",
              "set xlabel 'instructions a firing / those without a survey'"]
    for voxel, rows in curves.items():
        lines = "\n".join(" ".join(map(str, row)) for row in sorted(rows))
        script.append(f"$cubes{voxel.replace('.', '')} << E\n{lines}\nE")
    for column, what in ((3, "median error on ground in cm"), (4, "beams not within 0.3 m in %")):
        plots = ", ".join(f"$cubes{voxel.replace('.', '')} using 2:{column} with linespoints title 'cubes of {voxel} m'"
                          for voxel in curves)
        script.append(f"set ylabel '{what}'; plot {plots}")
    subprocess.run(["gnuplot"], input="\n".join(script), text=True, check=True)


if __name__ == "__main__":
    main()
