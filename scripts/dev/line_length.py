#!/usr/bin/env python3
"""Shows that memory and frame time do not grow with the length of the line.

Runs `railcast-generate sequence` on the same stretch of a 30 km and of a 300 km line in turn, and
prints peak memory and time per frame of both, with their ratios.

With --hills, the line has the terrain and the plants of scenarios/hills.json.

  scripts/dev/line_length.py [--generate build/release/generator/railcast-generate] [--runs 5] [--hills]
"""

import argparse
import json
import os
import pathlib
import re
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def scenario(length_km, is_hilly):
    """Alternating left and right curves over the given length, a kilometre per pair."""
    pair = []
    for radius_m in (600, -600):
        pair += [
            {"type": "straight", "length_m": 200},
            {"type": "clothoid", "length_m": 80},
            {"type": "arc", "length_m": 140, "radius_m": radius_m},
            {"type": "clothoid", "length_m": 80},
        ]
    scenarios = ROOT / "scenarios"
    hills = json.loads((scenarios / "hills.json").read_text())["world"] if is_hilly else {}
    land = {key: hills[key] for key in ("terrain", "vegetation") if key in hills}
    return {
        "version": 1,
        "lidar": str(scenarios / "sensors/vir2rail.json"),
        "materials": str(scenarios / "materials/railway.json"),
        "labels": str(scenarios / "labels.json"),
        "world": land
        | {
            "alignment": {
                "course": {"type": "elements", "elements": pair * length_km},
                "speed_limits_kmph": [{"s_m": 0, "value": 90}],
            }
        },
        "vehicle": {
            "start_s_m": 15000,
            "motion": {"profile": [{"time_s": 0, "speed_mps": 25}]},
        },
    }


def run(generate, file, frames):
    """Peak memory in MB and time per frame in ms of one run."""
    with tempfile.TemporaryDirectory(dir="/dev/shm") as out:
        command = [generate, "sequence", file, "--out", out + "/run", "--frames", str(frames)]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        said = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            raise SystemExit(f"{' '.join(command)}: exit status {process.returncode}")
    seconds = float(re.search(r"made \d+ frames in ([0-9.]+) s", said).group(1))
    return usage.ru_maxrss / 1024, 1e3 * seconds / frames


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--generate", default=ROOT / "build/release/generator/railcast-generate")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--frames", type=int, default=200)
    parser.add_argument("--hills", action="store_true")
    arguments = parser.parse_args()
    results = {30: [], 300: []}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(arguments.runs):
            for length_km, figures in results.items():
                file = pathlib.Path(folder) / f"line_{length_km}_km.json"
                file.write_text(json.dumps(scenario(length_km, arguments.hills)))
                figures.append(run(arguments.generate, file, arguments.frames))
    medians = {
        length_km: [statistics.median(column) for column in zip(*figures)]
        for length_km, figures in results.items()
    }
    for length_km, (memory_mb, frame_ms) in medians.items():
        print(f"{length_km:4d} km  peak memory {memory_mb:7.1f} MB  {frame_ms:6.2f} ms a frame")
    memory, time = (medians[300][i] / medians[30][i] for i in (0, 1))
    print(f"ratio    peak memory {memory:7.3f}     {time:6.3f}")


if __name__ == "__main__":
    main()
