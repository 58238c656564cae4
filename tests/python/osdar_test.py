"""Scenes of the OSDaR layout: what scripts/export_osdar.py writes passes scripts/check_osdar.py, which finds faults."""

import copy
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

from support import ROOT, SCENARIO, SKIPPED, generate, np

import railcast

sys.path.insert(0, str(ROOT / "scripts"))
DEFINITIONS = pathlib.Path(sys.argv.pop(1)) / "raillabel"
FRAMES = 2
TWO = {"version": 1, "file": str(SCENARIO), "lidars": [
    {"file": str(ROOT / "scenarios" / "sensors" / "vlp16.json"), "name": name,
     "mount": {"position_m": [2.2, y, 2.5], "yaw_deg": 5 * y}, "phase_s": phase}
    for name, y, phase in (("left", 1.0, 0.0), ("right", -1.0, 0.04))]}


def run_script(name, *arguments):
    command = [sys.executable, ROOT / "scripts" / name, *arguments, "--definitions", DEFINITIONS]
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)


def shifted(box, center):
    """Points in the axes of a cuboid `val`."""
    x, y, z, w = box[3:7]
    turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    return (center - np.array(box[:3])) @ turn


class Exported(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        generate("sequence", SCENARIO, "--out", cls.folder / "run", "--frames", FRAMES, "--start-frame", 30)
        for ontology in ("osdar23", "osdar26"):
            ended = run_script("export_osdar.py", cls.folder / "run", "--out", cls.folder / ontology, "--ontology",
                               ontology)
            assert ended.returncode == 0, ended.stderr
        cls.recording = railcast.open(cls.folder / "run")
        cls.definitions = check_osdar.read_definitions(DEFINITIONS)
        cls.whole = json.loads((cls.folder / "osdar26" / "osdar26_labels.json").read_text("utf-8"))
        cls.label = cls.whole["openlabel"]

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def data(self, frame, name):
        uid, = (uid for uid, entry in self.label["objects"].items() if entry["name"] == name)
        return self.label["frames"][str(frame)]["objects"][uid]["object_data"]

    def test_all_checks_pass_with_both_ontologies(self):
        for ontology in ("osdar23", "osdar26"):
            path = self.folder / ontology / f"{ontology}_labels.json"
            ended = run_script("check_osdar.py", path)
            self.assertEqual((ended.returncode, ended.stdout), (0, f"{path}: passes all checks\n"), ended.stderr)

    def test_a_type_of_ones_own_table_has_the_class_that_it_says(self):
        table = {"version": 1, "models": [{"name": "sweeper", "file": "railcast:tractor.ply", "label": "road_vehicle",
                                           "size_m": [4.15, 2.275, 2.76], "material": "grey_paint",
                                           "osdar": {"class": "road_vehicle", "type": "other"}}]}
        (self.folder / "models.json").write_text(json.dumps(table), "utf-8")
        scenario = self.folder / "sweeper.json"
        scenario.write_text(json.dumps({
            "version": 1, "file": str(ROOT / "scenarios" / "minimal.json"), "models": "models.json",
            "world": {"alignment": {"course": {"type": "elements",
                                               "elements": [{"type": "straight", "length_m": 1000}]}},
                      "objects": [{"name": "sweeper", "type": "sweeper", "s_m": 430, "d_m": 4}]}}), "utf-8")
        generate("sequence", scenario, "--out", self.folder / "sweeper", "--frames", 1)
        ended = run_script("export_osdar.py", self.folder / "sweeper", "--out", self.folder / "own")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        whole = json.loads((self.folder / "own" / "own_labels.json").read_text("utf-8"))
        kinds = {entry["name"]: entry["type"] for entry in whole["openlabel"]["objects"].values()}
        self.assertEqual(kinds["sweeper"], "road_vehicle")

    def test_clouds_are_the_points_of_the_frames(self):
        for frame in self.recording:
            uri = self.label["frames"][str(frame.index)]["frame_properties"]["streams"]["lidar_merged"]["uri"]
            cloud = railcast.open(self.folder / "osdar26" / uri[1:])[0]
            np.testing.assert_array_equal(cloud.points(), frame.points(compensate="sensor"))

    def test_segments_are_the_points_of_their_objects(self):
        for frame in self.recording:
            instance = frame["instance"][frame.has_point]
            points = frame.points(compensate="sensor").astype(float)
            for thing in frame.objects:
                if thing.points == 0 or thing.label == "object":
                    continue
                data = self.data(frame.index, thing.name)
                self.assertEqual(len(data["vec"][0]["val"]), thing.points)
                self.assertEqual(set(instance[data["vec"][0]["val"]]), {thing.instance})
                box = data["cuboid"][0]["val"]
                own = np.abs(shifted(box, points[data["vec"][0]["val"]])) - np.array(box[7:]) / 2
                # Five standard deviations of the range noise, 2 cm, and what a wagon moves at 15 m/s while the raster
                # passes over half of it, in 6 ms at most.
                self.assertLess(own.max(), 0.1 + 15 * 0.006)

    def test_rails_are_a_gauge_apart_and_hold_their_points(self):
        for frame in self.recording:
            data = self.data(frame.index, "track/main/0")
            left, right = (np.array(rail["val"]).reshape(-1, 3) for rail in data["poly3d"])
            self.assertEqual([{entry["name"]: entry["val"] for entry in rail["attributes"]["text"]}["railSide"]
                              for rail in data["poly3d"]], ["leftRail", "rightRail"])
            along = np.linspace(0, 100, 101)
            gap = np.interp(along, left[:, 0], left[:, 1]) - np.interp(along, right[:, 0], right[:, 1])
            # In a bend, the gap across the sensor's axis is wider than the gauge.
            self.assertTrue((gap > 1.48).all() and (gap < 1.75).all(), gap)
            label = frame["label"][frame.has_point]
            for segment in data["vec"]:
                self.assertEqual(set(label[segment["val"]]), {self.recording.labels["rail"]})

    def test_attributes_are_the_truth(self):
        person = self.data(30, "person")["cuboid"][0]["attributes"]
        text = {entry["name"]: entry["val"] for entry in person["text"]}
        self.assertEqual((text["age"], text["pose"], text["occlusion"]), ("adult", "upright", "0-25%"))
        flat = {entry["name"]: entry["val"] for entry in self.data(30, "train_flat")["cuboid"][0]["attributes"]["text"]}
        hidden, = (thing.occlusion for thing in self.recording[0].objects if thing.name == "train_flat")
        self.assertTrue(0.5 <= hidden < 0.75)
        self.assertEqual((flat["type"], flat["occlusion"]), ("freight", "50-75%"))

    def test_shares_outside_0_to_1_are_refused(self):
        rule = {"attribute_type": {"options": ["0-25%", "25-50%", "50-75%", "75-100%", "undefined"]}}
        for share, expected in ((0.0, "0-25%"), (0.25, "25-50%"), (1.0, "75-100%"), (None, "undefined")):
            self.assertEqual(osdar_truth.occlusion_of(share, rule), expected)
        for share in (-4.0, -0.81, -1e-9, 1.001, float("nan")):
            with self.assertRaisesRegex(ValueError, f"^occlusion: must be from 0 to 1 \\(got {share}\\)$"):
                osdar_truth.occlusion_of(share, rule)

    def test_the_ins_has_the_vehicles_pose_and_motion(self):
        rows = np.genfromtxt(self.folder / "osdar26" / "gps_imu" / "ins.csv", delimiter=",", names=True)
        speed = np.sqrt(rows["vx_mps"] ** 2 + rows["vy_mps"] ** 2 + rows["vz_mps"] ** 2)
        step = np.linalg.norm([np.diff(rows[axis])[0] for axis in ("x_m", "y_m", "z_m")])
        self.assertAlmostEqual(step / 0.1, speed.mean(), delta=0.1)
        norm = sum(rows[name] ** 2 for name in ("qx", "qy", "qz", "qw"))
        np.testing.assert_allclose(norm, 1, atol=1e-6)

    def test_samples_of_motion_sensors_are_beside_the_ins(self):
        for name in ("imu", "ins"):
            scenario = self.folder / f"{name}.json"
            scenario.write_text(json.dumps({"version": 1, "file": str(SCENARIO),
                                            "motion_sensors": {"imus": [{"name": name}]}}), "utf-8")
            generate("sequence", scenario, "--out", self.folder / f"with_{name}", "--frames", 1)
        ended = run_script("export_osdar.py", self.folder / "with_imu", "--out", self.folder / "moving")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertEqual((self.folder / "moving" / "gps_imu" / "imu.csv").read_bytes(),
                         (self.folder / "with_imu" / "motion" / "imu.csv").read_bytes())
        ended = run_script("export_osdar.py", self.folder / "with_ins", "--out", self.folder / "refused")
        self.assertEqual((ended.returncode, ended.stderr), (
            1, f"{self.folder}/with_ins: must have no motion sensor that is called as the INS that is written "
               "(got ins)\n"))

    def test_several_sensors_are_merged_in_the_vehicles_axes(self):
        scenario = self.folder / "two.json"
        scenario.write_text(json.dumps(TWO), "utf-8")
        runs = []
        for name in ("left", "right"):
            runs.append(self.folder / name)
            generate("sequence", scenario, "--out", runs[-1], "--frames", FRAMES, "--sensor", name)
        for option in ((), ("--ascii",)):
            out = self.folder / f"merged{''.join(option)}"
            ended = run_script("export_osdar.py", *runs, "--out", out, *option)
            self.assertEqual(ended.returncode, 0, ended.stderr)
            ended = run_script("check_osdar.py", out / f"{out.name}_labels.json")
            self.assertEqual(ended.returncode, 0, ended.stderr)
            clouds = railcast.open(out / "lidar_merged")
            for place, cloud in enumerate(clouds):
                frames = [railcast.open(run)[place] for run in runs]
                number = cloud["sensor_index"][cloud.has_point]
                self.assertEqual([np.sum(number == index) for index in (0, 1)], [frame.num_points for frame in frames])
                # Times count from the file's first, which is the left one's; the right one begins 40 ms later.
                since_ns = [cloud["time_ns"][cloud.has_point][number == index].min() for index in (0, 1)]
                self.assertAlmostEqual(since_ns[1] - since_ns[0], 4e7, delta=2e6)
                # The sensors are 1 m to the left and right, and turned by 5 degrees. The right one begins 40 ms later,
                # in which the vehicle moves by 0.444 m, at 11.1 m/s.
                for index, frame in enumerate(frames):
                    turn = np.radians(5 - 10 * index)
                    x, y, z = frame.points(compensate="sensor").astype(float).T
                    expected = np.stack([np.cos(turn) * x - np.sin(turn) * y + 2.2,
                                         np.sin(turn) * x + np.cos(turn) * y + 1.0 - 2 * index, z + 2.5], axis=1)
                    moved_m = cloud.points()[number == index].mean(axis=0) - expected.mean(axis=0)
                    np.testing.assert_allclose(moved_m, [0.444 * index, 0, 0], atol=0.01)

    def test_frames_are_those_that_all_sensors_have(self):
        generate("sequence", SCENARIO, "--out", self.folder / "next", "--frames", FRAMES, "--start-frame", 31)
        out = self.folder / "common"
        ended = run_script("export_osdar.py", self.folder / "run", self.folder / "next", "--out", out)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        frames = json.loads((out / "common_labels.json").read_text("utf-8"))["openlabel"]["frames"]
        self.assertEqual(list(frames), ["31"])
        cloud = railcast.open(out / "lidar_merged")[0]
        self.assertEqual(cloud.num_points, 2 * self.recording[1].num_points)

    def test_bad_runs_are_named_and_nothing_is_written(self):
        generate("sequence", SCENARIO, "--out", self.folder / "later", "--frames", FRAMES, "--start-frame", 40)
        for runs, line in (
            ((self.folder / "run", self.folder / "later"), f"{self.folder / 'run'}: must have a frame during which one "
                                                           "of each other run begins\n"),
            ((self.folder / "run" / "frames",), f"{self.folder}/run/frames: must be a sequence of railcast (got "
                                                "directory of point clouds)\n"),
            ((self.folder / "nowhere",), f"{self.folder}/nowhere: no such file or directory\n"),
        ):
            ended = run_script("export_osdar.py", *runs, "--out", self.folder / "bad")
            self.assertEqual((ended.returncode, ended.stderr), (1, line))
            self.assertFalse((self.folder / "bad").exists())

    def faults_after(self, change):
        changed = copy.deepcopy(self.whole)
        change(changed["openlabel"])
        path = self.folder / "osdar26" / "changed.json"
        path.write_text(json.dumps(changed), "utf-8")
        return "\n".join(check_osdar.faults_of(path, *self.definitions))

    def test_each_rule_finds_its_fault(self):
        uids = {entry["name"]: uid for uid, entry in self.label["objects"].items()}

        def data(label, name, kind, index=0):
            return label["frames"]["30"]["objects"][uids[name]]["object_data"][kind][index]

        def attribute(label, name, kind, key, index=0):
            groups = data(label, name, kind, index)["attributes"].values()
            return next(entry for group in groups for entry in group if entry["name"] == key)

        def remove(label, name):
            del label["frames"]["30"]["objects"][uids[name]]

        def rename_sensor(label):
            for place in (label["streams"], label["coordinate_systems"]):
                place["gnss"] = place.pop("gps_imu")

        def swap(label):
            first, second = (attribute(label, "track/main/0", "poly3d", "railSide", index) for index in (0, 1))
            first["val"], second["val"] = second["val"], first["val"]

        for change, rule in (
            (lambda label: label.pop("metadata"), "'metadata' is a required property"),
            (lambda label: label["objects"][uids["person"]].update(type="robot"), "must be a class of the ontology"),
            (lambda label: attribute(label, "person", "cuboid", "age").update(val="old"), "age: must be one of"),
            (lambda label: attribute(label, "person", "cuboid", "age").update(name="years"), "age: missing"),
            (lambda label: attribute(label, "person", "cuboid", "age").update(val="child"),
             "age: must be the same in the whole object"),
            (lambda label: label["frames"]["30"].update(objects={}), "lidar_merged: must have annotations"),
            (lambda label: remove(label, "track/main/0"), "lidar_merged: must have the ego track"),
            (lambda label: attribute(label, "track/main/0", "poly3d", "railSide").update(val="rightRail"),
             "must have both rails of the ego track"),
            (lambda label: attribute(label, "track/second/1", "poly3d", "railSide").update(val="rightRail"),
             "must have at most one rightRail (got 2)"),
            (swap, "left and right rail must not be swapped"),
            (lambda label: label["frames"]["30"]["frame_properties"]["streams"]["gps_imu"].update(uri="ins.csv"),
             'must begin with /gps_imu/ (got "ins.csv")'),
            (lambda label: label["frames"]["30"]["frame_properties"]["streams"]["gps_imu"].update(uri="/gps_imu/a"),
             'must be a file (got "/gps_imu/a")'),
            (rename_sensor, "gnss: must be a sensor of OSDaR"),
            (lambda label: label["streams"]["gps_imu"].update(type="other"), 'must be gps_imu (got "other")'),
            (lambda label: data(label, "person", "cuboid")["val"].__setitem__(9, 3.0),
             "height must be from 1.1 to 2.7 m (got 3.0)"),
            (lambda label: data(label, "person", "vec")["val"].append(10**6), "must be different indices from 0 to"),
            (lambda label: attribute(label, "train_flat", "vec", "occlusion").update(val="undefined"),
             "occlusion: must be a quarter of what is seen, as "),
        ):
            self.assertIn(rule, self.faults_after(change))


if __name__ == "__main__":
    if not DEFINITIONS.is_dir():
        print(f"skipped: {DEFINITIONS} is not there")
        sys.exit(SKIPPED)
    try:
        import check_osdar
        import osdar_truth
    except ImportError as error:
        print(f"skipped: {sys.executable}: {error} (python3-jsonschema, python3-yaml)")
        sys.exit(SKIPPED)
    unittest.main()
