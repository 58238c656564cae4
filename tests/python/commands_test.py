"""railcast.Simulator.apply() changes what commands of a live run change."""

import json
import pathlib
import tempfile
import unittest

from support import SCENARIO, generate, read_pcd

import railcast

COMMANDS = [
    (2, {"command": "set_speed", "speed_mps": 20, "acceleration_mps2": 1.5}),
    (4, {"command": "place_object", "object": {"name": "bob", "type": "person", "s_m": 2130, "d_m": 1.5}}),
    (4, {"command": "set_weather", "weather": {"visibility_m": 80}}),
    (5, {"command": "remove_object", "name": "foul_wagon"}),
]
FRAMES = 8


class Commands(unittest.TestCase):

    def test_frames_are_those_of_a_replayed_log(self):
        simulator = railcast.Simulator(SCENARIO)
        stamps = [simulator.scan(index).stamp_ns for index in range(FRAMES)]
        for index, command in COMMANDS:
            simulator.apply(command, index)
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            generate("sequence", SCENARIO, "--out", folder / "plain", "--frames", 1)
            scenario = json.loads((folder / "plain" / "run.json").read_text("utf-8"))["scenario_xxh3"]
            log = [{"railcast_commands": 1, "scenario_xxh3": scenario}]
            log += [{"time_ns": stamps[index], "command": command} for index, command in COMMANDS]
            (folder / "log.jsonl").write_text("".join(json.dumps(line) + "\n" for line in log), "utf-8")
            generate("sequence", SCENARIO, "--out", folder / "run", "--frames", FRAMES, "--commands",
                     folder / "log.jsonl")
            for index in reversed(range(FRAMES)):
                written = read_pcd(folder / "run" / "frames" / f"{index:06}.pcd")
                made = simulator.scan(index)
                for field in made.fields:
                    self.assertEqual(made[field].tobytes(), written[field].tobytes(), (index, field))

    def test_a_text_does_what_a_dict_does(self):
        made = []
        for command in ({"command": "brake"}, '{"command": "brake"}'):
            simulator = railcast.Simulator(SCENARIO)
            simulator.apply(command, 1)
            made.append(simulator.scan(20)["x"].tobytes())
        self.assertEqual(made[0], made[1])
        self.assertNotEqual(made[0], railcast.Simulator(SCENARIO).scan(20)["x"].tobytes())

    def test_reset_returns_to_the_scenario(self):
        simulator = railcast.Simulator(SCENARIO)
        before = simulator.scan(20)["x"].tobytes()
        simulator.apply({"command": "stop"}, 10)
        simulator.apply({"command": "reset"}, 0)
        self.assertEqual(simulator.scan(20)["x"].tobytes(), before)

    def test_a_faulty_command_has_the_lines_of_a_live_run_and_changes_nothing(self):
        simulator = railcast.Simulator(SCENARIO)
        before = simulator.scan(5)["x"].tobytes()
        for command, line in (
            ({"command": "set_speed", "speed_mps": -1}, "command: /speed_mps: must be >= 0 and <= 200 (got -1)"),
            ({"command": "remove_object", "name": "bob"}, 'command: /name: must be the name of an object that is there (got "bob")'),
        ):
            with self.assertRaises(railcast.InputError) as raised:
                simulator.apply(command, 3)
            self.assertEqual(str(raised.exception), line)
        self.assertEqual(simulator.scan(5)["x"].tobytes(), before)

    def test_commands_come_in_order_of_time(self):
        simulator = railcast.Simulator(SCENARIO)
        simulator.apply({"command": "brake"}, 10)
        with self.assertRaises(railcast.InputError) as raised:
            simulator.apply({"command": "stop"}, 9)
        stamps = [simulator.scan(index).stamp_ns / 1e9 for index in (9, 10)]
        self.assertEqual(str(raised.exception),
                         f"frame: must not be stamped before the last command, at {stamps[1]:g} s (got {stamps[0]:g} s)")


if __name__ == "__main__":
    unittest.main()
