#!/usr/bin/env python3
"""Runs scripts/join_semantic_kitti.py on small runs and reads the result as semantic-kitti-api does."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SKIPPED = 77  # For ctest.

try:
    import numpy as np
    import yaml
except ImportError as error:
    print(f"skipped: {sys.executable}: {error} (python3-numpy, python3-yaml)")
    sys.exit(SKIPPED)

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "scripts" / "join_semantic_kitti.py"
GENERATE = pathlib.Path(sys.argv.pop(1)) / "generator" / "railcast-generate"
FRAMES = 2


def join(*arguments):
    return subprocess.run([SCRIPT, *map(str, arguments)], capture_output=True, text=True, check=False)


class Joined(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.runs = [cls.folder / name for name in "abc"]
        for run, start in zip(cls.runs, (0, 20, 40)):
            command = [GENERATE, "sequence", ROOT / "scenarios" / "st_gallen_approach.json", "--out", run, "--frames",
                       FRAMES, "--start-frame", start, "--format", "kitti"]
            subprocess.run([str(word) for word in command], check=True, capture_output=True)
        a, b, c = cls.runs
        ended = join(cls.folder / "set", "--train", a, b, "--valid", c)
        assert ended.returncode == 0, ended.stderr
        cls.configuration = yaml.safe_load((cls.folder / "set" / "semantic-kitti-railcast.yaml").read_text("utf-8"))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def labels(self, number):
        files = sorted((self.folder / "set" / "sequences" / f"{number:02}" / "labels").glob("*.label"))
        self.assertEqual(len(files), FRAMES)
        return np.concatenate([np.fromfile(file, np.uint32) for file in files]) & 0xFFFF

    def test_sequences_are_those_of_the_runs_with_their_own_poses(self):
        self.assertEqual(self.configuration["split"], {"train": [0, 1], "valid": [2], "test": []})
        for number, run in enumerate(self.runs):
            for file in (run / "sequences" / "00").rglob("*.*"):
                joined = self.folder / "set" / "sequences" / f"{number:02}" / file.relative_to(run / "sequences" / "00")
                self.assertEqual(joined.read_bytes(), file.read_bytes())
            poses = np.loadtxt(self.folder / "set" / "sequences" / f"{number:02}" / "poses.txt").reshape(-1, 3, 4)
            np.testing.assert_allclose(poses[0], np.eye(4)[:3], atol=1e-12)
            self.assertGreater(np.linalg.norm(poses[1][:, 3]), 0.1)

    def test_every_label_is_learned_and_comes_back(self):
        # As evaluate_semantics.py: look-up tables over learning_map and learning_map_inv.
        learning, inverse = self.configuration["learning_map"], self.configuration["learning_map_inv"]
        table = np.zeros(max(learning) + 100, np.int32)
        table[list(learning)] = list(learning.values())
        self.assertEqual(sorted(inverse), list(range(len(inverse))))
        self.assertEqual(sorted(set(learning.values())), sorted(inverse))
        self.assertEqual(set(self.configuration["learning_ignore"]), set(inverse))
        self.assertEqual([number for number, ignored in self.configuration["learning_ignore"].items() if ignored], [0])
        for number in range(3):
            labels = self.labels(number)
            self.assertTrue(set(np.unique(labels)) <= set(self.configuration["labels"]))
            again = np.array([inverse[int(trained)] for trained in table[np.unique(labels)]])
            np.testing.assert_array_equal(table[again], table[np.unique(labels)])
        self.assertEqual(learning[256], learning[16])  # A wagon is one, moving or not.

    def test_contents_are_the_shares_of_points(self):
        labels = np.concatenate([self.labels(number) for number in range(3)])
        content = self.configuration["content"]
        self.assertEqual(set(content), set(self.configuration["labels"]))
        self.assertAlmostEqual(sum(content.values()), 1.0)
        for label, share in content.items():
            self.assertAlmostEqual(share, np.mean(labels == label))
        self.assertTrue(all(len(bgr) == 3 for bgr in self.configuration["color_map"].values()))

    def test_faults_are_listed_and_nothing_is_written(self):
        a, b, _ = self.runs
        other = self.folder / "other"
        other.mkdir(exist_ok=True)
        ended = join(self.folder / "bad", "--train", a, a, other)
        self.assertEqual((ended.returncode, ended.stderr),
                         (1, f"{other}: must be a complete run, with a manifest.json\n"
                             f"{a}: must be given once (got 2 times)\n"))
        self.assertFalse((self.folder / "bad").exists())
        changed = yaml.safe_load((b / "semantic-kitti-railcast.yaml").read_text("utf-8"))
        changed["labels"][260] = "sleeper"
        (other / "semantic-kitti-railcast.yaml").write_text(yaml.safe_dump(changed), "utf-8")
        (other / "manifest.json").write_text(json.dumps({}), "utf-8")
        ended = join(self.folder / "bad", "--train", a, other)
        self.assertEqual(ended.stderr, f"{other}/semantic-kitti-railcast.yaml: /labels: must be that of {a}\n")
        (other / "manifest.json").unlink()
        ended = join(self.folder / "set", "--train", a)
        self.assertEqual((ended.returncode, ended.stderr), (1, f"{self.folder / 'set'}: must not exist\n"))


if __name__ == "__main__":
    unittest.main()
