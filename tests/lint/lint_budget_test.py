"""Each test plants a small tree and reads what scripts/dev/lint_budget.py says of it."""

import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/dev"))
import lint_budget  # noqa: E402 (found through the line above)

LONG = "\n" * lint_budget.SMALL_HEADER_LINES


def measured(files):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = pathlib.Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return lint_budget.measure(pathlib.Path(folder))


class Rooms(unittest.TestCase):

    def test_a_room_has_its_lines_and_files(self):
        now = measured({"core/base/units.h": "a\nb\n", "core/rail/track/ballast.cpp": "c\n", "tests/a_test.cpp": "d\n"})
        self.assertEqual(now["rooms"], {"core/base": {"lines": 2, "files": 1},
                                        "core/rail/track": {"lines": 1, "files": 1}})

    def test_more_than_the_budget_is_a_fault(self):
        now = measured({"core/base/units.h": "a\nb\n", "core/scan/beam.h": "c\n"})
        budget = {"rooms": {"core/base": {"lines": 1, "files": 1}}, "single_user_headers": [], "product_to_extras": []}
        self.assertEqual(list(lint_budget.lint(now, budget)), [
            "core/base: has 2 lines, and 1 in scripts/dev/budget.json",
            "core/scan: has 1 lines, and 0 in scripts/dev/budget.json",
            "core/scan: has 1 files, and 0 in scripts/dev/budget.json"])

    def test_lowering_never_raises(self):
        now = measured({"core/base/units.h": "a\n", "core/scan/beam.h": "c\nd\n"})
        budget = {"rooms": {"core/base": {"lines": 7, "files": 3}, "core/scan": {"lines": 1, "files": 1}},
                  "single_user_headers": ["core/gone.h"], "product_to_extras": []}
        self.assertEqual(lint_budget.lowered(now, budget), {
            "rooms": {"core/base": {"lines": 1, "files": 1}, "core/scan": {"lines": 1, "files": 1}},
            "single_user_headers": [], "product_to_extras": []})


class SmallHeaders(unittest.TestCase):

    def test_one_with_a_single_user_is_listed(self):
        now = measured({"core/base/one.h": "a\n", "core/base/one.cpp": '#include "core/base/one.h"\n',
                        "core/base/two.cpp": '#include "core/base/one.h"\n'})
        self.assertEqual(now["single_user_headers"], {"core/base/one.h": "core/base/two.cpp"})

    def test_long_ones_public_ones_and_those_with_two_users_are_not(self):
        now = measured({"core/base/long.h": LONG, "core/base/shared.h": "a\n", "core/include/railcast/frame.h": "b\n",
                        "core/base/one.cpp": '#include "core/base/long.h"\n#include "core/base/shared.h"\n',
                        "core/base/two.cpp": '#include "core/base/shared.h"\n#include "railcast/frame.h"\n'})
        self.assertEqual(now["single_user_headers"], {})

    def test_a_new_one_is_a_fault(self):
        now = {"rooms": {}, "single_user_headers": {"core/base/one.h": "core/base/two.cpp"}, "product_to_extras": []}
        self.assertEqual(list(lint_budget.lint(now, {"rooms": {}, "single_user_headers": [], "product_to_extras": []})), [
            "core/base/one.h: a private header has several users, or 120 lines; this belongs into its only user, "
            "core/base/two.cpp"])


class Extras(unittest.TestCase):

    def test_an_include_from_the_product_is_listed(self):
        files = {"generator/extras/insert/plan.h": "", "generator/run/run.cpp": '#include "generator/extras/insert/plan.h"\n',
                 "generator/extras/insert/plan.cpp": '#include "generator/extras/insert/plan.h"\n',
                 "analysis/extras/study/study_command.cpp": '#include "analysis/extras/study/study.h"\n'}
        self.assertEqual(measured(files)["product_to_extras"], ["generator/run/run.cpp -> generator/extras/insert/plan.h"])


class Text(unittest.TestCase):

    def test_has_a_line_for_each_entry(self):
        budget = {"rooms": {"core/base": {"lines": 2, "files": 1}}, "single_user_headers": ["a.h", "b.h"],
                  "product_to_extras": []}
        self.assertIn('    "core/base": {"lines": 2, "files": 1}\n', lint_budget.text_of(budget))
        self.assertIn('    "a.h",\n    "b.h"\n', lint_budget.text_of(budget))


if __name__ == "__main__":
    unittest.main()
