"""Reads a PCD file of railcast, binary or compressed, with numpy alone, in the folder of a run `out`."""

import numpy as np


def unpack_lzf(raw):
    out, at = bytearray(), 0
    while at < len(raw):
        code, at = raw[at], at + 1
        if code < 32:  # That many bytes as they are, and one more.
            out += raw[at:at + code + 1]
            at += code + 1
            continue
        length = code >> 5
        if length == 7:
            length, at = length + raw[at], at + 1
        begin, at = len(out) - ((code & 31) << 8) - raw[at] - 1, at + 1
        piece = out[begin:begin + length + 2]  # Shorter where it reaches into what it makes.
        out += (piece * (length + 2))[:length + 2]
    return bytes(out)


def read_pcd(path):
    raw = open(path, "rb").read()
    end = raw.index(b"\n", raw.index(b"\nDATA binary") + 1) + 1
    head = dict(line.split(" ", 1) for line in raw[:end].decode().splitlines() if line[0] != "#")
    dtype = np.dtype([(n, f"<{t.lower()}{s}") for n, t, s in
                      zip(*(head[k].split() for k in ("FIELDS", "TYPE", "SIZE")))])
    shape = int(head["HEIGHT"]), int(head["WIDTH"])
    if head["DATA"] == "binary":
        return np.frombuffer(raw, dtype, offset=end).reshape(shape)
    frame, at = np.empty(shape, dtype), 0  # binary_compressed: field by field.
    body = unpack_lzf(raw[end + 8:end + 8 + int.from_bytes(raw[end:end + 4], "little")])
    for name in dtype.names:
        frame[name] = np.frombuffer(body, dtype[name], frame.size, at).reshape(shape)
        at += frame[name].nbytes
    return frame


if __name__ == "__main__":
    frame = read_pcd("out/frames/000000.pcd")
    points = frame[~np.isnan(frame["x"])]
    print(frame.shape, len(points), np.unique(points["label"], return_counts=True))
    lost = frame[frame["outcome"] == 3]  # below_threshold: what, and how far?
    print(len(lost), np.median(lost["true_range_m"]))
