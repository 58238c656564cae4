#!/usr/bin/env python3
"""Turns a track of TTOBench (https://github.com/nuorail/ttobench) into a railcast alignment file.

  scripts/convert_ttobench.py TTOBENCH.json ALIGNMENT.json [--origin X Y] [--heading-deg H]

TTOBench states gradient, radius and speed limit by chainage, but neither where the line lies nor to
which side a positive radius turns. It is the right: laid on the map with both ends of St.Gallen -
Wil in place, the line then passes the four stations we looked at on its way (Bruggen, Gossau,
Flawil, Uzwil) within 0.7 km, and with positive as left it misses them by 2.5 to 5.5 km. railcast
counts left as positive, so radii change their sign here.

The line's start is put at --origin (east, north), at the altitude of the file, or at height 0 if it
states none. scenarios/alignments/st_gallen_wil.json was made with --heading-deg 226.18, which leads
it from St. Gallen to Wil as on the map.
"""

import argparse
import json
import sys

ATTRIBUTION = (
    "Figures of {id} from TTOBench (https://github.com/nuorail/ttobench): D. Kouzoupis et al. 2023, "
    "doi:10.1007/s43069-023-00248-x. Copyright (c) 2022, Dimitris Kouzoupis, BSD-2-Clause: "
    "LICENSE.ttobench. Changed: the format, and the sign of the radii, which TTOBench does not "
    "document: its positive radii are taken as right, ours are left."
)


def values_of(track, key, units):
    """The rows below `key`, after checking their units."""
    if key not in track:
        return []
    found = track[key].get("units") or {"position": track[key]["unit"]}
    if found != units:
        sys.exit(f"{key}: units must be {units} (got {found})")
    return track[key]["values"]


def section(row):
    s_m, *radii_m = row
    result = {"s_m": s_m}
    for name, radius_m in zip(("radius_start_m", "radius_end_m"), radii_m, strict=True):
        if radius_m != "infinity":
            result[name] = -radius_m
    return result


def steps(rows):
    return [{"s_m": s_m, "value": value} for s_m, value in rows]


def convert(track, origin, heading_deg):
    stops = values_of(track, "stops", {"position": "m"})
    curvatures = values_of(
        track,
        "curvatures",
        {"position": "m", "radius at start": "m", "radius at end": "m"},
    )
    gradients = values_of(track, "gradients", {"position": "m", "slope": "permil"})
    speed_limits = values_of(track, "speed limits", {"position": "m", "velocity": "km/h"})
    return {
        "version": 1,
        "attribution": ATTRIBUTION.format(id=track["metadata"]["id"]),
        "course": {
            "type": "sections",
            "length_m": stops[-1],
            "sections": [section(row) for row in curvatures] or [{"s_m": 0.0}],
        },
        "origin_m": [*origin, track.get("altitude", {"value": 0.0})["value"]],
        "heading_deg": heading_deg,
        "gradients_permil": steps(gradients),
        "speed_limits_kmph": steps(speed_limits),
    }


def text_of(value, indent=""):
    """JSON with one list item per line, so that diffs are readable."""
    inner = indent + "  "
    if isinstance(value, dict) and any(isinstance(v, (dict, list)) for v in value.values()):
        lines = [f"{inner}{json.dumps(k)}: {text_of(v, inner)}" for k, v in value.items()]
        return "{\n" + ",\n".join(lines) + f"\n{indent}}}"
    if isinstance(value, list) and any(isinstance(v, (dict, list)) for v in value):
        return "[\n" + ",\n".join(inner + text_of(v, inner) for v in value) + f"\n{indent}]"
    return json.dumps(value)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("ttobench")
    parser.add_argument("alignment")
    parser.add_argument("--origin", type=float, nargs=2, default=[0.0, 0.0], metavar=("X", "Y"))
    parser.add_argument("--heading-deg", type=float, default=0.0, metavar="H")
    arguments = parser.parse_args()
    with open(arguments.ttobench, encoding="utf-8") as file:
        track = json.load(file)
    alignment = convert(track, arguments.origin, arguments.heading_deg)
    with open(arguments.alignment, "w", encoding="utf-8") as file:
        file.write(text_of(alignment) + "\n")


if __name__ == "__main__":
    main()
