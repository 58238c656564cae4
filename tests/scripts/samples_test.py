"""Makes the samples and looks at what a stranger would look at: samples_test.py BUILD_DIR."""

import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


class MakeSamples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = Path(cls.folder.name) / "samples"
        made = subprocess.run([ROOT / "scripts/make_samples.sh", BUILD, cls.out], capture_output=True, text=True)
        assert made.returncode == 0, made.stdout + made.stderr
        cls.said = made.stdout

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_all_take_about_twenty_megabytes(self):
        size = sum(file.stat().st_size for file in self.out.rglob("*") if file.is_file())
        self.assertGreater(size, 10e6)
        self.assertLess(size, 25e6)

    def test_each_is_whole_and_has_a_card(self):
        names = sorted(folder.name for folder in self.out.iterdir())
        self.assertEqual(names, ["crossing", "persons", "weather"])
        self.assertEqual(self.said.count(": whole; read "), 3)
        for name in names:
            card = (self.out / name / "README.md").read_text()
            self.assertTrue(card.startswith(f"# Data set {name}\n\n- **Licence**: MIT\n"), card[:200])
            links = re.findall(r"\]\(([^)]*)\)", card)
            self.assertGreaterEqual(len(links), 3)
            for link in links:
                self.assertTrue((self.out / name / link).is_file(), f"{name}: {link}")

    def test_each_shows_what_it_is_named_after(self):
        def report(name):
            return json.loads((self.out / name / name / "report.json").read_text())

        self.assertGreater(report("persons")["objects"]["person"]["with_points"], 0)
        self.assertGreaterEqual(len(report("weather")["weathers"]), 3)
        self.assertGreater(report("crossing")["objects"]["barrier"]["with_points"], 0)
        self.assertEqual(len(list((self.out / "crossing").rglob("*.mcap"))), 8)
        # Every part has something to train or test with.
        for name in ("persons", "weather", "crossing"):
            self.assertTrue(all(part["points"] > 0 for part in report(name)["splits"].values()), name)


if __name__ == "__main__":
    BUILD = sys.argv.pop(1)
    unittest.main()
