"""railcast.open() reads sequences, clouds, KITTI's folders and captures."""

import json
import pathlib
import tempfile
import unittest

from support import ROOT, SCENARIO, generate, np, read_pcd

import railcast

FRAMES = 3
VLP16 = {"version": 1, "file": str(ROOT / "scenarios" / "minimal.json"),
         "lidar": {"file": str(ROOT / "scenarios" / "sensors" / "vlp16.json"), "mount": {"position_m": [0, 0, 3]}}}


class Recordings(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        for kind in ("pcd", "ply", "kitti"):
            generate("sequence", SCENARIO, "--out", cls.folder / kind, "--frames", FRAMES, "--format", kind)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_a_sequence_has_the_fields_of_its_files(self):
        recording = railcast.open(self.folder / "pcd")
        self.assertEqual((recording.kind, len(recording), recording.num_frames), ("sequence", FRAMES, FRAMES))
        for index, frame in enumerate(recording):
            written = read_pcd(self.folder / "pcd" / "frames" / f"{index:06}.pcd")
            self.assertEqual(frame.fields, list(written.dtype.names))
            for name in frame.fields:
                self.assertEqual(frame[name].tobytes(), written[name].tobytes(), name)

    def test_a_sequence_has_labels_materials_scenario_poses_and_objects(self):
        recording = railcast.open(self.folder / "pcd")
        table = json.loads((self.folder / "pcd" / "labels.json").read_text("utf-8"))["labels"]
        self.assertEqual(recording.labels, {label["name"]: label["id"] for label in table})
        self.assertEqual(recording.materials[0], "none")
        resolved = json.loads((self.folder / "pcd" / "scenario.resolved.json").read_text("utf-8"))
        self.assertEqual(recording.scenario["lidar"], resolved["lidar"])
        lines = (self.folder / "pcd" / "objects.jsonl").read_text("utf-8").splitlines()
        for frame, line in zip(recording, map(json.loads, lines)):
            self.assertEqual([thing.name for thing in frame.objects], [thing["name"] for thing in line["objects"]])
            np.testing.assert_allclose(np.linalg.det(frame.world_from_sensor), 1, atol=1e-12)
            for thing, written in zip(frame.objects, line["objects"]):
                np.testing.assert_array_equal(thing.sensor_from_box[:3, 3], written["sensor"]["center_m"])

    def test_certified_frames_have_what_their_error_rests_on(self):
        generate("sequence", SCENARIO, "--out", self.folder / "certified", "--frames", 2, "--certify", "20%")
        lines = (self.folder / "certified" / "frames.jsonl").read_text("utf-8").splitlines()
        for frame, line in zip(railcast.open(self.folder / "certified"), map(json.loads, lines)):
            self.assertEqual(frame.certificate, line["certificate"])
            self.assertEqual(sum(each["firings"] for each in frame.certificate["strata"]), 28800)
        self.assertIsNone(next(iter(railcast.open(self.folder / "pcd"))).certificate)

    def test_frames_are_read_by_their_place(self):
        recording = railcast.open(self.folder / "pcd")
        in_order = [frame["x"].tobytes() for frame in recording]
        self.assertEqual([recording[place]["x"].tobytes() for place in (2, 0, -2)],
                         [in_order[place] for place in (2, 0, 1)])
        with self.assertRaisesRegex(IndexError, r"frame: must be >= 0 and < 3 \(got 3\)"):
            recording[3]

    def test_other_formats_have_the_same_points(self):
        expected = railcast.open(self.folder / "pcd")[1].points()
        np.testing.assert_array_equal(railcast.open(self.folder / "ply")[1].points(), expected)
        kitti = railcast.open(self.folder / "kitti")
        self.assertTrue(kitti.has_kitti_labels)
        # KITTI's points are those of the stamp, without the motion of the scan.
        self.assertEqual(kitti[1].points().shape, expected.shape)
        np.testing.assert_array_equal(kitti[1].points()[0], expected[0])

    def test_clouds_alone_have_no_poses_and_no_objects(self):
        frame = railcast.open(self.folder / "pcd" / "frames" / "000000.pcd")[0]
        self.assertIsNone(frame.world_from_sensor)
        self.assertEqual(frame.objects, [])
        self.assertEqual(len(railcast.open(self.folder / "pcd" / "frames")), FRAMES)

    def test_a_clouds_own_fields_are_there_under_their_names(self):
        path = self.folder / "own.pcd"
        path.write_text("VERSION .7\nFIELDS x y z curvature\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\n"
                        "HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n1 2 3 0.5\n4 5 6 0.25\n", "ascii")
        frame = railcast.open(path)[0]
        self.assertIn("curvature", frame)
        self.assertEqual(sorted(frame["curvature"][frame.has_point]), [0.25, 0.5])

    def test_the_module_says_what_extras_it_has(self):
        self.assertEqual(sorted(railcast.EXTRAS), ["insert", "osi", "packets", "recipe", "ros"])

    def test_a_capture_is_iterated_and_has_no_length(self):
        scenario = self.folder / "vlp16.json"
        scenario.write_text(json.dumps(VLP16), "utf-8")
        capture = self.folder / "capture.pcap"
        generate("stream", scenario, "--protocol", "vlp16", "--pcap", capture, "--duration", "0.5")
        recording = railcast.open(capture)
        self.assertEqual((recording.kind, recording.num_frames), ("capture of VLP-16", None))
        frames = list(recording)
        self.assertGreaterEqual(len(frames), 4)
        self.assertEqual({frame.rows for frame in frames}, {16})
        with self.assertRaisesRegex(TypeError, "number of frames is known"):
            len(recording)

    def test_a_damaged_or_missing_file_is_an_error_of_one_line(self):
        path = self.folder / "damaged.pcd"
        path.write_text("VERSION .7\nFIELDS x y\n", "ascii")
        for source in (path, self.folder / "nowhere", ROOT / "README.md"):
            with self.assertRaises(railcast.InputError) as raised:
                railcast.open(source)[0]
            self.assertTrue(str(raised.exception).startswith(f"{source}: "), raised.exception)
            self.assertNotIn("\n", str(raised.exception))


if __name__ == "__main__":
    unittest.main()
