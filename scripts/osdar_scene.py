"""A scene of the OSDaR layout as OpenLABEL, made of railcast's frames."""

import json
import uuid

import numpy as np
from osdar_truth import place_in_train, rail_below, truth_of

import railcast

NAMESPACE = uuid.UUID("6f1a3c52-6c8b-5d0e-9d5b-2f4f0b7a9c11")
FIRST_MAST_INSTANCE = 20_000  # RailWorld: masts are numbered from here.
RAIL_REACH_M = 0.25  # A rail's foot is 75 mm beside its middle; the rest is noise and motion.
RAIL_TOLERANCE_M = 0.01  # By which a polyline may leave the rail between its points.
FOOT_M = 1.0  # A mast whose lowest point is less than this above top of rail shows its foot.
KINDS = {bool: "boolean", str: "text", list: "vec"}
SIDES = (("leftRail", "left"), ("rightRail", "right"))


def seconds(stamp_ns):
    return f"{stamp_ns // 10**9}.{stamp_ns % 10**9:09}"


def quaternion(rotation):
    """[x, y, z, w] of a rotation matrix, w >= 0."""
    vectors = np.array([[rotation[2, 1] - rotation[1, 2]], [rotation[0, 2] - rotation[2, 0]],
                        [rotation[1, 0] - rotation[0, 1]]]).ravel()
    # Of Bar-Itzhack (2000): the eigenvector of the greatest eigenvalue, which is stable at half a turn, too.
    symmetric = np.zeros((4, 4))
    symmetric[:3, :3] = rotation + rotation.T - np.trace(rotation) * np.eye(3)
    symmetric[:3, 3] = symmetric[3, :3] = vectors
    symmetric[3, 3] = np.trace(rotation)
    result = np.linalg.eigh(symmetric / 3)[1][:, -1]
    return [float(value) for value in (result if result[3] >= 0 else -result)]


def thinned(line):
    """A polyline with fewer points, within RAIL_TOLERANCE_M of the given one (Douglas and Peucker 1973)."""
    kept = {0, len(line) - 1}
    parts = [(0, len(line) - 1)]
    while parts:
        begin, end = parts.pop()
        chord = line[end] - line[begin]
        inner = line[begin + 1:end] - line[begin]
        if len(inner) == 0:
            continue
        along = np.clip(inner @ chord / (chord @ chord), 0, 1)
        apart = np.linalg.norm(inner - along[:, None] * chord, axis=1)
        farthest = int(np.argmax(apart))
        if apart[farthest] > RAIL_TOLERANCE_M:
            kept.add(begin + 1 + farthest)
            parts += [(begin, begin + 1 + farthest), (begin + 1 + farthest, end)]
    return line[sorted(kept)]


def distances_to(points, line):
    """Distances of points from a polyline."""
    begin, chord = line[:-1], np.diff(line, axis=0)
    lengths = np.maximum(np.einsum("ij,ij->i", chord, chord), 1e-12)
    along = np.clip(np.einsum("pij,ij->pi", points[:, None] - begin, chord) / lengths, 0, 1)
    return np.linalg.norm(points[:, None] - begin - along[..., None] * chord, axis=2).min(axis=1)


def ins_sample(frame, vehicle_from_sensor):
    """Position, quaternion, velocity in world axes; angular velocity in those of the vehicle: means over the scan."""
    sensor_from_vehicle = np.linalg.inv(vehicle_from_sensor)
    begin = frame.world_from_sensor @ sensor_from_vehicle
    end = frame.world_from_sensor_end @ sensor_from_vehicle
    duration_s = max(frame.duration_ns, 1) * 1e-9
    turn = begin[:3, :3].T @ end[:3, :3]  # Small, so that its antisymmetric part is the angle about each axis.
    rates = 0.5 / duration_s * np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    return [*begin[:3, 3], *quaternion(begin[:3, :3]), *((end - begin)[:3, 3] / duration_s), *rates]


class Thing:
    """An object as all sensors of a frame see it, with its box where it was at the mean time of its points."""

    def __init__(self, seen):
        self.name, self.type, self.label, self.instance = seen.name, seen.type, seen.label, seen.instance
        self.size_m = seen.size_m
        self.lidar_from_box = None
        self.points = self.hidden = self.alone = 0

    def count(self, seen, lidar_from_box):
        if self.lidar_from_box is None:
            self.lidar_from_box = lidar_from_box
        elif seen.points > 0:
            share = seen.points / (self.points + seen.points)
            self.lidar_from_box[:3, 3] += share * (lidar_from_box - self.lidar_from_box)[:3, 3]
        self.points += seen.points
        self.alone += seen.firings_alone
        self.hidden += seen.firings_alone * (seen.occlusion or 0)

    @property
    def occlusion(self):
        """The mean of the sensors' by their firings."""
        return self.hidden / self.alone if self.alone > 0 else None


class View:
    """What the sensors of a frame see together, in the axes of the scene's lidar at the stamp of the first one's frame.

    The sensors' motion is undone, as a vehicle can that knows its own.
    """

    def __init__(self, frames, mounts, is_merged):
        self.frame = frames[0]
        self.is_merged = is_merged
        self.vehicle_from_lidar = np.eye(4) if is_merged else mounts[0]
        self.things, self.parts, self.rails = {}, [], []
        lidar_from_first = mounts[0] if is_merged else np.eye(4)
        for number, frame in enumerate(frames):
            first_from_sensor = np.linalg.inv(frames[0].world_from_sensor) @ frame.world_from_sensor
            lidar_from_sensor = lidar_from_first @ (first_from_sensor if number > 0 else np.eye(4))
            self.parts.append((number, frame, lidar_from_sensor))
            for seen in frame.objects:
                self.things.setdefault(seen.name, Thing(seen)).count(
                    seen, lidar_from_sensor @ frame.sensor_from_box(seen, compensate="sensor"))
        self.xyz = np.concatenate([frame.points(compensate="sensor") @ turn[:3, :3].T.astype(np.float32) +
                                   turn[:3, 3].astype(np.float32) for _, frame, turn in self.parts])
        self.label, self.instance, self.outcome = (self.values(name) for name in ("label", "instance", "outcome"))

    def values(self, field):
        return np.concatenate([frame[field][frame.has_point] for _, frame, _ in self.parts])

    def add_rails(self, stretches):
        """Takes the rails in the axes of the first sensor."""
        turn = self.parts[0][2]
        self.rails = [{"track": stretch.track, "is_ego": stretch.is_ego,
                       **{side: getattr(stretch, side) @ turn[:3, :3].T + turn[:3, 3] for _, side in SIDES}}
                      for stretch in stretches]

    def points(self):
        """The points of the PCD file."""
        fields = [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("intensity", "<f4"), ("timestamp", "<f8")]
        points = np.zeros(len(self.xyz), fields + ([("sensor_index", "u1")] if self.is_merged else []))
        points["x"], points["y"], points["z"] = self.xyz.T
        points["intensity"] = np.nan_to_num(self.values("intensity"))
        points["timestamp"] = 1e-9 * np.concatenate([frame.stamp_ns + frame["time_ns"][frame.has_point].astype(np.int64)
                                                     for _, frame, _ in self.parts])
        if self.is_merged:
            points["sensor_index"] = np.concatenate([np.full(frame.num_points, number)
                                                     for number, frame, _ in self.parts])
        return points

    def track_numbers(self):
        """OSDaR23's numbers of tracks, from the right of the vehicle's (+1, +2) to its left (-1, -2)."""
        def nearest_y(stretch):
            middle = (stretch["left"] + stretch["right"]) / 2
            return middle[np.argmin(np.abs(middle[:, 0])), 1]
        ego_y = next((nearest_y(stretch) for stretch in self.rails if stretch["is_ego"]), 0.0)
        beside = sorted((abs(nearest_y(stretch) - ego_y), index) for index, stretch in enumerate(self.rails)
                        if not stretch["is_ego"])
        numbers = {index: "0" for index, stretch in enumerate(self.rails) if stretch["is_ego"]}
        counts = {1: 0, -1: 0}
        for _, index in beside:
            side = 1 if nearest_y(self.rails[index]) < ego_y else -1
            counts[side] += 1
            if counts[side] <= 2:
                numbers[index] = f"{side * counts[side]:+d}"
        return numbers


class Scene:
    """The OpenLABEL file."""

    def __init__(self, name, ontology, lidar, base_from_lidar):
        self.name, self.ontology, self.lidar = name, ontology, lidar
        self.base_from_lidar = base_from_lidar
        self.objects, self.frames = {}, {}
        self.num_annotations = 0

    @property
    def num_objects(self):
        return len(self.objects)

    def uid(self, *words):
        return str(uuid.uuid5(NAMESPACE, "/".join(map(str, (self.name, *words)))))

    def annotate(self, frame, name, class_name, annotation):
        """Adds an annotation (kind, values, attributes, further keys) of an object to a frame."""
        kind, values, attributes, more = annotation
        uid = self.uid(name)
        data_name = f"{self.lidar}__{kind}__{class_name}"
        entry = self.objects.setdefault(uid, {"name": name, "type": class_name, "seen": {}})
        entry["seen"].setdefault(data_name, ({}, set()))
        pointers, numbers = entry["seen"][data_name]
        pointers.update({key: KINDS[type(value)] for key, value in attributes.items()})
        numbers.add(frame)
        data = self.frames[frame]["objects"].setdefault(uid, {"object_data": {}})["object_data"].setdefault(kind, [])
        groups = {group: [{"name": key, "val": value} for key, value in attributes.items() if KINDS[type(value)] == group]
                  for group in ("boolean", "num", "text", "vec")}
        data.append({"name": data_name, "val": values, "coordinate_system": self.lidar,
                     "uid": self.uid(name, frame, kind, len(data)), "attributes": groups, **more})
        self.num_annotations += 1

    def add_frame(self, view, run):
        """Annotates a frame; returns the name of its PCD file."""
        frame = view.frame.index
        stamp = seconds(view.frame.stamp_ns)
        file = f"{frame:03}_{stamp}.pcd"
        uris = {self.lidar: f"/{self.lidar}/{file}", "gps_imu": "/gps_imu/ins.csv"}
        streams = {name: {"uri": uri, "stream_properties": {"sync": {"timestamp": stamp}}} for name, uri in uris.items()}
        self.frames[frame] = {"frame_properties": {"timestamp": stamp, "streams": streams, "frame_data": {"num": []}},
                              "objects": {}}
        self.add_things(frame, view, run)
        self.add_tracks(frame, view, run.labels["rail"])
        self.add_masts(frame, view, run.labels["mast"])
        return file

    def add_things(self, frame, view, run):
        specs = {spec["name"]: spec for spec in run.scenario["world"]["objects"]}
        of_label = {label["name"]: label["osdar23"] for label in run.scenario["labels"]}
        is_surface = view.outcome == railcast.OUTCOMES["returned"]
        shown = {name: thing for name, thing in view.things.items()
                 if thing.points > 0 and self.ontology.class_of(thing, of_label[thing.label])}
        for name, thing in shown.items():
            class_name = self.ontology.class_of(thing, of_label[thing.label])
            truth = truth_of(thing, specs.get(name, {}), self.ontology.entry_of(thing))
            order, beside = place_in_train(name, shown)
            truth.update(connectedTo=[self.uid(other) for other in beside], isFront=order in (None, 1))
            truth["order"] = str(order) if order else "1"
            center = thing.lidar_from_box[:3, 3]
            track, truth["railSide"] = rail_below(center, view.rails)
            truth["onTrack"] = view.track_numbers().get(track, "none")
            truth["isBottomVisible"] = self.shows_foot(view, view.instance == thing.instance)
            attributes = self.ontology.attributes(class_name, truth, thing.occlusion)
            box = [*center, *quaternion(thing.lidar_from_box[:3, :3]), *thing.size_m]
            self.annotate(frame, name, class_name, ("cuboid", [float(value) for value in box], attributes, {}))
            own = np.flatnonzero((view.instance == thing.instance) & is_surface)
            self.annotate(frame, name, class_name, ("vec", own.tolist(), attributes, {}))

    def add_tracks(self, frame, view, rail_label):
        """Both rails of each track: of OSDaR23 each is an object, of OSDaR26 both are one."""
        on_rail = np.flatnonzero((view.label == rail_label) & (view.outcome == railcast.OUTCOMES["returned"]))
        lines = [(index, option, stretch[side]) for index, stretch in enumerate(view.rails) for option, side in SIDES]
        apart = np.array([distances_to(view.xyz[on_rail].astype(float), line) for _, _, line in lines])
        nearest = np.where(apart.min(axis=0) < RAIL_REACH_M, apart.argmin(axis=0), -1) if lines else None
        numbers = view.track_numbers()
        side_of_object = self.ontology.classes["track"]["railSide"]["scope"] == "object"
        for number, (index, option, line) in enumerate(lines):
            stretch = view.rails[index]
            if side_of_object and index not in numbers:
                continue  # OSDaR23 has no number for tracks beyond the second on either side.
            name = f"track/{stretch['track']}/{index}" + (f"/{option}" if side_of_object else "")
            truth = {"railSide": option, "trackID": numbers.get(index), "isEgoTrack": stretch["is_ego"]}
            attributes = self.ontology.attributes("track", truth)
            values = [float(value) for value in thinned(line).ravel()]
            self.annotate(frame, name, "track", ("poly3d", values, attributes, {"closed": False}))
            own = on_rail[nearest == number]
            if len(own) > 0:
                self.annotate(frame, name, "track", ("vec", own.tolist(), attributes, {}))

    def add_masts(self, frame, view, mast_label):
        """Masts have no boxes: they are no objects of the scenario."""
        is_mast = (view.label == mast_label) & (view.instance >= FIRST_MAST_INSTANCE)
        for instance in np.unique(view.instance[is_mast]):
            own = is_mast & (view.instance == instance)
            attributes = self.ontology.attributes(
                "catenary_pole", {"type": "solid", "isBottomVisible": self.shows_foot(view, own)})
            indices = np.flatnonzero(own).tolist()
            self.annotate(frame, f"mast/{instance}", "catenary_pole", ("vec", indices, attributes, {}))

    @staticmethod
    def shows_foot(view, own):
        """Whether points of a thing lie near the height of the rails beside it."""
        if not own.any() or not view.rails:
            return False
        lowest = view.xyz[own][np.argmin(view.xyz[own][:, 2])]
        line = view.rails[0]["left"]
        beside = line[np.argmin(np.linalg.norm(line[:, :2] - lowest[:2], axis=1))]
        return bool(lowest[2] - beside[2] < FOOT_M)

    def json_text(self):
        """The whole file."""
        objects = {uid: {"name": entry["name"], "type": entry["type"],
                         "frame_intervals": intervals(set().union(*(seen for _, seen in entry["seen"].values()))),
                         "object_data_pointers": {
                             name: {"type": name.split("__")[1], "frame_intervals": intervals(seen),
                                    "attribute_pointers": pointers}
                             for name, (pointers, seen) in entry["seen"].items()}}
                   for uid, entry in self.objects.items()}
        systems = {"base": {"type": "local", "parent": "", "children": [self.lidar, "gps_imu"]}}
        for name, pose in ((self.lidar, self.base_from_lidar), ("gps_imu", np.eye(4))):
            systems[name] = {"type": "sensor", "parent": "base", "pose_wrt_parent": {
                "translation": [float(value) for value in pose[:3, 3]], "quaternion": quaternion(pose[:3, :3])}}
        return json.dumps({"openlabel": {
            "metadata": {"schema_version": "1.0.0", "subschema_version": "2.1.0", "file_version": "1.0.0",
                         "name": self.name, "tagged_file": self.name, "annotator": "railcast, exact by construction",
                         "exporter_version": railcast.__version__},
            "coordinate_systems": systems,
            "streams": {self.lidar: {"type": "lidar", "uri": self.lidar}, "gps_imu": {"type": "gps_imu", "uri": "gps_imu"}},
            "objects": objects,
            "frames": {str(number): frame for number, frame in self.frames.items()},
            "frame_intervals": intervals(self.frames)}}) + "\n"


def intervals(numbers):
    """Frame numbers as OpenLABEL's closed intervals."""
    result = []
    for number in sorted(numbers):
        if result and result[-1]["frame_end"] == number - 1:
            result[-1]["frame_end"] = number
        else:
            result.append({"frame_start": number, "frame_end": number})
    return result
