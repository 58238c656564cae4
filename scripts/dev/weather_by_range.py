#!/usr/bin/env python3
"""Makes gnuplot data of dropout, density and noise against range in several weathers, from the CSV
files of `railcast-analyze stats`, for scripts/dev/draw_weather.sh.

usage: weather_by_range.py FOLDER

FOLDER/RUNG_WEATHER_stats are the reports. Writes FOLDER/dropout.dat, density.dat and noise.dat, each
with a block per rung and weather, and prints a Markdown table.
"""

import csv
import json
import pathlib
import sys

RUNGS = ("plausibility", "surface")
WEATHERS = ("clear", "fog", "rain", "snow")
BANDS = ("10 to 15", "50 to 60", "100 to 125")  # Of range in metres, in the table.
LEAST_SAMPLES = 30  # Of a point in the charts: fewer say nothing beside the others.


def read_rows(report, name):
    with open(pathlib.Path(report) / "csv" / f"{name}.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def middle_m(band):
    """Middle of a band of range like "10 to 15"."""
    low, high = band.split(" to ")
    return 0.5 * (float(low) + float(high))


def curve_of(rows, range_of, figure):
    """[(range, value, low, high)] of the rows with enough samples."""
    return [(range_of(row), *(float(row[figure + end]) for end in ("", "_low", "_high")))
            for row in rows
            if row[figure] and int(row[f"{figure}_samples"]) >= LEAST_SAMPLES]


def dropout_curve(report):
    return curve_of(read_rows(report, "dropout_by_range"),
                    lambda row: middle_m(row["true_range_m"]), "dropout_percent")


def density_curve(report):
    ground = [row for row in read_rows(report, "density_by_range") if row["surface"] == "ground"]
    return curve_of(ground, lambda row: float(row["range_m"]), "per_m2")


def noise_curve(report):
    return curve_of(read_rows(report, "noise_from_truth"),
                    lambda row: middle_m(row["range_m"]), "sigma_mm")


CURVES = {"dropout": dropout_curve, "density": density_curve, "noise": noise_curve}


def blocks_of(curves):
    """gnuplot's data blocks; an empty one keeps its place."""
    blocks = ["".join(" ".join(f"{number:.6g}" for number in point) + "\n" for point in curve)
              for curve in curves]
    return "\n\n".join(block or "NaN NaN NaN NaN\n" for block in blocks)


def shown(rows, band, name, figure, scale, unit):
    """A figure of the row whose column `name` is `band`; "-" if the report has too few samples."""
    values = [row[figure] for row in rows if row[name] == band]
    return f"{scale * float(values[0]):.1f} {unit}" if values and values[0] else "-"


def points_a_frame(report):
    """From the counts: the report gives no mean of a few frames."""
    facts = json.loads((pathlib.Path(report) / "stats.json").read_text(encoding="utf-8"))["facts"]
    return int(facts["Points"]) / int(facts["Frames"])


def table_line(rung, weather, report):
    outcomes = read_rows(report, "outcomes")
    num_clutter = sum(int(row["firings"]) for row in outcomes if row["outcome"] == "clutter")
    clutter = num_clutter / sum(int(row["firings"]) for row in outcomes)
    dropout = read_rows(report, "dropout_by_range")
    noise = read_rows(report, "noise_from_truth")
    cells = [f"`{rung}`", weather, f"{points_a_frame(report):,.0f}", f"{100.0 * clutter:.1f} %"]
    cells += [shown(dropout, band, "true_range_m", "dropout_percent", 1.0, "%") for band in BANDS]
    cells += [shown(noise, band, "range_m", "sigma_mm", 1.0, "mm") for band in BANDS]
    return "| " + " | ".join(cells) + " |"


def main(arguments):
    if len(arguments) != 1:
        raise SystemExit(__doc__)
    folder = pathlib.Path(arguments[0])
    runs = [(rung, weather, folder / f"{rung}_{weather}_stats")
            for rung in RUNGS for weather in WEATHERS]
    for name, curve in CURVES.items():
        text = blocks_of(curve(report) for _, _, report in runs)
        (folder / f"{name}.dat").write_text(text, encoding="utf-8")
    columns = ["rung", "weather", "points a frame", "clutter"]
    columns += [f"{name} at {band} m" for name in ("dropout", "noise") for band in BANDS]
    print(f"| {' | '.join(columns)} |\n|{'---|' * len(columns)}")
    for run in runs:
        print(table_line(*run))


if __name__ == "__main__":
    main(sys.argv[1:])
