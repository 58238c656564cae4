#!/usr/bin/env python3
"""Detects the nearest obstacle in each frame and reports it to collect_detections.py.

Steps through `railcast-generate stream SCENARIO --lockstep --commands-port PORT`, whose points must
be in vehicle axes (`output.frame` is "vehicle"), on straight track. Put your detector in the place
of detect().
"""

import argparse
import itertools
import json
import socket
import time

from brake_client import (GAUGE_BOTTOM_M, GAUGE_HALF_WIDTH_M, GAUGE_TOP_M, NEAREST_M, OBSTACLE_LENGTH_M, Train,
                          endpoint)

MIN_POINTS = 4
LEAST_SIDE_M = 0.1  # A line of points has no height.


def detect(points):
    """The boxes of a frame with points (x, y, z) in m: one around the nearest points in the gauge, or none."""
    ahead = sorted(point for point in points if point[0] > NEAREST_M and abs(point[1]) < GAUGE_HALF_WIDTH_M
                   and GAUGE_BOTTOM_M < point[2] < GAUGE_TOP_M)
    near = [point for point in ahead if point[0] < ahead[0][0] + OBSTACLE_LENGTH_M]
    if len(near) < MIN_POINTS:
        return []
    sides = [(min(axis), max(axis)) for axis in zip(*near)]
    return [{"center_m": [(low + high) / 2 for low, high in sides],
             "size_m": [max(high - low, LEAST_SIDE_M) for low, high in sides]}]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--stream", default="127.0.0.1:27400", metavar="HOST:PORT", help="where frames arrive")
    parser.add_argument("--commands", type=endpoint, default="127.0.0.1:27401", metavar="HOST:PORT",
                        help="address at which the simulation takes commands")
    parser.add_argument("--to", type=endpoint, default="127.0.0.1:27402", metavar="HOST:PORT",
                        help="address at which detections are collected")
    parser.add_argument("--frames", type=int, required=True, help="how many")
    parser.set_defaults(lockstep=True, deceleration=0.0)
    options = parser.parse_args()
    train = Train(options)
    sender = socket.socket(socket.AF_INET6 if ":" in options.to[0] else socket.AF_INET, socket.SOCK_DGRAM)
    for frame in itertools.islice(train.frames(), options.frames):
        begin_s = time.monotonic()
        detections = detect(frame.points())
        latency_s = frame.duration_s + time.monotonic() - begin_s  # From the stamp: the scan, then the computing.
        line = {"frame": frame.number, "axes": "vehicle", "latency_ms": 1e3 * latency_s, "detections": detections}
        sender.sendto(json.dumps(line).encode(), options.to)


if __name__ == "__main__":
    main()
