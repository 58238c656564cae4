"""`pip wheel .` makes a wheel that brings its libraries; here it is made of what the build has."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

from support import BUILD, ROOT, SKIPPED

sys.path.insert(0, str(ROOT / "generator" / "python"))
import wheel_backend  # noqa: E402  # pylint: disable=wrong-import-position
import wheel_libraries  # noqa: E402  # pylint: disable=wrong-import-position

THREE_LINES = """
import railcast
frame = railcast.Simulator(railcast.SCENARIOS / "st_gallen_approach.json").scan(30)
xyz, label = frame.points(), frame["label"][frame.has_point]
assert len(xyz) == len(label) > 1000
print(railcast.__file__)
"""
MOST_BYTES = 60e6


def run(*command):
    return subprocess.run([str(word) for word in command], env={"PATH": "/usr/bin:/bin"}, check=True,
                          capture_output=True, text=True).stdout


class Wheel(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        run(sys.executable, "-m", "pip", "wheel", "--no-index", "--no-deps", "--config-settings", f"build-dir={BUILD}",
            "--wheel-dir", cls.folder, ROOT)
        cls.wheel, = cls.folder.glob("railcast-*.whl")
        cls.environment = cls.folder / "environment"
        # With the numpy and the pip of the system.
        run(sys.executable, "-m", "venv", "--system-site-packages", "--without-pip", cls.environment)
        cls.python = cls.environment / "bin" / "python3"
        run(cls.python, "-m", "pip", "install", "--no-index", cls.wheel)

    @classmethod
    def tearDownClass(cls):
        run(cls.python, "-m", "pip", "uninstall", "--yes", "railcast")
        left = [path for path in cls.environment.rglob("*railcast*") if path.name != "__pycache__"]
        assert not left, left

    def test_it_gives_a_frame_in_three_lines(self):
        where = run(self.python, "-c", THREE_LINES).strip()
        self.assertTrue(where.startswith(str(self.environment)), where)

    def test_it_brings_the_programs(self):
        out = self.folder / "demo"
        scenario = run(self.python, "-c", "import railcast; print(railcast.SCENARIOS / 'minimal.json')").strip()
        run(self.environment / "bin" / "railcast-generate", "sequence", scenario, "--out", out, "--frames", 1)
        self.assertIn("whole", run(self.environment / "bin" / "railcast-analyze", "verify", out))
        self.assertIn("Usage: ", run(self.environment / "bin" / "railcast-generate", "insert", "--help"))

    def test_it_says_what_extras_it_has(self):
        self.assertIn("ros", run(self.python, "-c", "import railcast; print(railcast.EXTRAS)"))

    def test_its_libraries_are_inside(self):
        package, = self.environment.glob("lib/python3*/site-packages/railcast")
        libraries = list(package.with_name("railcast.libs").iterdir())
        for name in ("libembree", "libtbb"):
            self.assertEqual(sum(library.name.startswith(name) for library in libraries), 1, libraries)
        for binary in (*package.glob("*.so"), *package.glob("bin/*"), *libraries):
            for line in run("ldd", binary).splitlines():
                name, _, place = line.strip().partition(" => ")
                if place and not wheel_libraries.OF_THE_SYSTEM.match(name):
                    self.assertIn(str(self.environment), place, binary)

    def test_making_it_shows_on_the_terminal_how_far_it_is(self):
        terminal = self.folder / "terminal"
        steps = "".join(f"[{step}/40] Building {step}.o\n" for step in range(1, 41))
        wheel_backend.run_with_progress("printf", steps, terminal=terminal)
        percents = re.findall(r"railcast: (\d+) % compiled", terminal.read_text("utf-8"))
        self.assertEqual([int(percent) for percent in percents], [2, *range(5, 101, 5)])
        with self.assertRaises(subprocess.CalledProcessError):
            wheel_backend.run_with_progress("false", terminal=terminal)

    def test_it_is_small_and_says_on_what_it_runs(self):
        self.assertLess(self.wheel.stat().st_size, MOST_BYTES)
        self.assertRegex(self.wheel.name, r"-cp\d+-cp\d+-manylinux_2_\d+_\w+\.whl$")

    def test_it_has_types_and_licences(self):
        listed = run(self.python, "-m", "pip", "show", "--files", "railcast")
        for file in ("__init__.py", "_railcast.pyi", "py.typed", "dataset.py"):
            self.assertIn(f"railcast/{file}\n", listed)
        for name in ("railcast", "libembree", "libtbb"):
            self.assertRegex(listed, rf"dist-info/licenses/{name}")


if __name__ == "__main__":
    for module in ("venv", "pip"):
        if subprocess.run([sys.executable, "-c", f"import {module}"], capture_output=True, check=False).returncode != 0:
            print(f"skipped: {sys.executable} has no {module} (python3-{'venv' if module != 'pip' else 'pip'})")
            sys.exit(SKIPPED)
    if not shutil.which("patchelf"):
        print("skipped: patchelf is not installed")
        sys.exit(SKIPPED)
    unittest.main()
