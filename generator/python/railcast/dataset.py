"""Frames of recordings by index, as loaders for training want them (torch.utils.data.DataLoader)."""

from __future__ import annotations

import bisect
import collections
import contextlib
import itertools
import json
import math
import os
import pathlib
import sqlite3
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ._railcast import Frame, InputError, Object, Recording, open as open_recording

Sample = dict[str, Any]

# Recordings that each process keeps open: one takes milliseconds to open, and its scenario some memory.
KEPT_OPEN = 64


def box_of(frame: Frame, thing: Object, compensate: str) -> list[float]:
    """An object's box as 7 numbers: centre x, y, z, length, width, height in m and yaw in rad, in the sensor's axes."""
    pose = frame.sensor_from_box(thing, compensate=compensate)
    return [*pose[:3, 3], *thing.size_m, math.atan2(pose[1, 0], pose[0, 0])]


def rows_of_database(index: pathlib.Path) -> list[tuple[str, int, str, str]]:
    """Folder, number of frames, split and sensor of each sequence of a data set, from its index.sqlite."""
    with contextlib.closing(sqlite3.connect(f"{index.absolute().as_uri()}?mode=ro", uri=True)) as connection:
        return connection.execute("SELECT folder, num_frames, split, sensor FROM sequences JOIN scenarios "
                                  "USING (scenario) ORDER BY id").fetchall()


def rows_of_lines(index: pathlib.Path) -> list[tuple[str, int, str, str]]:
    """As rows_of_database(), from index.jsonl, where the lines of a sequence follow one another."""
    with open(index, encoding="utf-8") as file:
        lines = (json.loads(line) for line in file)
        keys = [(line["folder"], line["split"], line["sensor"]) for line in lines]
    return [(folder, len(list(frames)), split, sensor) for (folder, split, sensor), frames in itertools.groupby(keys)]


def recordings_of(source: str, split: str | None, sensor: str | None) -> list[tuple[str, int]]:
    """Path and number of frames of each recording of a source. Raises InputError if it has no such split or sensor."""
    # The database is faster, and not every data set has it.
    for name, read in (("index.sqlite", rows_of_database), ("index.jsonl", rows_of_lines)):
        index = pathlib.Path(source, name)
        if index.is_file():
            break
    else:
        for name, value in (("split", split), ("sensor", sensor)):
            if value is not None:
                raise InputError(f"{name}: must be left out for what is no data set, {source} (got {value!r})")
        return [(source, len(open_recording(source)))]
    try:
        rows = read(index)
    except (sqlite3.Error, ValueError, KeyError, TypeError) as error:
        raise InputError(f"{index}: is damaged: {error}") from error
    for name, value, column in (("split", split, 2), ("sensor", sensor, 3)):
        names = sorted({row[column] for row in rows})
        if value is not None and value not in names:
            raise InputError(f"{name}: must be one of {', '.join(names)}, those of {source} (got {value!r})")
    return [(os.path.join(source, folder), num_frames) for folder, num_frames, of_split, of_sensor in rows
            if split in (None, of_split) and sensor in (None, of_sensor)]


class Dataset:
    """The frames of a data set, or of one or several recordings, by index.

        dataset = railcast.Dataset("out/dataset", split="train")
        points, labels = dataset[0]["points"], dataset[0]["labels"]

    It has `__len__` and `__getitem__`, which is all that torch's DataLoader asks of a dataset; torch
    itself is not needed. Each process opens the recordings that it reads, so that workers may be
    forked or spawned. A sample is a dict:

        points      float32, (n, len(fields)): the fields of the n slots that have a point; x, y and z
                    in m, in the sensor's axes, without the motion that `compensate` undoes
        labels      int64, (n,): the field `label` of these slots
        boxes       float32, (k, 7): centre x, y, z, length, width, height in m and yaw in rad of the
                    k objects with points, in the sensor's axes; each box encloses its object's points
        box_labels  int64, (k,): the labels of these objects; Dataset.labels has the names
        source      index of the recording in Dataset.paths
        frame       index of the frame in its run

    `labels` is absent where a recording has none. Samples differ in their numbers of points and
    boxes: docs/python.md shows how torch's DataLoader makes batches of them. Raises InputError if a
    source cannot be read, or has no such split or sensor.
    """

    def __init__(self,
                 *sources: str | os.PathLike[str],
                 split: str | None = None,
                 sensor: str | None = None,
                 fields: Sequence[str] = ("x", "y", "z", "intensity"),
                 compensate: str = "all",
                 transform: Callable[[Sample], Any] | None = None) -> None:
        """sources: data sets of `railcast-generate dataset`, or what railcast.open() reads, captures excepted.

        split: the part of a data set, such as "train"; None = all parts.
        sensor: the name of one sensor of a data set that has several; None = the frames of all sensors.
        fields: the columns of `points`, names of fields (docs/files.md).
        compensate: the motion during a scan that is undone in x, y and z, and for which boxes are placed.
            "all": the motion of the sensor and of the objects. Points and boxes are those of one instant,
                the stamp.
            "sensor": the sensor's motion alone, which a vehicle knows. The points of a moving object are
                spread over its path while it was scanned; its box is where it was at the mean time of these
                points.
            "none": no motion. Points are as they were measured; boxes are where the objects were at the
                mean time of their points, in the axes that the sensor had at that time.
            KITTI's clouds come with the sensor's motion undone and without times: "sensor" always holds for them.
            All other fields, also range_m, are as measured.
        transform: called with each sample; its result is returned instead of the sample.
        """
        found = [run for source in sources for run in recordings_of(os.fspath(source), split, sensor)]
        self.paths = [path for path, _ in found]
        self.fields = tuple(fields)
        self.compensate = compensate
        self.transform = transform
        self._ends = list(itertools.accumulate(num_frames for _, num_frames in found))
        self._process = os.getpid()
        self._opened: collections.OrderedDict[int, Recording] = collections.OrderedDict()

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_opened": collections.OrderedDict()}

    def __len__(self) -> int:
        return self._ends[-1] if self._ends else 0

    def __getitem__(self, index: int) -> Any:
        length = len(self)
        if not -length <= index < length:
            raise IndexError(f"index: must be >= 0 and < {length} (got {index})")
        index %= length
        source = bisect.bisect_right(self._ends, index)
        begin = self._ends[source - 1] if source > 0 else 0
        recording = self._recording(source)
        sample = self._sample(recording[index - begin], recording.labels)
        sample["source"] = source
        return sample if self.transform is None else self.transform(sample)

    @property
    def labels(self) -> dict[str, int]:
        """The ids of labels by name, from the first recording; empty if there is none."""
        return self._recording(0).labels if self.paths else {}

    def _recording(self, source: int) -> Recording:
        if self._process != os.getpid():  # Threads and files of another process are not ours.
            self._process = os.getpid()
            self._opened.clear()
        if source not in self._opened:
            if len(self._opened) >= KEPT_OPEN:
                self._opened.popitem(last=False)
            self._opened[source] = open_recording(self.paths[source])
        self._opened.move_to_end(source)
        return self._opened[source]

    def _sample(self, frame: Frame, labels: dict[str, int]) -> Sample:
        has_point = frame.has_point
        xyz = dict(zip("xyz", frame.points(compensate=self.compensate).T))
        points = np.empty((np.count_nonzero(has_point), len(self.fields)), np.float32)
        for column, field in enumerate(self.fields):
            points[:, column] = xyz[field] if field in xyz else frame[field][has_point]
        seen = [thing for thing in frame.objects if thing.points > 0]
        sample: Sample = {
            "points": points,
            "boxes": np.array([box_of(frame, thing, self.compensate) for thing in seen], np.float32).reshape(-1, 7),
            "box_labels": np.array([labels[thing.label] for thing in seen], np.int64),
            "frame": frame.index,
        }
        if "label" in frame:
            sample["labels"] = frame["label"][has_point].astype(np.int64)
        return sample
