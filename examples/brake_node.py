#!/usr/bin/env python3
"""Drives a simulated train on sight in ROS 2: what brake_client.py does, by topics alone.

A node for `railcast-generate stream SCENARIO --protocol ros2 --commands-topic /brake`, whose points
must be in vehicle axes (`output.frame` is "vehicle"). With `--step` every frame waits until the node
is done with the one before it (stream `--lockstep --step-topic /step`). The vehicle brakes with
the scenario's `interfaces.ros2.deceleration_mps2`.
"""

import argparse
import collections
import struct
import sys
import time

import rclpy
from builtin_interfaces.msg import Time
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2

from brake_client import PATIENCE_S, RETRY_S, add_lookout_options, drive_on_sight

DEPTH = 20  # Of queues, as the simulation's; writers and readers are reliable.


class Frame:
    """A cloud in vehicle axes, and where the vehicle was at its stamp."""

    def __init__(self, cloud, odometry):
        self.cloud = cloud
        self.stamp_s = cloud.header.stamp.sec + 1e-9 * cloud.header.stamp.nanosec
        position = odometry.pose.pose.position
        self.position_m = (position.x, position.y, position.z)

    def points(self):
        # x, y and z stand side by side in every layout.
        x = next(field.offset for field in self.cloud.fields if field.name == "x")
        rest = self.cloud.point_step - x - 3 * 4
        return list(struct.iter_unpack(f"<{x}x3f{rest}x", self.cloud.data))


class Train:
    """The simulated train, with all that brake_client.Drive uses of one."""

    def __init__(self, node, options):
        self.node = node
        self.num_lost = 0  # Always, since writers are reliable.
        self.clouds, self.odometry = collections.deque(), {}
        # Clouds last: in lockstep, the first frame comes as soon as somebody reads them.
        node.create_subscription(Odometry, "/odometry", self.take_odometry, DEPTH)
        node.create_subscription(PointCloud2, options.points, self.clouds.append, DEPTH)
        self.brakes = node.create_publisher(TwistStamped, options.brake, DEPTH)
        self.steps = node.create_publisher(Time, options.step, DEPTH) if options.step else None

    def brake(self):
        self.brakes.publish(TwistStamped())  # A speed of 0: brake to a standstill.

    def take_odometry(self, odometry):
        stamp = odometry.header.stamp
        self.odometry[stamp.sec, stamp.nanosec] = odometry

    def frames(self):
        done = Time(sec=-1)  # No frame yet.
        end_s = time.monotonic() + PATIENCE_S
        while time.monotonic() < end_s:
            if self.steps is not None:
                # Published again until a frame comes: at first nobody may be listening, and a
                # repeated step does no harm.
                self.steps.publish(done)
            again_s = time.monotonic() + RETRY_S
            while not self.has_frame() and time.monotonic() < again_s:
                rclpy.spin_once(self.node, timeout_sec=RETRY_S)
            if self.has_frame():
                cloud = self.clouds.popleft()
                done = cloud.header.stamp
                if cloud.header.frame_id != "base_link":
                    sys.exit("the points are not in vehicle axes: set the scenario's output.frame")
                yield Frame(cloud, self.odometry.pop((done.sec, done.nanosec)))
                end_s = time.monotonic() + PATIENCE_S
        sys.exit(f"no frame for {PATIENCE_S:g} s")

    def has_frame(self):
        """Whether there is a cloud and its odometry, which may come in either order."""
        if not self.clouds:
            return False
        stamp = self.clouds[0].header.stamp
        return (stamp.sec, stamp.nanosec) in self.odometry


def parse():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", default="/Vir2Rail/points", metavar="TOPIC",
                        help="clouds of the sensor (default: /Vir2Rail/points)")
    parser.add_argument("--brake", default="/brake", metavar="TOPIC",
                        help="where the simulation takes commands (default: /brake)")
    parser.add_argument("--step", metavar="TOPIC",
                        help="where the simulation waits for steps, such as /step")
    add_lookout_options(parser)
    return parser.parse_args()


def main():
    options = parse()
    rclpy.init()
    return drive_on_sight(Train(rclpy.create_node("brake_node"), options), options)


if __name__ == "__main__":
    sys.exit(main())
