#!/usr/bin/env python3
"""Receives a railcast stream (docs/stream.md) and prints a line per frame. Needs only Python."""
import argparse
import math
import socket
import struct
import time
import zlib
HEADER = struct.Struct("<4sBBHIHHIHHqIIIIIHH7d7dH")  # The table in docs/stream.md, in its order.
TYPES = {2: "B", 4: "H", 6: "I", 7: "f"}  # u8, u16, u32, f32
HOLD_S = 3.0  # Seconds of silence after which another sender is accepted.


def read_datagram(datagram):
    """Header, field names, points. Other datagrams raise one of the errors that main() catches."""
    crc = zlib.crc32(datagram[:-4]).to_bytes(4, "little")
    if datagram[:5] != b"RCST\x01" or datagram[-4:] != crc:
        raise ValueError("another protocol, or damaged")
    head = HEADER.unpack_from(datagram)
    if len(datagram) != head[3] + head[6] * head[17] + 4:
        raise ValueError("of another size than it says")
    names, types, at = [], "<", HEADER.size
    for _ in range(head[-1]):
        names.append(datagram[at + 2:at + 2 + datagram[at + 1]].decode("ascii"))
        types, at = types + TYPES[datagram[at]], at + 2 + datagram[at + 1]
    return head, names, list(struct.iter_unpack(types, datagram[head[3]:-4]))


def listener_at(text):
    """A socket that listens at HOST:PORT, or [HOST]:PORT of IPv6."""
    host, _, port = text.rpartition(":")
    listener = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET, socket.SOCK_DGRAM)
    listener.bind((host.strip("[]"), int(port)))
    return listener


def place_of(listener):
    at = "[%s]:%d" if listener.family == socket.AF_INET6 else "%s:%d"
    return at % listener.getsockname()[:2]


def report(number, packets, num_packets, axes):
    points = [[point[axis] for axis in axes] for part in packets.values() for point in part]
    nearest = min((math.hypot(*point) for point in points), default=math.nan)
    print(f"frame {number}: {len(points)} points, {num_packets - len(packets)} packets lost, "
          f"nearest {nearest:.2f} m", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("at", nargs="?", default="127.0.0.1:27400", metavar="HOST:PORT")
    parser.add_argument("--frames", type=int, default=-1, help="how many; default: until Ctrl-C")
    arguments = parser.parse_args()
    listener = listener_at(arguments.at)
    print("listening at", place_of(listener), flush=True)
    current, last, frames, left = None, -1, {}, arguments.frames
    sender, heard_s = None, -math.inf
    while left:
        datagram, origin = listener.recvfrom(65536)
        if origin != sender and time.monotonic() < heard_s + HOLD_S:
            continue  # From another sender.
        try:
            head, names, points = read_datagram(datagram)
            axes = [names.index(axis) for axis in "xyz"]
        except (ValueError, KeyError, IndexError, struct.error):
            continue
        if origin != sender:
            sender, current = origin, None
        heard_s = time.monotonic()
        run, frame, packet, num_packets = head[4], *head[7:10]
        if run != current or frame + 8 < last:  # The sender has restarted.
            current, last, frames = run, -1, {}
        if frame > last:
            frames.setdefault(frame, ({}, num_packets, axes))[0][packet] = points
            over = frame if len(frames[frame][0]) == num_packets else -1
            while left and frames and (min(frames) <= over or len(frames) > 2):
                last, left = min(frames), left - 1
                report(last, *frames.pop(last))


if __name__ == "__main__":
    main()
