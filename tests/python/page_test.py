"""The programs of docs/python.md and the three lines of README.md run as they stand."""

import importlib.util
import os
import pathlib
import re
import tempfile
import unittest

from support import ROOT, SCENARIO, generate, np

BLOCK = re.compile(r"^(<!-- needs torch -->\n)?```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


class Pages(unittest.TestCase):

    def test_the_programs_of_the_page_run_one_after_another(self):
        blocks = BLOCK.findall((ROOT / "docs" / "python.md").read_text("utf-8"))
        self.assertGreaterEqual(len(blocks), 5)
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "scenarios").symlink_to(ROOT / "scenarios")
            for run, frames in (("demo", 31), ("run1", 1), ("run2", 1)):
                generate("sequence", SCENARIO, "--out", folder / "out" / run, "--frames", frames)
            before = pathlib.Path.cwd()
            os.chdir(folder)
            self.addCleanup(os.chdir, before)
            has_torch = importlib.util.find_spec("torch") is not None
            names = {}
            exec("".join(block for needs_torch, block in blocks if has_torch or not needs_torch),  # pylint: disable=W0122
                 names)
            samples = [names["dataset"][place] for place in (0, 1)]
            self.check_batch(samples, names["collate"](samples))

    def check_batch(self, samples, batch):
        for place, sample in enumerate(samples):
            for rows, of_sample in (("points", "points"), ("labels", "points"), ("boxes", "boxes"),
                                    ("box_labels", "boxes")):
                np.testing.assert_array_equal(batch[rows][batch[f"sample_of_{of_sample}"] == place], sample[rows])
            self.assertGreater(len(sample["boxes"]), 0)
        self.assertEqual(len(batch["points"]), sum(len(sample["points"]) for sample in samples))

    def test_readme_shows_the_same_three_lines(self):
        first = BLOCK.search((ROOT / "docs" / "python.md").read_text("utf-8"))[2]
        self.assertEqual(len(first.splitlines()), 3)
        self.assertIn(first, (ROOT / "README.md").read_text("utf-8"))


if __name__ == "__main__":
    unittest.main()
