#!/usr/bin/env python3
"""Collects what your object detector reports of a live stream, for `railcast-analyze evaluate --detections`.

Takes a datagram with a line for each frame (docs/evaluate.md, "Live"), until Ctrl-C. Needs only Python.
"""

import argparse
import json
import math
import os
import select
import signal
import socket
import sys
import time

from receive_stream import HOLD_S, listener_at, place_of

PATIENCE_S = 0.02  # Seconds between checks whether the program was stopped.
CONTROLS = {chr(code) for code in (*range(32), 127)}
MOST_SHOWN = 60  # Characters of a faulty value.


def is_whole(value, most=2**32 - 1):
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= most


def is_within(value, low, high):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and low <= value <= high


def are_numbers(value, count, low, high):
    return isinstance(value, list) and len(value) == count and all(is_within(each, low, high) for each in value)


# What a line and a detection may hold: what the value must be, and whether it is.
LINE = {
    "frame": ("a whole number from 0 to 4294967295", is_whole),
    "latency_ms": ("a number from 0 to 100000", lambda value: is_within(value, 0, 1e5)),
    "compensate": ("none, sensor or all", lambda value: value in ("none", "sensor", "all")),
    "axes": ("sensor, vehicle or world", lambda value: value in ("sensor", "vehicle", "world")),
    "handedness": ("right or left", lambda value: value in ("right", "left")),
    "detections": ("a list", lambda value: isinstance(value, list))}
DETECTION = {
    "center_m": ("3 numbers from -1e7 to 1e7", lambda value: are_numbers(value, 3, -1e7, 1e7)),
    "size_m": ("3 numbers > 0 and <= 1000", lambda value: are_numbers(value, 3, math.ulp(0), 1e3)),
    "quaternion_xyzw": ("4 numbers of length 1",
                        lambda value: are_numbers(value, 4, -1, 1) and abs(math.hypot(*value) - 1) <= 1e-3),
    "points": ("a list of whole numbers that is not empty",
               lambda value: isinstance(value, list) and value and all(is_whole(each) for each in value)),
    "score": ("a number from 0 to 1", lambda value: is_within(value, 0, 1)),
    "class": ("one line of text", lambda value: isinstance(value, str) and not set(value) & CONTROLS)}


def shown_text(text):
    """A text from the network on one line of a terminal."""
    text = "".join(each if each.isprintable() else "?" for each in text[:MOST_SHOWN + 1])
    return text if len(text) <= MOST_SHOWN else text[:MOST_SHOWN] + "..."


def fault(place, rule, value):
    return f"{place}{rule} (got {shown_text(value if isinstance(value, str) else json.dumps(value))})"


def faults_of(thing, keys, place):
    """Yields the faults of a JSON object: unknown keys, and values against the rules in `keys`."""
    if not isinstance(thing, dict):
        yield fault(f"{place}: " if place else "", "must be an object", thing)
        return
    for key, value in thing.items():
        if key not in keys:
            yield f"{place}/{shown_text(key)}: unknown key"
        elif not keys[key][1](value):
            yield fault(f"{place}/{key}: ", f"must be {keys[key][0]}", value)


def faults_of_line(line):
    """Yields the faults of a line for which `evaluate` would refuse the file."""
    yield from faults_of(line, LINE, "")
    if not isinstance(line, dict):
        return
    yield from (f"/{key}: missing" for key in ("frame", "detections") if key not in line)
    detections = line.get("detections")
    for number, detection in enumerate(detections if isinstance(detections, list) else []):
        place = f"/detections/{number}"
        yield from faults_of(detection, DETECTION, place)
        if isinstance(detection, dict):
            found = {"center_m", "size_m", "points"} & detection.keys()
            if found not in ({"points"}, {"center_m", "size_m"}):
                yield f"{place}: must have either center_m and size_m, or points"


def refuse_constant(name):
    raise ValueError(f"numbers must be finite (got {name})")


def refuse_repeated(pairs):
    keys = dict(pairs)
    if len(keys) < len(pairs):
        raise ValueError("keys must be different")
    return keys


def frame_of(datagram, origin):
    """The line of a datagram, without its end, and its frame. Raises ValueError with a line for each fault."""
    line = datagram.removesuffix(b"\n").removesuffix(b"\r")
    if b"\n" in line:
        raise ValueError(fault(f"{origin}: ", "must send one line in each datagram",
                               datagram.decode(errors="replace").replace("\n", "\\n")))
    try:
        content = json.loads(line.decode(), parse_constant=refuse_constant, object_pairs_hook=refuse_repeated)
        faults = list(faults_of_line(content))
    except (ValueError, RecursionError) as reason:
        raise ValueError(f"{origin}: is no line of JSON: {reason}") from reason
    if faults:
        raise ValueError("\n".join(f"{origin}: {each}" for each in faults))
    return line + b"\n", content["frame"]


class Lines:
    """Lines by frame. Each is appended to FILE.part as it comes, so that none is lost if the program is killed."""

    def __init__(self, file):
        self.file = os.path.realpath(file)
        self.part = f"{self.file}.part"
        if os.path.exists(self.file) and not os.path.isfile(self.file):
            raise ValueError(f"{file}: must be a regular file")
        try:
            # Fail before anything is sent if the file cannot be written.
            with open(self.part, "xb"):
                os.remove(self.part)
        except FileExistsError as reason:
            raise ValueError(f"{self.part}: holds the lines of a collection that was killed; move it away") from reason
        self.lines = {}
        self.written = None  # FILE.part, open from the first line on.
        self.num_repeated = 0

    def take(self, datagram, origin):
        """Takes a datagram. A line that a network delivers twice is only counted. Raises ValueError if it is faulty."""
        line, frame = frame_of(datagram, origin)
        known = self.lines.setdefault(frame, line)
        if known is not line:
            if known != line:
                raise ValueError(f"{origin}: /frame: must be that of one line only (got {frame})")
            self.num_repeated += 1
            return
        if self.written is None:
            self.written = open(self.part, "xb")
        self.written.write(line)
        self.written.flush()

    def finish(self):
        """Gives the file its name, with the lines in their order."""
        if self.written is None:
            return
        self.written.seek(0)
        self.written.write(b"".join(self.lines[frame] for frame in sorted(self.lines)))
        os.fsync(self.written.fileno())
        self.written.close()
        os.replace(self.part, self.file)

    def summary(self):
        text = f"frames: {len(self.lines)}"
        if self.lines:
            first, last = min(self.lines), max(self.lines)
            text += f", from {first} to {last}, {last - first + 1 - len(self.lines)} missing between"
        return f"{text}; {self.num_repeated} repeated datagrams"


class Senders:
    """The sender that is followed: the first one heard, until it has been silent for HOLD_S."""

    def __init__(self, wanted):
        self.wanted = wanted  # Host and port, 0 for any port; None for any sender.
        self.followed, self.heard_s = None, -math.inf
        self.num_others, self.last_other = 0, None

    def drops(self, origin):
        """Whether datagrams of this origin are dropped; if so, counts one."""
        is_wanted = self.wanted is None or self.wanted in (origin, (origin[0], 0))
        if is_wanted and (origin == self.followed or time.monotonic() >= self.heard_s + HOLD_S):
            return False
        self.num_others += 1
        self.last_other = origin
        return True

    def follow(self, origin):
        """Follows the sender of a line that has been taken."""
        self.followed, self.heard_s = origin, time.monotonic()


def shown(origin):
    host, port = origin
    return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"


def collect(listener, senders, lines, options):
    """Takes datagrams until there are enough, the time is over, or a signal ends it."""
    signals = []
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda number, _: signals.append(number))
    print("listening at", place_of(listener), flush=True)
    end_s = time.monotonic() + options.duration
    is_over = False
    while len(lines.lines) < options.frames:
        is_over = is_over or signals or time.monotonic() >= end_s
        # Datagrams that had arrived by then are still taken.
        if not select.select([listener], [], [], 0 if is_over else PATIENCE_S)[0]:
            if is_over:
                return
            continue
        datagram, origin = listener.recvfrom(65536)
        if not senders.drops(origin[:2]):
            lines.take(datagram, shown(origin[:2]))
            senders.follow(origin[:2])


def sender_named(text, family):
    """The host and port of HOST or HOST:PORT, as recvfrom() returns them; port 0 stands for any."""
    host, port = text, 0
    if "]:" in text or text.count(":") == 1:
        host, _, port = text.rpartition(":")
    found = socket.getaddrinfo(host.strip("[]"), int(port), family, socket.SOCK_DGRAM, 0, socket.AI_V4MAPPED)
    return found[0][4][:2]


def positive(kind):
    def parse(text):
        value = kind(text)
        if not value > 0:
            raise ValueError
        return value
    parse.__name__ = "number above 0"
    return parse


def run(options):
    """Collects, prints a summary, and returns the faults."""
    lines = Lines(options.out)
    try:
        listener = listener_at(options.at)
    except (OSError, ValueError, OverflowError) as reason:
        raise ValueError(f"cannot listen: {getattr(reason, 'strerror', None) or reason} (got {options.at})") from reason
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 24)
    try:
        senders = Senders(options.sender and sender_named(options.sender, listener.family))
    except (OSError, ValueError, OverflowError) as reason:
        raise ValueError(f"--from: {getattr(reason, 'strerror', None) or reason} (got {options.sender})") from reason
    faults = []
    try:
        collect(listener, senders, lines, options)
    except ValueError as reason:
        faults.append(str(reason))
    finally:
        lines.finish()
        print(lines.summary(), flush=True)
        if senders.num_others:
            print(f"datagrams of other senders: {senders.num_others}, dropped; the last from "
                  f"{shown(senders.last_other)}", flush=True)
    if not faults and not lines.lines:  # An empty file would say that nothing was detected in any frame.
        faults.append(f"{place_of(listener)}: must be sent a line for each frame (got none)")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("at", nargs="?", default="127.0.0.1:27402", metavar="ADDRESS", help="HOST:PORT to listen at")
    parser.add_argument("--out", required=True, metavar="FILE", help="file to write: JSON lines; until the end FILE.part")
    parser.add_argument("--from", dest="sender", metavar="HOST[:PORT]",
                        help="whose datagrams are taken; default: the first sender heard")
    parser.add_argument("--frames", type=positive(int), default=math.inf, metavar="N", help="frames after which to end")
    parser.add_argument("--duration", type=positive(float), default=math.inf, metavar="S",
                        help="seconds after which to end")
    options = parser.parse_args()
    try:
        faults = run(options)
    except OSError as reason:
        faults = [f"{reason.filename or options.out}: {reason.strerror}"]
    except ValueError as reason:
        faults = [str(reason)]
    for each in faults:
        print(each, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
