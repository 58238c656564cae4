"""Loads frames for training, in batches: load_dataset.py RECORDING_OR_DATASET...

Needs the module: PYTHONPATH=build/release/python. Torch is used where it is installed.
"""

import importlib.util
import sys

import numpy as np
import railcast


def collate(samples):
    """Samples as one batch: their arrays end to end, and the index of the sample of each point and box."""
    batch = {name: np.concatenate([sample[name] for sample in samples])
             for name in ("points", "labels", "boxes", "box_labels")}
    for name in ("points", "boxes"):
        batch[f"sample_of_{name}"] = np.repeat(np.arange(len(samples)), [len(sample[name]) for sample in samples])
    return batch


def load_by_torch(dataset):
    import torch

    loader = torch.utils.data.DataLoader(dataset, batch_size=2, shuffle=True, num_workers=2, collate_fn=collate)
    for batch in loader:
        points, labels = torch.from_numpy(batch["points"]), torch.from_numpy(batch["labels"])
        print(points.shape, labels.shape)


def main():
    dataset = railcast.Dataset(*sys.argv[1:], fields=("x", "y", "z", "intensity"))
    sample = dataset[0]
    print(len(dataset), sample["points"].shape, sample["labels"].shape, sample["boxes"].shape)
    batch = collate([dataset[0], dataset[1]])
    print(batch["points"].shape, batch["sample_of_points"].shape, batch["boxes"].shape)
    if importlib.util.find_spec("torch"):
        load_by_torch(dataset)


if __name__ == "__main__":
    main()
