#!/usr/bin/python3
"""Runs every scenario of scenarios/situations and says what its sensor sees and how fast.

    scripts/measure_situations.py BUILD [--write | --check] [--pictures] [NAME...]

For each object with points in a run, the distance of its first detection is the distance of the
sensor from the object's box in the frame that completes the rule of `railcast-analyze detect`: 5
points in 3 of 5 consecutive frames. --write puts the table into scenarios/README.md, --check fails
where the table there differs from this run, and --pictures draws docs/images/situations/NAME.jpg.
Speeds are means over each run with everything written, on the cores that the program may use.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "scenarios" / "situations"
README = ROOT / "scenarios" / "README.md"
LEAST_POINTS, LEAST_FRAMES, OF_FRAMES = 5, 3, 5

# Frames of each run, the objects whose detection it is about, and the frame of its picture.
SITUATIONS = {
    "standing_wagon": (420, ["wagons/3"], 330),
    "foul_wagon": (300, ["wagons/3"], 240),
    "person_beside": (170, ["worker", "walker"], 110),
    "person_between": (170, ["shunter"], 110),
    "person_crossing": (290, ["walker", "child"], 200),
    "person_lying": (290, ["lying", "sitting", "crouching"], 240),
    "coupling": (60, ["wagons/1", "shunter"], 10),
    "yard_ladder": (270, ["target/2", "shunter"], 130),
    "hump": (650, ["cut/2"], 560),
    "level_crossing": (260, ["lorry", "car", "cyclist"], 150),
    "station_entry": (260, ["at_edge", "pram", "child", "walker"], 160),
    "tunnel_exit": (200, ["workers_cart", "worker"], 120),
    "passing_train": (120, ["express/1"], 72),
    "opposite_train": (150, ["freight/1"], 60),
    "signal_in_fog": (200, [], 130),
    "heavy_snow": (260, ["person", "wagons/2"], 210),
    "wet_rails": (260, ["wagons/2"], 200),
    "fallen_tree": (230, ["tree", "branch"], 170),
    "landslide": (230, ["slide", "boulder"], 170),
    "buffer_stop": (330, ["unit/1"], 250),
    "deer": (200, ["doe", "second_deer", "dog", "cow"], 110),
    "debris": (230, ["drag_shoe", "carton", "pallet", "tyre", "boulder", "branch", "ballast_heap"], 200),
    "hanging_wire": (240, ["wire"], 190),
}


def first_detection(frames, name):
    """The distance at which the rule is completed, or None. Distances are to the box's nearest point."""
    seen = []
    for frame in frames:
        entry = next((o for o in frame["objects"] if o["name"] == name), None)
        seen.append((entry["points"] >= LEAST_POINTS, entry) if entry else (False, None))
        window = seen[-OF_FRAMES:]
        if window[-1][0] and sum(is_seen for is_seen, _ in window) >= LEAST_FRAMES:
            return len(seen) - 1, distance_to(entry["sensor"])
    return None


def distance_to(box):
    """Distance of the origin from a box given by its centre, its size and its quaternion."""
    x, y, z, w = box["quaternion_xyzw"]
    px, py, pz = (-c for c in box["center_m"])
    # The inverse rotation of the vector from the box's centre to the origin.
    qx, qy, qz = -x, -y, -z
    tx, ty, tz = 2 * (qy * pz - qz * py), 2 * (qz * px - qx * pz), 2 * (qx * py - qy * px)
    inside = (px + w * tx + qy * tz - qz * ty,
              py + w * ty + qz * tx - qx * tz,
              pz + w * tz + qx * ty - qy * tx)
    beyond = (max(abs(c) - s / 2, 0.0) for c, s in zip(inside, box["size_m"]))
    return sum(b * b for b in beyond) ** 0.5


def run(build, name, folder):
    """Simulates a situation; returns its frames and the frames per second."""
    num_frames = SITUATIONS[name][0]
    command = [build / "generator/railcast-generate", "sequence", FOLDER / f"{name}.json", "--out",
               folder / name, "--frames", str(num_frames)]
    begin = time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True)
    seconds = time.monotonic() - begin
    if done.returncode != 0:
        sys.exit(f"{name}: {done.stderr.strip()}")
    with open(folder / name / "objects.jsonl", encoding="utf-8") as lines:
        return [json.loads(line) for line in lines], num_frames / seconds


def draw(build, name, folder):
    """Draws the picture of a situation from the driver's place."""
    images = ROOT / "docs/images/situations"
    images.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        png = Path(scratch) / f"{name}.png"
        subprocess.run(["xvfb-run", "--auto-servernum",
                        "--server-args=-noreset -screen 0 1920x1080x24",
                        build / "viewer/railcast-view", folder / name, "--frame",
                        str(SITUATIONS[name][2]), "--camera", "driver", "--color-by", "label",
                        "--size", "960x540", "--screenshot", png],
                       check=True, capture_output=True)
        code = ("import sys, open3d as o3d; "
                "o3d.io.write_image(sys.argv[2], o3d.io.read_image(sys.argv[1]), quality=60)")
        subprocess.run(["/usr/bin/python3", "-c", code, png, images / f"{name}.jpg"], check=True,
                       capture_output=True)


def measured(frames, name):
    """What the table says about a situation's detections."""
    texts = []
    for subject in SITUATIONS[name][1]:
        found = first_detection(frames, subject)
        if found is None:
            texts.append(f"`{subject}` never")
        else:
            frame, distance_m = found
            at_once = ", at once" if frame < OF_FRAMES else ""
            texts.append(f"`{subject}` {distance_m:.0f} m{at_once}")
    return "; ".join(texts) or "–"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--pictures", action="store_true")
    options = parser.parse_args()
    build = options.build.resolve()
    text = README.read_text(encoding="utf-8")
    shown = dict(re.findall(r"^\| \[`(\w+)`\]\([^)]*\) \| [^|]* \| ([^|]*) \|$", text, re.M))
    differs = False
    with tempfile.TemporaryDirectory() as scratch:
        for name in options.names or SITUATIONS:
            frames, rate = run(build, name, Path(scratch))
            cell = measured(frames, name)
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
            subprocess.run(["rm", "-r", Path(scratch) / name], check=True)
    if options.write:
        README.write_text(text, encoding="utf-8")
    sys.exit(1 if differs else 0)


if __name__ == "__main__":
    main()
