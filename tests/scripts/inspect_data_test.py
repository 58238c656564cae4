"""What scripts/dev/inspect_data.py writes of recordings that are refused."""

import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/dev"))
import inspect_data  # noqa: E402 (found through the line above)


class InspectData(unittest.TestCase):

    def row(self, ended):
        """That of a program which ends so."""
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "program"
            program.write_text("#!/bin/sh\n" + ended)
            program.chmod(0o755)
            return inspect_data.inspected(program, pathlib.Path("/data/a.LAS"), pathlib.Path("/data"))

    def test_names_what_was_said_but_no_remark(self):
        said = "echo '/data/a.LAS: must be x|y' >&2; echo 'railcast-analyze: remark far-returns: 1' >&2; exit 1"
        self.assertEqual(self.row(said), "| a.LAS | refused: a.LAS: must be x&#124;y | | | | | | | |\n")

    def test_names_the_status_where_nothing_was_said(self):
        self.assertEqual(self.row("kill -9 $$"), "| a.LAS | refused: ended with -9 | | | | | | | |\n")

    def test_finds_endings_in_any_case(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("a.LAS", "b.txt", "c.Ply"):
                (pathlib.Path(folder) / name).touch()
            self.assertEqual([file.name for file in inspect_data.recordings(pathlib.Path(folder))], ["a.LAS", "c.Ply"])


if __name__ == "__main__":
    unittest.main()
