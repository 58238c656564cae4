#!/usr/bin/env python3
"""Receives a camera's images (docs/stream.md), prints a line for each and, with --out, saves them.

An image is saved as FRAME.jpg, those of further runs of the sender as RUN_FRAME.jpg. Datagrams of
earlier runs are dropped. Needs only Python.
"""
import argparse
import pathlib
import socket
import struct
import zlib

from receive_stream import listener_at, place_of
HEADER = struct.Struct("<4sBBHIIqHHIIII7d8d")  # The table in docs/stream.md, in its order.


def read_datagram(datagram):
    """Header and piece of the JPEG file. Other datagrams raise ValueError or struct.error."""
    crc = zlib.crc32(datagram[:-4]).to_bytes(4, "little")
    if datagram[:6] != b"RCSI\x01\x01" or datagram[-4:] != crc:
        raise ValueError("another protocol, or damaged")
    head = HEADER.unpack_from(datagram)
    return head, datagram[head[3]:-4]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("at", metavar="HOST:PORT")
    parser.add_argument("--images", type=int, default=-1, help="how many; default: until Ctrl-C")
    parser.add_argument("--out", type=pathlib.Path, help="folder for the JPEG files")
    arguments = parser.parse_args()
    listener = listener_at(arguments.at)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
    print("listening at", place_of(listener), flush=True)
    first_run, current, pieces, left = None, (0, 0), {}, arguments.images
    while left:
        try:
            head, piece = read_datagram(listener.recv(65536))
        except (ValueError, struct.error):
            continue
        (_, _, _, _, run, frame, stamp_ns, _, num_packets, num_bytes, first, width,
         height) = head[:13]
        if run < current[0]:
            continue  # Sent before the sender restarted.
        if first_run is None:
            first_run = run
        if (run, frame) != current:
            if pieces:
                print(f"frame {current[1]}: incomplete", flush=True)
            current, pieces = (run, frame), {}
        pieces[first] = piece
        if len(pieces) < num_packets:
            continue
        jpeg = b"".join(pieces[at] for at in sorted(pieces))
        pieces = {}
        if len(jpeg) != num_bytes:
            continue
        print(f"frame {frame}: {width} x {height} pixels at {stamp_ns / 1e9:.3f} s, "
              f"{num_bytes} bytes in {num_packets} packets", flush=True)
        if arguments.out:
            arguments.out.mkdir(parents=True, exist_ok=True)
            name = f"{frame:06}.jpg" if run == first_run else f"{run}_{frame:06}.jpg"
            (arguments.out / name).write_bytes(jpeg)
        left -= 1


if __name__ == "__main__":
    main()
