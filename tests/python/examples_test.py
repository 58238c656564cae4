"""The programs of examples/ that use the module run, and say what they should."""

import csv
import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import unittest

from support import BUILD, ROOT, SCENARIO, generate, np

import railcast


def load(name):
    """A program of examples/ as a module."""
    spec = importlib.util.spec_from_file_location(name, ROOT / "examples" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Examples(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        (cls.folder / "scenarios").symlink_to(ROOT / "scenarios")
        generate("sequence", SCENARIO, "--out", cls.folder / "out/demo", "--frames", 2)

    def lines_of(self, name, *arguments):
        """What the program prints in a folder with the scenarios and a recording."""
        command = [sys.executable, ROOT / "examples" / f"{name}.py", *arguments]
        ended = subprocess.run(command, cwd=self.folder, check=False, capture_output=True, text=True)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        return ended.stdout.splitlines()

    def test_a_simulated_frame_is_counted_by_label(self):
        frame = railcast.Simulator(SCENARIO).scan(30)
        counts = [int(line.split()[1]) for line in self.lines_of("simulate_frame")]
        self.assertEqual(sum(counts), frame.num_points)

    def test_a_simulator_is_driven_into_fog(self):
        in_clear_air, in_fog = map(int, self.lines_of("drive_simulator")[-1].split())
        self.assertLess(in_fog, in_clear_air)

    def test_a_recording_is_read_frame_by_frame(self):
        lines = self.lines_of("read_recording")
        self.assertEqual([line.split()[0] for line in lines], ["0", "1", "1"])  # The last: label and sensor.

    def test_frames_are_loaded_for_training(self):
        self.assertEqual(self.lines_of("load_dataset", "out/demo")[0].split()[0], "2")

    def test_a_driven_track_has_in_its_gauge_what_the_given_one_has(self):
        """The rails' heads lie on the gauge's edge, so that centimetres change how many points are in it."""
        run = self.folder / "out/hills"
        generate("sequence", ROOT / "scenarios/hills.json", "--frames", 30, "--stride", 8, "--out", run)
        driven = self.folder / "driven.json"
        driven.write_text("\n".join(self.lines_of("driven_track", run, "2.6")), encoding="utf-8")
        counts = []
        for track in (run / "scenario.resolved.json", driven):
            out = self.folder / f"stats_{track.stem}"
            subprocess.run([BUILD / "analysis/railcast-analyze", "stats", run, "--track", track, "--out", out],
                           check=True, capture_output=True)
            with open(out / "csv/points_in_gauge.csv", encoding="utf-8", newline="") as lines:
                counts.append({row["label"]: int(row["0_to_10_m"]) + int(row["10_to_25_m"])
                               for row in csv.DictReader(lines) if "share" not in row["label"]})
        given, own = counts
        self.assertGreater(given["rail"], 1000)
        self.assertLess(abs(own["rail"] / given["rail"] - 1), 0.3)
        self.assertLess(sum(own.values()) - own["rail"], 0.05 * own["rail"])

    def test_batches_say_which_sample_each_row_is_of(self):
        dataset = railcast.Dataset(self.folder / "out/demo")
        samples = [dataset[place] for place in (0, 1)]
        batch = load("load_dataset").collate(samples)
        for place, sample in enumerate(samples):
            for rows, of_sample in (("points", "points"), ("labels", "points"), ("boxes", "boxes"),
                                    ("box_labels", "boxes")):
                np.testing.assert_array_equal(batch[rows][batch[f"sample_of_{of_sample}"] == place], sample[rows])
            self.assertGreater(len(sample["boxes"]), 0)
        self.assertEqual(len(batch["points"]), sum(len(sample["points"]) for sample in samples))


if __name__ == "__main__":
    unittest.main()
