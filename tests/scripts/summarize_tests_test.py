"""What scripts/dev/summarize_tests.py says of the results of GoogleTest."""

import json
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/dev"))
import summarize_tests  # noqa: E402 (found through the line above)

RESULTS = """<?xml version="1.0" encoding="UTF-8"?>
<testsuites tests="4" failures="0" disabled="1" errors="0" time="3.5" name="AllTests">
  <testsuite name="Rails" tests="4" failures="0" disabled="1" skipped="1" errors="0" time="3.5">
    <testcase name="AreParallel" status="run" result="completed" time="0.5" classname="Rails" />
    <testcase name="EndAtBuffers" status="run" result="completed" time="3" classname="Rails" />
    <testcase name="AreThoseOfAMap" status="run" result="skipped" time="0" classname="Rails">
      <skipped message="/source/rails_test.cpp:7&#x0A;the shared map is not there"><![CDATA[...]]></skipped>
    </testcase>
    <testcase name="DISABLED_Bend" status="notrun" result="suppressed" time="0" classname="Rails" />
  </testsuite>
</testsuites>
"""
SUMMARY = """\
2 tests of the test programs ran; skipped: 1
  the shared map is not there: Rails.AreThoseOfAMap
the slowest:
     3.0 s  Rails.EndAtBuffers
     0.5 s  Rails.AreParallel
     0.0 s  Rails.AreThoseOfAMap"""


class SummarizeTests(unittest.TestCase):

    def test_counts_names_what_was_skipped_and_lists_the_slowest(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "rails_test.xml").write_text(RESULTS, encoding="utf-8")
            self.assertEqual(summarize_tests.summary_of(summarize_tests.read_tests(folder)), SUMMARY)

    def test_names_entries_that_take_more_than_their_part(self):
        # A machine of half the pace: 40 s are allowed 1.5 times 80, and 10 s without a budget are 20.
        budget = {"rails_test": 40, "wires_test": 100}
        entries = {"rails_test": 81.0, "wires_test": 199.0, "new_test": 19.0}
        self.assertEqual(summarize_tests.over_budget(entries, budget), [])
        entries = {"rails_test": 140.0, "wires_test": 140.0, "new_test": 21.0}
        self.assertEqual(summarize_tests.over_budget(entries, budget),
                         ["  new_test: 21 s, 20 are allowed at this machine's pace",
                          "  rails_test: 140 s, 120 are allowed at this machine's pace"])
        self.assertEqual(summarize_tests.over_budget({"a": 50.0}, {}), [])

    def test_reads_the_budget_of_this_tree(self):
        budget = json.loads(summarize_tests.BUDGET.read_text(encoding="utf-8"))
        self.assertGreater(len(budget), 10)
        self.assertGreaterEqual(min(budget.values()), 10)


if __name__ == "__main__":
    unittest.main()
