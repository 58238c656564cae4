#!/usr/bin/env python3
"""Measures the figures of the pages into docs/results/results.json, and puts them into the pages (results.py beside it).

    measure_results.py [PART...] [--build build/release] [--list] [--again]

Without a PART, measures all parts of which the file has no figures of this revision and an idle machine, so that the
same command goes on where it was stopped. --again measures all; --list says what there is and how long each takes.
Needs a release build of everything, gnuplot, valgrind and Xvfb; `peers` installs and builds what it needs. Times are
measured on an idle machine: the script waits until nothing else runs, refuses if that does not come, and keeps no
figure beside which other programs ran.
"""

import argparse
import csv
import datetime
import json
import math
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

import growth
import metro_trial
import results

ROOT = pathlib.Path(__file__).resolve().parents[2]
FILE = ROOT / results.FILE
MOST_OTHER_CORES = 0.05  # What other programs may use while times are measured.
PAUSE_S = 5.0
MOST_PAUSES = 24  # A load of its own last part goes down within two minutes.
STEADY_PERCENT = 3.0
# Student's t for 95 % by degrees of freedom, from 2 on.
T_95 = (4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179)
SCENES = ("open_line", "parallel_wagons", "forest_rain", "fog_yard")
SENSORS = {"pandar64": "Pandar64", "vls128": "VLS-128", "rosette": "rosette"}


def said(*command, **options):
    """What a command prints."""
    return subprocess.run(list(map(str, command)), check=True, stdout=subprocess.PIPE, text=True, cwd=ROOT,
                          **options).stdout


def tables_in(text):
    """The rows of all Markdown tables of a text, each with its columns first."""
    found = re.findall(r"^\|.*\|\n\|[-|]+\|\n(?:\|.*\|\n?)*", text, re.M)
    return [[results.cells_of(line) for i, line in enumerate(table.splitlines()) if i != 1] for table in found]


def table(keys, columns, rows):
    return {"keys": keys, "columns": columns, "rows": rows}


def shown(value, scale=1.0, digits=2):
    return "-" if value is None else f"{scale * value:.{digits}f}"


def error_cells(row):
    """The cells of a row of `frontier` and their columns."""
    errors = row.get("errors") or {}
    share = lambda key: shown(errors.get(key), 100.0)
    found = lambda key: "-" if errors.get(key) is None else f"{100.0 * (1.0 - errors[key]):.2f}"
    length = lambda key: shown(errors.get(key), 1e3)
    return {"time x raw trace": shown(row["ratio_to_raw_trace"]), "missed %": share("missed_share"),
            "false %": share("false_share"), "range p50 mm": length("range_median_m"),
            "range p95 mm": length("range_p95_m"), "wires found %": found("thin_missed_share"),
            "further echoes %": found("further_missed_share"), "second surfaces %": found("second_missed_share"),
            "steps %": found("step_missed_share"), "at steps mm": length("step_range_median_m"),
            "persons %": share("person_points_error"), "poles %": share("pole_points_error"),
            "bright edges %": share("bright_edge_intensity_median")}


def by_range(file, names):
    """Missed echoes in percent by range: a column for each of the rows."""
    with open(file, encoding="utf-8", newline="") as lines:
        bins = list(csv.DictReader(lines))
    ranges = list(dict.fromkeys(bin["range"] for bin in bins))
    of = {(bin["range"], bin["row"]): bin for bin in bins}
    rows = [[f"{far} m", f"{int(of[far, names[0]]['reference_echoes']):,}",
             *(shown(float(of[far, name]["missed_percent"]), digits=1) for name in names)] for far in ranges]
    return table(1, ["range", "echoes of the reference", *(f"`{name}`" for name in names)], rows)


def choice_cells(scene, sensor, choice):
    left_out = [one["what"] for one in choice["measured"] if not one["is_kept"]]
    share = lambda key: shown(choice["deviation"][key], 100.0)
    return [f"`{scene}`", sensor, ", ".join(left_out) or "nothing", f"{choice['instructions_per_firing']:,.0f}",
            share("missed_share"), share("thin_missed_share"),
            f"{choice['held_back_beyond_tolerance']} of {len(choice['held_back'])}"]


def frontier_tables(folder):
    """The tables of what draw_frontiers.sh has measured so far."""
    tables, of_sensors, choices = {}, [], []
    for scene in SCENES:
        for suffix, sensor in [("", "raster"), *SENSORS.items()]:
            file = folder / (f"{scene}_{suffix}" if suffix else scene) / "frontier.json"
            if not file.exists():
                continue
            measured = json.loads(file.read_text(encoding="utf-8"))
            cells = {row["name"]: error_cells(row) for row in measured["rows"]}
            columns = list(next(iter(cells.values())))
            if not suffix:
                tables[scene] = table(1, ["row", *columns], [[f"`{name}`", *of.values()] for name, of in cells.items()])
            of_sensors += [[f"`{scene}`", sensor, f"`{name}`", *cells[name].values()]
                           for name in ("surface", "footprint", "brute_force_64")]
            choices.append(choice_cells(scene, sensor, measured["fidelity_auto"]))
    tables["by_range"] = by_range(folder / "open_line/csv/by_range.csv",
                                  ("surface+thin_conductors", "footprint_16", "footprint", "brute_force_64"))
    tables["sensors"] = table(3, ["scene", "sensor", "row", *columns], of_sensors)
    tables["auto"] = table(2, ["scene", "sensor", "measured and left out", "instructions a firing", "missed %",
                               "wires missed %", "held-back frames beyond"], choices)
    return tables


def frontier(_):
    said("scripts/dev/draw_frontiers.sh")
    return frontier_tables(ROOT / "out/frontier")


def instructions(build):
    """Instructions a firing, counted by callgrind."""
    text = said("scripts/dev/measure_effect_costs.sh", build / "generator/railcast-generate")
    counted = re.findall(r"^([\w.]+) (\d+)", text, re.M)
    return {"firing": table(1, ["what", "instructions"], [[f"`{name}`", f"{int(num):,}"] for name, num in counted])}


class NotSteadyError(Exception):
    """Says what varies too much to be a figure."""


def interval_percent(values):
    """Half of the 95 % interval of the mean of at least three values, in percent of it."""
    mean = statistics.fmean(values)
    return 100.0 * T_95[len(values) - 3] * statistics.stdev(values) / math.sqrt(len(values)) / mean


# What the pages show of it: the whole bench takes four minutes a run.
BENCH_ROWS = ("raw_trace", "geometry", "plausibility", "plausibility_in_snow", "surface", "surface_in_snow",
              "surface+thin_conductors", "footprint", "plausibility_pcd", "plausibility_stream")


def bench(build):
    """Runs until the ratios are known to 3 %, whose medians are given with their intervals."""
    runs = {}
    rows = "|".join(map(re.escape, BENCH_ROWS))
    for turn in range(len(T_95) + 2):
        lines = re.findall(r"^(\S+)/(demo)/threads:2\S* +([\d.]+) +([\d.]+) +([\d.]+)$",
                           said(build / "tests/bench/railcast-bench", f"--benchmark_filter=^({rows})/demo/threads:2/"),
                           re.M)
        for what, scene, *cells in lines:
            runs.setdefault((what, scene), []).append([float(cell) for cell in cells])
        if turn < 2:
            continue
        intervals = {row: interval_percent([ratio for *_, ratio in of]) for row, of in runs.items()}
        if max(intervals.values()) < STEADY_PERCENT:
            break
    else:
        row = max(intervals, key=intervals.get)
        raise NotSteadyError(f"{' of '.join(row)} varies by {intervals[row]:.1f} % in {turn + 1} runs")
    rows = []
    for (what, scene), of in runs.items():
        p50, p99, ratio = (statistics.median(values) for values in zip(*of))
        rows.append([f"`{what}`", scene, f"{p50:.3f}", f"{p99:.3f}", f"{ratio:.3f}", f"{intervals[what, scene]:.1f}"])
    return {"scan": table(2, ["what", "scene", "p50 ms", "p99 ms", "time x raw trace", "± %"], rows)}


def largest_change(cells):
    """The change of a column that is farthest from 0 by more than its interval, with its bin."""
    changes = [(abs(float(change)) - float(interval), change, interval, far)
               for far, cell in cells for change, interval in re.findall(r"([-+][\d.]+) ± ([\d.]+)", cell)]
    if not changes:
        return "-"
    _, change, interval, far = max(changes)
    return f"{change} ± {interval} from {far}"


NAMES = {"vir2rail": "raster", **SENSORS}


def detail(_):
    """The largest changes by coarser plants and ground, and the times."""
    echoes, times = [], []
    parts = re.split(r"^(\w+), (\w+)(, no plants)?$", said("scripts/dev/measure_detail.sh"), flags=re.M)
    for name, rung, bare, text in zip(parts[1::4], parts[2::4], parts[3::4], parts[4::4]):
        for columns, *rows in tables_in(text):
            group = ""  # A column without a group is of that before it.
            for i, column in enumerate(columns[1:], 1):
                group, _, figure = column.rpartition(": ") if ": " in column else (group, "", column)
                echoes.append([NAMES.get(name, name), f"`{rung}`", f"{group}: {figure}{bare or ''}",
                               largest_change([(row[0], row[i]) for row in rows])])
        for ratios in re.findall(r"^x raw trace(.*)", text, re.M):
            times.append([f"`{name}`", f"`{rung}`", *re.findall(r"\d+(?:\.\d+)?", ratios)])
    return {"echoes": table(3, ["sensor", "rung", "of", "largest change %"], echoes),
            "times": table(2, ["scenario", "rung", "raw trace, auto", "raw trace, without plants", "frame, full",
                               "frame, auto", "frame, without plants"], times)}


def of_printed(keys, *command):
    """A table that a command prints, the first columns of which name its rows."""
    columns, *rows = tables_in(said(*command))[0]
    return table(keys, columns, rows)


def modules(build):
    return {"modules": of_printed(1, build / "tests/bench/railcast-measure", "modules", "--scans", 1000)}


def settings(build):
    return {"settings": of_printed(1, build / "tests/bench/railcast-measure", "settings", "--turns", 100)}


def drawn(keys, script):
    """The table of a script that draws pictures, which go to docs/images."""
    with tempfile.TemporaryDirectory() as out:
        printed = of_printed(keys, script, out)
        for picture in (pathlib.Path(out) / "images").iterdir():
            shutil.copy(picture, ROOT / "docs/images")
    return printed


def plants(_):
    return {"landscape": drawn(1, "scripts/dev/draw_plants.sh")}


def weather(_):
    return {"weather": drawn(2, "scripts/dev/draw_weather.sh")}


def merged(texts):
    """Texts that differ in their numbers alone as one, with the range of each number; None if they differ in more."""
    if len({results.NUMBER.sub("#", text) for text in texts}) != 1:
        return None
    columns = iter(list(zip(*(results.NUMBER.findall(text) for text in texts))))
    def span(_):
        numbers = sorted(set(next(columns)), key=lambda number: float(number.replace(",", "")))
        return numbers[0] if len(numbers) == 1 else f"{numbers[0]} to {numbers[-1]}"
    return results.NUMBER.sub(span, texts[0])


def regimes(report):
    """The rows of where_methods_fail.md in a report of stability_test; those of several sensors are one."""
    found = {}
    for suite in json.loads(report)["testsuites"]:
        for test in suite["testsuite"]:
            for key, text in test.items():
                if key.startswith("regime: "):
                    text = text.encode("latin-1").decode("utf-8")  # GoogleTest escapes single bytes.
                    name = suite["name"].rpartition("/")[2]
                    found.setdefault((key[len("regime: "):], f"`{name}.*`"), []).append(text.split(" | "))
    rows = [[regime, *(merged(cells) or "; ".join(cells) for cells in zip(*texts)), name]
            for (regime, name), texts in found.items()]
    return sorted(rows, key=lambda row: (row[1] == "-", row[-1]))  # Those with a simple method first.


def stability(build):
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        said(build / "tests/stability/stability_test", f"--gtest_output=json:{report}")
        rows = regimes(report.read_text(encoding="utf-8"))
    return {"regimes": table(1, ["regime", "the simple method", "railcast", "test"], [r for r in rows if len(r) == 4]),
            "rungs": table(1, ["regime", "one ray a beam", "`footprint`", "`reference`", "test"],
                           [r for r in rows if len(r) == 5])}


def python(build):
    lines = re.findall(r"^(\S+): C\+\+ ([\d.]+) ms, Python ([\d.]+) ms, ratio (.*), \d+ frames$",
                       said("scripts/dev/measure_python_scan.py", build, 500), re.M)
    return {"scan": table(1, ["scenario", "C++ ms", "Python ms", "ratio, with its 95 % interval"],
                          [[f"`{pathlib.Path(name).name}`", *cells] for name, *cells in lines])}


def live(build):
    """Runs on loopback; the rates that each rung sustains."""
    text = said("scripts/dev/measure_live.py", build, "steady", "limits", "late", "fast")
    quantiles = (r"compute: p50 ([\d.]+), p99 ([\d.]+).*\n  send: p50 ([\d.]+).*\n"
                 r"  lateness: p50 ([\d.]+), p99 ([\d.]+), max ([\d.]+)")
    steady = re.findall(r"^published scan, (\d+ Hz, \w+), .*: (\d+) frames, (\d+) late.*\n  " + quantiles, text, re.M)
    rates = re.findall(r"^(\w+): (\d+) Hz for", text, re.M)
    runs = re.findall(r"^(.+), [\d.]+ s: (\d+) frames, (\d+) late; compute p50 ([\d.]+), p99 ([\d.]+)", text, re.M)
    return {"steady": table(1, ["published scan", "frames", "late", "compute p50 ms", "compute p99 ms", "send p50 ms",
                                "lateness p50 ms", "lateness p99 ms", "lateness max ms"], list(map(list, steady))),
            "rates": table(1, ["rung", "Hz"], [[f"`{rung}`", rate] for rung, rate in rates]),
            "runs": table(1, ["run", "frames", "late", "compute p50 ms", "compute p99 ms"], list(map(list, runs)))}


PERSON_AND_BOX = {"version": 1, "world": {"recording": {}, "objects": [
    {"name": "person", "type": "person", "frame": 100, "s_m": 40, "d_m": 0.4},
    {"name": "box", "type": "box", "size_m": [0.5, 0.5, 0.5], "frame": 600, "s_m": 40, "d_m": -0.5}]},
    "materials": str(ROOT / "scenarios/materials/railway.json"), "labels": str(ROOT / "scenarios/labels.json")}


def insertion(build):
    """Seconds of `insert` into 1,000 frames of the published scan and of `stats` of them, the least of three in turns."""
    generate, analyze = build / "generator/railcast-generate", build / "analysis/railcast-analyze"
    rows = []
    with tempfile.TemporaryDirectory() as out:
        folder = pathlib.Path(out)
        said(generate, "sequence", "scenarios/open_line.json", "--out", folder / "run", "--frames", 1000)
        for rung in ("plausibility", "footprint"):
            for weather in ({}, {"visibility_m": 200}):
                plan = folder / "plan.json"
                plan.write_text(json.dumps({**PERSON_AND_BOX, "fidelity": rung, "weather": weather}), encoding="utf-8")
                insert = (generate, "insert", folder / "run", plan, "--out", folder / "out")
                stats = (analyze, "stats", folder / "run", "--format", "text")
                least = {insert: math.inf, stats: math.inf}
                for _ in range(3):
                    for command in least:
                        shutil.rmtree(folder / "out", ignore_errors=True)
                        begin = time.monotonic()
                        said(*command)
                        least[command] = min(least[command], time.monotonic() - begin)
                rows.append([f"`{rung}`", "fog, 200 m" if weather else "clear", f"{least[insert]:.1f}",
                             f"{least[stats]:.1f}", f"{least[insert] / least[stats]:.2f}"])
    return {"times": table(2, ["rung", "weather", "insert s", "stats s", "ratio"], rows)}


def situations(build):
    """The table of scenarios/README.md, which has its own check."""
    said("scripts/dev/measure_situations.py", build, "--write")
    return {}


def peers(_):
    """Other programs' ways of tracing the same rays through one mesh, without and with all plants, on one thread."""
    scenes = []
    for columns, *rows in tables_in(said("scripts/dev/compare_peers.sh")):
        name, threads, ratio, same = map(columns.index, ("", "threads", "x raw trace", "same range within 1 mm"))
        scenes.append({row[name]: [row[ratio], row[same]] for row in rows if row[threads] == "1"})
    bare, leaves = scenes
    return {"peers": table(1, ["way", "x raw trace", "same range within 1 mm", "with plants: x raw trace",
                               "with plants: same range within 1 mm"],
                           [[way, *cells, *leaves.get(way, ["-", "-"])] for way, cells in bare.items()])}


def study(build):
    """200 approaches of the shipped study on each rung, between two measurements of the raw trace."""
    def raw_ms():
        text = said(build / "tests/bench/railcast-bench", "--benchmark_filter=^raw_trace/demo/threads:2/")
        return float(re.search(r"^raw_trace/demo/threads:2\S* +([\d.]+)", text, re.M)[1])

    rows = []
    source = ROOT / "scenarios/studies"
    for rung in ("plausibility", "surface", "footprint"):
        recipe = json.loads((source / "person_recipe.json").read_text(encoding="utf-8"))
        recipe["num_scenarios"] = 200
        recipe["set"]["/fidelity"] = rung
        recipe["bases"][0]["file"] = str(ROOT / "scenarios/brake_person.json")
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "person_recipe.json").write_text(json.dumps(recipe), encoding="utf-8")
            shutil.copy(source / "person.json", folder)
            before_ms = raw_ms()
            text = said(build / "analysis/railcast-analyze", "study", folder / "person.json", "--out", folder / "out",
                        "--threads", "2")
            trace_ms = 0.5 * (before_ms + raw_ms())
        num, elapsed_s, traced, _ = map(float, re.search(
            r"^made (\d+) approaches in ([\d.]+) s, tracing objects in (\d+) of (\d+) frames", text, re.M).groups())
        rows.append([f"`{rung}`", f"{1000 * elapsed_s / num:.0f}", f"{traced / num:.0f}",
                     f"{1000 * elapsed_s / traced / trace_ms:.2f}"])
    return {"approaches": table(1, ["rung", "s for 1,000 approaches", "frames traced of each",
                                    "a frame x raw trace"], rows)}


def metro(build):
    """Each object of the metro trial in each weather, and the false alarms of each weather."""
    folder = ROOT / "out/metro"  # Kept: the same command goes on after an interruption.
    said(build / "analysis/railcast-analyze", "study", ROOT / "scenarios/studies/metro_objects.json", "--out", folder)
    return {"objects": table(1, *metro_trial.objects(folder / "csv"))}


# Each with the minutes that it takes on two cores.
PARTS = {"frontier": (frontier, 30), "instructions": (instructions, 15), "bench": (bench, 4), "detail": (detail, 15),
         "modules": (modules, 5), "settings": (settings, 3), "plants": (plants, 2), "weather": (weather, 5),
         "stability": (stability, 4), "python": (python, 2), "live": (live, 15), "insertion": (insertion, 5),
         "situations": (situations, 10), "peers": (peers, 20), "study": (study, 3), "metro": (metro, 15),
         **{name: (lambda build, name=name: growth.measured(name, build), 2) for name in growth.NAMES}}
UNTIMED = ("instructions", "plants", "weather", "stability", "situations", "metro")


def machine():
    cpu = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8")
    isa = next((name for flag, name in (("avx512f", "AVX-512"), ("avx2", "AVX2")) if f" {flag} " in cpu), "SSE")
    return f"{len(os.sched_getaffinity(0))} cores of {re.search('model name.*: (.*)', cpu)[1]}, {isa}"


def revision():
    """The last one that changed what is measured: pages and their figures do not."""
    measured = ("core", "generator", "analysis", "viewer", "scenarios", "tests/bench", "tests/stability", ":!*.md")
    return said("git", "log", "-1", "--format=%h", "--abbrev=12", "--", *measured).strip()


def write(measured):
    """The file, a line for each row."""
    text = json.dumps(measured, indent=1, ensure_ascii=False)
    text = re.sub(r"\[\n\s+(\"(?:[^\[\]{}]|\\.)*?\")\n\s+\]", lambda m: "[" + re.sub(r"\n\s+", " ", m[1]) + "]", text)
    FILE.write_text(text + "\n", encoding="utf-8")


def used_s():
    """What all programs and what this one, with its children, have used of the processors so far."""
    user, nice, system, _, _, interrupts, soft_interrupts, stolen = map(
        int, pathlib.Path("/proc/stat").read_text(encoding="utf-8").split()[1:9])
    all_s = (user + nice + system + interrupts + soft_interrupts + stolen) / os.sysconf("SC_CLK_TCK")
    return all_s, sum(os.times()[:4])


def other_cores(begin, end, elapsed_s):
    """How many cores other programs have used between two results of used_s()."""
    return max(end[0] - begin[0] - (end[1] - begin[1]), 0.0) / elapsed_s


def cores_of_others_during(work):
    begin, begin_s = used_s(), time.monotonic()
    result = work()
    return result, other_cores(begin, used_s(), time.monotonic() - begin_s)


def wait_until_idle():
    """Returns None, or what other programs use if they do not end."""
    for _ in range(MOST_PAUSES):
        _, others = cores_of_others_during(lambda: time.sleep(PAUSE_S))
        if others < MOST_OTHER_CORES:
            return None
    return f"other programs use {others:.2f} of {len(os.sched_getaffinity(0))} cores, {os.getloadavg()[0]:.1f} wait or run"


def keep(measured, name, tables):
    note = "counts and errors, no times" if name in UNTIMED else "nothing else ran"
    measured[name] = {"made": {"machine": machine(), "date": str(datetime.date.today()), "revision": revision(),
                               "note": note}, "tables": tables}
    write(measured)
    results.fill(ROOT)


def is_done(measured, name):
    made = measured.get(name, {}).get("made", {})
    return made.get("revision") == revision()


def measure(measured, name, build):
    """Measures a part. Returns why it was not, or None."""
    part, _ = PARTS[name]
    if name in UNTIMED:
        keep(measured, name, part(build))
        return None
    busy = wait_until_idle()
    if busy:
        return f"{name}: must be measured on an idle machine ({busy})"
    try:
        tables, others = cores_of_others_during(lambda: part(build))
    except NotSteadyError as error:
        return f"{name}: not kept, since {error}"
    if others >= MOST_OTHER_CORES:
        return f"{name}: not kept, since other programs used {others:.2f} cores meanwhile"
    keep(measured, name, tables)
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join(PARTS))
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--list", action="store_true", help="say what is to be measured")
    parser.add_argument("--again", action="store_true", help="measure what is of this revision, too")
    options = parser.parse_args()
    for name in options.parts:
        if name not in PARTS:
            parser.error(f"PART: must be one of {', '.join(PARTS)} (got {name})")
    measured = json.loads(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}
    is_refused = False
    for name in options.parts or PARTS:
        minutes = PARTS[name][1]
        done = is_done(measured, name) and not options.parts and not options.again
        print(f"{name}: {'measured' if done else f'to be measured, some {minutes} minutes'}", flush=True)
        if done or options.list:
            continue
        refusal = measure(measured, name, options.build)
        if refusal:
            is_refused = True
            print(refusal, flush=True)
    faults = list(results.lint(ROOT))
    print("\n".join(faults))
    return 1 if is_refused or faults else 0


if __name__ == "__main__":
    sys.exit(main())
