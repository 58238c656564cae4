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
        names = sorted(folder.name for folder in self.out.iterdir() if folder.is_dir())
        self.assertEqual(names, ["crossing", "persons", "weather"])
        self.assertEqual(self.said.count(": whole; read "), 3)
        for name in names:
            card = (self.out / name / "README.md").read_text()
            self.assertTrue(card.startswith(f"# Data set {name}\n\n- **Licence**: MIT\n"), card[:200])
            links = re.findall(r"\]\(([^)]*)\)", card)
            self.assertGreaterEqual(len(links), 3)
            for link in links:
                self.assertTrue((self.out / name / link).is_file(), f"{name}: {link}")

    def test_licences_that_cards_name_are_there(self):
        self.assertIn("LICENSE.ttobench", (self.out / "weather/README.md").read_text())
        self.assertTrue((self.out / "LICENSE.ttobench").is_file())
        self.assertTrue((self.out / "LICENSE").is_file())

    def test_a_card_has_the_command_that_makes_the_data_set_again(self):
        card = (self.out / "weather/README.md").read_text().replace("\\", "")
        options = re.search(r"RECIPE --out DIR (.*), with the recipe", card)[1].split()
        again = self.out.parent / "again"
        subprocess.run([BUILD / "generator/railcast-generate", "dataset", ROOT / "scenarios/recipes/weather_sample.json",
                        "--out", again, *options], check=True, capture_output=True)
        first, second = (json.loads((folder / "manifest.json").read_text())["data_xxh3"]
                         for folder in (self.out / "weather/weather", again))
        self.assertEqual(first, second)

    def test_nothing_else_is_deleted(self):
        kept = self.out.parent / "mine"
        kept.mkdir()
        (kept / "thesis.txt").write_text("x")
        run = subprocess.run([ROOT / "scripts/make_samples.sh", kept / "nothing", kept], capture_output=True, text=True)
        self.assertEqual(run.returncode, 1)
        self.assertEqual(run.stderr, f"error: {kept}/nothing/generator/railcast-generate is not there\n")
        self.assertTrue((kept / "thesis.txt").is_file())

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
    BUILD = Path(sys.argv.pop(1)).resolve()
    unittest.main()
