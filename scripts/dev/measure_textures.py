#!/usr/bin/python3
"""Studies how far away a person and the objects of the metro trial are detected with and without textures.

    scripts/dev/measure_textures.py BUILD FOLDER [NAME...]

writes the table of docs/results/detection_table.md; of the named rows alone, if any is named ("person", "cubes", "rods",
"plates"). Each cell is of 64 approaches on one sensor, once with effect texture off and once with a texture of 0.22, what
real posts have, on every material. FOLDER keeps the studies: the same command continues after an interruption. No
figure is a time.
"""

import json
import pathlib
import sys

import measure_detection as detection

ROOT, SCENARIOS = detection.ROOT, detection.SCENARIOS
TEXTURE = 0.22
BEGIN, END = "<!-- figures: measure_textures.py -->", "<!-- end of these figures -->"
# Those of the metro trial that are in the way. Some stand side by side in one study, none before another; the vehicle
# comes from so many metres away. What is detected in the first frames is detected farther away than is told.
METRO = {"cubes": (("cube on the rail", "cube at the edge", "cube hanging in the gauge"), 100),
         "rods": (("beam on the rails", "hanging rod"), 150),
         "plates": (("plate in the gauge", "plate just inside the edge"), 220)}


def studies():
    """{name: the scenario, the frames, the things in it if not its own, the recipe's draws}."""
    recipe = detection.section_of(SCENARIOS / "studies/metro_objects_recipe.json")
    options = next(group for group in recipe["groups"] if group["name"] == "object")["options"]
    things = {option["name"]: option["set"]["/world/objects"] for option in options}
    person = SCENARIOS / "brake_person.json"
    found = {"person": (person, 300, None, detection.moved(detection.resolved(person), detection.SHIFT_M))}
    for name, (kinds, from_m) in METRO.items():
        start_m = 380 - from_m  # They stand at 380 m; a frame is 1.6 m.
        found[name] = (SCENARIOS / "insert/metro_run.json", int(from_m / 1.6), sum((things[kind] for kind in kinds), []),
                       {"/vehicle/start_s_m": {"type": "uniform", "min": start_m, "max": start_m + 3.2}})
    return found


def d90_95(build, folder, name, sensor, has_texture):
    """{object: the distance in m, as text}."""
    path, num_frames, things, draws = studies()[name]
    scenario = detection.resolved(path)
    lidar = {"file": str(SCENARIOS / "sensors" / f"{sensor}.json"), "mount": scenario["lidar"]["mount"]}
    materials = json.loads((SCENARIOS / "materials/railway.json").read_text(encoding="utf-8"))
    for material in materials["materials"]:
        material["texture"] = TEXTURE
    over = {"version": 1, "file": str(path), "fidelity": "footprint", "lidar": lidar, "materials": "materials.json",
            "effects": {"texture": has_texture}}
    recipe = {"version": 1, "seed": 5, "num_scenarios": detection.NUM_APPROACHES, "num_frames": num_frames,
              "bases": [{"file": "scenario.json"}], "draws": draws, "set": {"/vehicle/may_overlap": True}}
    if things:
        recipe["set"]["/world/objects"] = things
    study = {"version": 1, "question": f"From where on is the {name} detected?", "recipe": "recipe.json",
             "detection": {"points": 5, "frames": 3, "of_frames": 5},
             "braking": {"reaction_s": 2, "deceleration_mps2": 0.5, "margin_m": 15}}
    place = folder / name.replace(" ", "_") / sensor / ("textured" if has_texture else "even")
    place.mkdir(parents=True, exist_ok=True)
    for file, content in (("scenario", over), ("recipe", recipe), ("study", study), ("materials", materials)):
        (place / f"{file}.json").write_text(json.dumps(content, indent=1), encoding="utf-8")
    rows = detection.studied(build, place / "study.json", place / "out", f"{name}, {sensor}")
    first_m = METRO[name][1] - 8 if name in METRO else float("inf")  # Where the first frames are over.

    def text(d90_95_m):
        if not d90_95_m:
            return "none"
        return f"> {first_m}" if float(d90_95_m) > first_m else f"{float(d90_95_m):.1f}"

    return {row["target"]: text(row["d90_95_m"]) for row in rows}


def rows_of(build, folder, name):
    """{object: its row}"""
    cells = {}
    for sensor in detection.SENSORS:
        even, textured = (d90_95(build, folder, name, sensor, has_texture) for has_texture in (False, True))
        for thing in even:
            cells.setdefault(thing, []).append(f"{even[thing]} / {textured[thing]}")
    return {thing: f"| {thing} | " + " | ".join(of) + " |" for thing, of in cells.items()}


def main():
    build, folder, *names = sys.argv[1:]
    text = detection.PAGE.read_text(encoding="utf-8")
    head, _, rest = text.partition(BEGIN)
    old, _, tail = rest.partition(END)
    rows = {line.split(" | ")[0].removeprefix("| "): line for line in old.strip().splitlines()[2:]}
    for name in names or studies():
        rows |= rows_of(pathlib.Path(build), pathlib.Path(folder), name)
        print("\n".join(rows.values()), flush=True)
    table = ["| object | " + " | ".join(detection.SENSORS.values()) + " |", "|---" * 5 + "|", *rows.values()]
    detection.PAGE.write_text(head + BEGIN + "\n" + "\n".join(table) + "\n" + END + tail, encoding="utf-8")


if __name__ == "__main__":
    main()
