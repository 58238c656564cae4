"""Messages of ROS 2 as little-endian plain CDR, which is what DDS brings."""

import struct

NUMBERS = {"uint8": "B", "bool": "?", "int32": "i", "uint32": "I", "float64": "d"}
HEADER = b"\0\1\0\0"  # Alignment counts from behind it.


class Message:
    """Fields: a name and a type, which is a name of NUMBERS, "string", another message, [TYPE] for a
    sequence, or (TYPE, number)."""
    FIELDS = ()

    def __init__(self, **values):
        for name, kind in self.FIELDS:
            setattr(self, name, values.get(name, default_of(kind)))


def default_of(kind):
    if isinstance(kind, list):
        return []
    if isinstance(kind, tuple):
        return [default_of(kind[0])] * kind[1]
    if kind == "string":
        return ""
    return 0 if isinstance(kind, str) else kind()


class Reader:
    def __init__(self, data):
        self.data, self.at = data, 4

    def number(self, kind):
        code = struct.Struct("<" + NUMBERS[kind])
        self.at += -(self.at - 4) % code.size
        value, = code.unpack_from(self.data, self.at)
        self.at += code.size
        return value

    def bytes(self, size):
        self.at += size
        return self.data[self.at - size:self.at]

    def value(self, kind):
        if kind == ["uint8"]:
            return self.bytes(self.number("uint32"))
        if isinstance(kind, list):
            return [self.value(kind[0]) for _ in range(self.number("uint32"))]
        if isinstance(kind, tuple):
            return [self.value(kind[0]) for _ in range(kind[1])]
        if kind == "string":
            return self.bytes(self.number("uint32"))[:-1].decode()
        if isinstance(kind, str):
            return self.number(kind)
        return kind(**{name: self.value(each) for name, each in kind.FIELDS})


class Writer:
    def __init__(self):
        self.data = bytearray(HEADER)

    def put(self, kind, value):
        if kind == "string":
            self.put("uint32", len(value) + 1)
            self.data += value.encode() + b"\0"
        elif isinstance(kind, str):
            code = struct.Struct("<" + NUMBERS[kind])
            self.data += bytes(-(len(self.data) - 4) % code.size) + code.pack(value)
        else:
            for name, each in kind.FIELDS:
                self.put(each, getattr(value, name))


def decode(kind, data):
    return Reader(data).value(kind)


def encode(message):
    writer = Writer()
    writer.put(type(message), message)
    return bytes(writer.data)
