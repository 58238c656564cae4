"""railcast.Dataset gives the frames of recordings by index, also in other processes."""

import contextlib
import multiprocessing
import pathlib
import sqlite3
import tempfile
import unittest

from support import SCENARIO, generate, np

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
            np.testing.assert_array_equal(sample["points"][:, :3], frame.points())
            np.testing.assert_array_equal(sample["points"][:, 3], frame["intensity"][frame.has_point])
            np.testing.assert_array_equal(sample["labels"], frame["label"][frame.has_point])
            self.assertEqual((sample["points"].dtype, sample["labels"].dtype), (np.float32, np.int64))
        np.testing.assert_array_equal(dataset[-1]["points"], dataset[len(dataset) - 1]["points"])
        with self.assertRaises(IndexError):
            dataset[len(dataset)]

    def test_boxes_hold_the_points_of_their_objects(self):
        dataset = railcast.Dataset(self.runs[0], fields=("x", "y", "z", "instance"))
        sample = dataset[0]
        frame = railcast.open(self.runs[0])[0]
        seen = [thing for thing in frame.objects if thing.points > 0]
        moved_m = np.linalg.norm((frame.world_from_sensor_end - frame.world_from_sensor)[:3, 3])
        self.assertGreater(len(seen), 0)
        self.assertEqual(sample["boxes"].shape, (len(seen), 7))
        for thing, box, label in zip(seen, sample["boxes"], sample["box_labels"]):
            self.assertEqual(label, dataset.labels[thing.label])
            own = sample["points"][sample["points"][:, 3] == thing.instance][:, :3] - box[:3]
            along = own[:, 0] * np.cos(box[6]) + own[:, 1] * np.sin(box[6])
            across = own[:, 1] * np.cos(box[6]) - own[:, 0] * np.sin(box[6])
            # Points are distorted by the motion during the scan. The rest is range noise, and the pitch of
            # the sensor, which a yaw leaves out.
            for distance, length in ((along, box[3]), (across, box[4])):
                self.assertLess(np.abs(distance).max(), length / 2 + moved_m + 0.3)

    def test_a_part_of_a_data_set_has_its_frames_only(self):
        # The columns of index.sqlite that matter here, as docs/dataset.md has them.
        folder = pathlib.Path(self.temporary.name)
        with contextlib.closing(sqlite3.connect(folder / "index.sqlite")) as index, index:
            index.execute("CREATE TABLE scenarios (scenario INTEGER PRIMARY KEY, split TEXT)")
            index.execute("CREATE TABLE sequences (id INTEGER PRIMARY KEY, scenario INTEGER, sensor TEXT, folder TEXT, "
                          "num_frames INTEGER)")
            index.executemany("INSERT INTO scenarios VALUES (?, ?)", [(1, "val"), (0, "train")])
            index.executemany("INSERT INTO sequences VALUES (?, ?, ?, ?, ?)",
                              [(1, 1, "roof", "b", FRAMES), (0, 0, "front", "a", FRAMES)])
        self.addCleanup((folder / "index.sqlite").unlink)
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


if __name__ == "__main__":
    unittest.main()
