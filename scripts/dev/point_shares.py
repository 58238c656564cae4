#!/usr/bin/env python3
"""Compares the shares of points by class on an open line, in a station and in a yard with those of
real railway clouds, as docs/results/accuracy.md has them; prints the table.

usage: point_shares.py BUILD_DIR

Each scene is scanned by a Pandar64 on the roof, as README mounts it, and by Vir2Rail's raster, at
nine places on the way. Classes are those of WHU-Railway3D, to which labels.json maps ours.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

SCENARIOS = pathlib.Path(__file__).resolve().parents[2] / "scenarios"
SCENES = {"open line": SCENARIOS / "open_line.json",
          "station": SCENARIOS / "osm_sankt_poelten" / "station_throat.json",
          "yard": SCENARIOS / "yard.json"}
SENSORS = {"Pandar64": ("pandar64.json", {"position_m": [2.0, 0, 4.6], "pitch_deg": 3}),
           "Vir2Rail": ("vir2rail.json", {"position_m": [2.2, 0, 2.5]})}
BEGINS = range(0, 270, 30)  # Frames; the yard's vehicle stands after some 300.
CLASSES = ("Rails", "Track bed", "Masts", "Support devices", "Overhead lines", "Fences", "Poles",
           "Vegetation", "Buildings", "Ground", "Others")
# Millions of points, read from the log chart of WHU-Railway3D (IEEE TITS 2024) to 20 %.
URBAN = dict(zip(CLASSES, (23, 60, 2, 0.45, 2.2, 17, 1.5, 160, 18, 220, 30)))


def class_of_labels():
    table = json.loads((SCENARIOS / "labels.json").read_text(encoding="utf-8"))
    return {label["name"]: label["whu_railway3d"] for label in table["labels"]}


def measure(build, folder, scenario, sensor):
    """{class: points a frame} and the share of firings that meet the own vehicle."""
    file, mount = SENSORS[sensor]
    variant = folder / "scenario.json"
    variant.write_text(json.dumps({
        "version": 1, "file": str(scenario),
        "lidar": {"file": str(SCENARIOS / "sensors" / file), "mount": mount}}), encoding="utf-8")
    classes = class_of_labels()
    points = dict.fromkeys(CLASSES, 0.0)
    own = 0.0
    for begin in BEGINS:
        out = folder / f"frame_{begin}"
        subprocess.run([build / "generator" / "railcast-generate", "sequence", variant, "--out",
                        out, "--format", "kitti", "--start-frame", str(begin), "--frames", "1"],
                       check=True, stdout=subprocess.DEVNULL)
        frame = json.loads((out / "frames.jsonl").read_text(encoding="utf-8"))
        for label, count in frame["points_per_label"].items():
            points[classes[label]] += count / len(BEGINS)
        own += frame["outcomes"]["ego"] / sum(frame["outcomes"].values()) / len(BEGINS)
    return points, own


def cell(share):
    return "–" if share == 0.0 else f"{100.0 * share:.1f}" if share >= 1e-3 else "< 0.1"


def main(arguments):
    if len(arguments) != 1:
        raise SystemExit(__doc__)
    build = pathlib.Path(arguments[0])
    columns = {}
    footer = {}
    for sensor in SENSORS:
        for scene, scenario in SCENES.items():
            with tempfile.TemporaryDirectory() as folder:
                points, own = measure(build, pathlib.Path(folder), scenario, sensor)
            total = sum(points.values())
            name = f"{scene}, {sensor}"
            columns[name] = {key: value / total for key, value in points.items()}
            footer[name] = (total, own)
    columns["WHU-Urban"] = {key: value / sum(URBAN.values()) for key, value in URBAN.items()}
    print(f"| share of points, % | {' | '.join(columns)} |")
    print("|---" * (len(columns) + 1) + "|")
    for key in CLASSES:
        print(f"| {key} | {' | '.join(cell(shares[key]) for shares in columns.values())} |")
    print(f"| points a frame | {' | '.join(f'{total:,.0f}' for total, _ in footer.values())} | |")
    print(f"| firings that meet the own vehicle, % | "
          f"{' | '.join(cell(own) for _, own in footer.values())} | |")


if __name__ == "__main__":
    main(sys.argv[1:])
