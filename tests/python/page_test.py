"""The programs of docs/python.md and the three lines of README.md run as they stand."""

import os
import pathlib
import re
import tempfile
import unittest

from support import ROOT, SCENARIO, generate

BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


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
            exec("".join(blocks), {})  # pylint: disable=exec-used

    def test_readme_shows_the_same_three_lines(self):
        first = BLOCK.search((ROOT / "docs" / "python.md").read_text("utf-8"))[1]
        self.assertEqual(len(first.splitlines()), 3)
        self.assertIn(first, (ROOT / "README.md").read_text("utf-8"))


if __name__ == "__main__":
    unittest.main()
