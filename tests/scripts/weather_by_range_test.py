"""Each test writes small reports of `stats` and reads what scripts/dev/weather_by_range.py makes of them."""

import contextlib
import io
import json
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/dev"))
import weather_by_range  # noqa: E402 (found through the line above)

FILES = {
    "outcomes": ("outcome,firings", ["returned,700", "clutter,100"]),
    "dropout_by_range": (("true_range_m,dropout_percent,dropout_percent_low,dropout_percent_high,"
                          "dropout_percent_samples"),
                         ["10 to 15,25,20,30,400", "50 to 60,,,,5"]),
    "density_by_range": ("surface,range_m,per_m2,per_m2_low,per_m2_high,per_m2_samples",
                         ["rail,12,9,8,10,500", "ground,12,5,4,6,500"]),
    "noise_from_truth": ("range_m,sigma_mm,sigma_mm_low,sigma_mm_high,sigma_mm_samples",
                         ["10 to 15,11,10,12,40", "50 to 60,20,10,30,29"]),
}


# Too few frames for the report to give their mean.
FACTS = {"facts": {"Frames": "4", "Points": "4937"}}


def write_reports(folder, changed):
    """The same report for each rung and weather, but for the lines `changed`: {run: {file: lines}}."""
    for rung in weather_by_range.RUNGS:
        for weather in weather_by_range.WEATHERS:
            csv = folder / f"{rung}_{weather}_stats" / "csv"
            csv.mkdir(parents=True)
            (csv.parent / "stats.json").write_text(json.dumps(FACTS), encoding="utf-8")
            own = changed.get(f"{rung}_{weather}", {})
            for name, (head, lines) in FILES.items():
                text = "\n".join([head, *own.get(name, lines)]) + "\n"
                (csv / f"{name}.csv").write_text(text, encoding="utf-8")


def made_of(changed=None):
    """(table, {name: blocks}) of the reports."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_reports(folder, changed or {})
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            weather_by_range.main([str(folder)])
        blocks = {curve: (folder / f"{curve}.dat").read_text(encoding="utf-8").split("\n\n\n")
                  for curve in weather_by_range.CURVES}
        return printed.getvalue().splitlines()[2:], blocks


class WeatherByRange(unittest.TestCase):

    def test_the_table_has_a_line_per_rung_and_weather_and_a_dash_for_what_is_not_known(self):
        table, _ = made_of()
        self.assertEqual(len(table), 8)
        self.assertEqual(table[0], "| `plausibility` | clear | 1,234 | 12.5 % | 25.0 % | - | - "
                                   "| 11.0 mm | 20.0 mm | - |")
        self.assertTrue(table[7].startswith("| `surface` | snow |"))

    def test_ranges_are_the_middles_of_the_bands_and_few_samples_are_left_out(self):
        _, blocks = made_of()
        self.assertEqual(blocks["dropout"][0], "12.5 25 20 30")
        self.assertEqual(blocks["noise"][0], "12.5 11 10 12")

    def test_density_is_that_of_ground(self):
        _, blocks = made_of()
        self.assertEqual(blocks["density"][0], "12 5 4 6")

    def test_a_curve_without_points_keeps_its_place(self):
        _, blocks = made_of({"plausibility_fog": {"dropout_by_range": []},
                             "surface_clear": {"dropout_by_range": ["10 to 15,50,40,60,90"]}})
        self.assertEqual(blocks["dropout"][1], "NaN NaN NaN NaN")
        self.assertEqual(blocks["dropout"][4], "12.5 50 40 60")
        self.assertEqual(len(blocks["dropout"]), 8)


if __name__ == "__main__":
    unittest.main()
