#!/usr/bin/env python3
"""Runs scripts/export_kitti_objects.py and looks for each box's points as loaders of KITTI do."""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SKIPPED = 77  # For ctest.

try:
    import numpy as np
    import yaml  # noqa: F401  The script needs it.
except ImportError as error:
    print(f"skipped: {sys.executable}: {error} (python3-numpy, python3-yaml)")
    sys.exit(SKIPPED)

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "scripts" / "export_kitti_objects.py"
GENERATE = pathlib.Path(sys.argv.pop(1)) / "generator" / "railcast-generate"
SCENARIO = ROOT / "scenarios" / "st_gallen_approach.json"
FRAMES = 2


def export(*arguments):
    return subprocess.run([SCRIPT, *map(str, arguments)], capture_output=True, text=True, check=False)


def generate(out, *options, scenario=SCENARIO):
    command = [GENERATE, "sequence", scenario, "--out", out, "--frames", FRAMES, *options]
    subprocess.run([str(word) for word in command], check=True, capture_output=True)


class Exported(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.runs = [cls.folder / "a", cls.folder / "b"]
        for run, start in zip(cls.runs, (20, 60)):
            generate(run, "--start-frame", start, "--format", "kitti")
        cls.set = cls.folder / "set"
        ended = export(cls.set, "--train", cls.runs[0], "--val", cls.runs[1])
        assert ended.returncode == 0, ended.stderr

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def labels(self, number):
        """Classes, and the 14 numbers of each line."""
        lines = (self.set / "training" / "label_2" / f"{number:06}.txt").read_text("ascii").splitlines()
        words = [line.split() for line in lines]
        self.assertTrue(all(len(each) == 15 for each in words))
        return [each[0] for each in words], np.array([each[1:] for each in words], float)

    def test_shares_of_older_programs_are_refused_and_nothing_is_left(self):
        run = self.folder / "older"
        shutil.copytree(self.runs[0], run)
        path = run / "objects.jsonl"
        lines = path.read_text("utf-8").splitlines()
        second = json.loads(lines[1])
        second["objects"][1]["occlusion"] = -4.0
        path.write_text("\n".join([lines[0], json.dumps(second)]) + "\n", "utf-8")
        ended = export(self.folder / "bad", "--train", run)
        self.assertEqual((ended.returncode, ended.stderr),
                         (1, f"{path}:2: /objects/1/occlusion: must be from 0 to 1 (got -4.0)\n"))
        self.assertEqual(list(self.folder.glob("bad*")), [])

    def test_a_type_of_ones_own_table_has_the_class_that_it_says(self):
        corners = [(x, y, z) for x in (-2, 2) for y in (-1, 1) for z in (0, 2)]
        mesh = "".join(f"v {x} {y} {z}\n" for x, y, z in corners)
        mesh += "usemtl body\nf 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"
        (self.folder / "dumper.obj").write_text(mesh, "ascii")
        table = {"version": 1, "models": [{"name": "dumper", "file": "dumper.obj", "label": "road_vehicle",
                                           "size_m": [4, 2, 2], "kitti": "Truck",
                                           "parts": [{"of": "body", "material": "car_paint"}]}]}
        (self.folder / "models.json").write_text(json.dumps(table), "utf-8")
        scenario = self.folder / "dumper.json"
        scenario.write_text(json.dumps({
            "version": 1, "file": str(ROOT / "scenarios" / "minimal.json"), "models": "models.json",
            "world": {"alignment": {"course": {"type": "elements",
                                               "elements": [{"type": "straight", "length_m": 1000}]}},
                      "objects": [{"name": "dumper", "type": "dumper", "s_m": 430, "d_m": 4}]}}), "utf-8")
        run = self.folder / "dumper"
        generate(run, "--format", "kitti", scenario=scenario)
        ended = export(self.folder / "own", "--train", run)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        words = (self.folder / "own" / "training" / "label_2" / "000000.txt").read_text("ascii").split()
        self.assertEqual(words[0], "Truck")
        self.assertEqual([float(word) for word in words[8:11]], [2, 2, 4])
        inputs = json.loads((run / "run.json").read_text("utf-8"))["inputs"]
        self.assertIn("dumper.obj", [each["name"] for each in inputs])

    def test_frames_are_numbered_through_and_split(self):
        self.assertEqual((self.set / "ImageSets" / "train.txt").read_text("ascii"), "000000\n000001\n")
        self.assertEqual((self.set / "ImageSets" / "val.txt").read_text("ascii"), "000002\n000003\n")
        self.assertEqual((self.set / "ImageSets" / "test.txt").read_text("ascii"), "")
        for number, (run, place) in enumerate((run, place) for run in self.runs for place in range(FRAMES)):
            cloud = self.set / "training" / "velodyne" / f"{number:06}.bin"
            own = run / "sequences" / "00" / "velodyne" / f"{place:06}.bin"
            self.assertEqual(cloud.read_bytes(), own.read_bytes())

    def test_points_of_objects_lie_in_their_boxes(self):
        num_standing = num_moving = 0
        for number, (run, place) in enumerate((run, place) for run in self.runs for place in range(FRAMES)):
            points = np.fromfile(self.set / "training" / "velodyne" / f"{number:06}.bin", np.float32).reshape(-1, 4)
            instance = np.fromfile(run / "sequences" / "00" / "labels" / f"{place:06}.label", np.uint32) >> 16
            seen = json.loads((run / "objects.jsonl").read_text("utf-8").splitlines()[place])["objects"]
            seen = [each for each in seen if each["points"] > 0]
            classes, numbers = self.labels(number)
            self.assertEqual(len(classes), len(seen))
            calibration = dict(line.split(": ") for line in (self.set / "training" / "calib" / f"{number:06}.txt")
                               .read_text("ascii").splitlines())
            camera_from_lidar = np.array(calibration["Tr_velo_to_cam"].split(), float).reshape(3, 4)
            in_camera = points[:, :3] @ camera_from_lidar[:, :3].T
            for each, label in zip(seen, numbers):
                speed = np.linalg.norm(each["velocity_mps"])
                height, width, length, x, y, z, turn = label[7:]
                # KITTI's corners: x = length cos + width sin, z = -length sin + width cos, y up from the underside.
                offset = in_camera[instance == each["instance"]] - (x, y, z)
                along = np.cos(turn) * offset[:, 0] - np.sin(turn) * offset[:, 2]
                across = np.sin(turn) * offset[:, 0] + np.cos(turn) * offset[:, 2]
                self.assertEqual(len(offset), each["points"])
                # Noise, the slope of the line, which such boxes have not, and what an object moves while the raster
                # passes over half of it, in 6 ms at most.
                slack = 0.15 + 0.03 * length + 0.006 * speed
                self.assertLess(np.abs(along).max(), length / 2 + slack)
                self.assertLess(np.abs(across).max(), width / 2 + slack)
                self.assertLess((-offset[:, 1]).max(), height + slack)
                self.assertGreater((-offset[:, 1]).min(), -slack)
                num_standing += speed == 0
                num_moving += speed > 10  # These move by 1.5 m during a scan.
        self.assertGreaterEqual(num_standing, 8)
        self.assertGreaterEqual(num_moving, 8)

    def test_boxes_in_the_image_hold_the_objects_points(self):
        classes, numbers = self.labels(0)
        self.assertIn("Pedestrian", classes)
        self.assertIn("Tram", classes)
        points = np.fromfile(self.set / "training" / "velodyne" / "000000.bin", np.float32).reshape(-1, 4)
        instance = np.fromfile(self.runs[0] / "sequences" / "00" / "labels" / "000000.label", np.uint32) >> 16
        seen = json.loads((self.runs[0] / "objects.jsonl").read_text("utf-8").splitlines()[0])["objects"]
        for each, label in zip([each for each in seen if each["points"] > 0], numbers):
            truncated, occluded, left, top, right, bottom = *label[:2], *label[3:7]
            self.assertIn(occluded, (0, 1, 2, 3))
            self.assertGreaterEqual(truncated, 0)
            x, y, z = points[instance == each["instance"], :3].T
            u, v = 609.5593 - 721.5377 * y / x, 172.854 - 721.5377 * z / x
            if truncated > 0:
                continue
            self.assertGreater(u.min(), left - 4)
            self.assertLess(u.max(), right + 4)
            self.assertGreater(v.min(), top - 4)
            self.assertLess(v.max(), bottom + 4)

    def test_other_runs_are_named(self):
        generate(self.folder / "pcd")
        ended = export(self.folder / "none", "--train", self.folder / "pcd", self.folder / "missing")
        self.assertEqual(ended.returncode, 1)
        self.assertEqual(ended.stderr, f"{self.folder}/pcd: must be a run with --format kitti, with a "
                                       "semantic-kitti-railcast.yaml\n"
                                       f"{self.folder}/missing: must be a complete run, with a manifest.json\n")
        self.assertEqual(export(self.set, "--train", self.runs[0]).stderr, f"{self.set}: must not exist\n")
        self.assertFalse((self.folder / "none").exists())


if __name__ == "__main__":
    unittest.main()
