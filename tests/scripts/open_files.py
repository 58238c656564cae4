"""Opens each file that railcast writes, by its ending, with readers that are not railcast's."""

import ast
import csv
import hashlib
import html.parser
import json
import math
import sqlite3
import struct
import tempfile
import xml.etree.ElementTree
import zlib

FAULTS = (ValueError, KeyError, IndexError, SyntaxError, struct.error, zlib.error, sqlite3.Error,
          xml.etree.ElementTree.ParseError)
MCAP = b"\x89MCAP0\r\n"
MCAP_STATISTICS = 0x0B


def check(is_right, rule):
    if not is_right:
        raise ValueError(rule)


def open_rows(data):
    rows = list(csv.reader(data.decode().splitlines()))
    check(len({len(row) for row in rows}) == 1, "must have rows of one length")


def open_html(data):
    parser = html.parser.HTMLParser()
    parser.feed(data.decode())
    parser.close()
    check(data.rstrip().endswith(b"</html>"), "must end")


def open_correction(data):
    """The correction file of an AT128, which ends with the SHA-256 of the rest."""
    check(data.startswith(b"\xEE\xFF") and hashlib.sha256(data[:-32]).digest() == data[-32:], "must be a whole file of angles")


def open_png(data):
    check(data.startswith(b"\x89PNG\r\n\x1a\n") and data.endswith(b"IEND\xaeB`\x82"), "must be a whole PNG")
    at, packed, (width, height, depth, kind) = 8, b"", struct.unpack_from(">IIBB", data, 16)
    while at < len(data):
        size, name = struct.unpack_from(">I4s", data, at)
        packed += data[at + 8:at + 8 + size] if name == b"IDAT" else b""
        at += size + 12
    bits = depth * {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[kind]
    check(len(zlib.decompress(packed)) == height * (1 + math.ceil(width * bits / 8)), "must have all its pixels")


def open_pdf(data):
    check(data.startswith(b"%PDF-") and data.rstrip().endswith(b"%%EOF"), "must be a whole PDF")


def open_pcd(data):
    head, body = data.split(b"\nDATA ", 1)
    kind, body = body.split(b"\n", 1)
    fields = dict(line.split(b" ", 1) for line in head.splitlines() if line[:1] != b"#")
    num_points = int(fields[b"POINTS"])
    size = num_points * sum(int(each) for each in fields[b"SIZE"].split())
    if kind == b"ascii":
        rows = body.decode().splitlines()
        check(len(rows) == num_points and {len(row.split()) for row in rows} <= {len(fields[b"FIELDS"].split())},
              "must have as many points as its header says")
    elif kind == b"binary_compressed":
        packed, unpacked = struct.unpack_from("<II", body)
        check(len(body) >= 8 + packed and unpacked == size, "must have as many bytes as its header says")
    else:
        check(len(body) == size, "must have as many points as its header says")


def open_ply(data):
    head, body = data.split(b"end_header\n", 1)
    sizes = {b"char": 1, b"uchar": 1, b"short": 2, b"ushort": 2, b"int": 4, b"uint": 4, b"float": 4, b"double": 8,
             b"int8": 1, b"uint8": 1, b"int16": 2, b"uint16": 2, b"int32": 4, b"uint32": 4, b"float32": 4, b"float64": 8}
    size, count = 0, 0
    for words in (line.split() for line in head.splitlines()):
        if words[0] == b"element":
            count = int(words[2])
        elif words[:2] == [b"property", b"list"]:  # Triangles: a number and three vertices.
            size += count * (sizes[words[2]] + 3 * sizes[words[3]])
        elif words[0] == b"property":
            size += count * sizes[words[1]]
    check(len(body) == size > 0, "must have as many elements as its header says")


def open_pcap(data):
    at, num_packets = 24, 0
    while at < len(data):
        at += 16 + struct.unpack_from("<I", data, at + 8)[0]
        num_packets += 1
    check(at == len(data) and num_packets > 10, "must hold whole packets")


def open_mcap(data):
    check(data.startswith(MCAP) and data.endswith(MCAP), "must be a whole MCAP")
    at, num_messages = len(MCAP), 0
    while at < len(data) - len(MCAP):
        kind, size = struct.unpack_from("<BQ", data, at)
        if kind == MCAP_STATISTICS:
            num_messages = struct.unpack_from("<Q", data, at + 9)[0]
        at += 9 + size
    check(at == len(data) - len(MCAP) and num_messages > 0, "must hold whole records, and messages")


def open_trace(data):
    at, num_messages = 0, 0
    while at < len(data):
        at += 4 + struct.unpack_from("<I", data, at)[0]
        num_messages += 1
    check(at == len(data) and num_messages > 0, "must hold whole messages")


def open_glb(data):
    length, json_length = struct.unpack_from("<II", data, 8)
    check(length == len(data) and json.loads(data[20:20 + json_length])["meshes"], "must be a whole glTF")


def open_database(data):
    with tempfile.NamedTemporaryFile() as file:
        file.write(data)
        file.flush()
        check(sqlite3.connect(file.name).execute("PRAGMA integrity_check").fetchone() == ("ok",), "must be whole")


def open_array(data):
    size = struct.unpack_from("<H", data, 8)[0]
    head = ast.literal_eval(data[10:10 + size].decode())
    kinds = [each[1] for each in head["descr"]] if isinstance(head["descr"], list) else [head["descr"]]
    row_size = sum(int(kind.lstrip("<|>biuf")) for kind in kinds)
    check(len(data) == 10 + size + math.prod(head["shape"]) * row_size, "must be a whole array")


def open_words(size):
    def open_them(data):
        check(data and len(data) % size == 0, f"must hold whole rows of {size} bytes")
    return open_them


def open_something(data):
    check(data, "must not be empty")


OPENERS = {".json": json.loads, ".jsonl": lambda data: [json.loads(line) for line in data.splitlines()],
           ".csv": open_rows, ".html": open_html, ".svg": xml.etree.ElementTree.fromstring, ".png": open_png,
           ".xml": xml.etree.ElementTree.fromstring, ".pdf": open_pdf, ".pcd": open_pcd, ".ply": open_ply,
           ".pcap": open_pcap, ".dat": open_correction,
           ".mcap": open_mcap, ".osi": open_trace, ".glb": open_glb, ".sqlite": open_database, ".db3": open_database,
           ".npy": open_array, ".bin": open_words(16), ".label": open_words(4), ".md": bytes.decode, ".txt": bytes.decode,
           ".yaml": bytes.decode, ".obj": bytes.decode, ".gnuplot": bytes.decode, ".survey": open_something}


def faults_in(folder, before):
    """What is wrong with the files in a folder that were not there before."""
    for path in sorted(set(folder.rglob("*")) - before):
        if path.is_file():
            try:
                OPENERS[path.suffix](path.read_bytes())
            except FAULTS as fault:
                yield f"{path.relative_to(folder)}: cannot be opened: {fault!r}"
