"""railcast.Dataset gives the frames of recordings by index, also in other processes."""

import contextlib
import json
import multiprocessing
import pathlib
import sqlite3
import subprocess
import tempfile
import unittest

from support import BUILD, ROOT, SCENARIO, generate, np

import railcast

FRAMES = 2


def first_point(dataset, index):
    return dataset[index]["points"][0].tolist()


class Samples(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.runs = [pathlib.Path(cls.temporary.name) / name for name in ("a", "b")]
        for run, seed in zip(cls.runs, (1, 2)):
            generate("sequence", SCENARIO, "--out", run, "--frames", FRAMES, "--start-frame", 30, "--seed", seed)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_a_sample_is_a_frame_of_one_of_the_recordings(self):
        dataset = railcast.Dataset(*self.runs)
        self.assertEqual(len(dataset), 2 * FRAMES)
        for index in range(len(dataset)):
            source, place = divmod(index, FRAMES)
            frame = railcast.open(self.runs[source])[place]
            sample = dataset[index]
            self.assertEqual((sample["source"], sample["frame"]), (source, frame.index))
            np.testing.assert_array_equal(sample["points"][:, :3], frame.points(compensate="all"))
            np.testing.assert_array_equal(sample["points"][:, 3], frame["intensity"][frame.has_point])
            np.testing.assert_array_equal(sample["labels"], frame["label"][frame.has_point])
            self.assertEqual((sample["points"].dtype, sample["labels"].dtype), (np.float32, np.int64))
        raw = railcast.Dataset(*self.runs, compensate="none")
        np.testing.assert_array_equal(raw[0]["points"][:, :3], railcast.open(self.runs[0])[0].points())
        np.testing.assert_array_equal(dataset[-1]["points"], dataset[len(dataset) - 1]["points"])
        with self.assertRaises(IndexError):
            dataset[len(dataset)]

    def test_boxes_are_those_of_the_objects_with_points(self):
        dataset = railcast.Dataset(self.runs[0])
        seen = [thing for thing in railcast.open(self.runs[0])[0].objects if thing.points > 0]
        self.assertGreater(len(seen), 0)
        sample = dataset[0]
        self.assertEqual(sample["boxes"].shape, (len(seen), 7))
        np.testing.assert_array_equal(sample["boxes"][:, 3:6], np.float32([thing.size_m for thing in seen]))
        self.assertEqual(sample["box_labels"].tolist(), [dataset.labels[thing.label] for thing in seen])

    def write_index(self, folder):
        """The keys of index.jsonl that matter here, as docs/records.md has them."""
        lines = [{"folder": name, "split": split, "sensor": sensor}
                 for name, split, sensor in (("a", "train", "front"), ("b", "val", "roof")) for _ in range(FRAMES)]
        (folder / "index.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines), "utf-8")
        self.addCleanup((folder / "index.jsonl").unlink)

    def write_database(self, folder):
        """The columns of index.sqlite that matter here."""
        with contextlib.closing(sqlite3.connect(folder / "index.sqlite")) as index, index:
            index.execute("CREATE TABLE scenarios (scenario INTEGER PRIMARY KEY, split TEXT)")
            index.execute("CREATE TABLE sequences (id INTEGER PRIMARY KEY, scenario INTEGER, sensor TEXT, folder TEXT, "
                          "num_frames INTEGER)")
            index.executemany("INSERT INTO scenarios VALUES (?, ?)", [(1, "val"), (0, "train")])
            index.executemany("INSERT INTO sequences VALUES (?, ?, ?, ?, ?)",
                              [(1, 1, "roof", "b", FRAMES), (0, 0, "front", "a", FRAMES)])
        self.addCleanup((folder / "index.sqlite").unlink)

    def test_a_part_of_a_data_set_has_its_frames_only(self):
        folder = pathlib.Path(self.temporary.name)
        for write in (self.write_index, self.write_database):
            write(folder)
            self.check_parts(folder)
            self.doCleanups()

    def test_a_damaged_index_is_named(self):
        folder = pathlib.Path(self.temporary.name)
        for name, fault in (("index.jsonl", "Expecting value: line 1 column 1 (char 0)"),
                            ("index.sqlite", "file is not a database")):
            (folder / name).write_text("damaged", "utf-8")
            self.addCleanup((folder / name).unlink)
            with self.assertRaises(railcast.InputError) as raised:
                railcast.Dataset(folder)
            self.assertEqual(str(raised.exception), f"{folder / name}: is damaged: {fault}")

    def check_parts(self, folder):
        self.assertEqual(railcast.Dataset(folder).paths, [str(run) for run in self.runs])
        validation = railcast.Dataset(folder, split="val")
        self.assertEqual(len(validation), FRAMES)
        np.testing.assert_array_equal(validation[1]["points"], railcast.Dataset(self.runs[1])[1]["points"])
        self.assertEqual(railcast.Dataset(folder, sensor="front").paths, [str(self.runs[0])])
        self.assertEqual(len(railcast.Dataset(folder, split="val", sensor="front")), 0)
        for source, wanted, line in (
            (folder, {"split": "test"}, f"split: must be one of train, val, those of {folder} (got 'test')"),
            (folder, {"sensor": "rear"}, f"sensor: must be one of front, roof, those of {folder} (got 'rear')"),
            (self.runs[0], {"split": "test"}, f"split: must be left out for what is no data set, {self.runs[0]} "
                                              "(got 'test')")):
            with self.assertRaises(railcast.InputError) as raised:
                railcast.Dataset(source, **wanted)
            self.assertEqual(str(raised.exception), line)

    def test_no_more_recordings_are_kept_open_than_the_memory_is_meant_for(self):
        dataset = railcast.Dataset(*self.runs * 40)
        for index in range(0, len(dataset), FRAMES):
            self.assertEqual(dataset[index]["source"], index // FRAMES)
        self.assertEqual(len(dataset._opened), 64)  # pylint: disable=protected-access

    def test_a_transform_replaces_the_sample(self):
        dataset = railcast.Dataset(self.runs[0], transform=lambda sample: sample["points"].shape[1])
        self.assertEqual(dataset[0], 4)

    def test_workers_read_what_this_process_reads(self):
        dataset = railcast.Dataset(*self.runs)
        here = [first_point(dataset, index) for index in range(len(dataset))]
        for method in ("fork", "spawn"):
            with multiprocessing.get_context(method).Pool(2) as pool:
                there = pool.starmap(first_point, [(dataset, index) for index in range(len(dataset))])
            self.assertEqual(there, here, method)


def motion(speed_mps, **more):
    return {"motion": {"profile": [{"time_s": 0, "speed_mps": speed_mps}], **more}}


def at_30_mps(sensor):
    """A scenario: the vehicle and an oncoming wagon at 30 m/s, other things that stand, walk and run ahead."""
    folder = ROOT / "scenarios"
    return {
        "version": 1, "fidelity": "plausibility",
        "lidar": {"file": str(folder / "sensors" / f"{sensor}.json"), "mount": {"position_m": [2, 0, 3.5]}},
        "world": {
            "alignment": {"course": {"type": "elements",
                                     "elements": [{"type": "arc", "length_m": 2000, "radius_m": 1500}]}},
            "tracks": [{"name": "main"}, {"name": "second", "offset_m": 4.0}],
            "objects": [
                {"name": "parked", "type": "open_wagon", "s_m": 1080, "d_m": -4.5},
                {"name": "person", "type": "person", "s_m": 1045, "d_m": -2.5},
                {"name": "walker", "type": "person", "s_m": 1060, "d_m": 2.0, **motion(1.5)},
                {"name": "ahead", "type": "flat_wagon", "s_m": 1040, **motion(25)},
                {"name": "coming", "type": "tank_wagon", "track": "second", "s_m": 1090, **motion(30, reverse=True)}]},
        "vehicle": {"start_s_m": 1000, **motion(30)},
        "materials": str(folder / "materials" / "railway.json"), "labels": str(folder / "labels.json")}


class AtSpeed(unittest.TestCase):

    MARGIN_M = 0.1  # Five standard deviations of the sensors' range noise, 2 cm.
    MOVING = ("walker", "ahead", "coming")

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        for sensor in ("vir2rail", "pandar64"):
            scenario = cls.folder / f"{sensor}.json"
            scenario.write_text(json.dumps(at_30_mps(sensor)), "utf-8")
            for kind in ("pcd", "kitti"):
                generate("sequence", scenario, "--out", cls.folder / f"{sensor}_{kind}", "--frames", 3, "--format", kind)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def points_in_boxes(self, run, slack_s=0.0, **options):
        """Numbers of points and of those in their object's box, by name. The box may be longer by what a speed of
        60 m/s, that of the wagon that comes, makes of `slack_s`."""
        counts = {}
        dataset = railcast.Dataset(self.folder / run, fields=("x", "y", "z", "instance"), **options)
        for sample, frame in zip(dataset, railcast.open(self.folder / run)):
            seen = [thing for thing in frame.objects if thing.points > 0]
            self.assertEqual(sample["box_labels"].tolist(), [dataset.labels[thing.label] for thing in seen])
            for thing, box, label in zip(seen, sample["boxes"], sample["box_labels"]):
                is_own = sample["points"][:, 3] == thing.instance
                self.assertEqual(set(sample["labels"][is_own]), {label})
                offset = sample["points"][is_own, :3] - box[:3]
                turn = np.array([[np.cos(box[6]), -np.sin(box[6]), 0], [np.sin(box[6]), np.cos(box[6]), 0], [0, 0, 1]])
                reach = box[3:6] / 2 + self.MARGIN_M + np.array([60 * slack_s, 0, 0])
                inside = (np.abs(offset @ turn) <= reach).all(axis=1)
                before = counts.get(thing.name, (0, 0))
                counts[thing.name] = (before[0] + len(inside), before[1] + int(inside.sum()))
        self.assertEqual(set(counts), {"parked", "person", *self.MOVING})
        return counts

    def share_in_boxes(self, run, names=None, **options):
        counts = [count for name, count in self.points_in_boxes(run, **options).items() if names is None or name in names]
        return sum(inside for _, inside in counts) / sum(points for points, _ in counts)

    def test_points_lie_in_the_boxes_of_what_stands_and_of_what_moves(self):
        for sensor in ("vir2rail", "pandar64"):
            for name, (points, inside) in self.points_in_boxes(f"{sensor}_pcd").items():
                self.assertGreaterEqual(inside, 0.999 * points, (sensor, name))

    def test_with_the_sensors_motion_alone_undone_boxes_go_with_their_points(self):
        self.assertGreaterEqual(self.share_in_boxes("vir2rail_pcd", compensate="sensor"), 0.998)
        # Pandar64 begins and ends its turn ahead, where it meets the wagons twice, 0.1 s apart.
        self.assertEqual(self.share_in_boxes("pandar64_pcd", ("parked", "person"), compensate="sensor"), 1.0)

    def test_measured_points_lie_where_their_boxes_were_seen(self):
        # The raster passes over the nearest wagon in less than 10 ms, half of it before the mean time.
        self.assertGreaterEqual(self.share_in_boxes("vir2rail_pcd", slack_s=0.005, compensate="none"), 0.999)
        raw = railcast.Dataset(self.folder / "vir2rail_pcd", compensate="none")[0]["boxes"]
        undone = railcast.Dataset(self.folder / "vir2rail_pcd", compensate="sensor")[0]["boxes"]
        self.assertGreater(np.abs(raw - undone)[:, 0].max(), 1.0)

    def test_kitti_has_the_boxes_of_the_sensors_motion_alone(self):
        for sensor in ("vir2rail", "pandar64"):
            of_pcd, of_kitti = (railcast.Dataset(self.folder / f"{sensor}_{kind}", compensate="sensor")[1]
                                for kind in ("pcd", "kitti"))
            np.testing.assert_array_equal(of_kitti["boxes"], of_pcd["boxes"])
            np.testing.assert_array_equal(of_kitti["points"], of_pcd["points"])
            for compensate in ("all", "none"):
                same = railcast.Dataset(self.folder / f"{sensor}_kitti", compensate=compensate)[1]
                np.testing.assert_array_equal(same["boxes"], of_kitti["boxes"])
                np.testing.assert_array_equal(same["points"], of_kitti["points"])
        self.assertGreaterEqual(self.share_in_boxes("vir2rail_kitti"), 0.998)
        labels = railcast.Dataset(self.folder / "vir2rail_kitti").labels
        self.assertEqual((labels["person"], labels["moving person"]), (30, 254))

    def test_what_cannot_be_undone_is_named(self):
        run = self.folder / "no_times"
        generate("sequence", self.folder / "vir2rail.json", "--out", run, "--frames", 1, "--fields", "x,y,z,instance")
        file = run / "frames" / "000000.pcd"
        for compensate, line in (
                ("all", f"{file}: time_ns: must be among the fields to undo the motion of the scan"),
                ("some", 'compensate: must be one of all, sensor, none (got "some")')):
            with self.assertRaises(railcast.InputError) as raised:
                railcast.Dataset(run, fields=("x",), compensate=compensate)[0]
            self.assertEqual(str(raised.exception), line)
        self.assertEqual(len(railcast.Dataset(run, fields=("x",), compensate="none")[0]["boxes"]), 5)


def analyze(*arguments):
    command = [str(word) for word in (BUILD / "analysis" / "railcast-analyze", *arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class Insertions(unittest.TestCase):
    """What was put into recordings that are no sequences has its boxes, labels, poses and times, too."""

    FRAMES = 3

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        scenario = at_30_mps("vlp16")
        scenario["world"]["objects"] = []
        (cls.folder / "vlp16.json").write_text(json.dumps(scenario), "utf-8")
        generate("stream", cls.folder / "vlp16.json", "--protocol", "vlp16", "--pcap", cls.folder / "drive.pcap",
                 "--duration", 1)
        generate("sequence", cls.folder / "vlp16.json", "--out", cls.folder / "drive", "--frames", 8, "--format", "mcap")
        for recording, poses in (("drive.pcap", {"poses": "standing"}), ("drive/frames.mcap", {})):
            name = pathlib.Path(recording).suffix[1:]
            plan = {key: scenario[key] for key in ("version", "lidar", "materials", "labels")}
            plan["world"] = {"recording": poses}
            recipe = {"version": 1, "num_scenarios": 2, "num_frames": cls.FRAMES,
                      "bases": [{"file": f"plan_{name}.json", "recordings": [recording]}],
                      "objects": [{"name": "person", "count": {"type": "choice", "values": [1]},
                                   "object": {"type": "person", "h_m": 0, **motion(1.5)},
                                   "draws": {"/d_m": {"type": "uniform", "min": -1, "max": 1}},
                                   "ahead_m": {"type": "uniform", "min": 17, "max": 18}}]}
            (cls.folder / f"plan_{name}.json").write_text(json.dumps(plan), "utf-8")
            (cls.folder / f"recipe_{name}.json").write_text(json.dumps(recipe), "utf-8")
            for kind, options in (("same", []), ("pcd", ["--format", "pcd"])):
                generate("dataset", cls.folder / f"recipe_{name}.json", "--out", cls.folder / f"{name}_{kind}",
                         *options)
        cls.sets = [cls.folder / f"{name}_{kind}" for name in ("pcap", "mcap") for kind in ("same", "pcd")]

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_points_of_what_was_put_in_lie_in_its_boxes(self):
        # Half a step of the person and five standard deviations of the range noise, 3 cm.
        margin_m = 0.25
        for source in self.sets:
            dataset = railcast.Dataset(source)
            self.assertEqual(len(dataset), 2 * self.FRAMES, source)
            for sample in dataset:
                self.assertEqual(sample["box_labels"].tolist(), [dataset.labels["person"]], source)
                points = sample["points"][sample["labels"] == dataset.labels["person"], :3]
                # At 18 m rows are 0.63 m apart and columns 0.06 m: at least 2 rows of 4 on a person of 1.75 m.
                self.assertGreaterEqual(len(points), 8, source)
                box = sample["boxes"][0]
                self.assertLess(np.abs(points - box[:3]).max(axis=0)[2], box[5] / 2 + margin_m, source)
                self.assertLess(np.hypot(*(points - box[:3]).T[:2]).max(), np.hypot(*box[3:5]) / 2 + margin_m, source)

    def test_frames_have_the_numbers_of_the_recordings_frames(self):
        for source in self.sets:
            lines = [json.loads(line) for line in (source / "index.jsonl").read_text("utf-8").splitlines()]
            self.assertEqual([sample["frame"] for sample in railcast.Dataset(source)],
                             [line["frame"] for line in lines])

    def test_reports_take_them(self):
        for source in self.sets:
            out = self.folder / "reports" / source.name
            analyze("stats", source, "--out", out / "stats")
            card = analyze("card", source, "--out", out / "card")
            self.assertIn("person", (out / "card" / "README.md").read_text("utf-8"), card)
            run = source / "sequences" / "000" / "000000"
            for folder in (run, run / "recording"):
                self.assertIn("person/1", analyze("detect", folder, "--frames", "1/1", "--format", "json"))
                self.assertIn("person/1", analyze("evaluate", folder, "--frames", "1/1", "--format", "json"))


if __name__ == "__main__":
    unittest.main()
