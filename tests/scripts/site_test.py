"""scripts/make_site.sh makes a site of all pages and interfaces, without a warning.

Usage: site_test.py BUILD_DIR. Skipped where Sphinx or what else the script needs is absent.
"""

import html
import importlib.util
import pathlib
import re
import shutil
import subprocess
import sys
import unittest
from urllib.parse import unquote

ROOT = pathlib.Path(__file__).resolve().parents[2]
SKIPPED = 77  # For ctest.


class Site(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        made = subprocess.run([ROOT / "scripts/make_site.sh", BUILD], check=False, capture_output=True, text=True)
        assert made.returncode == 0, made.stderr
        assert not made.stderr, made.stderr

    def text(self, name):
        return (BUILD / "site" / name).read_text(encoding="utf-8")

    def test_holds_every_page_of_docs(self):
        for page in (ROOT / "docs").rglob("*.md"):
            self.assertIn("<h1>", self.text(page.relative_to(ROOT).with_suffix(".html")))

    def test_lists_the_interfaces(self):
        self.assertIn('id="_CPPv45Frame"', self.text("api/cpp/frame.html"))
        self.assertIn('id="c.railcast_create"', self.text("api/c.html"))
        self.assertIn('id="railcast.Simulator.scan"', self.text("api/python.html"))

    def test_is_searched_by_words_of_pages_and_interfaces(self):
        index = self.text("searchindex.js")
        self.assertIn('"docs/effects"', index)
        self.assertIn("power_ratio", index)

    def test_pictures_load_fast(self):
        pictures = [path for path in (BUILD / "site/_images").iterdir() if path.suffix != ".svg"]
        self.assertGreater(len(pictures), 30)
        for picture in pictures:
            self.assertEqual(picture.suffix, ".webp", picture)
            self.assertLess(picture.stat().st_size, 200_000, picture)

    def test_every_link_and_picture_leads_somewhere(self):
        site = BUILD / "site"
        pages = {path: path.read_text(encoding="utf-8") for path in site.rglob("*.html")}
        self.assertGreater(len(pages), 80)
        for page, text in pages.items():
            for target in re.findall(r'(?:href|src)="([^"#?]+)', text):
                if re.match(r"[a-z]+:", target):
                    continue
                self.assertTrue((page.parent / html.unescape(unquote(target))).exists(), f"{page}: {target}")

    def test_repairs_the_theme(self):
        self.assertNotIn("import Gumshoe", self.text("_static/scripts/furo.js"))
        self.assertIn("(prefers-color-scheme: dark)", self.text("_static/styles/furo.css"))


if __name__ == "__main__":
    BUILD = pathlib.Path(sys.argv.pop())
    missing = [name for name in ("breathe", "furo", "myst_parser", "sphinx") if not importlib.util.find_spec(name)]
    missing += [name for name in ("cwebp", "doxygen") if not shutil.which(name)]
    if missing:
        print(f"skipped: no {', '.join(missing)} (site_packages of scripts/packages.sh)")
        sys.exit(SKIPPED)
    unittest.main()
