#!/usr/bin/python3
"""Studies the brake scenarios and all situations on four sensors, and writes docs/results/detection_table.md.

    scripts/dev/measure_detection.py BUILD FOLDER [--check] [NAME...]

Each is a study of 64 approaches with the rung footprint, in the situation's own weather; the brake scenarios in clear
air, heavy rain and thick fog. Where fewer than 60 of them come to an object, the page says so instead of a distance. What stands in the way is moved by up to 2.5 m along the track, so that scan lines fall
elsewhere on it each time. FOLDER keeps the studies: the same command continues after an interruption. --check fails
where a study's figures differ from detection_table.csv; without it, rows of the named studies are replaced there.
No figure is a time, so that the machine may be busy. All take some hours on two cores.
"""

import argparse
import csv
import json
import pathlib
import subprocess
import sys

from effects_table import section_of
from measure_situations import SITUATIONS

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = ROOT / "scenarios"
PAGE = ROOT / "docs" / "results" / "detection_table.md"
FIGURES = ROOT / "docs" / "results" / "detection_table.csv"
SENSORS = {"vir2rail": "raster", "pandar64": "Pandar64", "vls128": "VLS-128", "rosette": "rosette"}
NUM_APPROACHES = 64
SHIFT_M = (-2.5, 2.5)
# Of trains that reach into the gauge on a part of their way only.
OWN_SHIFTS_M = {"foul_wagon": (-5, -2.5)}
KEYS = ("study", "sensor", "object", "approaches", "detected", "answer", "most_needed_m", "least_detected_at_m",
        "d90_95_m", "curve_d90_m", "curve_d90_95_m")
TOO_FEW = "too few approaches"
NOTHING_IN_WAY = "no approach comes to an object in the way"
BEGIN, END = "<!-- figures: measure_detection.py -->", "<!-- end of the figures -->"


def resolved(path):
    """A scenario's file on top of what it builds on, section by section."""
    scenario = section_of(path)
    below = scenario.pop("file", None)
    return (resolved(path.parent / below) if below else {}) | scenario


def studies():
    """{name: (scenario, frames, objects asked about or None for all in the way, what is laid over it)}."""
    brakes = {f"brake_{what}_{weather}": (SCENARIOS / f"brake_{what}.json", 300, None, overlay)
              for what in ("person", "wagon")
              for weather, overlay in [("clear", {}), ("rain", {"file": str(SCENARIOS / "weather/heavy_rain.json")}),
                                       ("fog", {"file": str(SCENARIOS / "weather/thick_fog.json")})]}
    situations = {name: (SCENARIOS / "situations" / f"{name}.json", frames, objects, None)
                  for name, (frames, objects) in SITUATIONS.items() if objects}
    return brakes | situations


def moved(scenario, shift_m):
    """Draws that move what stands on the line along it."""
    world = scenario["world"]
    places = [(f"/world/objects/{i}/s_m", each) for i, each in enumerate(world.get("objects", []))]
    places += [(f"/world/trains/{i}/s_m", each) for i, each in enumerate(world.get("trains", []))]
    return {pointer: {"type": "uniform", "min": each["s_m"] + shift_m[0], "max": each["s_m"] + shift_m[1]}
            for pointer, each in places if "s_m" in each and "motion" not in each and "shape" not in each}


def write_study(name, sensor, folder):
    """The study of a scenario with one sensor where the scenario's first one sits."""
    path, num_frames, objects, weather = studies()[name]
    scenario = resolved(path)
    own = scenario["lidars"][0] if "lidars" in scenario else scenario.get("lidar", {})
    lidar = {"file": str(SCENARIOS / "sensors" / f"{sensor}.json")}
    lidar |= {key: own[key] for key in ("mount", "cover") if key in own}
    over = {"version": 1, "file": str(path), "fidelity": "footprint", "lidar": lidar}
    if "lidars" in scenario:
        over["lidars"] = [over.pop("lidar") | {"name": sensor}]
    if weather is not None:
        over["weather"] = weather
    recipe = {"version": 1, "seed": 5, "num_scenarios": NUM_APPROACHES, "num_frames": num_frames,
              "bases": [{"file": "scenario.json"}], "draws": moved(scenario, OWN_SHIFTS_M.get(name, SHIFT_M)),
              # A vehicle that couples to wagons meets them where they stand nearer.
              "set": {"/vehicle/may_overlap": True}}
    study = {"version": 1, "question": f"From where on is what stands in the way of {name} detected?",
             "recipe": "recipe.json", "detection": {"points": 5, "frames": 3, "of_frames": 5},
             "braking": {"reaction_s": 2, "deceleration_mps2": 0.5, "margin_m": 15}}
    if objects:
        study["objects"] = objects
    folder.mkdir(parents=True, exist_ok=True)
    for file, content in (("scenario", over), ("recipe", recipe), ("study", study)):
        (folder / f"{file}.json").write_text(json.dumps(content, indent=1), encoding="utf-8")


def studied(build, study, out, what):
    """The verdicts of a study, one for each object in the way."""
    done = subprocess.run([build / "analysis/railcast-analyze", "study", study, "--out", out],
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if NOTHING_IN_WAY in done.stderr:
        return []
    if done.returncode != 0:
        sys.exit(f"{what}: {done.stderr.strip()}")
    with open(out / "csv" / "verdicts.csv", encoding="utf-8", newline="") as lines:
        return list(csv.DictReader(lines))


def rows_of(build, name, sensor, folder):
    """The rows of one study, one for each object in the way."""
    inputs = folder / "inputs" / name / sensor
    write_study(name, sensor, inputs)
    verdicts = studied(build, inputs / "study.json", folder / "studies" / name / sensor, f"{name}, {sensor}")

    def metres(text):
        return f"{float(text):.1f}" if text else ""

    return [dict(zip(KEYS, (name, sensor, row["target"], row["approaches"], row["detected"], row["answer"],
                            metres(row["most_needed_m"]), metres(row["least_detected_at_m"]), metres(row["d90_95_m"]),
                            metres(row["curve_d90_m"]), metres(row["curve_d90_95_m"])))) for row in verdicts]


def kept():
    """The rows of the shipped figures."""
    if not FIGURES.exists():
        return []
    with open(FIGURES, encoding="utf-8", newline="") as lines:
        return list(csv.DictReader(lines))


def cell(row):
    """What the page says of an object on a sensor."""
    if row is None:
        return ""
    if row["answer"].startswith(TOO_FEW):
        return TOO_FEW
    text = f"{float(row['d90_95_m']):.0f}" if row["d90_95_m"] else "none"
    return f"**{text}**" if row["answer"] == "yes" else text + (" (no)" if row["answer"] == "no" else "")


def page(rows):
    """The page's table: a row for each object, a column for each sensor."""
    lines = ["| scenario | object | needed, at most, m | " + " | ".join(SENSORS.values()) + " |",
             "|---|---|---|" + "---|" * len(SENSORS)]
    by_place = {(row["study"], row["object"], row["sensor"]): row for row in rows}
    for study, thing in dict.fromkeys((row["study"], row["object"]) for row in rows):
        of = [by_place.get((study, thing, sensor)) for sensor in SENSORS]
        needed_m = max(float(row["most_needed_m"]) for row in of if row)
        lines.append(f"| `{study}` | {thing} | {needed_m:.0f} | " + " | ".join(map(cell, of)) + " |")
    return "\n".join(lines) + "\n"


def write(rows):
    with open(FIGURES, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, KEYS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    text = PAGE.read_text(encoding="utf-8")
    head, _, rest = text.partition(BEGIN)
    PAGE.write_text(head + BEGIN + "\n" + page(rows) + END + rest.partition(END)[2], encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_intermixed_args()
    shown = kept()
    rows = {name: [row for row in shown if row["study"] == name] for name in studies()}
    differs = False
    for name in options.names or studies():
        measured = []
        for sensor in SENSORS:
            measured += rows_of(options.build, name, sensor, options.folder)
            print(name, sensor, *measured[-1:], flush=True)
        if options.check and measured != rows[name]:
            print(f"{name}: {FIGURES} says otherwise", file=sys.stderr)
            differs = True
        rows[name] = measured
        if not options.check:
            write([row for of_study in rows.values() for row in of_study])
    sys.exit(1 if differs else 0)


if __name__ == "__main__":
    main()
