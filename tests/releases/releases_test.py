"""What earlier releases wrote is read, and what was written for them is understood: releases_test.py BUILD.

Each folder beside this file was written by scripts/dev/keep_release.py with the programs of the release it is named for.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
GENERATE, ANALYZE = BUILD / "generator/railcast-generate", BUILD / "analysis/railcast-analyze"
RELEASES = sorted(folder for folder in pathlib.Path(__file__).resolve().parent.iterdir() if folder.is_dir())


def run(*command, folder):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True, cwd=folder).stdout


class Releases(unittest.TestCase):

    def test_there_are_some(self):
        self.assertIn("0.2.0", [folder.name for folder in RELEASES])

    def test_every_format_is_read_with_all_its_points(self):
        for release in RELEASES:
            for source, expected in json.loads((release / "expected.json").read_text("utf-8")).items():
                with self.subTest(release=release.name, source=source):
                    facts = json.loads(run(ANALYZE, "stats", source, "--format", "json", folder=release))["facts"]
                    self.assertEqual({"frames": facts["Frames"], "points": facts["Points"]}, expected)

    def test_sequences_and_data_sets_are_found_whole(self):
        for release in RELEASES:
            for source in ("pcd", "mcap", "kitti", "dataset"):
                if (release / source).exists():
                    with self.subTest(release=release.name, source=source):
                        self.assertIn("whole", run(ANALYZE, "verify", source, folder=release))

    def test_scenarios_and_recipes_mean_the_same(self):
        """Frames may differ in bytes among versions, but hardly in the number of their points."""
        for release in RELEASES:
            expected = json.loads((release / "expected.json").read_text("utf-8"))
            with self.subTest(release=release.name), tempfile.TemporaryDirectory() as out:
                run(GENERATE, "sequence", release / "scenario.json", "--out", "pcd", "--frames", 2, folder=out)
                run(GENERATE, "dataset", release / "recipe.json", "--out", "dataset", folder=out)
                for source in ("pcd", "dataset"):
                    facts = json.loads(run(ANALYZE, "stats", source, "--format", "json", folder=out))["facts"]
                    points, before = int(facts["Points"]), int(expected[source]["points"])
                    # Rain takes one beam in a hundred, whichever they are: 5 standard deviations.
                    self.assertAlmostEqual(points, before, delta=5 * (0.02 * before)**0.5)


if __name__ == "__main__":
    unittest.main()
