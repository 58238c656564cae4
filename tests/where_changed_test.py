"""Tests run where what they depend on has changed: where_changed_test.py."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).with_name("where_changed.py")
SKIPPED = 77


class WhereChanged(unittest.TestCase):

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.root = pathlib.Path(temporary.name)
        for name in ("core/include/a.h", "core/a.cpp", "core/base/CMakeLists.txt", "tests/a"):
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            (self.root / name).write_text(name)
        groups = {"headers": {"tests": ["A", "B"], "inputs": ["core/include/**/*", "core/**/CMakeLists.txt"]},
                  "sources": {"tests": ["C"], "inputs": ["core/**/*.cpp"]}}
        (self.root / "tests/where_changed.json").write_text(json.dumps(groups))
        self.script = shutil.copy(SCRIPT, self.root / "tests")

    def status_of(self, *words, **environment):
        before = {key: value for key, value in os.environ.items() if not key.startswith("RAILCAST_")}
        return subprocess.run([sys.executable, "-B", self.script, *words], env=before | environment, check=False,
                              stdout=subprocess.DEVNULL).returncode

    def test_it_ends_as_the_command_does(self):
        self.assertEqual(self.status_of("A", "true"), 0)
        self.assertEqual(self.status_of("A", "sh", "-c", "exit 3"), 3)

    def test_what_has_passed_is_skipped_until_its_inputs_change(self):
        self.assertEqual(self.status_of("--keep", "A"), 0)
        self.assertEqual(self.status_of("A", "false"), SKIPPED)
        self.assertEqual(self.status_of("B", "false"), 1)
        self.assertEqual(self.status_of("A", "false", RAILCAST_TRY_ALL="1"), 1)
        (self.root / "core/a.cpp").write_text("compiled alone")
        self.assertEqual(self.status_of("A", "false"), SKIPPED)
        for name in ("core/include/a.h", "core/base/CMakeLists.txt", "tests/where_changed.py"):
            with self.subTest(name):
                self.assertEqual(self.status_of("--keep", "A"), 0)
                (self.root / name).write_text((self.root / name).read_text() + "\n")
                self.assertEqual(self.status_of("A", "false"), 1)

    def test_a_test_depends_on_the_files_of_its_group_alone(self):
        self.assertEqual(self.status_of("--keep", "A", "C"), 0)
        (self.root / "core/a.cpp").write_text("changed")
        self.assertEqual(self.status_of("--is-due", "A"), 1)
        self.assertEqual(self.status_of("--is-due", "B"), 0)
        self.assertEqual(self.status_of("--is-due", "C"), 0)
        self.assertEqual(self.status_of("--is-due", "A", RAILCAST_TRY_ALL="1"), 0)

    def test_what_passes_is_kept_where_asked_for(self):
        self.assertEqual(self.status_of("A", "false", RAILCAST_KEEP="1"), 1)
        self.assertEqual(self.status_of("A", "true"), 0)
        self.assertEqual(self.status_of("A", "true", RAILCAST_KEEP="1"), 0)
        self.assertEqual(self.status_of("A", "false"), SKIPPED)

    def test_a_test_without_a_group_is_an_error(self):
        self.assertEqual(self.status_of("D", "true"), 1)


if __name__ == "__main__":
    unittest.main()
