"""Stands in for ROS 2's rclpy, of which it has what examples/brake_node.py asks for: nodes whose
messages fast_bridge (tests/core/extras/dds) brings by Fast DDS."""

import os
import select
import subprocess

from cdr import decode, encode


class Publisher:
    def __init__(self, bridge, kind, topic):
        self.bridge, self.topic = bridge, topic
        bridge.stdin.write(f"write rt{topic} {kind.DDS}\n".encode())

    def publish(self, message):
        data = encode(message)
        self.bridge.stdin.write(f"send rt{self.topic} {len(data)}\n".encode() + data)


class Node:
    def __init__(self):
        command = [os.environ["RAILCAST_FAST_BRIDGE"], os.environ["ROS_DOMAIN_ID"]]
        self.bridge = subprocess.Popen(command, bufsize=0, stdin=subprocess.PIPE,
                                       stdout=subprocess.PIPE)
        self.readers = {}

    def create_subscription(self, kind, topic, callback, _depth):
        self.readers["rt" + topic] = (kind, callback)
        self.bridge.stdin.write(f"read rt{topic} {kind.DDS}\n".encode())

    def create_publisher(self, kind, topic, _depth):
        return Publisher(self.bridge, kind, topic)

    def read(self, size):
        data = b""
        while len(data) < size:
            data += self.bridge.stdout.read(size - len(data))
        return data

    def take(self):
        line = b""
        while not line.endswith(b"\n"):
            line += self.read(1)
        topic, size = line.decode().split()
        kind, callback = self.readers[topic]
        callback(decode(kind, self.read(int(size))))


def init():
    pass


def create_node(_name):
    return Node()


def spin_once(node, timeout_sec):
    if select.select([node.bridge.stdout], [], [], timeout_sec)[0]:
        node.take()
