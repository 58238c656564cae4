# simulate_frame_ctypes.py: counts what became of the firings of a scenario's first frames.
import collections
import ctypes
import pathlib
import sys


class Config(ctypes.Structure):
    _fields_ = [("json_text", ctypes.c_char_p), ("file", ctypes.c_char_p),
                ("sensor", ctypes.c_char_p), ("num_threads", ctypes.c_int)]


class Field(ctypes.Structure):
    _fields_ = [("values", ctypes.c_void_p), ("num_values", ctypes.c_size_t),
                ("type", ctypes.c_int)]


TYPES = {1: ctypes.c_float, 2: ctypes.c_uint8, 3: ctypes.c_uint16, 4: ctypes.c_uint32}

library, scenario = sys.argv[1:]
railcast = ctypes.CDLL(library)
railcast.railcast_last_error.restype = ctypes.c_char_p
railcast.railcast_outcome_name.restype = ctypes.c_char_p
if railcast.railcast_c_api_version() != 1:
    sys.exit("this program is for version 1 of the interface")


def check(status):
    if status != 0:
        sys.exit(railcast.railcast_last_error().decode())


def values_of(sim, name):
    field = Field()
    check(railcast.railcast_get_field(sim, name.encode(), ctypes.byref(field)))
    # The array lies in the simulation's memory: copy it to keep it beyond the next step.
    # numpy.ctypeslib.as_array() makes a view of it.
    return (TYPES[field.type] * field.num_values).from_address(field.values)


config = Config(json_text=pathlib.Path(scenario).read_bytes(), file=scenario.encode())
sim = ctypes.c_void_p()
check(railcast.railcast_create(ctypes.byref(config), ctypes.byref(sim)))
for index in range(3):
    check(railcast.railcast_step(sim, ctypes.c_uint32(index)))
    counts = collections.Counter(values_of(sim, "outcome"))
    for outcome in sorted(counts):
        print(index, railcast.railcast_outcome_name(outcome).decode(), counts[outcome])
railcast.railcast_destroy(sim)
