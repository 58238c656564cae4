"""docs/results/detection_table.md has the figures of the .csv beside it, and bold is what the figures say is in time."""

import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/dev"))
import measure_detection  # noqa: E402 (found through the line above)


class DetectionTable(unittest.TestCase):

    def test_the_page_has_the_table_of_the_figures(self):
        text = measure_detection.PAGE.read_text(encoding="utf-8")
        shown = text.partition(measure_detection.BEGIN + "\n")[2].partition(measure_detection.END)[0]
        self.assertEqual(shown, measure_detection.page(measure_detection.kept()))

    def test_yes_is_where_the_distance_is_not_less_than_needed(self):
        rows = measure_detection.kept()
        self.assertGreater(len(rows), 0)
        for row in rows:
            is_in_time = bool(row["d90_95_m"]) and float(row["d90_95_m"]) >= float(row["most_needed_m"])
            self.assertEqual(row["answer"] == "yes", is_in_time, row)

    def test_fewer_approaches_than_needed_are_no_object_that_was_never_detected(self):
        row = {"study": "brake_person_clear", "sensor": "vir2rail", "object": "person", "approaches": "3",
               "detected": "3", "answer": "too few approaches: 60 are needed", "most_needed_m": "77.2",
               "least_detected_at_m": "100.5", "d90_95_m": "", "curve_d90_m": "", "curve_d90_95_m": ""}
        self.assertIn("| `brake_person_clear` | person | 77 | too few approaches |  |  |  |",
                      measure_detection.page([row]))


if __name__ == "__main__":
    unittest.main()
