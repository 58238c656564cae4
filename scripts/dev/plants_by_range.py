#!/usr/bin/env python3
"""Makes a table and gnuplot data of the landscape's returns with and without plants, from the CSV
files of `railcast-analyze stats`, for scripts/dev/draw_plants.sh.

usage: plants_by_range.py WITH WITHOUT DATA

WITH and WITHOUT are reports of `stats`. Writes the file DATA and prints a Markdown table.
"""

import csv
import math
import pathlib
import sys

BINS_AN_OCTAVE = 4  # Of the densities in stats; analysis/stats/bins.cpp.
LANDSCAPE = ("ground", "grass", "tree")


def read_rows(report, name):
    with open(pathlib.Path(report) / "csv" / f"{name}.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def num_frames(report):
    return int(next(row["mean_samples"] for row in read_rows(report, "frames")
                    if row["figure"] == "points"))


def bin_of(range_m):
    """Index of the bin [2^(i/4), 2^((i+1)/4)) metres that a range lies in."""
    return math.floor(BINS_AN_OCTAVE * math.log2(range_m))


def edge_m(index):
    return 2.0 ** (index / BINS_AN_OCTAVE)


def points_by_bin(report):
    """{label: {bin: points per frame}} of all surfaces, by true range."""
    frames = num_frames(report)
    points = {}
    for row in read_rows(report, "density_by_range"):
        counts = points.setdefault(row["surface"], {})
        index = bin_of(float(row["range_m"]))
        counts[index] = counts.get(index, 0.0) + int(row["per_m2_samples"]) / frames
    return points


def landscape_bins(with_plants, without_plants):
    """Lines (bin, ground, grass, tree, ground without plants), points per frame."""
    kinds = [with_plants.get(name, {}) for name in LANDSCAPE]
    kinds.append(without_plants.get("ground", {}))
    bins = set().union(*kinds)
    if not bins:
        raise SystemExit("error: neither report has points on ground, grass or trees")
    return [(index, *(kind.get(index, 0.0) for kind in kinds))
            for index in range(min(bins), max(bins) + 1)]


def half_octaves(lines):
    """The same lines summed up to half octaves."""
    sums = {}
    for index, *counts in lines:
        half = index - index % 2
        sums[half] = [a + b for a, b in zip(sums.get(half, [0.0] * len(counts)), counts)]
    return [(half, *counts) for half, counts in sorted(sums.items())]


def plants_table(lines):
    table = ["| range | with plants: ground | grass | trees | together | without plants: ground |",
             "|---|---|---|---|---|---|"]
    octaves = half_octaves(lines)
    rows = [(f"{edge_m(half):.0f} to {edge_m(half + 2):.0f} m", counts)
            for half, *counts in octaves[:-1]]
    # The sensor's range ends somewhere in the last one.
    rows.append((f"from {edge_m(octaves[-1][0]):.0f} m", octaves[-1][1:]))
    rows.append(("all", [sum(column) for column in zip(*(line[1:] for line in lines))]))
    for name, (ground, grass, tree, bare) in rows:
        cells = (ground, grass, tree, ground + grass + tree, bare)
        table.append(f"| {name} | " + " | ".join(f"{count:,.0f}" for count in cells) + " |")
    return "\n".join(table)


def data_of(lines):
    text = "# begin_m end_m ground grass tree ground_without_plants, points per frame and bin\n"
    for index, *counts in lines:
        numbers = (edge_m(index), edge_m(index + 1), *counts)
        text += " ".join(f"{number:.3f}" for number in numbers) + "\n"
    return text


def main(arguments):
    if len(arguments) != 3:
        raise SystemExit(__doc__)
    with_plants, without_plants, data = arguments
    lines = landscape_bins(points_by_bin(with_plants), points_by_bin(without_plants))
    pathlib.Path(data).write_text(data_of(lines), encoding="utf-8")
    print(plants_table(lines))


if __name__ == "__main__":
    main(sys.argv[1:])
