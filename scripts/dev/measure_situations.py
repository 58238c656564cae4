#!/usr/bin/python3
"""Runs every scenario of scenarios/situations and says what its sensor sees and how fast.

    scripts/dev/measure_situations.py BUILD [--write | --check] [--pictures] [NAME...]

Distances of first detection are those of `railcast-analyze detect`: 5 points in 3 of 5 consecutive
frames, with what is left of the distance that the train needs to stop. --write puts the table into
scenarios/README.md, --check fails where the table there differs from this run, and --pictures draws
docs/images/situations/NAME.jpg.
Speeds are means over each run with everything written, on the cores that the program may use.
"""

import argparse
import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "scenarios" / "situations"
README = ROOT / "scenarios" / "README.md"
LEAST_POINTS, LEAST_FRAMES, OF_FRAMES = 5, 3, 5

# Frames of each run, and the objects whose detection it is about.
SITUATIONS = {
    "standing_wagon": (420, ["wagons/3"]),
    "foul_wagon": (300, ["wagons/3"]),
    "person_beside": (170, ["worker", "walker"]),
    "person_between": (170, ["shunter"]),
    "person_crossing": (290, ["walker", "child"]),
    "person_lying": (290, ["lying", "sitting", "crouching"]),
    "coupling": (60, ["wagons/1", "shunter"]),
    "yard_ladder": (270, ["target/2", "shunter"]),
    "hump": (650, ["cut/2"]),
    "level_crossing": (260, ["lorry", "car", "cyclist"]),
    "station_entry": (260, ["at_edge", "pram", "child", "walker"]),
    "tunnel_exit": (200, ["workers_cart", "worker"]),
    "passing_train": (120, ["express/1"]),
    "opposite_train": (150, ["freight/1"]),
    "signal_in_fog": (200, []),
    "heavy_snow": (260, ["person", "wagons/2"]),
    "wet_rails": (260, ["wagons/2"]),
    "fallen_tree": (230, ["tree", "branch"]),
    "landslide": (230, ["slide", "boulder"]),
    "buffer_stop": (330, ["unit/1"]),
    "deer": (200, ["doe", "second_deer", "dog", "cow"]),
    "debris": (230, ["drag_shoe", "carton", "pallet", "tyre", "boulder", "branch", "ballast_heap"]),
    "hanging_wire": (240, ["wire"]),
    "train_spray": (85, ["worker"]),
    "retro_signs": (110, ["worker", "person"]),
    "dirty_window": (260, ["person", "wagons/2"]),
    "two_lidars": (120, ["person", "oncoming/1"]),
    "metre_gauge": (120, ["cow"]),
    "scanned_boulder": (130, ["boulder"]),
}


def rows_of(report, table):
    """The rows of a report's table; a table without rows has no file."""
    file = report / "csv" / f"{table}.csv"
    if not file.exists():
        return []
    with open(file, encoding="utf-8", newline="") as lines:
        return list(csv.DictReader(lines))


def detections(build, folder):
    """{object: what the table says} by `railcast-analyze detect` of one run."""
    run = folder.parent if (folder.parent / "sensors.json").exists() else folder
    report = run.with_name(f"{run.name}_{folder.name}_detect")
    subprocess.run([build / "analysis/railcast-analyze", "detect", folder, "--out", report],
                   check=True, capture_output=True)
    # An object that the first frames show may have been there to be seen from farther away.
    at_once = {row["object"] for row in rows_of(report, "beside_the_track")
               if row["detected"] != "0" and not row["least_detected_at_m"]}
    at_once |= {row["object"] for row in rows_of(report, "verdicts")
                if row["begun_too_near"] not in ("", "0")}
    texts = {}
    for row in rows_of(report, "runs"):
        name = row["object"]
        if not row["detected_at_m"]:
            texts[name] = "never"
            continue
        texts[name] = f"{float(row['detected_at_m']):.0f} m"
        if name in at_once:
            texts[name] += ", at once"
        elif row["spare_m"]:
            spare_m = float(row["spare_m"])
            texts[name] += f" ({spare_m:.0f} m to spare)" if spare_m >= 0 else \
                f" ({-spare_m:.0f} m too late)"
    shutil.rmtree(report)
    return texts


def label_counts(folder):
    """[(file, {label: points})] of a run's frames."""
    with open(folder / "frames.jsonl", encoding="utf-8") as lines:
        return [(frame["files"][0]["name"], frame["points_per_label"])
                for frame in map(json.loads, lines)]


def signals_detected(folder):
    """What the table says of signals, which are structures: the same rule for points of their label."""
    counts = label_counts(folder)
    seen = [labels.get("signal", 0) >= LEAST_POINTS for _, labels in counts]
    for i, (file, _) in enumerate(counts):
        if seen[i] and sum(seen[max(0, i - OF_FRAMES + 1):i + 1]) >= LEAST_FRAMES:
            code = ("import json, sys, numpy as np, open3d as o3d\n"
                    "cloud = o3d.t.io.read_point_cloud(sys.argv[1])\n"
                    "is_signal = cloud.point['label'].numpy().ravel() == int(sys.argv[2])\n"
                    "print(np.nanmin(cloud.point['true_range_m'].numpy().ravel()[is_signal]))")
            labels = json.loads((folder / "labels.json").read_text(encoding="utf-8"))["labels"]
            signal = next(label["id"] for label in labels if label["name"] == "signal")
            done = subprocess.run(["/usr/bin/python3", "-c", code, folder / file, str(signal)],
                                  check=True, capture_output=True, text=True)
            return f"{float(done.stdout):.0f} m" + (", at once" if i < OF_FRAMES else "")
    return "never"


def run(build, name, folder):
    """Simulates a situation and returns the frames per second."""
    num_frames = SITUATIONS[name][0]
    command = [build / "generator/railcast-generate", "sequence", FOLDER / f"{name}.json", "--out",
               folder / name, "--frames", str(num_frames)]
    begin = time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True)
    seconds = time.monotonic() - begin
    if done.returncode != 0:
        sys.exit(f"{name}: {done.stderr.strip()}")
    return num_frames / seconds


def first_sequence(run):
    """The sequence of a run's first sensor: the run's own folder if that is the only one."""
    sensors = run / "sensors.json"
    if not sensors.exists():
        return run
    return run / json.loads(sensors.read_text(encoding="utf-8"))["sensors"][0]["name"]


def telling_frame(name, sequence):
    """The first frame that shows half as many points on the situation's objects as any."""
    with open(sequence / "objects.jsonl", encoding="utf-8") as lines:
        points = [sum(o["points"] for o in json.loads(line)["objects"]
                      if o["name"] in SITUATIONS[name][1]) for line in lines]
    if name == "signal_in_fog":
        points = [labels.get("signal", 0) for _, labels in label_counts(sequence)]
    return next(i for i, count in enumerate(points) if 2 * count >= max(points))


def draw(build, name, folder):
    """Draws the picture of a situation from the driver's place."""
    images = ROOT / "docs/images/situations"
    images.mkdir(exist_ok=True)
    sequence = first_sequence(folder / name)
    with tempfile.TemporaryDirectory() as scratch:
        png = Path(scratch) / f"{name}.png"
        # In the runs' folder, so that no picture shows a temporary path.
        subprocess.run(["xvfb-run", "--auto-servernum",
                        "--server-args=-noreset -screen 0 1920x1080x24",
                        build / "viewer/railcast-view", sequence.relative_to(folder), "--frame",
                        str(telling_frame(name, sequence)), "--camera", "driver", "--color-by",
                        "label", "--point-size", "3", "--size", "960x540", "--screenshot", png],
                       check=True, capture_output=True, cwd=folder)
        code = ("import sys, open3d as o3d; "
                "o3d.io.write_image(sys.argv[2], o3d.io.read_image(sys.argv[1]), quality=60)")
        subprocess.run(["/usr/bin/python3", "-c", code, png, images / f"{name}.jpg"], check=True,
                       capture_output=True)


def measured(build, name, folder):
    """What the table says about a situation's detections."""
    found = detections(build, folder)
    texts = [f"`{subject}` {found.get(subject, 'never')}" for subject in SITUATIONS[name][1]]
    if name == "signal_in_fog":
        texts.append(f"signal {signals_detected(folder)}")
    return "; ".join(texts)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--pictures", action="store_true")
    options = parser.parse_intermixed_args()
    build = options.build.resolve()
    text = README.read_text(encoding="utf-8")
    shown = dict(re.findall(r"^\| \[`(\w+)`\]\([^)]*\) \| [^|]* \| ([^|]*) \|$", text, re.M))
    differs = False
    with tempfile.TemporaryDirectory() as scratch:
        for name in options.names or SITUATIONS:
            rate = run(build, name, Path(scratch))
            folder = Path(scratch) / name
            cell = measured(build, name, next((f.parent for f in sorted(folder.glob("*/frames.jsonl"))), folder))
            print(f"{name}: {rate:.1f} frames/s with {len(os.sched_getaffinity(0))} cores; {cell}",
                  flush=True)
            if options.check and shown.get(name) != cell:
                print(f"{name}: scenarios/README.md says {shown.get(name)}", file=sys.stderr)
                differs = True
            if options.write:
                text = re.sub(rf"^(\| \[`{name}`\]\([^)]*\) \| [^|]* \| )[^|]*( \|)$",
                              lambda row: row.group(1) + cell + row.group(2), text, flags=re.M)
            if options.pictures:
                draw(build, name, Path(scratch))
            shutil.rmtree(Path(scratch) / name)
    if options.write:
        README.write_text(text, encoding="utf-8")
    sys.exit(1 if differs else 0)


if __name__ == "__main__":
    main()
