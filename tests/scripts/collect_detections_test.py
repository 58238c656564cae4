"""examples/collect_detections.py writes what a detector sends as a file for `evaluate`."""

import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
HOST = f"127.{1 + os.getpid() % 250}.0.1"  # Any 127.x.x.x is loopback; this one is hardly another test's.


def line_of(frame, detections=""):
    return f'{{"frame": {frame}, "detections": [{detections}]}}\n'


def place_of(sender):
    return "%s:%d" % sender.getsockname()


class Collecting(unittest.TestCase):

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.file = pathlib.Path(temporary.name).resolve() / "mine.jsonl"
        self.part = self.file.with_name("mine.jsonl.part")
        self.detector = self.sender()

    def sender(self):
        sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(sender.close)
        sender.bind(("127.0.0.1", 0))
        return sender

    def start(self, *options, at=f"{HOST}:0"):
        command = [sys.executable, "-B", ROOT / "examples/collect_detections.py", at, "--out", self.file, *options]
        self.program = subprocess.Popen(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.addCleanup(self.program.kill)

    def listen(self, *options):
        self.start(*options)
        said, self.at = self.program.stdout.readline().split(" at ")
        self.assertEqual(said, "listening")
        self.at = self.at.strip()

    def send(self, text, sender=None):
        (sender or self.detector).sendto(text.encode(), (HOST, int(self.at.rpartition(":")[2])))

    def assert_ends(self, status, said):
        self.assertEqual(self.program.communicate(timeout=60)[0], said)
        self.assertEqual(self.program.returncode, status)

    def test_it_writes_lines_by_rising_frame_when_it_has_them(self):
        self.listen("--frames", "3")
        for frame in (7, 4, 7, 5):
            self.send(line_of(frame))
        self.assert_ends(0, "frames: 3, from 4 to 7, 1 missing between; 1 repeated datagrams\n")
        self.assertEqual(self.file.read_text(), line_of(4) + line_of(5) + line_of(7))
        self.assertFalse(self.part.exists())

    def test_it_ends_at_a_signal_with_what_had_arrived(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            self.listen()
            for frame in (2, 3, 4):
                self.send(line_of(frame))
            self.program.send_signal(number)
            self.assert_ends(0, "frames: 3, from 2 to 4, 0 missing between; 0 repeated datagrams\n")
            self.assertEqual(self.file.read_text(), line_of(2) + line_of(3) + line_of(4))

    def test_lines_may_come_without_their_end_and_with_that_of_windows(self):
        self.listen("--frames", "2")
        self.send(line_of(4).rstrip())
        self.send(line_of(5).replace("\n", "\r\n"))
        self.assert_ends(0, "frames: 2, from 4 to 5, 0 missing between; 0 repeated datagrams\n")
        self.assertEqual(self.file.read_text(), line_of(4) + line_of(5))

    def test_it_ends_at_the_first_faulty_datagram_with_the_lines_before_it(self):
        box = '"center_m": [0, 0, 0], "size_m": [1, 0, 1]'
        for datagram, faults in (
                ('{"frame": 5}', ["/detections: missing"]),
                (line_of(4, '{"points": [1]}'), ["/frame: must be that of one line only (got 4)"]),
                (line_of(5, '{"points": []}'),
                 ["/detections/0/points: must be a list of whole numbers that is not empty (got [])"]),
                (line_of(5, f"{{{box}}}"), ["/detections/0/size_m: must be 3 numbers > 0 and <= 1000 (got [1, 0, 1])"]),
                (line_of(5, '{"center_m": [0, 0, 0]}'), ["/detections/0: must have either center_m and size_m, or points"]),
                ('{"frame": -1, "axis": "sensor", "detections": []}',
                 ["/frame: must be a whole number from 0 to 4294967295 (got -1)", "/axis: unknown key"]),
                (line_of(5) + line_of(6),
                 ['must send one line in each datagram (got {"frame": 5, "detections": []}\\n{"frame": 6, "detections": [...)']),
                ('{"frame": NaN, "detections": []}', ["is no line of JSON: numbers must be finite (got NaN)"]),
                ("", ["is no line of JSON: Expecting value: line 1 column 1 (char 0)"]),
                ("[1]", ["must be an object (got [1])"])):
            self.listen()
            self.send(line_of(4))
            self.send(datagram)
            self.assert_ends(1, "frames: 1, from 4 to 4, 0 missing between; 0 repeated datagrams\n" +
                             "".join(f"{place_of(self.detector)}: {fault}\n" for fault in faults))
            self.assertEqual(self.file.read_text(), line_of(4))

    def test_it_follows_the_first_sender_that_it_hears(self):
        self.listen("--frames", "2")
        other = self.sender()
        self.send(line_of(4))
        self.send("nonsense", other)
        self.send(line_of(6), other)
        self.send(line_of(5))
        self.assert_ends(0, "frames: 2, from 4 to 5, 0 missing between; 0 repeated datagrams\n"
                            f"datagrams of other senders: 2, dropped; the last from {place_of(other)}\n")
        self.assertEqual(self.file.read_text(), line_of(4) + line_of(5))

    def test_it_keeps_each_line_as_it_comes_also_when_it_is_killed(self):
        self.listen()
        self.send(line_of(7))
        self.send(line_of(4))
        while not self.part.exists() or self.part.read_text() != line_of(7) + line_of(4):
            time.sleep(0.001)
        self.program.kill()
        self.program.communicate()
        self.assertFalse(self.file.exists())
        self.start()
        self.assert_ends(1, f"{self.part}: holds the lines of a collection that was killed; move it away\n")
        self.assertEqual(self.part.read_text(), line_of(7) + line_of(4))

    def test_it_takes_nobody_but_who_it_is_told_and_writes_nothing_without_detections(self):
        self.file.write_text("as it was")
        self.listen("--from", "127.9.9.9", "--duration", "1")
        self.send(line_of(4))
        self.send("nonsense")
        self.assert_ends(1, "frames: 0; 0 repeated datagrams\n"
                            f"datagrams of other senders: 2, dropped; the last from {place_of(self.detector)}\n"
                            f"{self.at}: must be sent a line for each frame (got none)\n")
        self.assertEqual(self.file.read_text(), "as it was")
        self.assertFalse(self.part.exists())

    def test_a_sender_may_be_named_with_its_port(self):
        self.listen("--from", place_of(self.detector), "--frames", "1")
        self.send(line_of(3), self.sender())
        self.send(line_of(4))
        self.assertIn("frames: 1, from 4 to 4", self.program.communicate(timeout=60)[0])

    def test_it_names_what_it_cannot_listen_to_or_write(self):
        taken = place_of(self.detector)
        self.start(at=taken)
        self.assert_ends(1, f"cannot listen: Address already in use (got {taken})\n")
        self.start("--from", "127.0.0.1:x")
        self.assert_ends(1, "--from: invalid literal for int() with base 10: 'x' (got 127.0.0.1:x)\n")
        folder = self.file.parent
        self.file = folder / "none" / "mine.jsonl"
        self.start()
        self.assert_ends(1, f"{self.file}.part: No such file or directory\n")
        self.file = folder
        self.start()
        self.assert_ends(1, f"{folder}: must be a regular file\n")


if __name__ == "__main__":
    unittest.main()
