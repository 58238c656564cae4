#!/usr/bin/env python3
"""Turns a ROS 2 recording of a Hesai sensor's packets into a capture that railcast reads.

  scripts/rosbag_to_pcap.py RECORDING.db3 CAPTURE.pcap

RECORDING.db3 is a rosbag2 file (SQLite 3) with messages of type pandar_msgs/msg/PandarScan; other
messages are left out. Its packets become UDP datagrams from 192.168.1.201 to 255.255.255.255, from
and to port 2368, as the sensor sends them, with the times at which they were received. Needs
nothing but Python's own modules.
"""

import os
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
    if not isinstance(message, bytes):
        raise ValueError("messages must be blobs")
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
        if seconds < 0 or nanoseconds >= 10**9:
            raise ValueError("times of packets must have >= 0 s and < 1e9 ns "
                             f"(got {seconds} s, {nanoseconds} ns)")
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
    path = recording.resolve()
    # Read-only, so that a path that is wrong is not made into a new recording; immutable, so that
    # the folder may be read-only. SQLite then ignores what is still in the write-ahead log.
    log = path.with_name(path.name + "-wal")
    if log.exists() and log.stat().st_size > 0:
        raise ValueError(f"must be closed by its recorder ({log.name} still holds messages)")
    database = sqlite3.connect(f"{path.as_uri()}?mode=ro&immutable=1", uri=True)
    try:
        rows = database.execute(
            "SELECT data FROM messages JOIN topics ON topics.id = messages.topic_id "
            "WHERE topics.type = ? ORDER BY messages.timestamp, messages.id", (SCAN,)).fetchall()
    finally:
        database.close()
    return [row[0] for row in rows]


def write_whole(path, content):
    """Writes the file under another name first, so that it is never there in part."""
    path = path.resolve()
    if path.exists() and not path.is_file():
        raise ValueError("must be a file")
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    try:
        part.write_bytes(content)
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    recording, capture = map(pathlib.Path, sys.argv[1:])
    if capture.resolve() == recording.resolve():
        sys.exit(f"{capture}: must be another file than the recording")
    try:
        records = [record_of(*packet)
                   for message in messages_in(recording) for packet in packets_of(message)]
    except (sqlite3.Error, struct.error, ValueError) as error:
        sys.exit(f"{recording}: {error}")
    except OSError as error:
        sys.exit(f"{recording}: {error.strerror}")
    if not records:
        sys.exit(f"{recording}: must hold messages of type {SCAN}")
    try:
        write_whole(capture, FILE_HEADER + b"".join(records))
    except OSError as error:
        sys.exit(f"{capture}: {error.strerror}")
    except ValueError as error:
        sys.exit(f"{capture}: {error}")


if __name__ == "__main__":
    main()
