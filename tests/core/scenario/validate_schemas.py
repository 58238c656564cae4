"""Validates the published schemas, the shipped files by them, and that faults do not pass."""

import json
import pathlib
import sys

try:
    from jsonschema import Draft202012Validator
except ImportError:
    print("skipped: Debian's python3-jsonschema is not installed")
    sys.exit(77)

scenarios = pathlib.Path(sys.argv[1])
validators = {}
for file in sorted((scenarios / "schema").glob("*.schema.json")):
    schema = json.loads(file.read_text())
    Draft202012Validator.check_schema(schema)
    validators[file.name.removesuffix(".schema.json")] = Draft202012Validator(schema)

SHIPPED = {
    "scenario": ["*.json", "osm_sankt_poelten/line.json", "osm_sankt_poelten/station_throat.json"],
    "world": ["osm_sankt_poelten/*.world.json"],
    "lidar": ["sensors/*.json", "published/Lidar.json"],
    "weather": ["weather/*.json", "published/Weather.json"],
    "interfaces": ["published/Interfaces.json"],
    "camera": ["published/Camera.json"],
    "motion_sensors": ["motion_sensors/*.json"],
    "alignment": ["alignments/*.json", "osm_sankt_poelten/*.alignment.json"],
    "materials": ["materials/*.json"],
    "labels": ["labels.json"],
    "models": ["models/*.json"],
}
# Faults that concern a single value, which a schema can detect.
REFUSED = """unknown_key unknown_section unknown_key_in_list missing_keys missing_key_nested
missing_type unknown_type string_for_number null_for_number number_for_flag list_for_object
wrong_length fraction_for_whole negative_range not_a_choice unknown_effect no_channels no_tracks
wrong_version no_version rain_twice camera_of_another_kind
camera_out_of_limits motion_sensors_out_of_limits""".split()
# Over a file, nested objects need not have their required keys.
PARTIAL = {
    "version": 1,
    "file": "base.json",
    "lidar": {"scan": {"rate_hz": 5}, "velocity": {"max_mps": 30}},
    "camera": {"width_px": 640},
    "world": {"alignment": {"gauge_mm": 1000, "map": {"latitude_deg": 48}}},
    "vehicle": {"motion": {"path": {"speed_mps": 3}}},
}

num_failures = 0


def fail(message):
    global num_failures
    num_failures += 1
    print(message)


num_files = 0
for kind, patterns in SHIPPED.items():
    for file in sorted(f for pattern in patterns for f in scenarios.glob(pattern)):
        if kind == "scenario" and file.name == "labels.json":
            continue
        num_files += 1
        for error in validators[kind].iter_errors(json.loads(file.read_text())):
            fail(f"{file}: {error.json_path}: {error.message[:200]}")
for name in REFUSED:
    file = scenarios / "malformed" / "read" / f"{name}.json"
    if validators["scenario"].is_valid(json.loads(file.read_text())):
        fail(f"{file}: passes")
for error in validators["scenario"].iter_errors(PARTIAL):
    fail(f"a part over a file: {error.json_path}: {error.message[:200]}")
if validators["scenario"].is_valid({key: part for key, part in PARTIAL.items() if key != "file"}):
    fail("a part without a file passes")
print(f"{len(validators)} schemas, {num_files} files, {len(REFUSED)} faults: {num_failures} failures")
sys.exit(num_failures > 0)
