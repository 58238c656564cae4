"""Names what differs between two folders of files that railcast has written: of each file the first place, and how many.

Places are pointers in JSON, columns and rows in CSV, lines of other text and offsets of other files. What a program's
version and measured time change does not count: the version itself, hashes over what holds it, dates, durations.
"""

import csv
import json
import operator
import re

# Hashes of what holds the version.
HASHES = re.compile(rb'"(version|program|(manifest|report|line|files)_xxh3|(run|dataset)\.json|scenarios\.jsonl)"'
                    rb': ?"[^"]+"')
VERSION = re.compile(rb"\d+\.\d+\.\d+(-[\w.]+)?\+[0-9a-f]{12}(\.dirty)?(\.[0-9a-f]{8})?")
TIME = re.compile(rb"in [0-9.]+ (s|ms)\b|\([0-9.]+ frames/s\)|\b[0-9.]+ ms\b|\d{4}-\d\d-\d\d \d\d:\d\d UTC")
PROGRESS = re.compile(rb"^after \d+:\d\d.*\n", re.MULTILINE)
CHUNK = 65536
# Of a frontier's report: what is measured in time, or follows from it.
TIMED = {"p50_ms", "p99_ms", "ratio_to_raw_trace", "time_ratio", "headlines", "charts", "pareto_front",
         "brute_force_faster_and_more_accurate"}
TIMED_TABLE = "pareto_fronts"
# These show what the report's JSON holds, times and all, or are typeset of its page by another program.
LEFT_OUT = re.compile(r"(^|/)(live/|scenarios/|frontier/(.*/)?([^/]*\.(html|svg|png|gnuplot)|pareto_fronts.csv))"
                      r"|analyze_frontier_[^/]*\.txt$|\.pdf$")


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(each) for key, each in value.items() if key not in TIMED}
    if isinstance(value, list):
        return [without_times(each) for each in value
                if not (isinstance(each, dict) and each.get("key") in TIMED | {TIMED_TABLE})]
    return value


def normalized(name, data):
    """The bytes of a file that count."""
    data = VERSION.sub(b"VERSION", HASHES.sub(rb'"\1": ""', data))
    if name.endswith((".txt", ".html", ".json", ".md")):
        data = TIME.sub(b"TIME", PROGRESS.sub(b"", data))
    if "frontier/" in name and name.endswith(".json"):
        return json.dumps(without_times(json.loads(data)), indent=1).encode()
    if "frontier/" in name and name.endswith(".csv"):
        rows = list(csv.reader(data.decode().splitlines()))
        kept = [place for place, title in enumerate(rows[0]) if title not in TIMED]
        return "\n".join(",".join(row[place] for place in kept) for row in rows).encode()
    return data


def json_places(before, now, pointer=""):
    """(pointer, before, now) of all that differs."""
    if isinstance(before, dict) and isinstance(now, dict):
        for key in before | now:
            yield from json_places(before.get(key), now.get(key), f"{pointer}/{key}")
    elif isinstance(before, list) and isinstance(now, list) and len(before) == len(now):
        for place, (old, new) in enumerate(zip(before, now)):
            yield from json_places(old, new, f"{pointer}/{place}")
    elif before != now or type(before) is not type(now):
        yield pointer or "/", json.dumps(before), json.dumps(now)


def read_json(name, text):
    return json.loads(text) if name.endswith(".json") else [json.loads(line) for line in text.splitlines()]


def csv_places(before, now):
    before, now = (list(csv.reader(text.splitlines())) for text in (before, now))
    if [len(row) for row in before] != [len(row) for row in now]:
        return
    for number, (old, new) in enumerate(zip(before, now)):
        for title, a, b in zip(before[0], old, new):
            if a != b:
                yield f"row {number}, {title}", a, b


def line_places(before, now):
    before, now = before.splitlines(keepends=True), now.splitlines(keepends=True)
    for number in range(max(len(before), len(now))):
        old, new = (repr(lines[number]) if number < len(lines) else "no line" for lines in (before, now))
        if old != new:
            yield f"line {number + 1}", old, new


def byte_places(before, now):
    """The first place in bytes, and how many there are; files may have hundreds of megabytes."""
    size = min(len(before), len(now))
    count = sum(map(operator.ne, before, now)) + max(len(before), len(now)) - size
    at = next((at for at in range(0, size, CHUNK) if before[at:at + CHUNK] != now[at:at + CHUNK]), size)
    at = next((at for at in range(at, min(at + CHUNK, size)) if before[at] != now[at]), size)
    if at == size:
        return (f"byte {size}", f"size {len(before)}", f"size {len(now)}"), count
    return (f"byte {at}", f"0x{before[at]:02x}", f"0x{now[at]:02x}"), count


def places_of(name, before, now):
    """((place, before, now) of the first difference, how many there are) of two contents of a file."""
    try:
        before_text, now_text = before.decode(), now.decode()
    except UnicodeDecodeError:
        return byte_places(before, now)
    places = []
    if name.endswith((".json", ".jsonl")):
        try:
            places = list(json_places(read_json(name, before_text), read_json(name, now_text)))
        except ValueError:
            pass  # Lines name the place.
    elif name.endswith(".csv"):
        places = list(csv_places(before_text, now_text))
    places = places or list(line_places(before_text, now_text))
    return places[0], len(places)


def difference(name, before, now):
    """What differs between two contents of a file, in words; None if nothing that counts does."""
    if before == now:
        return None
    before, now = normalized(name, before), normalized(name, now)
    if before == now:
        return None
    (place, old, new), count = places_of(name, before, now)
    more = f", and {count - 1} more places" if count > 1 else ""
    return f"{place}: {shortened(old)} became {shortened(new)}{more}"


def shortened(text):
    return text if len(text) <= 100 else f"{text[:100]}..."


def files_in(folder):
    """Path by name of all files that are compared."""
    names = ((str(path.relative_to(folder)), path) for path in folder.rglob("*") if path.is_file())
    return {name: path for name, path in names if not LEFT_OUT.search(name)}


def content(path, folder):
    """A file's bytes, with the folder's own name left out."""
    return path.read_bytes().replace(str(folder.resolve()).encode(), b"@")


def differences(before, now):
    """(name, what differs) of the files of two folders, by name."""
    olds, news = files_in(before), files_in(now)
    for name in sorted(olds.keys() | news.keys()):
        if name not in news or name not in olds:
            yield name, "gone" if name in olds else "new"
            continue
        what = difference(name, content(olds[name], before), content(news[name], now))
        if what:
            yield name, what
