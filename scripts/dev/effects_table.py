#!/usr/bin/python3
"""Measures what each effect changes in each shipped situation, for docs/results/effects_table.md and .csv.

    scripts/dev/effects_table.py BUILD [--results FILE] [--frames N] [NAME...]

Each situation is simulated by `railcast-analyze compare --ablate` with four sensors in place of its own, whose window
and receiver they keep, on rung `footprint`; effects of other rungs on the first rung that has them. Of the sensors
every sixth to 96th column fires, which changes no share. What has been measured is kept in FILE
(out/effects_table.json) and not measured again; NAME measures these situations anew. The costs need valgrind.
"""

import argparse
import json
import pathlib
import re
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SITUATIONS = ROOT / "scenarios" / "situations"
PAGE = ROOT / "docs" / "results" / "effects_table.md"
FIGURES = ROOT / "docs" / "results" / "effects_table.csv"
SENSORS = {"vir2rail": 6, "vlp16": 36, "pandar64": 96, "rosette": 9}
# The first rung that has an effect which `footprint` lacks.
RUNGS = {"threshold": "plausibility", "rain": "plausibility", "snow": "plausibility", "noise": "plausibility",
         "dense_footprint": "reference", "sampled_waveform": "reference"}
# Keys that are no effects: the situation that has each, where, and on which of its sensors it acts.
KEYS = {
    "fog_variation": ("metre_gauge", ["weather"], 0),
    "gauge_mm": ("metre_gauge", ["world", "alignment"], 0),
    "ride": ("metre_gauge", ["vehicle"], 0),
    "mount_error": ("two_lidars", ["lidars", 1], 1),
    "phase_s": ("two_lidars", ["lidars", 1], 1),
    "tolerance_mm": ("scanned_boulder", ["world", "objects", 0], 0),
}


def read(path):
    return json.loads(path.read_text())


def section_of(path):
    return {key: value for key, value in read(path).items() if key not in ("$schema", "version")}


def sensors_of(situation, folder):
    """The lidars of a situation's file or of its base: the four sensors, thinned, where its first one sits."""
    own = situation if "lidar" in situation or "lidars" in situation else read(SITUATIONS / "base.json")
    own = own["lidar"] if "lidar" in own else own["lidars"][0]
    lidars = []
    for name, every in SENSORS.items():
        lidar = section_of(ROOT / "scenarios" / "sensors" / f"{name}.json")
        pattern = lidar["scan"]["pattern"]
        if "angular_resolution_deg" in pattern:
            pattern["angular_resolution_deg"] *= every
        elif "columns" in pattern:
            pattern["columns"] //= every
            pattern["cycle_us"] *= every
        else:
            rows = (ROOT / "scenarios" / "sensors" / pattern["file"]).read_text().splitlines()
            pattern["file"] = str(folder / f"{name}.csv")
            pathlib.Path(pattern["file"]).write_text("\n".join([rows[0], *rows[1::every]]) + "\n")
        receiver = {k: v for k, v in own.get("receiver", {}).items() if k != "range_at_10_percent_m"}
        lidar["receiver"] = lidar.get("receiver", {}) | receiver
        lidar |= {"name": name, "mount": own["mount"]}
        if "cover" in own:
            lidar["cover"] = own["cover"]
        lidars.append(lidar)
    return lidars


def scenario_of(path, folder, **changes):
    return {"version": 1, "file": str(path), "fidelity": "footprint",
            "lidars": sensors_of(read(path), folder)} | changes


def ablated(build, scenario, *options):
    """{sensor: report of what each effect changes} of a scenario."""
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        json.dump(scenario, file)
        file.flush()
        said = subprocess.run([build / "analysis" / "railcast-analyze", "compare", "--ablate", file.name,
                               "--format", "json", *options],
                              check=True, stdout=subprocess.PIPE, text=True).stdout
    reports = json.loads(said)  # Of several sensors a list.
    return dict(zip((lidar["name"] for lidar in scenario["lidars"]), reports if isinstance(reports, list) else [reports]))


def rows_of(report, key):
    """{effect: its row in a table} of a report."""
    return {row["effect"]: row for section in report["sections"] for table in section["tables"]
            if table["key"] == key for row in table["rows"]}


def number(cell):
    return (cell.get("value") if isinstance(cell, dict) else cell) or 0.0


def figures(row, of_frames):
    """Of an effect's rows in the report: shares of the firings in percent, and sizes of changes."""
    beams = row["beams"]
    echoes = 100.0 * (row["points_taken"] + row["points_added"]) / beams
    return {"any": 100.0 - number(row["identical_percent"]), "outcome": number(row["outcome_percent"]),
            "outcome_of_frames": [of_frames["outcome_least_percent"], of_frames["outcome_most_percent"]],
            "echoes": echoes, "echoes_of_frames": [of_frames["points_least_percent"], of_frames["points_most_percent"]],
            "moved": number(row["moved_percent"]), "moved_m": number(row["moved_median_m"]),
            "intensity": number(row["intensity_percent"]), "intensity_by": number(row["intensity_median"])}


def measure(build, path, frames):
    with tempfile.TemporaryDirectory() as folder:
        reports = ablated(build, scenario_of(path, pathlib.Path(folder)), "--all-effects", "--frames", str(frames))
    return {sensor: {effect: figures(row, rows_of(report, "frames")[effect])
                     for effect, row in rows_of(report, "effects").items()} for sensor, report in reports.items()}


def matters(cell):
    """By what effects are sorted: firings that end otherwise, or echoes that come and go."""
    return max(cell["outcome"], cell["echoes"])


def most_of(situations):
    """{effect: (situation, sensor, its figures there)} where each matters most, the effects in that order."""
    def rank(name, sensor, effect):
        cell = situations[name][sensor][effect]
        return matters(cell), cell["any"] * (cell["moved_m"] + cell["intensity_by"]), name, sensor

    most = {effect: max(rank(name, sensor, effect) for name, rows in situations.items() for sensor in rows)
            for effect in next(iter(situations.values()))["vir2rail"]}
    ordered = sorted(most, key=lambda effect: most[effect][:2], reverse=True)
    return {effect: (*most[effect][2:], situations[most[effect][2]][most[effect][3]][effect]) for effect in ordered}


def sample_frame(build, scenario):
    """The number of the frame that is looked at when one is, of a scenario with one sensor."""
    report, = ablated(build, scenario | {"fidelity": "plausibility"}, "--frames", "1").values()
    return report["facts"]["Frames"].partition(":")[0]


def instructions(build, scenario, frame):
    """Those of Simulator::Scan a firing on a frame of a scenario, without making the scene, by callgrind."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "scenario.json"
        file.write_text(json.dumps(scenario))
        run = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
                              "--toggle-collect=railcast::Simulator::Parts::Scan*",
                              build / "generator" / "railcast-generate", "sequence", file, "--frames", "1",
                              "--start-frame", frame, "--threads", "1", "--out", file.parent / "out"],
                             check=True, capture_output=True, text=True)
    collected = int(re.search(r"Collected : (\d+)", run.stderr)[1])
    return collected / int(re.search(r"firings by outcome \((\d+)\)", run.stdout)[1])


def measure_costs(build, results, keep):
    """Adds to results what each effect costs where it matters most: instructions a firing with it less those without."""
    costs, with_it = results.setdefault("costs", {}), {}
    for effect, (name, sensor, cell) in most_of(results["situations"]).items():
        if cell["any"] == 0 or costs.get(effect, {}).get("at") == [name, sensor]:
            continue
        with tempfile.TemporaryDirectory() as folder:
            scenario = scenario_of(SITUATIONS / f"{name}.json", pathlib.Path(folder))
            scenario["lidars"] = [lidar for lidar in scenario["lidars"] if lidar["name"] == sensor]
            scenario["fidelity"] = RUNGS.get(effect, "footprint")
            key = (name, sensor, scenario["fidelity"])
            if key not in with_it:
                frame = sample_frame(build, scenario)
                with_it[key] = frame, instructions(build, scenario, frame)
            frame, counted = with_it[key]
            without = instructions(build, scenario | {"effects": {effect: False}}, frame)
        costs[effect] = {"at": [name, sensor], "instructions": counted - without, "of": counted}
        keep()
        print(f"{effect}: {counted - without:.0f} of {counted:.0f} instructions a firing", flush=True)


def measure_keys(build):
    """{key: percent of the firings that change in some bit where the key is left out}, in the middle of a run."""
    import sys
    sys.path.insert(0, str(build / "python"))
    import numpy as np
    import railcast
    shares = {}
    for key, (situation, place, sensor) in KEYS.items():
        path = SITUATIONS / f"{situation}.json"
        if not path.exists():
            continue
        frames = []
        for is_left_out in (False, True):
            scenario = read(path)
            section = scenario
            for step in place:
                if isinstance(section[step], str):  # A file.
                    section[step] = section_of(SITUATIONS / section[step])
                section = section[step]
            if is_left_out:
                del section[key]
            frames.append(railcast.Simulator(scenario, file=str(path)).scan(100, sensor))
        same = np.ones(frames[0]["range_m"].shape, dtype=bool)
        for field in ("x", "y", "z", "intensity", "range_m", "outcome"):
            a, b = (frame[field] for frame in frames)
            same &= (a == b) | ((a != a) & (b != b))
        shares[key] = 100.0 * (1.0 - same.mean())
    return shares


def share(value):
    """A share in percent, short."""
    return "" if value == 0 else "< 0.01" if value < 0.01 else f"{value:.2g}" if value < 10 else f"{value:.0f}"


def with_spread(mean, of_frames):
    """A mean share, and the least and the most of a frame."""
    return f"{share(mean)} ({share(of_frames[0]) or 0} to {share(of_frames[1]) or 0})" if of_frames[1] > 0 else ""


def mean_over_sensors(results, situation, effect, figure):
    return statistics.fmean(rows[effect][figure] for rows in results["situations"][situation].values())


def csv_of(results):
    """Of each situation the effects that change anything, in percent of the firings: means over sensors and frames, and
    the least and the most of a sensor's frame."""
    lines = ["situation,effect,any_percent,outcome_percent,echoes_percent,moved_percent,intensity_percent,"
             "outcome_least_percent,outcome_most_percent,echoes_least_percent,echoes_most_percent"]
    for name in sorted(results["situations"]):
        for effect in next(iter(results["situations"][name].values())):
            means = [mean_over_sensors(results, name, effect, figure)
                     for figure in ("any", "outcome", "echoes", "moved", "intensity")]
            cells = [rows[effect] for rows in results["situations"][name].values()]
            spreads = [of([cell[key][place] for cell in cells]) for key in ("outcome_of_frames", "echoes_of_frames")
                       for place, of in enumerate((min, max))]
            if means[0] > 0:
                lines.append(",".join([name, effect, *(f"{value:.3g}" for value in means + spreads)]))
    return "\n".join(lines) + "\n"


def page_of(results):
    names = sorted(results["situations"])
    effects = list(next(iter(results["situations"][names[0]].values())))
    headings = re.findall(r"^## (.+)$", (ROOT / "docs" / "effects.md").read_text(), re.M)
    costs = results.get("costs", {})
    lines = [(PAGE.read_text() if PAGE.exists() else "").split("<!-- table -->")[0].rstrip() + "\n\n<!-- table -->\n",
             "| effect | matters most in | outcome % | echoes % | moved %, by | intensity %, by | any bit %, median | "
             "cost |", "|---|---|---|---|---|---|---|---|"]
    for effect, (name, sensor, cell) in most_of(results["situations"]).items():
        is_idle = cell["any"] == 0
        moved_by = f", {1000 * cell['moved_m']:.2g} mm" if cell["moved_m"] < 1 else f", {cell['moved_m']:.1f} m"
        moved = share(cell["moved"]) + (moved_by if cell["moved_m"] else "")
        dimmed = share(cell["intensity"]) + (f", {cell['intensity_by']:.2g}" if cell["intensity_by"] else "")
        median = statistics.median(mean_over_sensors(results, other, effect, "any") for other in names)
        cost = f"{costs[effect]['instructions']:,.0f}" if effect in costs else ""
        if cost and costs[effect]["at"] != [name, sensor]:
            cost += f" in {', '.join(costs[effect]['at'])}"
        where = "nowhere" if is_idle else f"[{name}](../../scenarios/situations/{name}.json), {sensor}"
        heading = next((heading for heading in headings if effect in heading.split()), "")
        anchor = "#" + heading.replace(" ", "-") if heading else ""
        lines.append(f"| [`{effect}`](../effects.md{anchor}) | {where} | {with_spread(cell['outcome'], cell['outcome_of_frames'])} | "
                     f"{with_spread(cell['echoes'], cell['echoes_of_frames'])} | {moved} | {dimmed} | {share(median)} | {cost} |")
    num_shipped = len(list(SITUATIONS.glob("*.json"))) - 1
    if len(names) < num_shipped:
        lines += ["", f"{len(names)} of {num_shipped} situations are measured so far."]
    lines += ["", "## Keys that are no effects", "", "Of frame 100 alone.", "",
              "| key | situation | firings that change without it % |", "|---|---|---|"]
    for key, value in results.get("keys", {}).items():
        situation = KEYS[key][0]
        lines.append(f"| `{key}` | [{situation}](../../scenarios/situations/{situation}.json) | {share(value)} |")
    lines += ["", "## By sensor", "", "Firings of which anything changes, in percent: the median over the situations and "
              "the most.", "", "| effect | " + " | ".join(f"{sensor}: median, most" for sensor in SENSORS) + " |",
              "|---|" + "---|" * len(SENSORS)]
    for effect in effects:
        cells = []
        for sensor in SENSORS:
            shares = [results["situations"][name][sensor][effect]["any"] for name in names]
            cells.append(f"{share(statistics.median(shares)) or 0}, {share(max(shares)) or 0}")
        lines.append(f"| `{effect}` | " + " | ".join(cells) + " |")
    lines += ["", "## By situation", "",
              "Effects that change at least 1 % of the firings, the strongest first, in percent; means over the four",
              f"sensors. [{FIGURES.name}]({FIGURES.name}) has all figures.", "",
              "| situation | firings that end otherwise | points that come or go |", "|---|---|---|"]
    for name in names:
        cells = [name]
        for figure in ("outcome", "echoes"):
            means = [(mean_over_sensors(results, name, effect, figure), effect) for effect in effects]
            cells.append(", ".join(f"`{effect}` {share(value)}" for value, effect in sorted(means, reverse=True)
                                   if value >= 1))
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "out" / "effects_table.json")
    parser.add_argument("--frames", type=int, default=10, help="sample frames of each situation")
    parser.add_argument("names", nargs="*", metavar="NAME")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    results = {"situations": {}}
    if arguments.results.exists():
        results = read(arguments.results)

    def keep():
        arguments.results.parent.mkdir(parents=True, exist_ok=True)
        arguments.results.write_text(json.dumps(results, indent=1) + "\n")

    for path in sorted(SITUATIONS.glob("*.json")):
        name = path.stem
        if name != "base" and (name in arguments.names or name not in results["situations"]):
            results["situations"][name] = measure(build, path, arguments.frames)
            keep()
            print(name, flush=True)
    results["keys"] = measure_keys(build)
    keep()
    measure_costs(build, results, keep)
    PAGE.write_text(page_of(results))
    FIGURES.write_text(csv_of(results))


if __name__ == "__main__":
    main()
