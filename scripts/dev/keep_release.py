#!/usr/bin/env python3
"""Keeps what a release writes, so that tests can tell whether later versions still read it.

usage: keep_release.py BUILD

BUILD is that of the release's commit. Writes tests/releases/VERSION/: a scenario and a recipe with all that they
include, small outputs of every kind made of them, and expected.json with the numbers of their points, as
railcast-analyze of the release counts them.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIDAR = {
    "name": "front", "mount": {"position_m": [1, 0, 2.5]}, "range_max_m": 100,
    "scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 30, "vertical_fov_deg": 16,
                                        "angular_resolution_deg": 1.0}},
}
SCENARIO = {
    "version": 1, "fidelity": "surface", "lidar": LIDAR, "materials": "materials.json", "labels": "labels.json",
    "weather": {"rain_rate_mmph": 4},
    "world": {
        "alignment": {"course": {"type": "elements", "elements": [{"type": "straight", "length_m": 600}]}},
        "catenary": {"enabled": False}, "vegetation": {"trees_per_hectare": 0, "grass": False},
        "objects": [{"name": "wagon", "type": "open_wagon", "s_m": 240},
                    {"name": "bob", "type": "person", "s_m": 225, "d_m": 2.0}],
    },
    "vehicle": {"start_s_m": 200, "motion": {"profile": [{"time_s": 0, "speed_mps": 10}]}},
}
RECIPE = {
    "version": 1, "seed": 1, "num_scenarios": 2, "num_frames": 1, "bases": [{"file": "scenario.json"}],
    "draws": {"/weather/rain_rate_mmph": {"type": "uniform", "min": 0, "max": 10}},
}
CAPTURE = {"version": 1, "file": "scenario.json",
           "lidar": {"file": "vlp16.json", "mount": {"position_m": [1, 0, 2.5]}}, "interfaces": {"protocol": "vlp16"}}
FORMATS = ("pcd", "pcd-compressed", "ply", "kitti", "mcap", "rosbag2")


def run(*command, folder=None):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True, cwd=folder).stdout


def keep(build, folder):
    generate, analyze = build / "generator/railcast-generate", build / "analysis/railcast-analyze"
    shutil.copy(ROOT / "scenarios/materials/railway.json", folder / "materials.json")
    shutil.copy(ROOT / "scenarios/labels.json", folder / "labels.json")
    shutil.copy(ROOT / "scenarios/sensors/vlp16.json", folder / "vlp16.json")
    for name, content in (("scenario", SCENARIO), ("recipe", RECIPE), ("capture", CAPTURE)):
        (folder / f"{name}.json").write_text(json.dumps(content, indent=2) + "\n", "utf-8")
    # Relative names, so that the files do not tell of this machine's folders.
    sources = [*FORMATS, "capture.pcap", "dataset"]
    for name in FORMATS:
        run(generate, "sequence", "scenario.json", "--out", name, "--frames", 2, "--format", name, folder=folder)
    run(generate, "stream", "capture.json", "--pcap", "capture.pcap", "--duration", 0.1, folder=folder)
    run(generate, "dataset", "recipe.json", "--out", "dataset", "--format", "pcd-compressed", folder=folder)
    expected = {}
    for name in sources:
        facts = json.loads(run(analyze, "stats", name, "--format", "json", folder=folder))["facts"]
        expected[name] = {"frames": facts["Frames"], "points": facts["Points"]}
    (folder / "expected.json").write_text(json.dumps(expected, indent=2) + "\n", "utf-8")


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    build = pathlib.Path(sys.argv[1]).resolve()
    said = run(build / "generator/railcast-generate", "--version")
    version = re.match(r"railcast (\d+\.\d+\.\d+\S*?)(\+\S+)?$", said.strip())
    if version is None or "dirty" in said:
        sys.exit(f"{build} was not built of a commit: {said}")
    folder = ROOT / "tests/releases" / version[1]
    if folder.exists():
        sys.exit(f"{folder} is there already")
    folder.mkdir(parents=True)
    keep(build, folder)
    print(folder, sum(file.stat().st_size for file in folder.rglob("*") if file.is_file()), "bytes")


if __name__ == "__main__":
    main()
