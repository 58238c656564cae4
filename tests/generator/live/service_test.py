"""A stream tells systemd that it is ready and goes on, and answers on its health port: service_test.py GENERATE SOURCE.

The manager is a socket of this test's, as systemd gives one to services (sd_notify(3)).
"""

import http.client
import json
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

GENERATE, SOURCE = sys.argv.pop(1), pathlib.Path(sys.argv.pop(1))
PATIENCE_S = 60


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def get(port, target):
    client = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
    client.request("GET", target)
    answer = client.getresponse()
    return answer.status, answer.read().decode()


class Service(unittest.TestCase):

    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.manager = self.enterContext(socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM))
        self.manager.bind(str(self.folder / "notify"))
        self.manager.settimeout(PATIENCE_S)

    def stream(self, *options, watchdog_s=0.3):
        environment = {"NOTIFY_SOCKET": str(self.folder / "notify"), "WATCHDOG_USEC": str(int(watchdog_s * 1e6))}
        command = [GENERATE, "stream", SOURCE / "scenarios/minimal.json", "--to", f"127.0.0.1:{free_port()}", *options]
        process = subprocess.Popen([str(word) for word in command], env=environment, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        return process

    def hear(self, word):
        """What the manager hears up to a line; it fails after PATIENCE_S."""
        heard = []
        while word not in heard:
            heard += self.manager.recv(65536).decode().split("\n")
        return heard

    def test_it_is_ready_goes_on_and_stops(self):
        port = free_port()
        process = self.stream("--health-port", port)
        self.assertNotIn("WATCHDOG=1", self.hear("READY=1")[:-2])
        # The watchdog wants to hear of it every 0.3 s.
        begin = time.monotonic()
        statuses = [line for _ in range(8) for line in self.hear("WATCHDOG=1") if line.startswith("STATUS=")]
        self.assertEqual(len(statuses), 8)
        self.assertRegex(statuses[-1], r"^STATUS=[\d.]+ s, [1-9]\d* frames, \d+ late")
        self.assertLess(time.monotonic() - begin, PATIENCE_S / 4)
        status, line = get(port, "/health")
        self.assertEqual(status, 200)
        self.assertEqual(json.loads(line)["status"], "running")
        self.assertGreater(json.loads(line)["frames"], 0)
        status, text = get(port, "/metrics")
        self.assertEqual(status, 200)
        self.assertRegex(text, r'(?m)^railcast_frames_total\{sensor="\w+"\} [1-9]\d*$')
        process.send_signal(signal.SIGTERM)
        self.hear("STOPPING=1")
        said, faults = process.communicate(timeout=PATIENCE_S)
        self.assertEqual((process.returncode, faults), (0, ""), said)
        self.assertIn(f"health at 127.0.0.1:{port}\n", said)

    def test_it_goes_on_while_it_waits_for_commands(self):
        process = self.stream("--commands-port", free_port(), "--lockstep")
        self.hear("READY=1")
        for _ in range(5):
            self.hear("WATCHDOG=1")
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=PATIENCE_S)

    def test_a_port_that_is_taken_is_refused_in_a_line(self):
        with socket.socket() as other:
            other.bind(("127.0.0.1", 0))
            other.listen()
            port = other.getsockname()[1]
            process = self.stream("--health-port", port)
            _, faults = process.communicate(timeout=PATIENCE_S)
        self.assertEqual(process.returncode, 1)
        self.assertRegex(faults, rf"^--health-port: .*127\.0\.0\.1:{port}.*\n$")

    @unittest.skipUnless(shutil.which("systemd-analyze"), "systemd is not installed")
    def test_systemd_takes_the_unit(self):
        unit = self.folder / "railcast-stream@.service"
        text = (SOURCE / "scripts/packaging/railcast-stream@.service").read_text("utf-8")
        unit.write_text(text.replace("/usr/bin/railcast-generate", GENERATE), "utf-8")
        ended = subprocess.run(["systemd-analyze", "verify", "--man=no", unit.with_name("railcast-stream@test.service")],
                               capture_output=True, text=True, check=False, cwd=self.folder)
        self.assertEqual((ended.returncode, ended.stdout + ended.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
