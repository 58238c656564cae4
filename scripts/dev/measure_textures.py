#!/usr/bin/python3
"""Studies how far away a person and a cube of the metro trial are detected with and without textures.

    scripts/dev/measure_textures.py BUILD FOLDER

writes the table of docs/results/detection_table.md. Each cell is a study of 64 approaches on one sensor, once with
effect texture off and once with a texture of 0.22, what real posts have, on every material. FOLDER keeps the studies:
the same command continues after an interruption. No figure is a time. About an hour on two cores.
"""

import json
import pathlib
import sys

import measure_detection as detection

ROOT, SCENARIOS = detection.ROOT, detection.SCENARIOS
TEXTURE = 0.22
BEGIN, END = "<!-- figures: measure_textures.py -->", "<!-- end of these figures -->"
METRO = ("cube on the rail",)  # One of them: each takes a quarter of an hour.


def objects():
    """{name: what it is added to: the scenario, the frames, the recipe's draws and the study's gauge}."""
    recipe = detection.section_of(SCENARIOS / "studies/metro_objects_recipe.json")
    options = next(group for group in recipe["groups"] if group["name"] == "object")["options"]
    things = {option["name"]: option["set"]["/world/objects"] for option in options if option["name"] in METRO}
    person = SCENARIOS / "brake_person.json"
    found = {"person": (person, 300, None, detection.moved(detection.resolved(person), detection.SHIFT_M))}
    for name, thing in things.items():
        found[name] = (SCENARIOS / "insert/metro_run.json", 136, thing, {"/vehicle/start_s_m": recipe["start_s_m"]})
    return found


def d90_95(build, folder, name, sensor, has_texture):
    """The distance, m; None where too many approaches detect nothing."""
    path, num_frames, things, draws = objects()[name]
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
    row = detection.studied(build, place / "study.json", place / "out", f"{name}, {sensor}")[0]
    return float(row["d90_95_m"]) if row["d90_95_m"] else None


def main():
    build, folder = map(pathlib.Path, sys.argv[1:])
    rows = []
    for name in objects():
        cells = []
        for sensor in detection.SENSORS:
            both = [d90_95(build, folder, name, sensor, has_texture) for has_texture in (False, True)]
            cells.append(" / ".join("none" if each is None else f"{each:.1f}" for each in both))
        rows.append(f"| {name} | " + " | ".join(cells) + " |")
        print(rows[-1], flush=True)
    table = ["| object | " + " | ".join(detection.SENSORS.values()) + " |", "|---" * 5 + "|", *rows]
    text = detection.PAGE.read_text(encoding="utf-8")
    head, _, rest = text.partition(BEGIN)
    detection.PAGE.write_text(head + BEGIN + "\n" + "\n".join(table) + "\n" + END + rest.partition(END)[2],
                              encoding="utf-8")


if __name__ == "__main__":
    main()
