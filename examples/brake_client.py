#!/usr/bin/env python3
"""Drives a simulated train on sight: finds the nearest obstacle on its track and brakes.

Speaks to `railcast-generate stream SCENARIO --commands-port PORT`, whose points must be in vehicle
axes (`output.frame` is "vehicle") on track that is straight as far as the sensor sees. An
obstacle is where enough points lie close together in the train's way, frame after frame.
Prints where it was detected, how far the train still ran and what gap is left; exits with
status 1 if there is no gap.
"""

import argparse
import collections
import json
import math
import random
import select
import socket
import struct
import sys
import time

from receive_stream import listener_at, read_datagram

# Half the width that pantographs need under 15 kV (EBO, Anlage 1). Ballast, rails and
# sleepers are below the box, and the contact wire is above it.
GAUGE_HALF_WIDTH_M = 1.43
GAUGE_BOTTOM_M = 0.35
GAUGE_TOP_M = 4.5

OBSTACLE_LENGTH_M = 1.0  # Points closer than this along the track belong to one object.
# A cluster is an object if it has LEAST_SHARE of the points that a face of SMALLEST_M2 returns at its
# distance. Raindrops and snowflakes are scattered and have fewer.
SMALLEST_M2 = 0.25
LEAST_SHARE = 0.3
# The echoes of dense fog lie within 25 m of a sensor like this one, so new obstacles are not
# searched for there, and the position of a known one is no longer measured.
NEAREST_M = 25.0
STANDSTILL_MPS = 0.02
AXES_FLAGS, VEHICLE_AXES = 0b1110, 0b0010  # docs/stream.md
PATIENCE_S = 60.0
RETRY_S = 0.5


class Frame:
    """The part of a frame that has arrived: points as (x, y, z), m. head: as read_datagram() returns it."""

    def __init__(self, head):
        self.run, self.number, self.num_packets = head[4], head[7], head[9]
        self.stamp_s = head[10] * 1e-9
        self.duration_s = head[11] * 1e-9
        self.position_m = head[18:21]
        self.points_of_packet = {}

    def is_before(self, head):
        return (self.run, self.number) < (head[4], head[7])

    def lacks(self, head):
        """Whether this datagram belongs to the frame and has not arrived before."""
        is_own = (self.run, self.number) == (head[4], head[7])
        return is_own and head[8] not in self.points_of_packet

    def add(self, head, names, points):
        x, y, z = (names.index(axis) for axis in "xyz")
        self.points_of_packet[head[8]] = [(point[x], point[y], point[z]) for point in points]

    def is_whole(self):
        return len(self.points_of_packet) == self.num_packets

    def points(self):
        return [point for points in self.points_of_packet.values() for point in points]


class Train:
    """The simulated train: receives its sensor's frames and sends it commands."""

    def __init__(self, options):
        self.stream = listener_at(options.stream)
        self.stream.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 24)
        # Sender of the first frame. Datagrams of others are ignored, so that they cannot feign
        # obstacles.
        self.sender = None
        self.to = options.commands
        self.controls = socket.socket(socket.AF_INET6 if ":" in self.to[0] else socket.AF_INET,
                                      socket.SOCK_DGRAM)
        self.is_lockstep = options.lockstep
        self.deceleration = options.deceleration
        self.session = f"brake_client {random.randrange(1 << 64):016x}"
        self.next_id = 0
        self.coming = None  # The frame whose datagrams are arriving.
        self.whole = collections.deque()
        self.num_lost = 0

    def tell(self, command):
        """Repeats a command until it is answered, and reads the stream meanwhile."""
        self.next_id += 1
        tag = {"session": self.session, "id": self.next_id}
        line = json.dumps({**tag, **command}).encode()
        end_s = time.monotonic() + PATIENCE_S
        while time.monotonic() < end_s:
            self.controls.sendto(line, self.to)
            again_s = time.monotonic() + RETRY_S
            while time.monotonic() < again_s:
                if self.receive(RETRY_S):
                    return
        sys.exit(f"no answer from {self.to[0]}:{self.to[1]}")

    def brake(self):
        self.tell({"command": "brake", "deceleration_mps2": self.deceleration})

    def frames(self):
        """Yields each frame once it is complete; incomplete ones are counted as lost."""
        end_s = time.monotonic() + PATIENCE_S
        while time.monotonic() < end_s:
            if self.is_lockstep:
                # The answer follows the last datagram of the frame; what does not arrive soon after
                # it is lost.
                self.tell({"command": "step"})
                while not self.whole and self.has_more():
                    self.receive(RETRY_S)
            else:
                self.receive(RETRY_S)
            while self.whole:
                yield self.whole.popleft()
                end_s = time.monotonic() + PATIENCE_S
        sys.exit(f"no whole frame for {PATIENCE_S:g} s")

    def has_more(self):
        return bool(select.select([self.stream], [], [], RETRY_S)[0])

    def receive(self, timeout_s):
        """Reads stream and answers. Returns whether the last command has been answered."""
        is_answered = False
        for port in select.select([self.stream, self.controls], [], [], timeout_s)[0]:
            data, origin = port.recvfrom(65536)
            if port is self.stream:
                self.take(data, origin)
            else:
                is_answered = self.is_answer(data)
        return is_answered

    def is_answer(self, data):
        answer = json.loads(data)
        if (answer.get("session"), answer.get("id")) != (self.session, self.next_id):
            return False
        if not answer["ok"]:
            sys.exit("refused: " + "; ".join(answer["faults"]))
        return True

    def take(self, datagram, origin):
        if self.sender not in (None, origin):
            return
        try:
            head, names, points = read_datagram(datagram)
        except (ValueError, KeyError, IndexError, struct.error):
            return
        if head[2] & AXES_FLAGS != VEHICLE_AXES:
            sys.exit("the points are not in vehicle axes: set the scenario's output.frame")
        self.sender = origin
        if self.coming is None or self.coming.is_before(head):
            self.num_lost += self.coming is not None and not self.coming.is_whole()
            self.coming = Frame(head)
        if self.coming.lacks(head):
            self.coming.add(head, names, points)
            if self.coming.is_whole():
                self.whole.append(self.coming)


def points_wanted(distance_m, options):
    """Least number of points of an object at a distance: a share of what a small one can return."""
    side_rad = math.radians(options.resolution)
    hits = SMALLEST_M2 / (max(distance_m, 1.0) * side_rad) ** 2
    return max(options.min_points, math.ceil(LEAST_SHARE * hits))


def things_ahead(points, options):
    """Distances in m ahead of the train's front at which enough points cluster in the gauge, rising."""
    along = sorted(x - options.front for x, y, z in points
                   if x > options.front and abs(y) < GAUGE_HALF_WIDTH_M
                   and GAUGE_BOTTOM_M < z < GAUGE_TOP_M)
    ahead, end = [], 0
    for first, distance_m in enumerate(along):
        while end < len(along) and along[end] <= distance_m + OBSTACLE_LENGTH_M:
            end += 1
        if end - first >= points_wanted(distance_m, options):
            ahead.append(distance_m)
    return ahead


class Lookout:
    """Tells obstacles from raindrops, fog and noise: an obstacle keeps its position."""

    def __init__(self, min_frames):
        self.seen = collections.deque(maxlen=min_frames)

    def nearest(self, places_m):
        """The nearest of these positions, rising, that was occupied in all recent frames, or None."""
        self.seen.append(places_m)
        if len(self.seen) < self.seen.maxlen:
            return None
        for place_m in places_m:
            if all(any(abs(place_m - other) <= 0.5 * OBSTACLE_LENGTH_M for other in others)
                   for others in self.seen):
                return place_m
        return None


class Drive:
    """One approach: brakes for an obstacle and measures the remaining gap."""

    def __init__(self, train, options):
        self.train = train
        self.options = options
        self.lookout = Lookout(options.min_frames)
        self.speed_mps = 0.0
        self.travelled_m = 0.0
        # Position of the obstacle in the coordinate of travelled_m at the train's front.
        self.obstacle_at_m = None
        self.braked_at_m = None
        self.braked_speed_mps = None
        self.detected_m = None

    def run(self):
        """Returns whether there was an obstacle; if so, the train has stopped."""
        before = None
        for frame in self.train.frames():
            if before is not None:
                step_m = math.dist(frame.position_m, before.position_m)
                self.travelled_m += step_m
                self.speed_mps = step_m / (frame.stamp_s - before.stamp_s)
            before = frame
            self.look(frame)
            if self.braked_at_m is not None and self.speed_mps < STANDSTILL_MPS:
                return True
            if self.travelled_m > self.options.max_travel:
                return False
        return False

    def look(self, frame):
        ahead_m = things_ahead(frame.points(), self.options)
        places_m = [self.travelled_m + distance_m for distance_m in ahead_m]
        if self.braked_at_m is None:
            places_m = [place_m for place_m in places_m
                        if place_m - self.travelled_m > NEAREST_M]
        elif self.obstacle_at_m - self.travelled_m < NEAREST_M:
            return  # Too near; after a collision, the sensor would see the obstacle's far side.
        else:
            # Once the train stands, raindrops and fog keep their positions, too, so only points
            # near the obstacle count.
            places_m = [place_m for place_m in places_m
                        if abs(place_m - self.obstacle_at_m) < OBSTACLE_LENGTH_M]
        place_m = self.lookout.nearest(places_m)
        if place_m is None:
            return
        self.obstacle_at_m = place_m
        if self.braked_at_m is None:
            self.train.brake()
            self.detected_m = place_m - self.travelled_m
            self.braked_at_m = self.travelled_m
            self.braked_speed_mps = self.speed_mps

    def report(self):
        return (f"detected at {self.detected_m:.1f} m with {self.braked_speed_mps:.2f} m/s, "
                f"braking distance {self.travelled_m - self.braked_at_m:.1f} m, "
                f"gap left {self.obstacle_at_m - self.travelled_m:.1f} m")


def endpoint(text):
    host, port = text.rsplit(":", 1)
    return host.strip("[]"), int(port)


def weather(file):
    with open(file, encoding="utf-8") as text:
        section = json.load(text)
    return {key: value for key, value in section.items() if key not in ("$schema", "version")}


def parse():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--stream", default="127.0.0.1:27400", metavar="HOST:PORT",
                        help="address at which to receive frames")
    parser.add_argument("--commands", type=endpoint, default="127.0.0.1:27401",
                        metavar="HOST:PORT", help="address at which the simulation takes commands")
    parser.add_argument("--lockstep", action="store_true",
                        help="request frames one by one (stream --lockstep)")
    parser.add_argument("--weather", type=weather, metavar="FILE",
                        help="a weather section to set first")
    parser.add_argument("--deceleration", type=float, default=1.0, help="m/s2 (default: 1)")
    add_lookout_options(parser)
    return parser.parse_args()


def add_lookout_options(parser):
    parser.add_argument("--front", type=float, default=2.0,
                        help="m from the vehicle's origin to its front (default: 2)")
    parser.add_argument("--resolution", type=float, default=0.25,
                        help="deg between the sensor's beams (default: 0.25)")
    parser.add_argument("--min-points", type=int, default=4,
                        help="least cluster size of a distant obstacle (default: 4)")
    parser.add_argument("--min-frames", type=int, default=3,
                        help="consecutive frames that confirm it (default: 3)")
    parser.add_argument("--max-travel", type=float, default=1000.0,
                        help="m after which the drive ends without an obstacle (default: 1000)")


def main():
    options = parse()
    train = Train(options)
    if options.weather is not None:
        train.tell({"command": "set_weather", "weather": options.weather})
    return drive_on_sight(train, options)


def drive_on_sight(train, options):
    """Drives, prints the result, and returns the exit status: 0 if a gap is left, else 1."""
    drive = Drive(train, options)
    if not drive.run():
        print(f"no obstacle within {drive.travelled_m:.0f} m")
        return 1
    print(drive.report() + (f"; {train.num_lost} frames lost" if train.num_lost else ""))
    return 0 if drive.obstacle_at_m > drive.travelled_m else 1


if __name__ == "__main__":
    sys.exit(main())
