#!/usr/bin/env python3
"""Measures how the time of a frame grows, and draws docs/performance.md's charts and tables.

  scripts/dev/draw_performance.py [CHART...] [--redraw] [--build build/release]

Each chart varies one thing of the demo (scripts/dev/performance_scenarios.py), in turns in one process
(railcast-scaling) or run by run (railcast-generate sequence), and keeps the least of the times; on
one thread, of the times that the processor spent on it.
The figures are kept as docs/reports/performance/CHART.tsv, the charts as
docs/images/performance_CHART.png, the tables between the page's markers. --redraw measures nothing
and draws the kept figures. Takes a quarter of an hour; for figures worth quoting nothing else may
run on the machine, and the page says what did.
"""

import argparse
import csv
import datetime
import json
import math
import os
import pathlib
import re
import subprocess
import tempfile
import time

import performance_scenarios as scenarios

ROOT = scenarios.ROOT
PAGE = ROOT / "docs/performance.md"
FIELDS = ("x y z intensity power_ratio range_m time_ns ring column return_index return_count label "
          "instance outcome true_range_m incidence_rad material footprint_share "
          "mixed_share").split()
FORMATS = ("pcd", "pcd-compressed", "pcd-ascii", "ply", "kitti")
FRAMES = 100  # Of a sequence.


class Chart:
    """A quantity that is varied: what to measure and how to show it."""

    def __init__(self, title, axis, column, rows, **more):
        self.title, self.axis, self.column, self.rows = title, axis, column, rows
        self.options = more.get("options", ["--turns", "15", "--threads", "1"])
        self.shape = more.get("shape", "power")  # Of the fit: power or line.
        self.table = more.get("table", [])  # Further columns of the table.


def all_threads():
    return list(range(1, len(os.sched_getaffinity(0)) + 1))


def charts():
    """The charts that railcast-scaling measures, by name. Rows are (x or None, scenario)."""
    counts = [0, 1, 10, 30, 100, 300, 1000]
    return {
        "threads": Chart("threads", "threads", "threads", [(None, scenarios.demo())],
                         options=["--turns", "40", "--threads",
                                  ",".join(map(str, all_threads()))]),
        "beams": Chart("beams", "beams a frame", "firings",
                       [(None, scenarios.beams(10**n)) for n in range(3, 8)],
                       options=["--turns", "5", "--threads", "1"], table=["memory_mb"]),
        "triangles": Chart(
            "triangles", "triangles in the scene, instanced", "triangles",
            [(None, scenarios.trees(n))
             for n in (None, 0, 6, 60, 600, scenarios.MOST_TREES_PER_HECTARE)],
            table=["instances", "build_s", "memory_mb"]),
        "moving": Chart("moving objects", "moving persons", "objects",
                        [(None, scenarios.persons(n, True)) for n in counts],
                        shape="line", table=["memory_mb"]),
        "standing": Chart("standing objects", "standing persons", "objects",
                          [(None, scenarios.persons(n, False)) for n in [*counts, 3000, 10000]],
                          shape="line", table=["build_s", "memory_mb"]),
        "sensors": Chart("sensors", "sensors", "sensors",
                         [(None, scenarios.sensors(n)) for n in (1, 2, 4, 8)],
                         table=["memory_mb"]),
        "line": Chart("length of the line", "km", "length_km",
                      [(n, scenarios.line(n)) for n in (1, 10, 100, 1000)],
                      table=["build_s", "memory_mb"]),
    }


def load():
    return os.getloadavg()[0]


def measure_scaling(build, chart):
    """Runs railcast-scaling on a chart's scenarios; a dictionary of numbers for each line."""
    with tempfile.TemporaryDirectory() as folder:
        files = []
        for i, (_, scenario) in enumerate(chart.rows):
            files.append(pathlib.Path(folder) / f"{i}.json")
            files[-1].write_text(json.dumps(scenario))
        command = [build / "tests/bench/railcast-scaling", *files, *chart.options]
        said = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
    lines = list(csv.DictReader(said.splitlines(), delimiter="\t"))
    is_on_one_thread = all(line["threads"] == "1" for line in lines)
    for line in lines:
        for key in ("raw", "frame"):  # On one thread, what other programs took is left out.
            cpu_ms = line.pop(f"{key}_cpu_ms")
            line[f"{key}_ms"] = cpu_ms if is_on_one_thread else line[f"{key}_ms"]
        x = chart.rows[int(pathlib.Path(line.pop("scenario")).stem)][0]
        if x is not None:
            line[chart.column] = x
    return [{key: float(value) for key, value in line.items()} for line in lines]


def run_sequence(build, file, folder, options):
    """Time from a frame to the next in ms, and bytes of a frame."""
    with tempfile.TemporaryDirectory(dir=folder) as out:
        command = [build / "generator/railcast-generate", "sequence", file, "--out", out + "/run",
                   "--frames", str(FRAMES), *options]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        run = pathlib.Path(out) / "run"
        files = [f for part in ("frames", "sequences") for f in (run / part).rglob("*")]
        size = sum(f.stat().st_size for f in files if f.is_file())
        clouds = [f.stat().st_mtime_ns for f in files if f.suffix in (".pcd", ".ply", ".bin")]
    return 1e-6 * (max(clouds) - min(clouds)) / (FRAMES - 1), size / FRAMES


def least_of_turns(turns, jobs):
    """Runs every job once a turn; the first value of each is the least, the others are the last."""
    results = [None] * len(jobs)
    for _ in range(turns):
        for i, job in enumerate(jobs):
            value = job()
            if results[i] is not None:
                value = (min(value[0], results[i][0]), *value[1:])
            results[i] = value
    return results


def raw_trace_ms(build):
    """Of the demo, on all cores."""
    chart = Chart("", "", "firings", [(None, scenarios.demo())], options=["--turns", "40"])
    return measure_scaling(build, chart)[0]["raw_ms"]


def plain_write(folder, size):
    """Time in ms of writing a frame's bytes as railcast does: beside, synced, renamed."""
    data = os.urandom(int(size))
    with tempfile.TemporaryDirectory(dir=folder) as out:
        begin = time.perf_counter()
        for i in range(FRAMES):
            part = pathlib.Path(out) / "part"
            with open(part, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            part.rename(pathlib.Path(out) / str(i))
        return 1e3 * (time.perf_counter() - begin) / FRAMES


def measure_fields(build, file):
    counts = [3, 6, 9, 12, 15, 19]
    jobs = [lambda n=n: run_sequence(build, file, "/dev/shm", ["--fields", ",".join(FIELDS[:n])])
            for n in counts]
    raw_ms = raw_trace_ms(build)
    return [{"fields": n, "bytes": size, "raw_ms": raw_ms, "frame_ms": ms}
            for n, (ms, size) in zip(counts, least_of_turns(3, jobs))]


def measure_sequence(build, file):
    """By the number of threads."""
    jobs = [lambda n=n: run_sequence(build, file, "/dev/shm", ["--threads", str(n)])
            for n in all_threads()]
    raw = {line["threads"]: line["raw_ms"]
           for line in measure_scaling(build, charts()["threads"])}
    return [{"threads": n, "raw_ms": raw[n], "frame_ms": ms}
            for n, (ms, _) in zip(all_threads(), least_of_turns(5, jobs))]


def measure_stages(build, file):
    """Of a frame of a sequence, on one thread."""
    said = subprocess.run([build / "tests/bench/railcast-stages", file], check=True,
                          stdout=subprocess.PIPE, text=True).stdout
    rows = [[cell.strip() for cell in line.strip("|").split("|")]
            for line in said.splitlines()[2:]]
    return [{"stage": stage, "stage_ms": float(ms), "share": float(share)}
            for stage, ms, share in rows]


def measure_disk(build, file):
    folder = ROOT / "out"
    folder.mkdir(exist_ok=True)
    jobs = [lambda f=f, where=where: run_sequence(build, file, where, ["--format", f])
            for f in FORMATS for where in ("/dev/shm", folder)]
    results = least_of_turns(3, jobs)
    raw_ms = raw_trace_ms(build)
    lines = []
    for i, name in enumerate(FORMATS):
        (memory_ms, size), (disk_ms, _) = results[2 * i:2 * i + 2]
        write_ms = min(plain_write(folder, size) for _ in range(3))
        lines.append({"format": name, "bytes": size, "raw_ms": raw_ms, "frame_ms": memory_ms,
                      "disk_ms": disk_ms, "write_ms": write_ms})
    return lines


def fit_line(points):
    """Least squares of y = a + b x."""
    n = len(points)
    mean_x, mean_y = (sum(column) / n for column in zip(*points))
    slope = (sum((x - mean_x) * (y - mean_y) for x, y in points)
             / sum((x - mean_x) ** 2 for x, _ in points))
    return mean_y - slope * mean_x, slope


def fit(shape, points):
    """A fitted growth as a gnuplot expression of x and in words."""
    if shape == "line":
        at_0, slope = fit_line(points)
        return f"{at_0} + {slope} * x", f"{at_0:.2f} ms {'+' if slope >= 0 else '-'} {abs(1e3 * slope):.3g} us each"
    log_a, exponent = fit_line([(math.log(x), math.log(y)) for x, y in points])
    exponent = round(exponent, 2) + 0.0  # Never -0.00.
    return f"{math.exp(log_a)} * x ** {exponent}", f"x^{{{exponent:.2f}}}"


def draw(name, chart, lines):
    """Writes the chart; returns its fits in words."""
    points = {key: [(line[chart.column], line[key]) for line in lines]
              for key in ("raw_ms", "frame_ms")}
    fits = {key: fit(chart.shape, values) for key, values in points.items()}
    script = ["set terminal pngcairo size 760,460 font 'sans,11'",
              f"set output '{ROOT / 'docs/images' / f'performance_{name}.png'}'",
              "set grid", "set key top left Left reverse", f"set xlabel '{chart.axis}'",
              "set ylabel 'ms a frame'"]
    highest = max(y for values in points.values() for _, y in values)
    if chart.shape == "power":
        lowest = min(y for values in points.values() for _, y in values)
        x = [line[chart.column] for line in lines]
        script += ["set logscale xy", f"set xrange [{0.8 * min(x)}:{1.25 * max(x)}]",
                   f"set yrange [{lowest / 3}:{highest * 8}]"]
        if chart.column in ("threads", "sensors", "length_km"):
            ticks = ", ".join(f"{line[chart.column]:.0f}" for line in lines)
            script.append(f"set xtics ({ticks})")
        else:
            script.append("set format x '%.0s%c'")
    else:
        script += ["set xrange [0:*]", f"set yrange [0:{1.4 * highest}]"]
    for key, values in points.items():
        script += [f"${key} << end", *(f"{x} {y}" for x, y in values), "end"]
    plots = []
    for key, color, text in (("raw_ms", "#666666", "raw trace"), ("frame_ms", "#0072b2", "frame")):
        plots += [f"$%s using 1:2 with points pt 7 lc rgb '{color}' title '{text}'" % key,
                  f"{fits[key][0]} lc rgb '{color}' dt 2 title '{fits[key][1]}'"]
    script.append("plot " + ", ".join(plots))
    subprocess.run(["gnuplot"], input="\n".join(script), text=True, check=True)
    return {key: words.replace("^{", "^").replace("}", "") for key, (_, words) in fits.items()}


def serial_share(lines):
    """Fits frame_ms = serial + parallel / threads; the serial part and its share of one thread's."""
    serial_ms, parallel_ms = fit_line([(1.0 / line["threads"], line["frame_ms"])
                                       for line in lines])
    return max(0.0, serial_ms), max(0.0, serial_ms) / (max(0.0, serial_ms) + parallel_ms)


def draw_disk(lines):
    script = ["set terminal pngcairo size 760,460 font 'sans,11'",
              f"set output '{ROOT / 'docs/images/performance_disk.png'}'",
              "set style data histograms", "set style fill solid 0.8", "set yrange [0:*]",
              "set grid y", "set ylabel 'frames a second'", "set key outside top horizontal",
              "$data << end"]
    for line in lines:
        script.append(" ".join([line["format"]] + [
            str(1e3 / line[key]) for key in ("raw_ms", "write_ms", "frame_ms", "disk_ms")]))
    colors = (("raw trace", "#666666"), ("the bytes alone to disk", "#bbbbbb"),
              ("frames to memory", "#56b4e9"), ("frames to disk", "#0072b2"))
    script += ["end", "plot " + ", ".join(
        f"$data using {i + 2}:xtic(1) lc rgb '{color}' title '{title}'"
        for i, (title, color) in enumerate(colors))]
    subprocess.run(["gnuplot"], input="\n".join(script), text=True, check=True)


def shown(value):
    """Three significant digits, whole numbers with commas."""
    if isinstance(value, str):
        return value
    if value >= 1000 or value == int(value):
        return f"{value:,.0f}"
    return f"{value:.3g}"


def table(columns, lines):
    heads = {"raw_ms": "raw trace ms", "frame_ms": "frame ms", "ratio": "x raw trace",
             "firings": "beams", "memory_mb": "memory MB", "build_s": "build s",
             "length_km": "km", "write_ms": "bytes alone ms", "disk_ms": "frame on disk ms",
             "bytes": "bytes a frame", "per_s": "frames/s", "stage_ms": "ms",
             "share": "x raw trace"}
    text = "| " + " | ".join(heads.get(c, c) for c in columns) + " |\n" + "|---" * len(columns)
    for line in lines:
        values = dict(line)
        if "frame_ms" in line:
            values.update(ratio=line["frame_ms"] / line["raw_ms"], per_s=1e3 / line["frame_ms"])
        text += "|\n| " + " | ".join(shown(values[c]) for c in columns) + " "
    return text + "|"


def keep(name, lines, note):
    file = ROOT / f"docs/reports/performance/{name}.tsv"
    file.parent.mkdir(exist_ok=True)
    with open(file, "w", encoding="utf-8") as out:
        out.write(f"# {note}\n")
        writer = csv.DictWriter(out, list(lines[0]), delimiter="\t", lineterminator="\n")
        writer.writeheader()
        writer.writerows(lines)


def kept(name):
    with open(ROOT / f"docs/reports/performance/{name}.tsv", encoding="utf-8") as file:
        note = file.readline()[2:].strip()
        lines = list(csv.DictReader(file, delimiter="\t"))
    number = lambda key, text: text if key in ("format", "stage") else float(text)
    return [{k: number(k, v) for k, v in line.items()} for line in lines], note


def put(name, text):
    """Replaces what stands between the page's markers of that name."""
    begin, end = f"<!-- draw_performance.py: {name} -->", "<!-- end -->"
    page = PAGE.read_text(encoding="utf-8")
    before, rest = page.split(begin, 1)
    after = rest.split(end, 1)[1]
    PAGE.write_text(f"{before}{begin}\n{text}\n{end}{after}", encoding="utf-8")


def measure(name, build):
    before = load()
    if name in OF_THE_DEMO:
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "demo.json"
            file.write_text(json.dumps(scenarios.demo()))
            lines = OF_THE_DEMO[name](build, file)
    else:
        lines = measure_scaling(build, charts()[name])
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text()).group(1)
    own = len(all_threads())
    busy = " **while other programs ran**," if before > 0.5 else ""
    keep(name, lines, f"{own} cores of {model}, {datetime.date.today()},{busy} load of the machine "
                      f"before: {before:.1f}")


def show(name):
    lines, note = kept(name)
    if name == "stages":
        put(name, f"{table(['stage', 'stage_ms', 'share'], lines)}\n\n*{note}.*")
        return
    if name == "sequence":
        chart = Chart("sequence", "threads", "threads", [])
        draw(name, chart, lines)
        serial_ms, share = serial_share(lines)
        text = table(["threads", "raw_ms", "frame_ms", "per_s", "ratio"], lines)
        fits = (f" Fitted: {serial_ms:.2f} ms of a frame do not shrink with the number of threads, "
                f"{100 * share:.0f} % of its time on one.")
    elif name == "disk":
        draw_disk(lines)
        text = table(["format", "bytes", "raw_ms", "write_ms", "frame_ms", "disk_ms"], lines)
        fits = ""
    else:
        chart = charts().get(name) or Chart("fields", "fields", "fields", [], shape="line",
                                            table=["bytes"])
        words = draw(name, chart, lines)
        columns = [chart.column, "raw_ms", "frame_ms", "ratio", *chart.table]
        text = table(columns, lines)
        fits = f" Fitted: frame {words['frame_ms']}, raw trace {words['raw_ms']}."
        if name in ("threads", "fields") and "while other programs ran" in note:
            fits = " Times by the clock do not show a growth while other programs run."
    put(name, f"![{name}](images/performance_{name}.png)\n\n{text}\n\n*{note}.*{fits}")


OF_THE_DEMO = {"sequence": measure_sequence, "stages": measure_stages, "fields": measure_fields,
               "disk": measure_disk}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    names = [*charts(), *OF_THE_DEMO]
    parser.add_argument("charts", nargs="*", metavar="CHART", help=", ".join(names))
    parser.add_argument("--redraw", action="store_true", help="draw the kept figures")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    arguments = parser.parse_args()
    unknown = [name for name in arguments.charts if name not in names]
    if unknown:
        parser.error(f"CHART: must be one of {', '.join(names)} (got {unknown[0]})")
    for name in arguments.charts or names:
        if not arguments.redraw:
            measure(name, arguments.build)
        show(name)
        print(f"{name}: {PAGE}")


if __name__ == "__main__":
    main()
