#!/usr/bin/env python3
"""Turns a track of TTOBench (https://github.com/nuorail/ttobench) into a railcast alignment file.

  scripts/convert_ttobench.py TTOBENCH.json ALIGNMENT.json [--origin X Y] [--heading-deg H]
      [--places PLACES.csv] [--structures STRUCTURES.json]

TTOBench states gradient, radius and speed limit by chainage, but not where the line lies. A positive
radius turns right, as current files of TTOBench say (tracks/README.md of version 1.4; version 1.2,
from which our line is, did not say so, and the map gave the same answer: placed there with both ends
fixed, the line passes within 0.7 km of four stations, which it misses by 2.5 to 5.5 km with left).
railcast counts left as positive, so radii change their sign here.

The line's start is put at --origin (east, north), at the altitude of the file, or at height 0 if it
states none. scenarios/alignments/st_gallen_wil.json was made with --heading-deg 226.18, which leads
it from St. Gallen to Wil as on the map.

An alignment has neither stops nor tunnels. --places writes them as CSV: type, begin_s_m, end_s_m and
cross_section_m2, where a stop ends where it begins and has no cross-section. --structures writes the tunnels as a list
that a world may name as its `structures`.

A file that breaks a rule is refused with one line on standard error, and nothing is written.
"""

import argparse
import json
import math
import sys

ATTRIBUTION = (
    "Figures of {id} from TTOBench (https://github.com/nuorail/ttobench): D. Kouzoupis et al. 2023, "
    "doi:10.1007/s43069-023-00248-x. Copyright (c) 2022, Dimitris Kouzoupis, BSD-2-Clause: "
    "LICENSE.ttobench. Changed: the format, and the sign of the radii, "
)
SIGNS = {
    "TTOBench v1.2": "which TTOBench does not document: its positive radii are taken as right, ours "
    "are left.",
}
LATER_SIGN = "of which TTOBench's positive ones turn right, ours left."
# As railcast has it (core/rail/line/alignment_course.h).
SMALLEST_RADIUS_M = 10.0


class Fault(Exception):
    """A file that breaks a rule."""

    def __init__(self, place, rule, value=None):
        got = "none" if value is None else json.dumps(value)[:100]
        super().__init__(f"{place}: {rule} (got {got})")


def is_number(value):
    is_real = isinstance(value, (int, float)) and not isinstance(value, bool)
    return is_real and math.isfinite(value)


def object_at(parent, key, place):
    if not isinstance(parent.get(key), dict):
        raise Fault(f"{place}/{key}", "must be an object", parent.get(key))
    return parent[key]


def values_of(track, key, units):
    """The rows below `key`, after checking their units; none if there is no such key."""
    if key not in track:
        return []
    part = object_at(track, key, "")
    found = part.get("units") or {"position": part.get("unit")}
    if found != units:
        raise Fault(f"/{key}", f"units must be {json.dumps(units)}", found)
    rows = part.get("values")
    if not isinstance(rows, list) or not rows:
        raise Fault(f"/{key}/values", "must be a list that is not empty", rows)
    return rows


def check_position(place, position_m, before_m):
    if not is_number(position_m):
        raise Fault(place, "must be a number of metres", position_m)
    if before_m is None and position_m != 0:
        raise Fault(place, "must be 0, the beginning of the line", position_m)
    if before_m is not None and not position_m > before_m:
        raise Fault(place, f"must be greater than {before_m} before it", position_m)


def checked_rows(track, key, units, length_m):
    """The rows below `key`: lists of numbers, in order of their positions on the line."""
    rows = values_of(track, key, units)
    before_m = -math.inf if key == "tunnels" else None
    for number, row in enumerate(rows):
        place = f"/{key}/values/{number}"
        if not isinstance(row, list) or len(row) != len(units):
            raise Fault(place, f"must be a list of {len(units)}: {', '.join(units)}", row)
        check_position(f"{place}/0", row[0], before_m)
        before_m = row[0]
        if not row[0] < length_m:
            raise Fault(f"{place}/0", f"must be less than the last stop, {length_m}", row[0])
        for column, value in enumerate(row[1:], start=1):
            if not is_number(value) and not (key == "curvatures" and value == "infinity"):
                raise Fault(f"{place}/{column}", "must be a number", value)
    return rows


def stops_of(track):
    """Positions of the stops; the last one is the line's length."""
    if "stops" not in track:
        raise Fault("/stops", "must be an object")
    stops = values_of(track, "stops", {"position": "m"})
    if len(stops) < 2:
        raise Fault("/stops/values", "must have the line's beginning and its end", stops)
    before_m = None
    for number, position_m in enumerate(stops):
        check_position(f"/stops/values/{number}", position_m, before_m)
        before_m = position_m
    return stops


def tunnels_of(track, length_m):
    """Tunnels one behind the other: beginning, length, cross-section."""
    units = {"position": "m", "length": "m", "cross section": "m^2"}
    tunnels = checked_rows(track, "tunnels", units, length_m)
    free_from_m = 0.0
    for number, (begin_m, tunnel_m, area_m2) in enumerate(tunnels):
        place = f"/tunnels/values/{number}"
        if not begin_m >= free_from_m:
            raise Fault(f"{place}/0", f"must be {free_from_m} or more, where it is free", begin_m)
        if not (tunnel_m > 0 and begin_m + tunnel_m <= length_m):
            raise Fault(f"{place}/1", "must be > 0 and end on the line", tunnel_m)
        if not area_m2 > 0:
            raise Fault(f"{place}/2", "must be > 0", area_m2)
        free_from_m = begin_m + tunnel_m
    return tunnels


def section(place, row):
    s_m, *radii_m = row
    result = {"s_m": s_m}
    for name, column in (("radius_start_m", 1), ("radius_end_m", 2)):
        radius_m = row[column]
        if radius_m == "infinity":
            continue
        if not abs(radius_m) >= SMALLEST_RADIUS_M:
            raise Fault(f"{place}/{column}", f"must be {SMALLEST_RADIUS_M:g} m or more", radius_m)
        result[name] = -radius_m
    return result


def steps(rows):
    return [{"s_m": s_m, "value": value} for s_m, value in rows]


def check_speeds(rows):
    for number, (_, speed_kmph) in enumerate(rows):
        if not speed_kmph > 0:
            raise Fault(f"/speed limits/values/{number}/1", "must be > 0", speed_kmph)


def altitude_of(track):
    if "altitude" not in track:
        return 0.0
    part = object_at(track, "altitude", "")
    if part.get("unit") != "m":
        raise Fault("/altitude/unit", 'must be "m"', part.get("unit"))
    if not is_number(part.get("value")):
        raise Fault("/altitude/value", "must be a number", part.get("value"))
    return part["value"]


def convert(track, origin, heading_deg):
    """The alignment, and the places for --places."""
    if not isinstance(track, dict):
        raise Fault("/", "must be an object", track)
    metadata = object_at(track, "metadata", "")
    identity = metadata.get("id")
    if not isinstance(identity, str):
        raise Fault("/metadata/id", "must be a text", identity)
    version = metadata.get("library version")
    version = version if isinstance(version, str) else ""
    stops = stops_of(track)
    length_m = stops[-1]
    curvatures = checked_rows(
        track,
        "curvatures",
        {"position": "m", "radius at start": "m", "radius at end": "m"},
        length_m,
    )
    gradients = checked_rows(track, "gradients", {"position": "m", "slope": "permil"}, length_m)
    speed_limits = checked_rows(
        track, "speed limits", {"position": "m", "velocity": "km/h"}, length_m
    )
    check_speeds(speed_limits)
    sections = [section(f"/curvatures/values/{n}", row) for n, row in enumerate(curvatures)]
    alignment = {
        "version": 1,
        "attribution": ATTRIBUTION.format(id=identity) + SIGNS.get(version, LATER_SIGN),
        "course": {
            "type": "sections",
            "length_m": length_m,
            "sections": sections or [{"s_m": 0.0}],
        },
        "origin_m": [*origin, altitude_of(track)],
        "heading_deg": heading_deg,
        "gradients_permil": steps(gradients),
        "speed_limits_kmph": steps(speed_limits),
    }
    places = [("stop", s_m, s_m, "") for s_m in stops]
    places += [("tunnel", s_m, s_m + tunnel_m, area_m2)
               for s_m, tunnel_m, area_m2 in tunnels_of(track, length_m)]
    return alignment, sorted(places, key=lambda place: place[1:3])


def places_text(places):
    rows = [("type", "begin_s_m", "end_s_m", "cross_section_m2"), *places]
    return "".join(",".join(str(value) for value in row) + "\n" for row in rows)


def structures_of(places):
    """The tunnels among the places, as a world has them."""
    tunnels = [place for place in places if place[0] == "tunnel"]
    return {"version": 1, "structures": [
        {"type": "tunnel", "name": f"tunnel_{number}", "begin_s_m": begin_m, "end_s_m": end_m}
        for number, (_, begin_m, end_m, _) in enumerate(tunnels, start=1)]}


def text_of(value, indent=""):
    """JSON with one list item per line, so that diffs are readable."""
    inner = indent + "  "
    if isinstance(value, dict) and any(isinstance(v, (dict, list)) for v in value.values()):
        lines = [f"{inner}{json.dumps(k)}: {text_of(v, inner)}" for k, v in value.items()]
        return "{\n" + ",\n".join(lines) + f"\n{indent}}}"
    if isinstance(value, list) and any(isinstance(v, (dict, list)) for v in value):
        return "[\n" + ",\n".join(inner + text_of(v, inner) for v in value) + f"\n{indent}]"
    return json.dumps(value)


def unique_keys(pairs):
    keys = [key for key, _ in pairs]
    for key in keys:
        if keys.count(key) > 1:
            raise Fault(f"key {json.dumps(key)}", "must be given once", f"{keys.count(key)} times")
    return dict(pairs)


def read_track(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file, object_pairs_hook=unique_keys)
    except (json.JSONDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise Fault("/", "must be JSON", str(error)) from error


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("ttobench")
    parser.add_argument("alignment")
    parser.add_argument("--origin", type=float, nargs=2, default=[0.0, 0.0], metavar=("X", "Y"))
    parser.add_argument("--heading-deg", type=float, default=0.0, metavar="H")
    parser.add_argument("--places", metavar="CSV", help="where to write stops and tunnels")
    parser.add_argument("--structures", metavar="JSON", help="where to write tunnels")
    arguments = parser.parse_args(arguments)
    try:
        alignment, places = convert(
            read_track(arguments.ttobench), arguments.origin, arguments.heading_deg
        )
        with open(arguments.alignment, "w", encoding="utf-8") as file:
            file.write(text_of(alignment) + "\n")
        if arguments.places:
            with open(arguments.places, "w", encoding="utf-8") as file:
                file.write(places_text(places))
        if arguments.structures:
            with open(arguments.structures, "w", encoding="utf-8") as file:
                file.write(text_of(structures_of(places)) + "\n")
    except Fault as fault:
        sys.exit(f"{arguments.ttobench}: {fault}")
    except OSError as error:
        sys.exit(f"{error.filename}: {error.strerror}")


if __name__ == "__main__":
    main()
