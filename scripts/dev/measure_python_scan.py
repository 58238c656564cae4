#!/usr/bin/python3
"""Measures what railcast.Simulator.scan() takes beside the same scan in C++.

Usage: measure_python_scan.py BUILD [FRAMES] [SCENARIO...]

Each frame is made by both in turn, so that both see the same machine: in C++ by railcast_step() of
the shared library, which is Simulator::Scan() and a status code. Each has a process of its own,
because TBB gives fewer turns to the second simulator of a process. The order alternates. Both use
one thread, whose CPU time is taken: other work on the machine changes it little. Prints the medians
and the median of the ratios frame by frame, with its 95 % interval.
"""

import ctypes
import multiprocessing
import pathlib
import random
import statistics
import sys
import time

SCENARIOS = ("scenarios/st_gallen_approach.json", "scenarios/minimal.json", "scenarios/open_line.json")
RESAMPLES = 1000


class Config(ctypes.Structure):
    _fields_ = [("json_text", ctypes.c_char_p), ("file", ctypes.c_char_p), ("sensor", ctypes.c_char_p),
                ("num_threads", ctypes.c_int)]


class CppSimulation:
    """A simulation of the shared library."""

    def __init__(self, library, scenario):
        self.library = library
        self.handle = ctypes.c_void_p()
        config = Config(pathlib.Path(scenario).read_bytes(), scenario.encode(), None, 1)
        if library.railcast_create(ctypes.byref(config), ctypes.byref(self.handle)) != 0:
            sys.exit(library.railcast_last_error().decode())

    def scan(self, index):
        if self.library.railcast_step(self.handle, ctypes.c_uint32(index)) != 0:
            sys.exit(self.library.railcast_last_error().decode())


def scan_of_cpp(build, scenario):
    library = ctypes.CDLL(str(build / "core" / "c" / "librailcast.so"))
    library.railcast_last_error.restype = ctypes.c_char_p
    return CppSimulation(library, scenario).scan


def scan_of_python(build, scenario):
    sys.path.insert(0, str(build / "python"))
    import railcast  # pylint: disable=import-outside-toplevel
    return railcast.Simulator(scenario, threads=1).scan


def serve(make_scan, build, scenario, connection):
    """Makes the frames whose numbers come; answers with the seconds of CPU time that each took."""
    scan = make_scan(build, scenario)
    while (index := connection.recv()) is not None:
        begin = time.thread_time()
        scan(index)
        connection.send(time.thread_time() - begin)


class Server:
    """A process that makes frames."""

    def __init__(self, *work):
        context = multiprocessing.get_context("spawn")
        self.connection, other = context.Pipe()
        self.process = context.Process(target=serve, args=(*work, other))
        self.process.start()

    def seconds_of(self, index):
        self.connection.send(index)
        return self.connection.recv()

    def end(self):
        self.connection.send(None)
        self.process.join()


def measure(build, scenario, num_frames):
    servers = {"C++": Server(scan_of_cpp, build, scenario), "Python": Server(scan_of_python, build, scenario)}
    for index in range(20):  # Builds the scene, and warms the caches.
        for server in servers.values():
            server.seconds_of(index)
    taken = {name: [] for name in servers}
    for index in range(num_frames):
        for name in sorted(servers, reverse=index % 2 == 1):
            taken[name].append(servers[name].seconds_of(index))
    for server in servers.values():
        server.end()
    return taken


def main(arguments):
    if len(arguments) < 2:
        sys.exit(__doc__)
    build = pathlib.Path(arguments[1])
    num_frames = int(arguments[2]) if len(arguments) > 2 else 200
    for scenario in arguments[3:] or SCENARIOS:
        taken = measure(build, scenario, num_frames)
        ratios = [python / cpp for python, cpp in zip(taken["Python"], taken["C++"])]
        draws = random.Random(1)
        medians = sorted(statistics.median(draws.choices(ratios, k=len(ratios))) for _ in range(RESAMPLES))
        cpp_ms, python_ms = (1e3 * statistics.median(taken[name]) for name in ("C++", "Python"))
        print(f"{scenario}: C++ {cpp_ms:.3f} ms, Python {python_ms:.3f} ms, ratio {statistics.median(ratios):.4f} "
              f"({medians[25]:.4f} to {medians[975]:.4f}), {num_frames} frames")


if __name__ == "__main__":
    main(sys.argv)
