"""Tests of packages run where what packages are made of has changed: where_changed_test.py."""

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
        for name in ("CMakeLists.txt", "pyproject.toml", "scripts/package.sh", "scripts/packages.sh",
                     "tests/python/wheel_test.py", "core/include/a.h", "core/a.cpp", "core/base/CMakeLists.txt"):
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            (self.root / name).write_text(name)
        (self.root / "tests/package").mkdir()
        self.script = shutil.copy(SCRIPT, self.root / "tests/package")

    def status_of(self, *words, **environment):
        before = {key: value for key, value in os.environ.items() if key != "RAILCAST_TRY_PACKAGES"}
        return subprocess.run([sys.executable, "-B", self.script, *words], env=before | environment, check=False,
                              stdout=subprocess.DEVNULL).returncode

    def test_it_ends_as_the_command_does(self):
        self.assertEqual(self.status_of("A", "true"), 0)
        self.assertEqual(self.status_of("A", "sh", "-c", "exit 3"), 3)

    def test_what_has_passed_is_skipped_until_its_inputs_change(self):
        self.assertEqual(self.status_of("--keep", "A"), 0)
        self.assertEqual(self.status_of("A", "false"), SKIPPED)
        self.assertEqual(self.status_of("B", "false"), 1)
        self.assertEqual(self.status_of("A", "false", RAILCAST_TRY_PACKAGES="1"), 1)
        (self.root / "core/a.cpp").write_text("compiled alone")
        self.assertEqual(self.status_of("A", "false"), SKIPPED)
        for name in ("core/include/a.h", "core/base/CMakeLists.txt", "tests/package/where_changed.py"):
            with self.subTest(name):
                self.assertEqual(self.status_of("--keep", "A"), 0)
                (self.root / name).write_text((self.root / name).read_text() + "\n")
                self.assertEqual(self.status_of("A", "false"), 1)


if __name__ == "__main__":
    unittest.main()
