"""What scripts/dev/brake_table.py makes of the reports of examples/brake_client.py."""

import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/dev"))
import brake_table  # noqa: E402 (found through the line above)

RUNS = """\
brake_wagon   clear       detected at 297.5 m with 11.11 m/s, braking distance 62.8 m, gap left 235.4 m
brake_wagon   thick_fog   detected at 59.3 m with 11.11 m/s, braking distance 62.8 m, gap left -3.3 m
brake_person  heavy_rain  detected at 73.3 m with 6.94 m/s, braking distance 24.8 m, gap left 48.8 m
"""
PAGE = "Before.\n\n<!-- figures: scripts/dev/brake_runs.sh -->\n{}\nAfter.\n\nMore.\n"
TABLE = """\
| | weather | detected at | braking distance | gap left |
|---|---|---|---|---|
| wagon, 40 km/h | clear | 297.5 m | 62.8 m | 235.4 m |
| | fog, visibility 100 m | 59.3 m | 62.8 m | **-3.3 m**: it runs into the wagon |
| person, 25 km/h | rain of 10 mm/h | 73.3 m | 24.8 m | 48.8 m |
"""


def written(runs, page):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "runs").write_text(runs, encoding="utf-8")
        (folder / "page").write_text(page, encoding="utf-8")
        brake_table.main([str(folder / "runs"), str(folder / "page")])
        return (folder / "page").read_text(encoding="utf-8")


class BrakeTable(unittest.TestCase):

    def test_replaces_the_table_behind_the_mark_and_nothing_else(self):
        self.assertEqual(written(RUNS, PAGE.format("| old |\n|---|\n")), PAGE.format(TABLE))
        self.assertEqual(written(RUNS, PAGE.format(TABLE)), PAGE.format(TABLE))

    def test_refuses_runs_that_stopped_for_nothing_and_pages_without_the_mark(self):
        with self.assertRaisesRegex(SystemExit, "must be the report of a run"):
            written("brake_wagon clear nothing detected\n", PAGE.format(TABLE))
        with self.assertRaisesRegex(SystemExit, "must have the line"):
            written(RUNS, "Before.\n")


if __name__ == "__main__":
    unittest.main()
