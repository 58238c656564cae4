"""The scenarios of scripts/dev/growth.py: the demo, with one thing of it varied."""

import copy
import json
import math
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = ROOT / "scenarios"
MOST_TREES_PER_HECTARE = 5000


def demo():
    """scenarios/st_gallen_approach.json, its files by absolute names so that it can lie anywhere."""
    scenario = json.loads((SCENARIOS / "st_gallen_approach.json").read_text())
    del scenario["$schema"]
    scenario["lidar"]["file"] = str(SCENARIOS / scenario["lidar"]["file"])
    scenario["world"]["alignment"] = str(SCENARIOS / scenario["world"]["alignment"])
    for key in ("weather", "materials", "labels"):
        scenario[key] = str(SCENARIOS / scenario[key])
    return scenario


def beams(count):
    """A raster over 60 x 30 degrees of about so many beams."""
    scenario = demo()
    step_deg = 30.0 / round(math.sqrt(count / 2.0))
    scenario["lidar"]["scan"] = {
        "rate_hz": 10,
        "pattern": {"type": "raster", "horizontal_fov_deg": 60, "vertical_fov_deg": 30,
                    "angular_resolution_deg": step_deg},
    }
    return scenario


def trees(per_hectare):
    """A wide strip with so many trees; without any (0), also a lean strip (None)."""
    scenario = demo()
    world = scenario["world"]
    world["objects"] = []
    world["vegetation"] = {"trees_per_hectare": per_hectare or 0, "grass": False}
    world["terrain"] = {"half_width_m": 120}
    if per_hectare is None:
        world["terrain"] = {"half_width_m": 6}
        world["catenary"] = {"enabled": False}
        world["tracks"] = [{"name": "main", "start_s_m": 2170, "end_s_m": 2195}]
    return scenario


def persons(count, moving):
    """So many persons ahead, up to 200 m away, in place of the demo's objects."""
    across, behind_m = (20, 3.9) if count <= 1000 else (40, 0.8)
    scenario = demo()
    scenario["world"]["objects"] = [
        {"name": f"person_{i}", "type": "person", "s_m": 2200 + behind_m * (i // across),
         "d_m": 40.0 / across * (i % across + 0.5) - 20.0,
         **({"motion": {"profile": [{"time_s": 0, "speed_mps": 1}]}} if moving else {})}
        for i in range(count)
    ]
    return scenario


def sensors(count):
    """So many of the demo's sensors side by side on the roof."""
    scenario = demo()
    lidar = scenario.pop("lidar")
    scenario["lidars"] = []
    for i in range(count):
        one = copy.deepcopy(lidar)
        one["name"] = f"sensor_{i}"
        one["mount"]["position_m"][1] = 0.2 * (i - 0.5 * (count - 1))
        scenario["lidars"].append(one)
    return scenario


# A ball of 224 x 224 cells, two triangles each.
DENSE_BALL = ROOT / "out/dense_ball.obj"
BALL_CELLS = 224
BALLS = 90


def write_dense_ball():
    """The mesh of yardstick(): a ball of 1 m with waves, of 100,352 triangles."""
    DENSE_BALL.parent.mkdir(exist_ok=True)
    with open(DENSE_BALL, "w", encoding="utf-8") as file:
        for i in range(BALL_CELLS + 1):
            down = math.pi * i / BALL_CELLS
            for k in range(BALL_CELLS):
                round_ = 2.0 * math.pi * k / BALL_CELLS
                radius_m = 1.0 + 0.02 * math.sin(20.0 * down) * math.sin(20.0 * round_)
                x, y = (radius_m * math.sin(down) * turn for turn in (math.cos(round_), math.sin(round_)))
                file.write(f"v {x:.6f} {y:.6f} {radius_m * math.cos(down):.6f}\n")
        for i in range(BALL_CELLS):
            for k in range(BALL_CELLS):
                a, b = 1 + BALL_CELLS * i + k, 1 + BALL_CELLS * i + (k + 1) % BALL_CELLS
                file.write(f"f {a} {a + BALL_CELLS} {b}\nf {b} {a + BALL_CELLS} {b + BALL_CELLS}\n")


def yardstick(count):
    """So many lidars of 128 x 4,096 firings, and 22 million triangles, of which 9 million move: the sizes of a published
    comparison (GRCA, arXiv 2605.10457)."""
    scenario = demo()
    del scenario["lidar"]
    one = json.loads((SCENARIOS / "sensors/vls128.json").read_text())
    sensor = {key: one[key] for key in ("range_min_m", "range_max_m", "plausibility", "beam", "receiver")}
    sensor["scan"] = {"rate_hz": 10, "pattern": {
        "type": "spinning", "cycle_us": 24.414, "columns": 4096,
        "channels": [{"elevation_deg": round(-25.0 + 40.0 * i / 127, 4), "azimuth_deg": 0.0, "time_us": 0.0}
                     for i in range(128)]}}
    scenario["lidars"] = [{"name": f"sensor_{i}", **sensor,
                           "mount": {"position_m": [0.5 * (i // 2), 0.8 * (i % 2) - 0.4, 4.6]}} for i in range(count)]
    scenario["world"]["objects"] += [
        {"name": f"ball_{i}", "type": "mesh", "file": str(DENSE_BALL), "s_m": 2190 + 6 * (i // 6),
         "d_m": (6.0 + 5.0 * (i % 3)) * (1 if i % 6 < 3 else -1), "motion": {"profile": [{"time_s": 0, "speed_mps": 1 + i % 3}]}}
        for i in range(BALLS)]
    return scenario


def line(length_km):
    """The demo's sensor in alternating curves, one left and one right a kilometre."""
    curves = []
    for radius_m in (600, -600):
        curves += [
            {"type": "straight", "length_m": 200},
            {"type": "clothoid", "length_m": 80},
            {"type": "arc", "length_m": 140, "radius_m": radius_m},
            {"type": "clothoid", "length_m": 80},
        ]
    scenario = demo()
    scenario["world"] = {"alignment": {"course": {"type": "elements",
                                                  "elements": curves * length_km}}}
    scenario["vehicle"] = {"start_s_m": 500}
    return scenario
