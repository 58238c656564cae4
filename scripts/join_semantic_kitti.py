#!/usr/bin/python3
"""Joins runs of `sequence --format kitti` into one data set of SemanticKITTI's layout.

Usage: join_semantic_kitti.py OUT [--train RUN...] [--valid RUN...] [--test RUN...]

Writes OUT/sequences/00, 01, ... in that order, each with its own poses, times and calibration, and
OUT/semantic-kitti-railcast.yaml, which semantic-kitti-api reads as it is: with the split, and with
the shares of points by label, counted here. Files are hard links where the file system allows.

Needs Debian's python3-numpy and python3-yaml. Exit status: 0 success, 1 bad input, 2 usage.
"""

import argparse
import os
import pathlib
import shutil
import sys

import numpy as np
import yaml

CONFIGURATION = "semantic-kitti-railcast.yaml"
SPLITS = ("train", "valid", "test")
FROM_RUN = ("name", "labels", "color_map", "learning_map", "learning_map_inv", "learning_ignore", "nearest_map")


class BadInput(Exception):
    """What is wrong, a line for each fault: "place: rule (got value)"."""


def read_configuration(run, faults):
    """The configuration of a complete run; None if there is a fault."""
    if not (run / "manifest.json").is_file():
        faults.append(f"{run}: must be a complete run, with a manifest.json")
        return None
    if not (run / CONFIGURATION).is_file():
        faults.append(f"{run}: must be a run with --format kitti, with a {CONFIGURATION}")
        return None
    configuration = yaml.safe_load((run / CONFIGURATION).read_text("utf-8"))
    missing = [key for key in FROM_RUN if key not in configuration]
    faults.extend(f"{run / CONFIGURATION}: /{key}: missing" for key in missing)
    return None if missing else configuration


def common_configuration(runs):
    """The configuration that all runs have."""
    faults = []
    configurations = [(run, read_configuration(run, faults)) for run in runs]
    known = [(run, configuration) for run, configuration in configurations if configuration is not None]
    for run, configuration in known[1:]:
        faults.extend(f"{run / CONFIGURATION}: /{key}: must be that of {known[0][0]}" for key in FROM_RUN
                      if configuration[key] != known[0][1][key])
    for run in sorted(set(runs)):
        if runs.count(run) > 1:
            faults.append(f"{run}: must be given once (got {runs.count(run)} times)")
    if faults:
        raise BadInput("\n".join(faults))
    return known[0][1]


def link_or_copy(source, target):
    try:
        os.link(source, target)
    except OSError:  # Another file system, or one without links.
        shutil.copy2(source, target)


def count_labels(sequence):
    """Number of points by label of a sequence."""
    counts = np.zeros(1 << 16, np.int64)
    for file in sorted((sequence / "labels").glob("*.label")):
        counts += np.bincount(np.fromfile(file, "<u4") & 0xFFFF, minlength=1 << 16)
    return counts


def content_of(counts, labels):
    """Shares of points by label. @throws BadInput if a label has no name."""
    strangers = sorted(set(np.flatnonzero(counts)) - set(labels))
    if strangers:
        raise BadInput(f"labels: must have a name in {CONFIGURATION} (got {', '.join(map(str, strangers))})")
    total = max(int(counts.sum()), 1)
    return {label: float(counts[label]) / total for label in labels}


def join(out, splits):
    """Makes the data set at `out`, which appears only when it is whole."""
    runs = [run for name in SPLITS for run in splits[name]]
    configuration = common_configuration(runs)
    if out.exists():
        raise BadInput(f"{out}: must not exist")
    begun = out.with_name(out.name + ".partial")
    if begun.exists():
        shutil.rmtree(begun)
    counts = np.zeros(1 << 16, np.int64)
    numbers = {name: [] for name in SPLITS}
    places = [(name, run) for name in SPLITS for run in splits[name]]
    for number, (name, run) in enumerate(places):
        sequence = begun / "sequences" / f"{number:02}"
        shutil.copytree(run / "sequences" / "00", sequence, copy_function=link_or_copy)
        counts += count_labels(sequence)
        numbers[name].append(number)
    whole = {key: configuration[key] for key in FROM_RUN}
    whole["content"] = content_of(counts, configuration["labels"])
    whole["split"] = numbers
    text = "".join(f"# {run}: sequence {number:02}\n" for number, (_, run) in enumerate(places))
    text += yaml.safe_dump(whole, sort_keys=False, allow_unicode=True, default_flow_style=None)
    (begun / CONFIGURATION).write_text(text, "utf-8")
    begun.rename(out)
    return counts


def run_in(folder):
    """The run itself of an insertion into one."""
    run = folder / "recording"
    return run if (folder / "insert.jsonl").exists() and (run / "run.json").exists() else folder


def read_arguments(description, names):
    """The folder OUT and the runs by the name of their part, from the command line."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("out", type=pathlib.Path, metavar="OUT")
    for name in names:
        parser.add_argument(f"--{name}", type=pathlib.Path, nargs="+", default=[], metavar="RUN")
    arguments = parser.parse_args()
    splits = {name: [run_in(run) for run in getattr(arguments, name)] for name in names}
    if not any(splits.values()):
        parser.error("at least one RUN is needed")
    return arguments.out, splits


def main():
    out, splits = read_arguments(__doc__.split("\n", maxsplit=1)[0], SPLITS)
    try:
        counts = join(out, splits)
    except BadInput as error:
        print(error, file=sys.stderr)
        return 1
    num_runs = sum(map(len, splits.values()))
    print(f"{out}: {num_runs} sequences, {counts.sum()} points, {np.count_nonzero(counts)} labels")
    return 0


if __name__ == "__main__":
    sys.exit(main())
