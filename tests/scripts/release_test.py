"""scripts/dev/release.sh --check says what stands against a release: release_test.py SOURCE."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv.pop(1))
COPIED = ("CMakeLists.txt", "CHANGELOG.md", "CITATION.cff", "README.md", "docs", "scripts/dev/release.sh",
          "scripts/dev/results.py", "tests/releases")


def git(*words, folder):
    subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b", *words], cwd=folder, check=True,
                   capture_output=True)


class Release(unittest.TestCase):

    def setUp(self):
        self.tree = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        for name in COPIED:
            target = self.tree / name
            target.parent.mkdir(parents=True, exist_ok=True)
            (shutil.copytree if (SOURCE / name).is_dir() else shutil.copy)(SOURCE / name, target)
        git("init", "--quiet", folder=self.tree)
        self.commit()

    def commit(self):
        git("add", "-A", folder=self.tree)
        git("commit", "--quiet", "--allow-empty", "-m", "a", folder=self.tree)

    def faults(self):
        ended = subprocess.run([self.tree / "scripts/dev/release.sh", "--check"], capture_output=True, text=True,
                               check=False)
        self.assertEqual(ended.returncode, 1 if ended.stderr else 0, ended)
        return [line.removeprefix("release.sh: ") for line in ended.stderr.splitlines()]

    def edit(self, name, old, new):
        text = (self.tree / name).read_text("utf-8")
        self.assertIn(old, text)
        (self.tree / name).write_text(text.replace(old, new, 1), "utf-8")

    def test_nothing_stands_against_this_tree(self):
        self.assertEqual(self.faults(), [])

    def test_changes_that_are_not_committed(self):
        self.edit("README.md", "railcast", "railcats")
        self.assertEqual(self.faults(), ["there are changes that are not committed"])

    def test_another_version_in_a_file(self):
        self.edit("CMakeLists.txt", "VERSION 1.", "VERSION 9.")
        self.commit()
        changelog, citation = self.faults()
        self.assertRegex(changelog, r"^CHANGELOG\.md begins with 1\.\S+ \(must be 9\.\S+\)$")
        self.assertRegex(citation, r"^CITATION\.cff has the version 1\.\S+ \(must be 9\.\S+\)$")

    def test_the_release_before_is_not_kept(self):
        shutil.rmtree(self.tree / "tests/releases/0.2.0")
        self.commit()
        fault, = self.faults()
        self.assertTrue(fault.startswith("tests/releases lacks 0.2.0: "), fault)

    def test_figures_that_are_not_the_file_s(self):
        (self.tree / "docs/results/results.json").write_text("{}\n", "utf-8")
        self.commit()
        fault, = self.faults()
        self.assertIn("docs/results/results.json", fault)


if __name__ == "__main__":
    unittest.main()
