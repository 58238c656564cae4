#!/usr/bin/env python3
"""Makes a data set's index a database for queries, index.sqlite in its folder: index_dataset.py DATASET

Its tables are those of the files index.jsonl and scenarios.jsonl (docs/dataset.md). Needs only Python.
"""

import itertools
import json
import os
import pathlib
import sqlite3
import sys

TABLES = """
CREATE TABLE scenarios (
  scenario INTEGER PRIMARY KEY, base TEXT, split TEXT, line TEXT, start_s_m REAL, drawn TEXT,
  placed TEXT, weather TEXT);
CREATE TABLE sequences (
  id INTEGER PRIMARY KEY, scenario INTEGER REFERENCES scenarios, sensor TEXT, folder TEXT,
  num_frames INTEGER, points INTEGER);
CREATE TABLE frames (
  id INTEGER PRIMARY KEY, sequence_id INTEGER REFERENCES sequences, frame INTEGER,
  stamp_ns INTEGER, vehicle_s_m REAL, vehicle_speed_mps REAL, points INTEGER);
CREATE TABLE files (frame_id INTEGER REFERENCES frames, name TEXT, bytes INTEGER, xxh3 TEXT);
CREATE TABLE objects (
  frame_id INTEGER REFERENCES frames, name TEXT, type TEXT, label TEXT, instance INTEGER,
  distance_m REAL, points INTEGER, firings_visible INTEGER, firings_alone INTEGER, occlusion REAL);
CREATE TABLE labels (frame_id INTEGER REFERENCES frames, label TEXT, points INTEGER);
"""
INDICES = """
CREATE INDEX sequences_by_scenario ON sequences (scenario);
CREATE INDEX frames_by_sequence ON frames (sequence_id);
CREATE INDEX files_by_frame ON files (frame_id);
CREATE INDEX objects_by_frame ON objects (frame_id);
CREATE INDEX objects_by_type ON objects (type);
CREATE INDEX labels_by_frame ON labels (frame_id);
"""
OBJECT_KEYS = ("name", "type", "label", "instance", "distance_m", "points", "firings_visible", "firings_alone", "occlusion")


def lines_of(file):
    with open(file, encoding="utf-8") as lines:
        for number, line in enumerate(lines, 1):
            try:
                yield json.loads(line)
            except ValueError as fault:
                raise ValueError(f"{file}:{number}: {fault}") from fault


def text_of(value):
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"))


def insert(database, table, *values):
    database.execute(f"INSERT INTO {table} VALUES ({','.join('?' * len(values))})", values)


def frame_lines(folder):
    """The lines that list the files of each frame of a sequence; of an insertion, in the folder above its recording."""
    own = folder / "frames.jsonl"
    return lines_of(own if own.exists() else folder.parent / "insert.jsonl")


def add_frame(database, frame, sequence, index, files):
    """Adds a frame from its line of the index. `files`: by name, the files that its folder's lines list for it."""
    insert(database, "frames", frame, sequence, *(index[key] for key in ("frame", "stamp_ns", "vehicle_s_m",
                                                                       "vehicle_speed_mps", "points")))
    for name in index["files"]:
        file = files.get(name) or files[f"recording/{name}"]
        insert(database, "files", frame, name, file.get("bytes", 0), file["xxh3"])
    for each in index["objects"]:
        insert(database, "objects", frame, *(each[key] for key in OBJECT_KEYS))
    for label, points in index["points_per_label"].items():
        insert(database, "labels", frame, label, points)


def frame_lines_of(folder, sequence):
    lines = list(itertools.islice(frame_lines(folder / sequence["folder"]), sequence["num_frames"]))
    if len(lines) < sequence["num_frames"]:
        raise ValueError(f"{folder / sequence['folder']}: must have a line for each of {sequence['num_frames']} frames "
                         f"(got {len(lines)})")
    return lines


def fill(database, folder):
    place = f"{folder}/index.jsonl: must have a line for each frame of scenarios.jsonl, in their order"
    index = lines_of(folder / "index.jsonl")
    sequences, frames = itertools.count(), itertools.count()
    for scenario in lines_of(folder / "scenarios.jsonl"):
        number = scenario["scenario"]
        insert(database, "scenarios", number, *(scenario[key] for key in ("base", "split", "line", "start_s_m")),
               *(text_of(scenario[key]) for key in ("drawn", "placed", "weather")))
        for each in scenario["sequences"]:
            sequence = next(sequences)
            insert(database, "sequences", sequence, number, *(each[key] for key in ("sensor", "folder", "num_frames",
                                                                                  "points")))
            for line in frame_lines_of(folder, each):
                files = {file["name"]: file for file in line.get("files", ())}
                of_frame = next(index, None)
                if of_frame is None or of_frame["folder"] != each["folder"]:
                    raise ValueError(place)
                add_frame(database, next(frames), sequence, of_frame, files)
    if next(index, None) is not None:
        raise ValueError(place)


def make(folder):
    """Makes the database, which has the name index.sqlite.part until it is complete."""
    file = folder / "index.sqlite"
    if file.exists():
        raise FileExistsError(f"{file}: is there; remove it to make it anew")
    if not (folder / "index.jsonl").exists():
        raise FileNotFoundError(f"{folder}: must be a finished data set (got no index.jsonl)")
    part = folder / "index.sqlite.part"
    part.unlink(missing_ok=True)
    database = sqlite3.connect(part, isolation_level=None)
    try:
        for statement in f"PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; BEGIN; {TABLES}".split(";"):
            database.execute(statement)
        fill(database, folder)
        for statement in f"{INDICES} COMMIT".split(";"):
            database.execute(statement)
        database.close()
        os.replace(part, file)
    finally:
        database.close()
        part.unlink(missing_ok=True)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.strip())
    try:
        make(pathlib.Path(sys.argv[1]))
    except (OSError, ValueError) as fault:
        sys.exit(str(fault))
    except sqlite3.OperationalError as fault:
        sys.exit(f"{sys.argv[1]}/index.sqlite: {fault}")
    except (AttributeError, KeyError, TypeError, sqlite3.Error) as fault:
        sys.exit(f"{sys.argv[1]}: a line is not as railcast writes it ({fault}); railcast-analyze verify says what was "
                 "changed")
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
