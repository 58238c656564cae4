#!/usr/bin/env python3
"""Prints the tables of sensors in docs/frontier.md from what draw_frontiers.sh
measured.

usage: frontier_tables.py out/frontier
"""

import json
import pathlib
import sys

SCENES = ("open_line", "parallel_wagons", "forest_rain", "fog_yard")
SENSORS = {"": "Vir2Rail's raster", "_pandar64": "Pandar64", "_vls128": "VLS-128",
           "_rosette": "rosette", "_narrow": "narrow view"}
HEADER = ("| sensor | row | time x raw | echoes missed % | wires % | second % | steps % "
          "| range p50, p95, p99 mm | at steps mm | persons % | poles % | bright edges % |")


def shown(value, scale, digits):
    return "-" if value is None else f"{scale * value:.{digits}f}"


def found(missed_share):
    """The found share in percent of a missed one."""
    return "-" if missed_share is None else f"{100.0 * (1.0 - missed_share):.1f}"


def line_of(sensor, row):
    errors = row["errors"]
    ranges = ", ".join(shown(errors[f"range_{name}_m"], 1e3, 1) for name in ("median", "p95", "p99"))
    cells = (sensor, f"`{row['name']}`", f"{row['ratio_to_raw_trace']:.2f}",
             shown(errors["missed_share"], 100.0, 1), found(errors["thin_missed_share"]),
             found(errors["second_missed_share"]), found(errors["step_missed_share"]), ranges,
             shown(errors["step_range_median_m"], 1e3, 1),
             shown(errors["person_points_error"], 100.0, 1),
             shown(errors["pole_points_error"], 100.0, 1),
             shown(errors["bright_edge_intensity_median"], 100.0, 1))
    return "| " + " | ".join(cells) + " |"


def choice_line(scene, sensor, measured):
    choice = measured["fidelity_auto"]
    left_out = [one["what"] for one in choice["measured"] if not one["is_kept"]]
    deviation = choice["deviation"]
    return (f"| `{scene}` | {sensor} | {', '.join(f'`{name}`' for name in left_out) or 'none'} "
            f"| {100.0 * deviation['missed_share']:.2f} % "
            f"| {100.0 * deviation['thin_missed_share']:.2f} % "
            f"| {choice['held_back_beyond_tolerance']} of {len(choice['held_back'])} |")


def main():
    folder = pathlib.Path(sys.argv[1])
    measured = {}
    for scene in SCENES:
        for suffix, sensor in SENSORS.items():
            text = (folder / (scene + suffix) / "frontier.json").read_text()
            measured[scene, sensor] = json.loads(text)
    for scene in SCENES:
        print(f"\n{scene}\n{HEADER}\n|{'---|' * HEADER.count(' | ')}---|")
        for sensor in SENSORS.values():
            for row in measured[scene, sensor]["rows"]:
                if row["name"] in ("surface", "footprint", "brute_force_64"):
                    print(line_of(sensor, row))
    print("\nfidelity auto\n| scene | sensor | left out | missed | wires missed "
          "| held-back frames beyond the tolerance |\n|---|---|---|---|---|---|")
    for (scene, sensor), each in measured.items():
        print(choice_line(scene, sensor, each))


if __name__ == "__main__":
    main()
