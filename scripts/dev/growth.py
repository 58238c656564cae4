"""How the time of a frame grows: the charts and tables of docs/results/performance.md, for measure_results.py.

Each chart varies one thing of the demo (scripts/dev/growth_scenarios.py), in turns in one process (railcast-measure
scaling) or run by run (railcast-generate sequence), and keeps the least of the times; on one thread, of the times that
the processor spent on it. The charts are docs/images/performance_NAME.png.
"""

import csv
import json
import math
import os
import pathlib
import subprocess
import tempfile
import time

import growth_scenarios as scenarios

ROOT = scenarios.ROOT
FORMATS = ("pcd", "pcd-compressed", "pcd-ascii", "ply", "kitti")
FRAMES = 100  # Of a sequence.


class Chart:
    """A quantity that is varied: what to measure and how to show it."""

    def __init__(self, title, axis, column, rows, **more):
        self.title, self.axis, self.column, self.rows = title, axis, column, rows
        self.options = more.get("options", ["--turns", "15", "--threads", "1"])
        self.shape = more.get("shape", "power")  # Of the fit: power or line.
        self.table = more.get("table", [])  # Further columns of the table.
        self.prepare = more.get("prepare", lambda: None)  # Writes what the scenarios name.


def all_threads():
    return list(range(1, len(os.sched_getaffinity(0)) + 1))


def charts():
    """The charts that railcast-measure scaling measures, by name. Rows are (x or None, scenario)."""
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
        "yardstick": Chart("sensors", "lidars of 128 x 4,096 firings", "sensors",
                           [(None, scenarios.yardstick(n)) for n in (1, 2, 4, 8)],
                           options=["--turns", "5", "--threads", "0"], table=["triangles", "build_s", "memory_mb"],
                           prepare=scenarios.write_dense_ball),
        "line": Chart("length of the line", "km", "length_km",
                      [(n, scenarios.line(n)) for n in (1, 10, 100, 1000)],
                      table=["build_s", "memory_mb"]),
    }


def measure_scaling(build, chart):
    """Runs railcast-measure scaling on a chart's scenarios; a dictionary of numbers for each line."""
    chart.prepare()
    with tempfile.TemporaryDirectory() as folder:
        files = []
        for i, (_, scenario) in enumerate(chart.rows):
            files.append(pathlib.Path(folder) / f"{i}.json")
            files[-1].write_text(json.dumps(scenario))
        command = [build / "tests/bench/railcast-measure", "scaling", *files, *chart.options]
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
    said = subprocess.run([build / "tests/bench/railcast-measure", "stages", file], check=True,
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
    """Writes the chart."""
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


HEADS = {"raw_ms": "raw trace ms", "frame_ms": "frame ms", "ratio": "time x raw trace", "firings": "beams",
         "memory_mb": "memory MB", "build_s": "build s", "length_km": "km", "write_ms": "bytes alone ms",
         "disk_ms": "frame on disk ms", "bytes": "bytes a frame", "per_s": "frames/s", "stage_ms": "ms",
         "share": "time x raw trace"}
# Those that are not charts of railcast-measure scaling: what measures them, and their columns.
OF_THE_DEMO = {"sequence": (measure_sequence, ["threads", "raw_ms", "frame_ms", "per_s", "ratio"]),
               "stages": (measure_stages, ["stage", "stage_ms", "share"]),
               "disk": (measure_disk, ["format", "bytes", "raw_ms", "write_ms", "frame_ms", "disk_ms"])}
NAMES = [*charts(), *OF_THE_DEMO]


def columns_of(name):
    if name in OF_THE_DEMO:
        return OF_THE_DEMO[name][1]
    chart = charts()[name]
    return [chart.column, "raw_ms", "frame_ms", "ratio", *chart.table]


def table(name, lines):
    """The lines of a chart as a table of docs/results/results.json."""
    columns, rows = columns_of(name), []
    for line in lines:
        values = dict(line)
        if "frame_ms" in line:
            values.update(ratio=line["frame_ms"] / line["raw_ms"], per_s=1e3 / line["frame_ms"])
        rows.append([shown(values[column]) for column in columns])
    return {"keys": 1, "columns": [HEADS.get(column, column) for column in columns], "rows": rows}


def exponent(points):
    return fit_line([(math.log(x), math.log(y)) for x, y in points])[1]


def growth(rows):
    """How the times of a chart's table grow: the exponent of the power that fits them best, and the greatest one between
    two rows of which the second has at least three times as much."""
    number = [[float(cell.replace(",", "")) for cell in row[:3]] for row in rows]
    lines = []
    for time_of, column in (("raw trace", 1), ("frame", 2)):
        points = [(row[0], row[column]) for row in number if row[0] > 0]
        steps = [exponent([low, high]) for low, high in zip(points, points[1:]) if high[0] >= 2.9 * low[0]]
        lines.append([time_of, f"{exponent(points):.2f}", f"{max(steps):.2f}"])
    return {"keys": 1, "columns": ["time", "exponent", "steepest"], "rows": lines}


GROWING = ("beams", "triangles", "moving", "standing", "line")


def measured(name, build):
    """Measures and draws a chart, and returns its tables."""
    if name in OF_THE_DEMO:
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "demo.json"
            file.write_text(json.dumps(scenarios.demo()))
            lines = OF_THE_DEMO[name][0](build, file)
    else:
        lines = measure_scaling(build, charts()[name])
    if name == "disk":
        draw_disk(lines)
    elif name != "stages":
        draw(name, charts().get(name) or Chart(name, "threads", "threads", []), lines)
    tables = {name: table(name, lines)}
    if name in GROWING:
        tables["growth"] = growth(tables[name]["rows"])
    return tables
