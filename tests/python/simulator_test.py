"""railcast.Simulator makes the frames that railcast-generate writes."""

import copy
import gc
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

from support import ROOT, SCENARIO, faults_of, generate, np, read_pcd

import railcast

FRAMES = 3
STRAIGHT = {"course": {"type": "elements", "elements": [{"type": "straight", "length_m": 1000}]}}
TWO_SENSORS = ROOT / "scenarios" / "two_sensors.json"
ENDLESS = """
import railcast
sim = railcast.Simulator({scenario!r})
try:
    print("ready", flush=True)
    for frame in range(0, 10**9, 40):
        sim.scan(frame % 600)
except KeyboardInterrupt:
    print("interrupted at", sim.scan(0).index, flush=True)
"""

ABANDONED = """
import atexit, threading, time
atexit.register(lambda: print("last" if sim.scan(0).index == 0 else "wrong"))  # Called after railcast's own.
import railcast
sim = railcast.Simulator({scenario!r})
started = threading.Event()
def work():
    started.set()
    for frame in range(10**9):
        sim.scan(frame % 600)
for _ in range(2):
    threading.Thread(target=work, daemon=True).start()
started.wait()
time.sleep({seconds})
"""


# Ends with a simulator that is never deleted and builds a scene ahead. Python's last call, after
# railcast's own, waits for standard input. Threads that build ahead give way to others.
KEPT = """
import ctypes, os
ctypes.pythonapi.Py_AtExit(ctypes.cast(ctypes.CDLL(None).getchar, ctypes.c_void_p))
import railcast
sim = railcast.Simulator({scenario!r})
ctypes.pythonapi.Py_IncRef(ctypes.py_object(sim))
sim.scan(0)
usual = os.getpriority(os.PRIO_PROCESS, 0)
threads = [thread for thread in os.listdir("/proc/self/task")
           if os.getpriority(os.PRIO_PROCESS, int(thread)) > usual]
print(*threads, flush=True)
"""


# A child that is forked while a simulator is alive, which is deleted there, too.
FORKED = """
import os, sys
import railcast
simulator = railcast.Simulator("{scenario}")
frame = simulator.scan(0)
child = os.fork()
if child == 0:
    try:
        simulator.scan(0)
    except railcast.InputError as error:
        print(error)
    print("of its own", railcast.Simulator("{scenario}").scan(0).num_points == frame.num_points)
    sys.exit(0)
print("child ended", os.waitpid(child, 0)[1])
print(simulator.scan(0).num_points == frame.num_points)
"""


class SameFramesAsASequence(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.run_folder = pathlib.Path(cls.folder.name) / "run"
        generate("sequence", SCENARIO, "--out", cls.run_folder, "--frames", FRAMES, "--start-frame", 30)
        cls.simulator = railcast.Simulator(SCENARIO, threads=2)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_every_field_has_the_bytes_of_the_file(self):
        # From the last frame to the first: frames do not depend on those before.
        for index in reversed(range(30, 30 + FRAMES)):
            written = read_pcd(self.run_folder / "frames" / f"{index:06}.pcd")
            made = self.simulator.scan(index)
            self.assertEqual(made.fields, list(written.dtype.names))
            for name in made.fields:
                self.assertEqual(made[name].dtype, written.dtype[name])
                self.assertEqual(made[name].tobytes(), written[name].tobytes(), name)

    def test_velocities_are_fields_of_sensors_that_measure_them(self):
        scenario = {"version": 1, "file": str(SCENARIO), "fidelity": "geometry",
                    "lidar": {"file": str(ROOT / "scenarios" / "sensors" / "vir2rail.json"),
                              "mount": {"position_m": [2.2, 0, 2.5]},
                              "velocity": {"sigma_mps": 0.03, "max_mps": 100}}}
        simulator = railcast.Simulator(scenario, file=ROOT / "scenarios" / "other.json")
        frame = simulator.scan(30)
        self.assertEqual(frame.fields, self.simulator.scan(30).fields +
                         ["radial_velocity_mps", "true_radial_velocity_mps"])
        ground = frame.has_point & (frame["instance"] == 0)
        forward = frame["x"][ground] / frame["range_m"][ground]
        # What stands comes nearer at the speed of the train, which brakes from 40 km/h.
        speed = -frame["true_radial_velocity_mps"][ground] / forward
        self.assertTrue(0 < np.median(speed) <= 40 / 3.6)
        self.assertLess(np.ptp(speed), 0.5)
        np.testing.assert_array_equal(frame["radial_velocity_mps"][ground],
                                      frame["true_radial_velocity_mps"][ground])

    def test_poses_and_objects_are_those_of_the_records(self):
        lines = (self.run_folder / "objects.jsonl").read_text("utf-8").splitlines()
        poses = np.genfromtxt(self.run_folder / "poses.csv", delimiter=",", names=True)
        for line, pose in zip(map(json.loads, lines), poses):
            made = self.simulator.scan(line["frame"], objects=True)
            self.assertEqual(made.stamp_ns, line["stamp_ns"])
            self.assertEqual([thing.name for thing in made.objects], [thing["name"] for thing in line["objects"]])
            np.testing.assert_array_equal(made.world_from_sensor[:3, 3], [pose["x"], pose["y"], pose["z"]])
            for thing, recorded in zip(made.objects, line["objects"]):
                self.assertEqual(thing.points, recorded["points"])
                self.assertEqual(thing.occlusion, recorded["occlusion"])
                np.testing.assert_array_equal(thing.size_m, recorded["sensor"]["size_m"])
                np.testing.assert_array_equal(thing.sensor_from_box[:3, 3], recorded["sensor"]["center_m"])

    def test_a_free_person_is_not_hidden_in_wide_beams(self):
        sensors = {"pandar64": 50, "vir2rail": 80}
        for rung in ("geometry", "footprint"):
            scenario = {"version": 1, "file": str(ROOT / "scenarios" / "minimal.json"), "fidelity": rung, "lidars": [
                {"file": str(ROOT / "scenarios" / "sensors" / f"{name}.json"), "name": name,
                 "mount": {"position_m": [2.0, 0, 2.0]}} for name in sensors],
                "world": {"alignment": STRAIGHT,
                          "objects": [{"name": f"person_{ahead_m}", "type": "person", "s_m": 402 + ahead_m, "d_m": side}
                                      for side, ahead_m in ((4.0, 50), (-4.0, 80))]}}
            simulator = railcast.Simulator(scenario, file=ROOT / "scenarios" / "other.json")
            for name, ahead_m in sensors.items():
                thing, = (each for each in simulator.scan(0, sensor=name, objects=True).objects
                          if each.name == f"person_{ahead_m}")
                self.assertGreater(thing.firings_alone, 0)
                self.assertLessEqual(thing.firings_visible, thing.firings_alone)
                # The ground may hide the soles.
                self.assertTrue(0 <= thing.occlusion < 0.25, (rung, name, thing.occlusion))

    def test_scan_poses_lead_from_the_stamp_to_the_last_firing(self):
        frame = self.simulator.scan(30)
        times_ns, poses = frame.scan_poses
        self.assertEqual((times_ns.dtype, poses.shape), (np.int64, (len(times_ns), 4, 4)))
        self.assertEqual((times_ns[0], times_ns[-1]), (0, frame.duration_ns))
        self.assertTrue((np.diff(times_ns) <= 20_000_000).all() and (np.diff(times_ns) > 0).all())
        np.testing.assert_array_equal(poses[0], frame.world_from_sensor)
        np.testing.assert_array_equal(poses[-1], frame.world_from_sensor_end)
        recorded = railcast.open(self.run_folder)[0].scan_poses
        np.testing.assert_array_equal(recorded[0], times_ns)
        np.testing.assert_allclose(recorded[1], poses, atol=1e-9)

    def test_a_dict_and_a_text_are_the_scenario_that_they_hold(self):
        scenario = json.loads(SCENARIO.read_text("utf-8"))
        expected = self.simulator.scan(30)["x"].tobytes()
        for same in (scenario, json.dumps(scenario)):
            self.assertEqual(railcast.Simulator(same, file=SCENARIO).scan(30)["x"].tobytes(), expected)
        self.assertEqual(railcast.Simulator(self.simulator.scenario).scan(30)["x"].tobytes(), expected)


class Arrays(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.simulator = railcast.Simulator(SCENARIO)

    def test_an_array_is_the_frames_own_memory_and_keeps_it(self):
        frame = self.simulator.scan(0)
        x = frame["x"]
        self.assertIs(x.base, frame)
        self.assertEqual(x.ctypes.data, frame["x"].ctypes.data)
        kept = x.copy()
        del frame
        gc.collect()
        for index in range(1, 4):
            self.simulator.scan(index)
        np.testing.assert_array_equal(x, kept)

    def test_the_memory_of_dropped_frames_is_used_again(self):
        places = set()
        for index in range(6):
            places.add(self.simulator.scan(index)["x"].ctypes.data)
        self.assertLessEqual(len(places), 2)

    def test_points_are_the_slots_that_have_one(self):
        frame = self.simulator.scan(0)
        has_point = frame.has_point
        self.assertEqual(has_point.shape, (frame.rows, frame.columns * frame.returns))
        returned = (railcast.OUTCOMES["returned"], railcast.OUTCOMES["clutter"])
        np.testing.assert_array_equal(has_point, np.isin(frame["outcome"], returned))
        expected = np.stack([frame[axis][has_point] for axis in "xyz"], axis=1)
        np.testing.assert_array_equal(frame.points(), expected)
        self.assertEqual(frame.num_points, len(expected))
        np.testing.assert_allclose(np.linalg.norm(expected, axis=1), frame["range_m"][has_point], rtol=1e-6)

    def test_a_missing_field_is_a_key_error(self):
        frame = self.simulator.scan(0)
        self.assertNotIn("colour", frame)
        with self.assertRaisesRegex(KeyError, 'must have the field, it has x, y, z, .* \\(got "colour"\\)'):
            frame["colour"]


class Errors(unittest.TestCase):

    def lines_of(self, *arguments, **options):
        with self.assertRaises(railcast.InputError) as raised:
            railcast.Simulator(*arguments, **options)
        return str(raised.exception)

    def test_a_faulty_scenario_has_the_lines_of_the_program(self):
        path = ROOT / "scenarios" / "malformed" / "read" / "everything_at_once.json"
        self.assertEqual(self.lines_of(path), faults_of("check", path))
        self.assertEqual(self.lines_of(path.read_text("utf-8"), file=path), faults_of("check", path))

    def test_a_missing_file_and_faulty_arguments_are_named(self):
        self.assertEqual(self.lines_of("nowhere.json"), "nowhere.json: no such file")
        self.assertEqual(self.lines_of(str(SCENARIO), threads=-1),
                         "threads: must be >= 0 and <= 1024 (got -1)")

    def test_a_wrong_frame_or_sensor_is_named(self):
        simulator = railcast.Simulator(SCENARIO)
        for arguments, line in (((-1,), "frame: must be >= 0 and <= 4294967295 (got -1)"),
                                ((0, 1), "sensor: must be >= 0 and < 1 (got 1)"),
                                ((0, "roof"), 'sensor: must be "Vir2Rail" (got "roof")')):
            with self.assertRaises(railcast.InputError) as raised:
                simulator.scan(*arguments)
            self.assertEqual(str(raised.exception), line)


class Misuse(unittest.TestCase):

    def test_a_scenario_of_a_wrong_type_is_a_type_error(self):
        for wrong, name in ((5, "int"), (None, "NoneType"), ([], "list"), (object(), "object")):
            with self.assertRaises(TypeError) as raised:
                railcast.Simulator(wrong)
            self.assertEqual(str(raised.exception), f"scenario: must be a path, a dict or JSON text (got {name})")

    def test_an_object_that_was_never_made_is_a_type_error(self):
        message = "self: must be an object that railcast made (got one that __new__ alone made)"
        for owner, use in ((railcast.Frame, lambda it: it["x"]), (railcast.Frame, lambda it: it.points()),
                           (railcast.Frame, repr), (railcast.Object, lambda it: it.size_m),
                           (railcast.Recording, len), (railcast.Recording, iter), (railcast.Rails, lambda it: it.left),
                           (railcast.Simulator, lambda it: it.scan(0)), (railcast.Simulator, lambda it: it.labels)):
            with self.assertRaises(TypeError, msg=owner) as raised:
                use(owner.__new__(owner))
            self.assertEqual(str(raised.exception), message)
            with self.assertRaises(TypeError):
                copy.copy(owner.__new__(owner))

    def test_motion_sensors_have_arrays_of_their_samples(self):
        simulator = railcast.Simulator(ROOT / "scenarios" / "tunnel_motion.json")
        motion = simulator.motion(2)
        self.assertEqual(list(motion), ["imu", "gnss", "odometer"])
        self.assertEqual({name: len(columns["time_ns"]) for name, columns in motion.items()},
                         {"imu": 20, "gnss": 1, "odometer": 5})
        force = motion["imu"]["true_specific_force_mps2"]
        self.assertEqual((force.shape, force.dtype), ((20, 3), np.float64))
        np.testing.assert_allclose(force.mean(axis=0)[2], 9.8, atol=0.5)
        self.assertEqual(motion["gnss"]["has_fix"].dtype, np.bool_)
        self.assertEqual(motion["odometer"]["pulses"].dtype, np.int64)
        np.testing.assert_allclose(motion["odometer"]["true_distance_m"],
                                   16e-9 * motion["odometer"]["time_ns"], rtol=1e-3)
        self.assertEqual(railcast.Simulator(ROOT / "scenarios" / "minimal.json").motion(0), {})
        with self.assertRaisesRegex(railcast.InputError, "^frame: must be >= 0"):
            simulator.motion(-1)

    def test_lengths_of_rails_are_numbers(self):
        simulator = railcast.Simulator(ROOT / "scenarios" / "minimal.json")
        for name, wrong, shown in (("ahead_m", math.nan, "nan"), ("behind_m", math.inf, "inf"), ("ahead_m", -1, "-1")):
            with self.assertRaises(railcast.InputError) as raised:
                simulator.rails(0, **{name: wrong})
            self.assertEqual(str(raised.exception), f"{name}: must be finite and >= 0 (got {shown})")

    def test_python_ends_while_other_threads_are_at_work(self):
        for begun in (0.0, 0.2, 0.6):  # In the building of the scene, and in its frames.
            program = ABANDONED.format(scenario=str(SCENARIO), seconds=begun)
            ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
            self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, "last\n", ""))

    @unittest.skipIf(os.getpriority(os.PRIO_PROCESS, 0) >= 10, "threads that build ahead are not to be told from others")
    def test_nothing_is_built_ahead_any_more_when_python_has_ended(self):
        with subprocess.Popen([sys.executable, "-c", KEPT.format(scenario=str(SCENARIO))], text=True,
                              stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
            tasks = pathlib.Path("/proc") / str(process.pid) / "task"
            builders = process.stdout.readline().split()
            self.assertEqual(len(builders), 1)
            deadline_s = time.monotonic() + 60
            while (tasks / builders[0]).exists() and time.monotonic() < deadline_s:
                time.sleep(0.01)
            is_building = (tasks / builders[0]).exists()
            self.assertIsNone(process.poll())  # The thread has not ended because the process has.
            process.communicate("\n")
            self.assertFalse(is_building)
            self.assertEqual(process.returncode, 0)

    def test_a_forked_process_ends_and_makes_simulators_of_its_own(self):
        program = FORKED.format(scenario=str(ROOT / "scenarios" / "minimal.json"))
        ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(ended.stderr, "")
        self.assertEqual(ended.stdout, "simulator: must be used in the process that made it (got one forked from that)\n"
                                       "of its own True\nchild ended 0\nTrue\n")


class Compensated(unittest.TestCase):

    def test_points_of_a_simulated_frame_lie_in_its_boxes(self):
        simulator = railcast.Simulator(SCENARIO)
        frame = simulator.scan(30, objects=True)
        instance = frame["instance"][frame.has_point & (frame["outcome"] == railcast.OUTCOMES["returned"])]
        self.assertEqual(len(instance), frame.num_points)  # No mirror images in this frame.
        points = frame.points(compensate="all")
        for thing in frame.objects:
            if thing.points == 0:
                self.assertIsNone(thing.points_time_ns)
                continue
            self.assertAlmostEqual(thing.points_time_ns,
                                   frame["time_ns"][frame.has_point][instance == thing.instance].mean(), delta=1)
            pose = frame.sensor_from_box(thing)
            np.testing.assert_array_equal(pose, thing.sensor_from_box)
            offset = (points[instance == thing.instance] - pose[:3, 3]) @ pose[:3, :3]
            # Five standard deviations of the range noise, 2 cm.
            self.assertLessEqual(np.abs(offset).max(axis=0).tolist(), (thing.size_m / 2 + 0.1).tolist())

    def test_points_in_other_axes_are_not_compensated(self):
        scenario = json.loads(SCENARIO.read_text("utf-8"))
        for output in ({"frame": "vehicle"}, {"handedness": "left"}):
            frame = railcast.Simulator({**scenario, "output": output}, file=SCENARIO).scan(0)
            with self.assertRaises(railcast.InputError) as raised:
                frame.points(compensate="sensor")
            self.assertEqual(str(raised.exception), 'compensate: must be "none" for points that the scenario\'s output '
                                                    'puts into other axes than the sensor\'s (got "sensor")')
            self.assertEqual(len(frame.points()), frame.num_points)


class Rails(unittest.TestCase):

    def test_points_on_rails_lie_beside_the_lines(self):
        simulator = railcast.Simulator(SCENARIO)
        frame = simulator.scan(30)
        rails = simulator.rails(30)
        self.assertEqual([(stretch.track, stretch.is_ego) for stretch in rails], [("main", True), ("second", False)])
        on_rail = frame["label"][frame.has_point] == simulator.labels["rail"]
        points = frame.points()[on_rail]
        near = points[(points[:, 0] > 5) & (points[:, 0] < 40)]
        self.assertGreater(len(near), 100)
        lines = np.concatenate([line for stretch in rails for line in (stretch.left, stretch.right)])
        # Lines have a point every metre; a rail's foot is 75 mm beside its middle; motion during the scan.
        nearest = np.min(np.linalg.norm(near[:, None, 1:] - lines[None, :, 1:] +
                                        np.where(np.abs(near[:, None, :1] - lines[None, :, :1]) < 0.6, 0, 99), axis=2),
                         axis=1)
        self.assertLess(np.quantile(nearest, 0.95), 0.3)

    def test_the_gauge_is_that_of_the_line_and_left_is_left(self):
        for stretch in railcast.Simulator(SCENARIO).rails(0, behind_m=0, ahead_m=100):
            apart = np.linalg.norm(stretch.left - stretch.right, axis=1)
            # 1435 mm between the heads' faces, 14 mm below their tops, and half of each head's 72 mm.
            np.testing.assert_allclose(apart, 1.505, atol=0.01)
            self.assertGreater(stretch.left[0, 1], stretch.right[0, 1])
            self.assertLess(stretch.left[0, 0], stretch.left[-1, 0])


class WithOthers(unittest.TestCase):

    def test_sensors_are_chosen_by_name_or_index(self):
        simulator = railcast.Simulator(TWO_SENSORS)
        self.assertEqual(len(simulator.sensors), 2)
        frames = []
        for index, name in enumerate(simulator.sensors):
            frames.append(simulator.scan(2, index)["x"].tobytes())
            self.assertEqual(simulator.scan(2, name)["x"].tobytes(), frames[-1])
        self.assertNotEqual(*frames)

    def test_other_threads_run_while_a_frame_is_made(self):
        simulator = railcast.Simulator(SCENARIO)
        begun = threading.Event()

        def scan():
            begun.set()
            simulator.scan(0)  # Builds the scene first.

        thread = threading.Thread(target=scan)
        thread.start()
        begun.wait()
        turns = 0
        while thread.is_alive():
            time.sleep(0.001)
            turns += 1
        # If the scan kept the interpreter's lock, this thread would have a turn before and one after.
        self.assertGreater(turns, 4)

    def test_threads_of_python_get_the_frames_that_they_asked_for(self):
        simulator = railcast.Simulator(SCENARIO)
        alone = [simulator.scan(index)["x"].tobytes() for index in range(4)]
        made = {}
        threads = [threading.Thread(target=lambda index=index: made.update({index: simulator.scan(index)}))
                   for index in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual([made[index]["x"].tobytes() for index in range(4)], alone)

    def test_ctrl_c_ends_a_loop_and_the_simulator_still_works(self):
        program = ENDLESS.format(scenario=str(SCENARIO))
        with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True) as child:
            self.assertEqual(child.stdout.readline(), "ready\n")
            child.send_signal(signal.SIGINT)
            self.assertEqual(child.stdout.read(), "interrupted at 0\n")
        self.assertEqual(child.returncode, 0)


if __name__ == "__main__":
    unittest.main()
