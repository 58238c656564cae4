"""What scripts/convert_ttobench.py makes of small files of TTOBench, and how it refuses bad ones."""

import contextlib
import copy
import io
import json
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import convert_ttobench  # noqa: E402 (found through the line above)

TRACK = {
    "metadata": {"id": "test", "library version": "TTOBench v1.4"},
    "altitude": {"unit": "m", "value": 400.0},
    "stops": {"unit": "m", "values": [0.0, 700.0, 2000.0]},
    "speed limits": {"units": {"position": "m", "velocity": "km/h"}, "values": [[0.0, 90]]},
    "gradients": {"units": {"position": "m", "slope": "permil"}, "values": [[0.0, 5.0]]},
    "curvatures": {
        "units": {"position": "m", "radius at start": "m", "radius at end": "m"},
        "values": [[0.0, "infinity", "infinity"], [500.0, "infinity", 400.0]],
    },
    "tunnels": {
        "units": {"position": "m", "length": "m", "cross section": "m^2"},
        "values": [[800.0, 150.0, 40.0], [1000.0, 50.0, 24.0]],
    },
}


def changed(path, value):
    """TRACK with another value at a path; None takes it away."""
    track = copy.deepcopy(TRACK)
    *parents, last = path
    part = track
    for key in parents:
        part = part[key]
    if value is None:
        del part[last]
    else:
        part[last] = value
    return track


class Converted:
    """A run of the program on a text."""

    def __init__(self, text):
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder) / "track.json"
            alignment = pathlib.Path(folder) / "alignment.json"
            places = pathlib.Path(folder) / "places.csv"
            source.write_text(text, encoding="utf-8")
            self.status = 0
            self.said = ""
            try:
                convert_ttobench.main([str(source), str(alignment), "--places", str(places)])
            except SystemExit as stop:
                self.status = 1  # Python's for a text, which it prints to standard error.
                self.said = str(stop.code).replace(folder + "/", "")
            self.has_files = alignment.exists() or places.exists()
            if self.has_files:
                self.alignment = json.loads(alignment.read_text(encoding="utf-8"))
                self.places = places.read_text(encoding="utf-8")


class ConvertTtobench(unittest.TestCase):

    def refusal_of(self, text):
        with contextlib.redirect_stderr(io.StringIO()):
            run = Converted(text)
        self.assertEqual(run.status, 1)
        self.assertFalse(run.has_files)
        self.assertNotIn("\n", run.said)
        return run.said

    def test_a_positive_radius_turns_right(self):
        alignment = Converted(json.dumps(TRACK)).alignment
        self.assertEqual(alignment["course"]["sections"][1], {"s_m": 500.0, "radius_end_m": -400.0})
        self.assertIn("positive ones turn right", alignment["attribution"])

    def test_stops_and_tunnels_are_kept_as_places(self):
        self.assertEqual(Converted(json.dumps(TRACK)).places, """\
type,begin_s_m,end_s_m,cross_section_m2
stop,0.0,0.0,
stop,700.0,700.0,
tunnel,800.0,950.0,40.0
tunnel,1000.0,1050.0,24.0
stop,2000.0,2000.0,
""")

    def test_tunnels_are_structures_of_a_world(self):
        _, places = convert_ttobench.convert(TRACK, [0.0, 0.0], 0.0)
        self.assertEqual(convert_ttobench.structures_of(places)["structures"], [
            {"type": "tunnel", "name": "tunnel_1", "begin_s_m": 800.0, "end_s_m": 950.0},
            {"type": "tunnel", "name": "tunnel_2", "begin_s_m": 1000.0, "end_s_m": 1050.0}])

    def test_the_shipped_line_is_what_the_file_gives(self):
        source = ROOT.parent / "shared/data/track_alignment_ttobench/CH_StGallen_Wil.json"
        if not source.exists():
            self.skipTest(f"{source} is absent")
        shipped = ROOT / "scenarios/alignments/st_gallen_wil.json"
        track = convert_ttobench.read_track(source)
        alignment, _ = convert_ttobench.convert(track, [0.0, 0.0], 226.18)
        self.assertEqual(convert_ttobench.text_of(alignment) + "\n",
                         shipped.read_text(encoding="utf-8"))

    def test_bad_input_is_refused_in_one_line(self):
        for path, value, message in (
                (("metadata",), None, "/metadata: must be an object (got none)"),
                (("metadata", "id"), 7, "/metadata/id: must be a text (got 7)"),
                (("stops",), None, "/stops: must be an object (got none)"),
                (("stops", "unit"), "km",
                 '/stops: units must be {"position": "m"} (got {"position": "km"})'),
                (("stops", "values"), [0.0],
                 "/stops/values: must have the line's beginning and its end (got [0.0])"),
                (("stops", "values", 1), 0.0,
                 "/stops/values/1: must be greater than 0.0 before it (got 0.0)"),
                (("altitude", "value"), "high", '/altitude/value: must be a number (got "high")'),
                (("altitude", "unit"), "ft", '/altitude/unit: must be "m" (got "ft")'),
                (("gradients", "values", 0, 0), 10.0,
                 "/gradients/values/0/0: must be 0, the beginning of the line (got 10.0)"),
                (("gradients", "values", 0, 1), "infinity",
                 '/gradients/values/0/1: must be a number (got "infinity")'),
                (("curvatures", "values", 1, 2), 5.0,
                 "/curvatures/values/1/2: must be 10 m or more (got 5.0)"),
                (("curvatures", "values", 1), [500.0, 400.0],
                 "/curvatures/values/1: must be a list of 3: position, radius at start, radius at "
                 "end (got [500.0, 400.0])"),
                (("speed limits", "values", 0, 1), 0,
                 "/speed limits/values/0/1: must be > 0 (got 0)"),
                (("tunnels", "values", 1, 0), 900.0,
                 "/tunnels/values/1/0: must be 950.0 or more, where it is free (got 900.0)"),
                (("tunnels", "values", 1, 1), 5000.0,
                 "/tunnels/values/1/1: must be > 0 and end on the line (got 5000.0)")):
            with self.subTest(message=message):
                self.assertEqual(self.refusal_of(json.dumps(changed(path, value))),
                                 f"track.json: {message}")

    def test_what_is_no_json_is_refused_in_one_line(self):
        self.assertTrue(self.refusal_of("{").startswith("track.json: /: must be JSON (got "))
        self.assertEqual(self.refusal_of('{"stops": 1, "stops": 2}'),
                         'track.json: key "stops": must be given once (got "2 times")')
        self.assertEqual(self.refusal_of("[]"), "track.json: /: must be an object (got [])")


if __name__ == "__main__":
    unittest.main()
