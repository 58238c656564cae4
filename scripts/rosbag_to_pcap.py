#!/usr/bin/env python3
"""Turns a ROS 2 recording of a Hesai sensor's packets into a capture that railcast reads.

  scripts/rosbag_to_pcap.py RECORDING.db3 CAPTURE.pcap

RECORDING.db3 is a rosbag2 file (SQLite 3) with messages of type pandar_msgs/msg/PandarScan; other
messages are left out. Its packets become UDP datagrams from 192.168.1.201 to 255.255.255.255, from
and to port 2368, as the sensor sends them, with the times at which they were received. Needs
nothing but Python's own modules.
"""

import pathlib
import sqlite3
import struct
import sys

SCAN = "pandar_msgs/msg/PandarScan"
# Of a PandarPacket in CDR: the stamp, an array of fixed length, the number of bytes in use.
PACKET_BYTES = 1500
PACKET = struct.Struct(f"<iI{PACKET_BYTES}sI")

# Classic pcap, microseconds, Ethernet.
FILE_HEADER = struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, 1)
ETHERNET = bytes.fromhex("ffffffffffff 0000c0a801c9 0800")
SOURCE, DESTINATION = bytes((192, 168, 1, 201)), b"\xff" * 4
PORT = 2368
IP_HEADER, UDP_HEADER = 20, 8


def packets_of(message):
    """Yields (seconds, nanoseconds, payload) of each packet of a PandarScan in CDR.

    Positions count from the end of the 4 bytes that say how the message is encoded. A number is
    aligned to its own size.
    """
    if message[:2] != b"\x00\x01":
        raise ValueError("must be little-endian CDR")
    body = message[4:]
    (name_size,) = struct.unpack_from("<I", body, 8)  # After the stamp of the whole scan.
    place = (12 + name_size + 3) // 4 * 4
    (num_packets,) = struct.unpack_from("<I", body, place)
    place += 4
    if len(body) != place + num_packets * PACKET.size:
        raise ValueError(f"must hold {num_packets} packets of {PACKET.size} bytes")
    for seconds, nanoseconds, data, size in PACKET.iter_unpack(body[place:]):
        if size > PACKET_BYTES:
            raise ValueError(f"packets must have at most {PACKET_BYTES} bytes (got {size})")
        yield seconds, nanoseconds, data[:size]


def ip_checksum(header):
    total = sum(struct.unpack(f">{len(header) // 2}H", header))
    total = (total & 0xFFFF) + (total >> 16)
    return ~((total & 0xFFFF) + (total >> 16)) & 0xFFFF


def frame_of(payload):
    """An Ethernet frame with the payload in a UDP datagram, which has no checksum of its own."""
    udp = struct.pack(">HHHH", PORT, PORT, UDP_HEADER + len(payload), 0)
    size = IP_HEADER + len(udp) + len(payload)
    start = struct.pack(">BBHHHBB", 0x45, 0, size, 0, 0x4000, 64, 17)
    checksum = ip_checksum(start + b"\0\0" + SOURCE + DESTINATION)
    return ETHERNET + start + struct.pack(">H", checksum) + SOURCE + DESTINATION + udp + payload


def record_of(seconds, nanoseconds, payload):
    frame = frame_of(payload)
    return struct.pack("<IIII", seconds, nanoseconds // 1000, len(frame), len(frame)) + frame


def messages_in(recording):
    """The scans in the order of their times."""
    # Read-only, so that a path that is wrong is not made into a new recording.
    database = sqlite3.connect(f"{recording.resolve().as_uri()}?mode=ro&immutable=1", uri=True)
    try:
        rows = database.execute(
            "SELECT data FROM messages JOIN topics ON topics.id = messages.topic_id "
            "WHERE topics.type = ? ORDER BY messages.timestamp", (SCAN,)).fetchall()
    finally:
        database.close()
    return [row[0] for row in rows]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    recording, capture = map(pathlib.Path, sys.argv[1:])
    try:
        records = [record_of(*packet)
                   for message in messages_in(recording) for packet in packets_of(message)]
    except (sqlite3.Error, struct.error, ValueError) as error:
        sys.exit(f"{recording}: {error}")
    if not records:
        sys.exit(f"{recording}: must hold messages of type {SCAN}")
    capture.write_bytes(FILE_HEADER + b"".join(records))


if __name__ == "__main__":
    main()
