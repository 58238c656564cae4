"""`pip install .` without a network installs the module, here from the build's own."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from support import BUILD, ROOT, SCENARIO, SKIPPED

THREE_LINES = f"""
import railcast
frame = railcast.Simulator({str(SCENARIO)!r}).scan(30)
xyz, label = frame.points(), frame["label"][frame.has_point]
assert len(xyz) == len(label) > 1000
print(railcast.__file__)
"""


def run(*command):
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    return subprocess.run([str(word) for word in command], env=environment, check=True, capture_output=True,
                          text=True).stdout


class Wheel(unittest.TestCase):

    def test_pip_installs_it_without_a_network(self):
        with tempfile.TemporaryDirectory() as name:
            environment = pathlib.Path(name) / "environment"
            run(sys.executable, "-m", "venv", "--system-site-packages", environment)
            python = environment / "bin" / "python3"
            run(python, "-m", "pip", "install", "--no-index", "--config-settings", f"build-dir={BUILD}", ROOT)
            where = run(python, "-c", THREE_LINES).strip()
            self.assertTrue(where.startswith(str(environment)), where)
            listed = run(python, "-m", "pip", "show", "--files", "railcast")
            for file in ("__init__.py", "_railcast.pyi", "py.typed", "dataset.py"):
                self.assertIn(f"railcast/{file}\n", listed)
            run(python, "-m", "pip", "uninstall", "--yes", "railcast")
            self.assertEqual(run(python, "-c", "import importlib.util as u; print(u.find_spec('railcast'))").strip(),
                             "None")


if __name__ == "__main__":
    for module in ("venv", "pip", "ensurepip"):
        if subprocess.run([sys.executable, "-c", f"import {module}"], capture_output=True, check=False).returncode != 0:
            print(f"skipped: {sys.executable} has no {module} (python3-{'venv' if module != 'pip' else 'pip'})")
            sys.exit(SKIPPED)
    unittest.main()
