"""Runs the programs on machines that lack something: poor_machine_test.py BUILD_DIR.

Each test takes one thing away: a display, a home that can be written to, /dev/shm, AVX, calls that kernels have had
only since 2014 to 2020. A program then does without, or says in one line what it needs. Ends with 77 if what stands for
such a machine is not installed.
"""

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
# Calls that came with the kernels 3.15 to 5.9.
NEW_CALLS = "clone3,rseq,statx,getrandom,membarrier,faccessat2,copy_file_range,renameat2,openat2,close_range"

NO_DISPLAY = "error: no display: on a machine without one, run xvfb-run -a -s -noreset railcast-view ...\n"


def tool(name):
    """Skips the test if a tool is missing."""
    if not shutil.which(name):
        raise unittest.SkipTest(f"{name} is not installed")
    return name


class PoorMachine(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def sequence(self, name, *options):
        return [BUILD / "generator/railcast-generate", "sequence", ROOT / "scenarios/minimal.json", "--frames", "1",
                "--out", self.folder / name, *options]

    def run_ok(self, command, **settings):
        run = subprocess.run(command, capture_output=True, text=True, check=False, **settings)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        return run

    def refused(self, command, **settings):
        """What a program says that ends with status 1 and one line."""
        run = subprocess.run(command, capture_output=True, text=True, check=False, **settings)
        self.assertEqual(run.returncode, 1, run.stdout + run.stderr)
        self.assertEqual(run.stdout, "")
        self.assertEqual(run.stderr.count("\n"), 1, run.stderr)
        return run.stderr

    def cloud(self, name):
        return hashlib.sha256((self.folder / name / "frames/000000.pcd").read_bytes()).hexdigest()

    def columns(self, name):
        return np.loadtxt(self.folder / name / "frames/000000.pcd", skiprows=11).T

    def test_without_a_display_the_viewer_says_what_to_do(self):
        self.run_ok(self.sequence("run"))
        environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
        said = self.refused([BUILD / "viewer/railcast-view", self.folder / "run"], env=environment)
        self.assertEqual(said, NO_DISPLAY)
        # One that is not there is none.
        said = self.refused([BUILD / "viewer/railcast-view", self.folder / "run"], env={**environment, "DISPLAY": ":97"})
        self.assertEqual(said, NO_DISPLAY)

    def test_without_a_home_everything_is_written_where_it_was_asked_for(self):
        # Nobody, not even root, creates anything in /proc.
        environment = {**os.environ, "HOME": "/proc", "XDG_CACHE_HOME": "/proc", "XDG_CONFIG_HOME": "/proc"}
        self.run_ok(self.sequence("run"), env=environment)
        self.run_ok([BUILD / "analysis/railcast-analyze", "stats", self.folder / "run", "--out", self.folder / "stats"],
                    env=environment)
        self.assertTrue((self.folder / "stats/charts/sheet.png").is_file())
        # xvfb-run has a folder of its own; the viewer has none.
        self.run_ok([tool("xvfb-run"), "-a", "-s", "-noreset", BUILD / "viewer/railcast-view", self.folder / "run",
                     "--screenshot", self.folder / "run.png"], env=environment)
        self.assertTrue((self.folder / "run.png").is_file())

    def test_without_shared_memory_nothing_changes(self):
        self.run_ok(self.sequence("run"))
        inner = 'mount -t tmpfs -o ro,size=4k none /dev/shm && exec "$@"'
        mounted = [tool("unshare"), "--mount", "sh", "-c", inner, "sh"]
        if subprocess.run([*mounted, "true"], capture_output=True, check=False).returncode != 0:
            self.skipTest("nothing may be mounted here")
        self.run_ok([*mounted, *self.sequence("without")])
        self.assertEqual(self.cloud("without"), self.cloud("run"))

    def test_without_avx_frames_are_those_of_sse2_but_for_last_bits(self):
        emulated = [tool("qemu-x86_64"), "-cpu", "qemu64"]
        text = ["--format", "pcd-ascii", "--fields", "range_m,label"]
        self.run_ok([*emulated, *self.sequence("emulated", *text)])
        self.run_ok(self.sequence("here", "--isa", "sse2", *text))
        ranges_m, labels = self.columns("emulated")
        ranges_here_m, labels_here = self.columns("here")
        self.assertGreater(np.isfinite(ranges_m).sum(), 10_000)
        # The emulator computes the reciprocal exactly that a processor approximates.
        self.assertLess((labels != labels_here).sum(), 5)
        share = np.nanmean(np.where(np.isfinite(ranges_m), ranges_m != ranges_here_m, np.nan))
        self.assertGreater(share, 0.1)
        self.assertLess(share, 0.5)
        same = labels == labels_here
        np.testing.assert_allclose(ranges_m[same], ranges_here_m[same], rtol=0, atol=2e-4)
        said = self.refused([*emulated, *self.sequence("avx2", "--isa", "avx2")])
        self.assertEqual(said, "--isa: must be an instruction set of this machine, one of sse2 (got avx2)\n")
        self.assertFalse((self.folder / "avx2").exists())

    def test_on_an_old_kernel_frames_are_the_same(self):
        traced = [tool("strace"), "--follow-forks", "--output", self.folder / "calls", "--trace", NEW_CALLS, "--inject",
                  f"{NEW_CALLS}:error=ENOSYS"]
        if subprocess.run([*traced, "true"], capture_output=True, check=False).returncode != 0:
            self.skipTest("nothing may be traced here")
        self.run_ok([*traced, *self.sequence("old")])
        # Some were asked for, in vain.
        self.assertIn("ENOSYS", (self.folder / "calls").read_text())
        self.run_ok(self.sequence("here"))
        self.assertEqual(self.cloud("old"), self.cloud("here"))


if __name__ == "__main__":
    BUILD = Path(sys.argv.pop(1)).resolve()
    ended = unittest.main(exit=False).result
    for test, reason in ended.skipped:
        print(f"skipped: {test}: {reason}")
    sys.exit(1 if not ended.wasSuccessful() else 77 if ended.skipped else 0)
