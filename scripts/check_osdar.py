#!/usr/bin/python3
"""Checks a scene of the OSDaR layout as the operator's validator does (raillabel-providerkit).

Usage: check_osdar.py LABELS.json... [--ontology osdar23|osdar26] [--definitions DIR]

Checks the JSON schema and, where that is kept, the ontology (classes, attributes, their values and
scopes), frames without annotations, rail sides, the ego track and both of its rails, transitions,
URIs, sensors, dimensions, horizon, and which annotations a sensor may have. Beyond the validator it
looks at the lidar's rails, too, and whether files are there and point indices within them. Prints
a line for each fault, "file: /pointer: rule (got value)"; exit status 0 none, 1 faults, 2 usage.

Needs Debian's python3-jsonschema, python3-numpy and python3-yaml, and the schema and ontologies of
https://github.com/dbinfrago/raillabel-providerkit (--definitions).
"""

import argparse
import json
import pathlib
import sys
from collections import defaultdict
from dataclasses import dataclass

from osdar_limits import ANNOTATIONS, CAMERAS_WITH_OPTICAL_AXES, DIMENSIONS, SENSORS

try:
    import jsonschema
    import numpy as np
    import osdar_definitions
except ImportError as missing:
    if __name__ != "__main__":
        raise
    sys.exit(f"{missing}: install Debian's python3-jsonschema, python3-numpy and python3-yaml")

KINDS = ("bbox", "cuboid", "poly2d", "poly3d", "vec")
HORIZON_TOLERANCE = 0.1  # Of the horizon's distance from the top of the image.
TRACKS = ("track", "transition")
UNSEEN, MANY_POINTS = ("undefined", "100 %"), 10
EGO_TRACK = (0, "0", "ego_track")


@dataclass
class Annotation:
    """One annotation of a frame."""
    frame: str
    object_uid: str
    class_name: str
    kind: str
    sensor: str
    sensor_type: str
    values: list
    attributes: dict
    pointer: str

    @property
    def is_ego_track(self):
        if "isEgoTrack" in self.attributes:
            return self.attributes["isEgoTrack"] is True
        return self.class_name in TRACKS and self.attributes.get("trackID") in EGO_TRACK

    def line(self):
        """Points of a polyline, (n, 2) or (n, 3)."""
        return np.array(self.values, float).reshape(-1, 2 if self.kind == "poly2d" else 3)


class Scene:
    """A file that keeps the schema."""

    def __init__(self, label):
        self.label = label
        self.streams = label.get("streams", {})
        self.frames = label.get("frames", {})
        self.annotations = list(self._annotations())
        # Of the cameras only the middle ones must have annotations.
        self.required = [name for name, stream in self.streams.items() if stream.get("type") == "lidar" or
                         stream.get("type") == "camera" and ("_center" in name or "_middle" in name)]

    def _annotations(self):
        for number, frame in self.frames.items():
            for uid, entry in frame.get("objects", {}).items():
                for kind in KINDS:
                    for index, data in enumerate(entry.get("object_data", {}).get(kind, [])):
                        groups = data.get("attributes", {})
                        sensor = data.get("coordinate_system", "")
                        yield Annotation(
                            number, uid, self.label.get("objects", {}).get(uid, {}).get("type", ""), kind, sensor,
                            self.streams.get(sensor, {}).get("type", ""), data["val"],
                            {entry["name"]: entry["val"] for group in groups.values() for entry in group},
                            f"/openlabel/frames/{number}/objects/{uid}/object_data/{kind}/{index}")

    def of_sensor_frames(self):
        """Annotations by (frame, sensor), with an entry for each sensor that must have some."""
        result = {(frame, sensor): [] for frame in self.frames for sensor in self.required}
        for annotation in self.annotations:
            result.setdefault((annotation.frame, annotation.sensor), []).append(annotation)
        return result


def shown(value):
    return f" (got {json.dumps(value)})"


def check_classes(scene, classes):
    for uid, entry in scene.label.get("objects", {}).items():
        if entry["type"] not in classes:
            yield f"/openlabel/objects/{uid}/type: must be a class of the ontology{shown(entry['type'])}"
    for one in scene.annotations:
        rules = {name: rule for name, rule in (classes.get(one.class_name) or {}).items()
                 if one.sensor_type in rule.get("sensor_types", ("camera", "lidar", "radar"))}
        if one.class_name not in classes:
            continue
        for name, value in one.attributes.items():
            if name not in rules:
                yield f"{one.pointer}/attributes: {name}: must not be an attribute of {one.class_name} there"
            elif (fault := value_fault(rules[name]["attribute_type"], value)):
                yield f"{one.pointer}/attributes: {name}: {fault}{shown(value)}"
        for name, rule in rules.items():
            if name not in one.attributes and not rule.get("optional"):
                yield f"{one.pointer}/attributes: {name}: missing"


def value_fault(kind, value):
    """What is wrong with an attribute's value; None if nothing."""
    if kind == "boolean":
        return None if isinstance(value, bool) else "must be true or false"
    if kind == "multi-reference":
        return None if isinstance(value, list) else "must be a list of objects"
    options = [str(option) for option in kind["options"]]
    if kind["type"] == "multi-select":
        return None if isinstance(value, list) and set(value) <= set(options) else f"must be of {options}"
    return None if value in options else f"must be one of {options}"


def check_scopes(scene, classes):
    seen = {}
    for one in scene.annotations:
        for name, value in one.attributes.items():
            scope = ((classes.get(one.class_name) or {}).get(name) or {}).get("scope", "annotation")
            if scope == "annotation":
                continue
            place = (one.object_uid, name, one.frame if scope == "frame" else None)
            value = sorted(value) if isinstance(value, list) else value
            first = seen.setdefault(place, value)
            if value != first:
                yield f"{one.pointer}/attributes: {name}: must be the same in the whole {scope}, {first}{shown(value)}"


def check_frames(scene, _):
    for (frame, sensor), annotations in scene.of_sensor_frames().items():
        place = f"/openlabel/frames/{frame}: {sensor}"
        if sensor in scene.required and not annotations:
            yield f"{place}: must have annotations"
        if sensor not in scene.required:
            continue
        kinds = ("poly3d",) if scene.streams[sensor]["type"] == "lidar" else KINDS
        own = [one for one in annotations if one.is_ego_track and one.kind in kinds]
        if not own:
            yield f"{place}: must have the ego track"
        yield from (f"{place}: {fault}" for fault in both_rails_faults(own))


def both_rails_faults(own):
    lines = {side: [one.line() for one in own
                    if one.kind.startswith("poly") and one.attributes.get("railSide") == side]
             for side in ("leftRail", "rightRail")}
    if not lines["leftRail"] or not lines["rightRail"]:
        if lines["leftRail"] or lines["rightRail"]:
            yield "must have both rails of the ego track"
        return
    axis, nearest = (1, max) if lines["leftRail"][0].shape[1] == 2 else (0, min)  # Image rows; forward.
    ends = {side: (min(line[:, axis].min() for line in own), max(line[:, axis].max() for line in own))
            for side, own in lines.items()}
    if ends["leftRail"][0] > ends["rightRail"][1] or ends["rightRail"][0] > ends["leftRail"][1]:
        yield "both rails of the ego track must overlap"
        return
    common = (min if nearest is max else max)(end[nearest is max] for end in ends.values())
    for side, own in lines.items():
        count = sum(line[:, axis].min() <= common <= line[:, axis].max() for line in own)
        if count != 1:
            yield f"must have one {side} of the ego track at its near end{shown(count)}"


def check_rail_sides(scene, _):
    tracks = defaultdict(list)
    for one in scene.annotations:
        if one.class_name in TRACKS and one.kind in ("poly2d", "poly3d"):
            tracks[one.frame, one.sensor, one.object_uid, one.kind].append(one)
    for (frame, sensor, uid, kind), own in tracks.items():
        place = f"/openlabel/frames/{frame}/objects/{uid}: {sensor}"
        sides = {side: [one.line() for one in own if one.attributes.get("railSide") == side]
                 for side in ("leftRail", "rightRail")}
        for side, lines in sides.items():
            if len(lines) > 1:
                yield f"{place}: must have at most one {side}{shown(len(lines))}"
        if all(len(lines) == 1 for lines in sides.values()):
            # Left is to the left in an image, and where y is greater in a lidar's axes.
            along, across, sign = (1, 0, 1) if kind == "poly2d" else (0, 1, -1)
            gaps = sign * rail_gaps(sides["leftRail"][0], sides["rightRail"][0], along, across)
            if gaps.size and gaps[-1 if kind == "poly2d" else 0] <= 0:
                yield f"{place}: left and right rail must not be swapped"
            elif gaps.size and (gaps <= 0).any():
                yield f"{place}: left and right rail must not cross"


def rail_gaps(left, right, along, across):
    """Right minus left at all places along which both have points between, in rising order."""
    places = np.unique(np.concatenate([left[:, along], right[:, along]]))
    begin, end = (bound([left[:, along].min(), right[:, along].min()]) if bound is max else
                  bound([left[:, along].max(), right[:, along].max()]) for bound in (max, min))
    places = places[(places >= begin) & (places <= end)]
    values = []
    for line in (left, right):
        order = np.argsort(line[:, along], kind="stable")
        values.append(np.interp(places, line[order, along], line[order, across]))
    return values[1] - values[0]


def check_transitions(scene, _):
    for one in scene.annotations:
        start = one.attributes.get("startTrack")
        if one.class_name == "transition" and start is not None and start == one.attributes.get("endTrack"):
            yield f"{one.pointer}/attributes: endTrack: must differ from startTrack{shown(start)}"


def check_sensors(scene, _):
    for name, stream in scene.streams.items():
        if name not in SENSORS:
            yield f"/openlabel/streams/{name}: must be a sensor of OSDaR, {', '.join(SENSORS)}"
        elif stream.get("type") != SENSORS[name]:
            yield f"/openlabel/streams/{name}/type: must be {SENSORS[name]}{shown(stream.get('type'))}"
        if name not in scene.label.get("coordinate_systems", {}):
            yield f"/openlabel/coordinate_systems/{name}: missing"


def check_kinds(scene, _):
    for one in scene.annotations:
        if one.kind not in ANNOTATIONS.get(one.sensor_type, KINDS):
            yield f"{one.pointer}: must be of {', '.join(ANNOTATIONS[one.sensor_type])} for a {one.sensor_type}"


def check_dimensions(scene, _):
    for one in scene.annotations:
        if one.kind != "cuboid":
            continue
        row = next((row for row in DIMENSIONS if one.class_name in row[0] and
                    all(one.attributes.get(name) == value for name, value in row[1].items())), None)
        if row is None:
            continue
        length, width, height = one.values[-3:]
        if not row[2][0] <= height <= row[2][1]:
            yield f"{one.pointer}/val: height must be from {row[2][0]} to {row[2][1]} m{shown(height)}"
        if row[3] and not (row[3][0] <= min(length, width) and max(length, width) <= row[3][1]):
            yield f"{one.pointer}/val: sides must be from {row[3][0]} to {row[3][1]} m{shown([length, width])}"


def rotation_of(quaternion):
    x, y, z, w = np.array(quaternion) / np.linalg.norm(quaternion)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def horizon_of(scene, sensor):
    """(row of the horizon at column 0, its slope) in a camera's image."""
    rotation = rotation_of(scene.label["coordinate_systems"][sensor]["pose_wrt_parent"]["quaternion"])
    matrix = np.array(scene.streams[sensor]["stream_properties"]["intrinsics_pinhole"]["camera_matrix"]).reshape(3, 4)
    optical_from_camera = np.array([[0, -1, 0], [0, 0, -1], [1, 0, 0]])
    if sensor.startswith(CAMERAS_WITH_OPTICAL_AXES):
        optical_from_camera = np.eye(3)
    forward = rotation @ optical_from_camera.T @ [0, 0, 1]
    heading = np.arctan2(forward[1], forward[0])
    pixels = []
    for angle in (heading - 0.1, heading + 0.1):  # Two points of the horizon fix the line.
        ray = optical_from_camera @ rotation.T @ [np.cos(angle), np.sin(angle), 0]
        pixel = matrix[:, :3] @ ray
        pixels.append(pixel[:2] / pixel[2])
    (x0, y0), (x1, y1) = pixels
    slope = (y1 - y0) / (x1 - x0)
    return y0 - slope * x0, slope


def check_horizon(scene, _):
    for one in scene.annotations:
        if one.kind != "poly2d" or one.class_name not in TRACKS or one.sensor_type != "camera":
            continue
        begin, slope = horizon_of(scene, one.sensor)
        for x, y in one.line():
            row = begin + slope * x
            if y < row - HORIZON_TOLERANCE * abs(row):
                yield f"{one.pointer}/val: points must be below the horizon, row {row:.1f}{shown([x, y])}"
                break


def check_files(scene, folder):
    num_points = {}
    for number, frame in scene.frames.items():
        for sensor, stream in frame.get("frame_properties", {}).get("streams", {}).items():
            uri, place = stream.get("uri", ""), f"/openlabel/frames/{number}/frame_properties/streams/{sensor}/uri"
            if not uri.startswith(f"/{sensor}/"):
                yield f"{place}: must begin with /{sensor}/{shown(uri)}"
            elif not (folder / uri[1:]).is_file():
                yield f"{place}: must be a file{shown(uri)}"
            elif uri.endswith(".pcd"):
                with open(folder / uri[1:], "rb") as file:
                    points = next((line[7:].strip() for line in file if line.startswith(b"POINTS ")), b"")
                if points.isdigit():
                    num_points[number, sensor] = int(points)
                else:
                    yield f"{place}: must be a PCD file that says its POINTS{shown(uri)}"
    for one in scene.annotations:
        if one.kind == "vec" and (one.frame, one.sensor) in num_points and one.values:
            most = num_points[one.frame, one.sensor] - 1
            if min(one.values) < 0 or max(one.values) > most or len(set(one.values)) < len(one.values):
                yield f"{one.pointer}/val: must be different indices from 0 to {most}"


def check_occlusions(scene, _):
    """Of what is hidden wholly, or to an unknown degree, a lidar has no points, or few on something thin."""
    boxed = {(one.frame, one.object_uid, one.sensor) for one in scene.annotations if one.kind == "cuboid"}
    for one in scene.annotations:
        if one.kind != "vec" or one.sensor_type != "lidar" or (one.frame, one.object_uid, one.sensor) not in boxed:
            continue
        value = one.attributes.get("occlusion")
        if len(one.values) >= MANY_POINTS and value in UNSEEN:
            yield (f"{one.pointer}/attributes: occlusion: must be a quarter of what is seen, as {len(one.values)} points "
                   f"are on it{shown(value)}")


CHECKS = (check_classes, check_scopes, check_frames, check_rail_sides, check_transitions, check_sensors, check_kinds,
          check_dimensions, check_horizon, check_occlusions)


def faults_of(path, schema, ontologies, ontology=None):
    """Every fault of a file."""
    try:
        whole = json.loads(path.read_text("utf-8"))
    except OSError as error:
        return [error.strerror]
    except ValueError as error:
        return [str(error)]
    errors = jsonschema.Draft7Validator(schema).iter_errors(whole)
    faults = ["/" + "/".join(map(str, error.absolute_path)) + f": {error.message[:200]}" for error in errors]
    if faults:
        return faults
    scene = Scene(whole["openlabel"])
    name = ontology or ("osdar26" if "lidar_merged" in scene.streams else "osdar23")
    faults = [fault for check in CHECKS for fault in check(scene, ontologies[name])]
    return faults + list(check_files(scene, path.parent))


def read_definitions(folder):
    """The schema, and the ontologies by name."""
    schema = osdar_definitions.read_definition(folder, "osdar26_schema.json")
    return schema, {name: osdar_definitions.read_definition(folder, f"{name}.yaml") for name in ("osdar23", "osdar26")}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("labels", nargs="+", type=pathlib.Path, metavar="LABELS.json")
    parser.add_argument("--ontology", choices=("osdar23", "osdar26"))
    parser.add_argument("--definitions", type=pathlib.Path, default=osdar_definitions.FOLDER,
                        help="folder above osdar23.yaml, osdar26.yaml and osdar26_schema.json")
    arguments = parser.parse_args()
    try:
        definitions = read_definitions(arguments.definitions)
    except (OSError, ValueError) as error:
        sys.exit(str(error))
    num_faults = 0
    for path in arguments.labels:
        faults = faults_of(path, *definitions, arguments.ontology)
        num_faults += len(faults)
        for fault in faults:
            print(f"{path}: {fault}", file=sys.stderr)
        if not faults:
            print(f"{path}: passes all checks")
    return 1 if num_faults else 0


if __name__ == "__main__":
    sys.exit(main())
