"""Frames of recordings by index, as loaders for training want them (torch.utils.data.DataLoader)."""

from __future__ import annotations

import bisect
import itertools
import math
import os
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ._railcast import Frame, Object, Recording, open as open_recording

Sample = dict[str, Any]


def box_of(thing: Object) -> list[float]:
    """Centre x, y, z, length, width, height in m and yaw in rad, in the sensor's axes."""
    pose = thing.sensor_from_box
    return [*pose[:3, 3], *thing.size_m, math.atan2(pose[1, 0], pose[0, 0])]


class Dataset:
    """The frames of one or several recordings, by index.

    It has `__len__` and `__getitem__`, which is all that torch's DataLoader asks of a dataset; torch
    itself is not needed. Each process opens the recordings anew, so that workers may be forked or
    spawned. A sample is a dict:

        points      float32, (n, len(fields)): the values of the slots that have a point
        labels      int64, (n,): their values of the field `label`
        boxes       float32, (k, 7): centre x, y, z, length, width, height in m and yaw in rad of the
                    objects with points, in the sensor's axes
        box_labels  int64, (k,): their labels; the names are in Dataset.labels
        source      index of the recording
        frame       index of the frame in its run

    Labels are absent where a recording has none.
    """

    def __init__(self,
                 *sources: str | os.PathLike[str],
                 fields: Sequence[str] = ("x", "y", "z", "intensity"),
                 transform: Callable[[Sample], Any] | None = None) -> None:
        """sources: what railcast.open() reads, captures excepted.

        fields: the columns of `points`.
        transform: called with each sample; what it returns takes its place.
        """
        self.sources = [os.fspath(source) for source in sources]
        self.fields = tuple(fields)
        self.transform = transform
        self._opened: dict[int, list[Recording]] = {}
        self._ends = list(itertools.accumulate(len(recording) for recording in self._recordings()))

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_opened": {}}

    def __len__(self) -> int:
        return self._ends[-1] if self._ends else 0

    def __getitem__(self, index: int) -> Any:
        length = len(self)
        if not -length <= index < length:
            raise IndexError(f"index: must be >= 0 and < {length} (got {index})")
        index %= length
        source = bisect.bisect_right(self._ends, index)
        begin = self._ends[source - 1] if source > 0 else 0
        recording = self._recordings()[source]
        sample = self._sample(recording[index - begin], recording.labels)
        sample["source"] = source
        return sample if self.transform is None else self.transform(sample)

    @property
    def labels(self) -> dict[str, int]:
        """Ids of labels by name, of all recordings."""
        return {name: label for recording in self._recordings() for name, label in recording.labels.items()}

    def _recordings(self) -> list[Recording]:
        process = os.getpid()
        if process not in self._opened:
            self._opened = {process: [open_recording(source) for source in self.sources]}
        return self._opened[process]

    def _sample(self, frame: Frame, labels: dict[str, int]) -> Sample:
        has_point = frame.has_point
        points = np.empty((np.count_nonzero(has_point), len(self.fields)), np.float32)
        for column, field in enumerate(self.fields):
            points[:, column] = frame[field][has_point]
        seen = [thing for thing in frame.objects if thing.points > 0]
        sample: Sample = {
            "points": points,
            "boxes": np.array([box_of(thing) for thing in seen], np.float32).reshape(-1, 7),
            "box_labels": np.array([labels[thing.label] for thing in seen], np.int64),
            "frame": frame.index,
        }
        if "label" in frame:
            sample["labels"] = frame["label"][has_point].astype(np.int64)
        return sample
