#!/usr/bin/env python3
"""Gives scripts/check_osdar.py small scenes of a camera, which railcast's own scenes have not."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SKIPPED = 77  # For ctest.
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
try:
    import check_osdar
except ImportError as error:
    print(f"skipped: {sys.executable}: {error} (python3-jsonschema, python3-numpy, python3-yaml)")
    sys.exit(SKIPPED)

DATA = pathlib.Path(sys.argv.pop(1))
HORIZON = 300  # Row of the horizon in the camera's image.
LEFT, RIGHT = [400, 590, 480, 320], [600, 590, 520, 320]  # Rails that meet far away: x, y, x, y.


def uid(number):
    return f"00000000-0000-0000-0000-{number:012}"


def rail(side, values, **more):
    return {"class": "track", "kind": "poly2d", "val": values,
            "attributes": {"railSide": side, "trackID": "0", "occlusion": "0-25 %", **more}}


def scene(*annotations, sensor="rgb_center"):
    """A scene of one frame, with an object for each annotation."""
    objects, of_frame = {}, {}
    for number, one in enumerate(annotations):
        object_uid = uid(one.get("object", number))
        objects[object_uid] = {"name": f"{one['class']}{number}", "type": one["class"]}
        data = {"name": f"{sensor}__{one['kind']}__{one['class']}", "coordinate_system": sensor, "val": one["val"],
                "uid": uid(100 + number),
                "attributes": {"text": [{"name": name, "val": value} for name, value in one["attributes"].items()]}}
        if one["kind"].startswith("poly"):
            data["closed"] = False
        if one["kind"] == "poly2d":
            data["mode"] = "MODE_POLY2D_ABSOLUTE"
        of_frame.setdefault(object_uid, {"object_data": {}})["object_data"].setdefault(one["kind"], []).append(data)
    pose = {"translation": [0, 0, 3], "quaternion": [0, 0, 0, 1]}
    pinhole = {"camera_matrix": [1000, 0, 500, 0, 0, 1000, HORIZON, 0, 0, 0, 1, 0], "distortion_coeffs": [0] * 5,
               "width_px": 1000, "height_px": 600}
    return {"openlabel": {
        "metadata": {"schema_version": "1.0.0"},
        "coordinate_systems": {"base": {"type": "local", "parent": "", "children": [sensor]},
                               sensor: {"type": "sensor", "parent": "base", "pose_wrt_parent": pose}},
        "streams": {sensor: {"type": "camera", "uri": sensor, "stream_properties": {"intrinsics_pinhole": pinhole}}},
        "objects": objects, "frames": {"0": {"frame_properties": {}, "objects": of_frame}}}}


class Cameras(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.definitions = check_osdar.read_definitions(DATA / "raillabel")

    def faults(self, whole):
        with tempfile.TemporaryDirectory() as name:
            path = pathlib.Path(name) / "labels.json"
            path.write_text(json.dumps(whole), "utf-8")
            return check_osdar.faults_of(path, *self.definitions)

    def test_rails_that_meet_below_the_horizon_pass(self):
        self.assertEqual(self.faults(scene(rail("leftRail", LEFT), rail("rightRail", RIGHT))), [])

    def test_rails_above_the_horizon_do_not(self):
        above = LEFT[:2] + [480, 0.9 * HORIZON - 2]
        place = f"/openlabel/frames/0/objects/{uid(0)}/object_data/poly2d/0/val"
        self.assertEqual(self.faults(scene(rail("leftRail", above), rail("rightRail", RIGHT))),
                         [f"{place}: points must be below the horizon, row 300.0 (got [480.0, 268.0])"])
        within_tolerance = LEFT[:2] + [480, 0.9 * HORIZON + 1]
        self.assertEqual(self.faults(scene(rail("leftRail", within_tolerance), rail("rightRail", RIGHT))), [])

    def test_a_camera_that_looks_down_has_its_horizon_higher_up(self):
        whole = scene(rail("leftRail", LEFT), rail("rightRail", RIGHT))
        half = 0.05  # Half of a pitch of 0.1 rad, nose down: the horizon is tan(0.1) * 1000 rows higher.
        pose = whole["openlabel"]["coordinate_systems"]["rgb_center"]["pose_wrt_parent"]
        pose["quaternion"] = [0, 0.0499792, 0, 1 - half * half / 2]
        row = check_osdar.horizon_of(check_osdar.Scene(whole["openlabel"]), "rgb_center")[0]
        self.assertAlmostEqual(row, HORIZON - 100.33, delta=0.1)

    def test_swapped_and_crossing_rails_are_found(self):
        for left, right, rule in ((RIGHT, LEFT, "left and right rail must not be swapped"),
                                  (LEFT[:2] + RIGHT[2:], RIGHT[:2] + LEFT[2:], "left and right rail must not cross")):
            one = {"object": 7}
            faults = self.faults(scene({**rail("leftRail", left), **one}, {**rail("rightRail", right), **one}))
            self.assertIn(f"/openlabel/frames/0/objects/{uid(7)}: rgb_center: {rule}", faults)

    def test_a_middle_camera_needs_the_ego_track_and_others_do_not(self):
        beside = scene(rail("leftRail", LEFT, trackID="+1"))
        self.assertEqual(self.faults(beside), ["/openlabel/frames/0: rgb_center: must have the ego track"])
        self.assertEqual(self.faults(scene(rail("leftRail", LEFT, trackID="+1"), sensor="rgb_left")), [])
        self.assertEqual(self.faults(scene()), ["/openlabel/frames/0: rgb_center: must have annotations",
                                                "/openlabel/frames/0: rgb_center: must have the ego track"])

    def test_rails_of_the_ego_track_overlap_in_rows(self):
        faults = self.faults(scene(rail("leftRail", [400, 590, 440, 500]), rail("rightRail", [540, 400, 520, 320])))
        self.assertEqual(faults, ["/openlabel/frames/0: rgb_center: both rails of the ego track must overlap"])

    def test_a_transition_leads_to_another_track(self):
        transition = {"class": "transition", "kind": "poly2d", "val": LEFT, "attributes": {
            "railSide": "leftRail", "startTrack": "0", "endTrack": "0", "occlusion": "0-25 %"}}
        rails = (rail("leftRail", LEFT), rail("rightRail", RIGHT))
        self.assertEqual([fault.split(": ", 1)[1] for fault in self.faults(scene(*rails, transition))],
                         ['endTrack: must differ from startTrack (got "0")'])

    def test_a_camera_has_no_cuboids(self):
        box = {"class": "buffer_stop", "kind": "cuboid", "val": [10, 0, 1, 0, 0, 0, 1, 1, 2, 1.5],
               "attributes": {"onTrack": "0", "occlusion": "0-25 %"}}
        faults = self.faults(scene(rail("leftRail", LEFT), rail("rightRail", RIGHT), box))
        self.assertEqual([fault.split(": ", 1)[1] for fault in faults], ["must be of bbox, poly2d for a camera"])

    def test_a_published_file_keeps_the_schema_and_has_its_rails_in_order(self):
        faults = check_osdar.faults_of(DATA / "osdar23_openlabel" / "1_calibration_1.1_labels.json", *self.definitions)
        # Its attributes differ from today's ontology, and its sensor files are not there.
        others = [fault for fault in faults if "attributes: " not in fault and "must be a file" not in fault]
        self.assertEqual({fault.split(": ", 1)[1] for fault in others}, {"must be of bbox, cuboid for a radar"})

    def test_a_cloud_without_its_number_of_points_is_named(self):
        whole = scene(rail("leftRail", LEFT), rail("rightRail", RIGHT))
        uri = "/rgb_center/0.pcd"
        whole["openlabel"]["frames"]["0"]["frame_properties"] = {"streams": {"rgb_center": {"uri": uri}}}
        for head in (b"VERSION 0.7\n", b"POINTS\n", b"POINTS many\n"):
            with tempfile.TemporaryDirectory() as name:
                (pathlib.Path(name) / "rgb_center").mkdir()
                (pathlib.Path(name) / uri[1:]).write_bytes(head)
                faults = list(check_osdar.check_files(check_osdar.Scene(whole["openlabel"]), pathlib.Path(name)))
            self.assertEqual(faults, ["/openlabel/frames/0/frame_properties/streams/rgb_center/uri: must be a PCD file "
                                      f'that says its POINTS (got "{uri}")'])


class WhatAStrangerLacks(unittest.TestCase):

    def said(self, *arguments, python=(sys.executable,), script="check_osdar.py"):
        command = [*python, ROOT / "scripts" / script, *arguments]
        ended = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
        self.assertEqual((ended.returncode, ended.stdout), (1, ""))
        return ended.stderr

    def test_modules_are_said_in_one_line(self):
        bare = (sys.executable, "-S")  # Without the modules that are not Python's own.
        self.assertRegex(self.said("a.json", python=bare), r"^No module named '\w+': install Debian's python3-jsonschema, "
                                                           r"python3-numpy and python3-yaml\n$")
        self.assertRegex(self.said("run", "--out", "scene", python=bare, script="export_osdar.py"),
                         r"^No module named '\w+': install Debian's python3-numpy and python3-yaml, and build the Python "
                         r"module \(docs/python\.md\)\n$")

    def test_definitions_are_said_in_one_line(self):
        with tempfile.TemporaryDirectory() as name:
            self.assertEqual(self.said("a.json", "--definitions", name),
                             f"{name}: must hold osdar26_schema.json; clone "
                             "https://github.com/dbinfrago/raillabel-providerkit and give its folder config by "
                             "--definitions\n")
            broken = pathlib.Path(name) / "schemas" / "osdar26_schema.json"  # As it stands in that repository.
            broken.parent.mkdir()
            broken.write_text("{", "utf-8")
            self.assertRegex(self.said("a.json", "--definitions", name), f"^{broken}: Expecting property name [^\n]*\n$")

    def test_a_file_of_labels_that_is_not_there_is_named_once(self):
        self.assertEqual(self.said("a.json", "--definitions", DATA / "raillabel"), "a.json: No such file or directory\n")


if __name__ == "__main__":
    if not (DATA / "raillabel").is_dir():
        print(f"skipped: {DATA / 'raillabel'} is not there")
        sys.exit(SKIPPED)
    unittest.main()
