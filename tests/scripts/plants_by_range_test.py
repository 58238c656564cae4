"""Each test writes two small reports of `stats` and reads what scripts/dev/plants_by_range.py counts."""

import contextlib
import io
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/dev"))
import plants_by_range  # noqa: E402 (found through the line above)


def write_report(folder, frames, rows):
    """`rows`: (surface, range in metres, points)."""
    (folder / "csv").mkdir(parents=True)
    (folder / "csv" / "frames.csv").write_text(
        f"figure,mean,mean_low,mean_high,mean_samples\npoints,1,1,1,{frames}\n", encoding="utf-8")
    lines = "".join(f"{surface},{range_m},{points}\n" for surface, range_m, points in rows)
    (folder / "csv" / "density_by_range.csv").write_text(
        "surface,range_m,per_m2_samples\n" + lines, encoding="utf-8")


def made_of(with_rows, without_rows, frames=1):
    """(table, data) of two reports."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_report(folder / "with", frames, with_rows)
        write_report(folder / "without", frames, without_rows)
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            plants_by_range.main([str(folder / "with"), str(folder / "without"),
                                  str(folder / "data")])
        data = (folder / "data").read_text(encoding="utf-8")
        return printed.getvalue().splitlines()[2:], data.splitlines()[1:]


class PlantsByRange(unittest.TestCase):

    def test_counts_the_landscape_per_frame_and_nothing_else(self):
        table, _ = made_of(
            [("ground", 9.0, 40), ("grass", 9.0, 20), ("tree", 9.0, 10), ("rail", 9.0, 500)],
            [("ground", 9.0, 60), ("rail", 9.0, 500)], frames=10)
        self.assertEqual(table, ["| from 8 m | 4 | 2 | 1 | 7 | 6 |", "| all | 4 | 2 | 1 | 7 | 6 |"])

    def test_sums_two_bins_a_row_and_names_the_last_by_its_beginning(self):
        table, _ = made_of([("ground", 9.0, 1), ("ground", 10.0, 2), ("ground", 12.0, 4)], [])
        self.assertEqual(table, ["| 8 to 11 m | 3 | 0 | 0 | 3 | 0 |", "| from 11 m | 4 | 0 | 0 | 4 | 0 |",
                                 "| all | 7 | 0 | 0 | 7 | 0 |"])

    def test_the_chart_has_a_line_per_bin_and_also_the_empty_ones(self):
        _, data = made_of([("tree", 8.5, 3)], [("ground", 12.0, 5)])
        self.assertEqual(data, ["8.000 9.514 0.000 0.000 3.000 0.000",
                                "9.514 11.314 0.000 0.000 0.000 0.000",
                                "11.314 13.454 0.000 0.000 0.000 5.000"])

    def test_reports_without_landscape_are_an_error(self):
        with self.assertRaisesRegex(SystemExit, "^error: neither report has points on ground"):
            made_of([("rail", 9.0, 1)], [])


if __name__ == "__main__":
    unittest.main()
