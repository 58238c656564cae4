"""examples/index_dataset.py makes the database that releases before 1.0 wrote with each data set."""

import contextlib
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
RELEASE = ROOT / "tests/releases/0.2.0/dataset"


def run(*arguments):
    return subprocess.run([sys.executable, "-B", ROOT / "examples/index_dataset.py", *arguments], check=False, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def content_of(database):
    with contextlib.closing(sqlite3.connect(f"{database.as_uri()}?mode=ro", uri=True)) as connection:
        return list(connection.iterdump())


class Database(unittest.TestCase):

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name).resolve() / "set"
        shutil.copytree(RELEASE, self.folder, ignore=shutil.ignore_patterns("index.sqlite"))

    def test_it_has_the_tables_that_the_release_wrote(self):
        ended = run(self.folder)
        self.assertEqual((ended.returncode, ended.stdout), (0, ""))
        self.assertEqual(content_of(self.folder / "index.sqlite"), content_of(RELEASE / "index.sqlite"))

    def test_one_that_is_there_is_kept(self):
        (self.folder / "index.sqlite").write_text("mine")
        ended = run(self.folder)
        self.assertEqual((ended.returncode, ended.stdout),
                         (1, f"{self.folder}/index.sqlite: is there; remove it to make it anew\n"))
        self.assertEqual((self.folder / "index.sqlite").read_text(), "mine")

    def test_an_unfinished_data_set_is_named(self):
        (self.folder / "index.jsonl").unlink()
        ended = run(self.folder)
        self.assertEqual((ended.returncode, ended.stdout),
                         (1, f"{self.folder}: must be a finished data set (got no index.jsonl)\n"))
        self.assertFalse((self.folder / "index.sqlite").exists())

    def test_what_is_damaged_is_named_and_no_half_database_stands_there(self):
        index = (self.folder / "index.jsonl").read_text().splitlines()
        order = "index.jsonl: must have a line for each frame of scenarios.jsonl, in their order\n"
        # Of the same data set, one after the other.
        for name, text, said in (
                ("index.jsonl", index[0] + "\n", order),
                ("index.jsonl", "\n".join([*index, index[-1]]) + "\n", order),
                ("index.jsonl", "\n".join(reversed(index)) + "\n", order),
                ("sequences/000/000000/frames.jsonl", "", "must have a line for each of 1 frames (got 0)\n"),
                ("sequences/000/000000/frames.jsonl", "[]\n", "railcast-analyze verify says what was changed\n")):
            file = self.folder / name
            before = file.read_text()
            file.write_text(text)
            ended = run(self.folder)
            self.assertEqual((ended.returncode, ended.stdout.count("\n")), (1, 1), ended.stdout)
            self.assertTrue(ended.stdout.startswith(str(self.folder)) and ended.stdout.endswith(said), ended.stdout)
            self.assertEqual(list(self.folder.glob("index.sqlite*")), [])
            file.write_text(before)


if __name__ == "__main__":
    unittest.main()
