"""Each test plants a page and a file of results and reads what scripts/dev/results.py says, or makes, of them."""

import json
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/dev"))
import measure_results  # noqa: E402 (found through the line above)
import results  # noqa: E402

MADE = {"machine": "2 cores of X", "date": "2026-01-02", "revision": "abc", "note": "nothing else ran"}
TABLE = {"keys": 1, "columns": ["row", "time", "error %"],
         "rows": [["`a`", "11.39", "4.91"], ["`b`", "1.05", "-"], ["c", "1,209.6", "2 to 3"]]}
HEAD = "<!-- results: p/t -->\n| row | time | error % | own |\n|---|---|---|---|\n"


def planted(text, run):
    """What `run` gives for a tree of which README.md has this text."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "docs/results").mkdir(parents=True)
        (root / "scenarios").mkdir()
        (root / "README.md").write_text(text, encoding="utf-8")
        (root / results.FILE).write_text(json.dumps({
            "p": {"made": MADE, "tables": {"t": TABLE}}, "q": {"made": MADE, "tables": {}},
            "later": {"made": {**MADE, "date": "2026-01-03"}, "tables": {}}}), encoding="utf-8")
        return run(root)


def faults_of(text):
    return planted(text, lambda root: list(results.lint(root)))


def filled(text):
    def run(root):
        results.fill(root)
        return (root / "README.md").read_text(encoding="utf-8")
    return planted(text, run)


class Check(unittest.TestCase):

    def test_a_table_has_the_files_figures_with_as_many_digits_as_it_shows(self):
        self.assertEqual(faults_of(HEAD + "| `a` | 11.4 | 4.91 | x |\n| c | 1,210 | 2 to 3 | y |\n"), [])
        self.assertEqual(faults_of(HEAD + "| `a` | 11.5 | 4.91 | x |\n"),
                         ["README.md:4: figures are those of docs/results/results.json "
                          "(| `a` | 11.5 | 4.91 | x | instead of | `a` | 11.4 | 4.91 | x |)"])

    def test_a_number_in_a_sentence_is_that_of_its_cell(self):
        self.assertEqual(faults_of("takes 11<!-- r: p/t ; a ; time --> times\n"), [])
        self.assertEqual(faults_of("takes 12<!-- r: p/t ; a ; time --> times\n"),
                         ["README.md:1: figures are those of docs/results/results.json "
                          "(takes 12<!-- r: p/t ; a ; time --> times instead of takes 11<!-- r: p/t ; a ; time --> times)"])

    def test_a_sentence_names_the_least_and_the_most_of_a_column(self):
        self.assertEqual(faults_of("1.05<!-- r: p/t ; least ; time --> to 1,210<!-- r: p/t ; most ; time --> s\n"), [])
        self.assertEqual(len(faults_of("1.06<!-- r: p/t ; least ; time -->\n")), 1)

    def test_a_page_says_where_and_when_a_part_was_measured(self):
        line = "*2 cores of X; 2026-01-02; revision abc; nothing else ran.*"
        self.assertEqual(faults_of(f"<!-- made: p -->\n{line}\n"), [])
        self.assertEqual(len(faults_of("<!-- made: p -->\n*3 cores of X.*\n")), 1)

    def test_parts_measured_together_share_a_line_and_others_are_named_in_it(self):
        line = "2 cores of X; 2026-01-02; revision abc; nothing else ran."
        self.assertEqual(faults_of(f"<!-- made: p q -->\n*{line}*\n"), [])
        self.assertEqual(faults_of(f"<!-- made: p later q -->\n*p, q: {line} later: {line.replace('02;', '03;')}*\n"), [])

    def test_a_mark_without_an_answer_is_a_fault(self):
        self.assertEqual(faults_of("1<!-- r: p/u ; a ; time -->\n2<!-- r: p/t ; d ; time -->\n"
                                   "3<!-- r: p/t ; a ; times -->\n"),
                         ["README.md:1: the file has the table (p/u)", "README.md:2: the file has the row (d)",
                          "README.md:3: the file has the column (times)"])
        self.assertEqual(faults_of("no number<!-- r: p/t ; a ; time -->\n"),
                         ["README.md:1: every mark stands at a table, after a number or above a line (1 do not)"])

    def test_a_column_of_the_pages_own_has_no_figures(self):
        self.assertEqual(faults_of(HEAD + "| `a` | 11.39 | 4.91 | 7 mm |\n"),
                         ["README.md:1: figures stand in columns of the file (a: 7 mm)"])


class Fill(unittest.TestCase):

    def test_a_table_of_all_rows_gets_the_files(self):
        text = "<!-- results: p/t all -->\n| row | error % |\n|---|---|\n| gone | 1 |\n"
        self.assertEqual(filled(text).splitlines()[3:], ["| `a` | 4.91 |", "| `b` | - |", "| c | 2 to 3 |"])
        self.assertEqual(faults_of(filled(text)), [])

    def test_a_whole_table_is_written_with_its_heading(self):
        whole = ("<!-- results: p/t whole -->\n| row | time | error % |\n|---|---|---|\n| `a` | 11.4 | 4.91 |\n"
                 "| `b` | 1.05 | - |\n| c | 1,210 | 2 to 3 |\n")
        self.assertEqual(filled("<!-- results: p/t whole -->\n\nx\n"), whole + "\nx\n")
        self.assertEqual(filled("<!-- results: p/t whole -->\n| old |\n|---|\n| 1 |\n"), whole)
        self.assertEqual(faults_of(whole), [])
        self.assertEqual(len(faults_of("<!-- results: p/t whole -->\n")), 1)

    def test_digits_and_units_stay_those_of_the_page(self):
        self.assertIn("| `a` | 11.4 | 4.91 | x |", filled(HEAD + "| `a` | 99.0 | | x |\n"))


class Measured(unittest.TestCase):

    def test_several_sensors_are_one_row_with_a_span_of_figures(self):
        test = lambda name, text: {"name": name, "regime: steps": text}
        report = json.dumps({"testsuites": [{"name": "All/EdgesOn", "testsuite": [
            test("Mix/a", "one | 90 % of 3 | yes"), test("Mix/b", "one | 100 % of 3 | yes")]}]})
        self.assertEqual(measure_results.regimes(report),
                         [["steps", "one", "90 to 100 % of 3", "yes", "`EdgesOn.*`"]])

    def test_the_change_farthest_beyond_its_interval_counts(self):
        cells = [("0 m", "+5.0 ± 4.9"), ("30 m", "-1.5 ± 0.2"), ("60 m", "")]
        self.assertEqual(measure_results.largest_change(cells), "-1.5 ± 0.2 from 30 m")
        self.assertEqual(measure_results.largest_change([("0 m", "")]), "-")

    def test_the_interval_of_runs_is_that_of_student(self):
        # A standard deviation of 1 % of the mean, and 4.303 / sqrt(3) of it.
        self.assertAlmostEqual(measure_results.interval_percent([0.99, 1.0, 1.01]), 2.484, places=3)
        self.assertEqual(measure_results.interval_percent([2.0, 2.0, 2.0, 2.0]), 0.0)

    def test_what_other_programs_use_is_told_from_what_this_one_does(self):
        # In 10 s all used 13 s of two cores, this program and its children 9 s of them.
        self.assertAlmostEqual(measure_results.other_cores((100.0, 5.0), (113.0, 14.0), 10.0), 0.4)
        _, others = measure_results.cores_of_others_during(lambda: sum(range(10 ** 6)))
        self.assertGreaterEqual(others, 0.0)

    def test_tables_of_a_text_are_found(self):
        self.assertEqual(measure_results.tables_in("x\n| a | b |\n|---|---|\n| 1 | 2 |\n\ny\n"),
                         [[["a", "b"], ["1", "2"]]])


if __name__ == "__main__":
    unittest.main()
