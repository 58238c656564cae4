"""Reads a PCD file of railcast, binary or compressed, with numpy alone, from a run in the folder `out`."""

import numpy as np


def unpack_lzf(raw):
    """The bytes that were compressed by LZF."""
    out, at = bytearray(), 0
    while at < len(raw):
        code, at = raw[at], at + 1
        if code < 32:  # code + 1 bytes follow as they are.
            out += raw[at:at + code + 1]
            at += code + 1
            continue
        length = code >> 5
        if length == 7:
            length, at = length + raw[at], at + 1
        begin, at = len(out) - ((code & 31) << 8) - raw[at] - 1, at + 1
        piece = out[begin:begin + length + 2]  # Shorter if the copy overlaps its own output.
        out += (piece * (length + 2))[:length + 2]
    return bytes(out)


def read_pcd(path):
    """The points as a structured array of shape (HEIGHT, WIDTH); slots without a point have NaN in x, y, z."""
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
    lost = frame[frame["outcome"] == 3]  # 3: below_threshold
    print(len(lost), np.median(lost["true_range_m"]))
