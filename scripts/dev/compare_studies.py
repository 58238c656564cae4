#!/usr/bin/env python3
"""How far two studies of one recipe differ in the distances at which they detect, approach by approach.

Usage: compare_studies.py STUDY OTHER

Both are folders that `railcast-analyze study` wrote, of recipes that draw the same. Prints the mean difference of the
distances (STUDY less OTHER) with its interval of 95 %, the median and the 90 % quantile of its magnitude, and how many
objects only one of them detects. docs/results/braking.md says what `ride` changes by it.
"""

import json
import math
import pathlib
import statistics
import sys


def read_approaches(folder):
    objects = {}
    with (pathlib.Path(folder) / "approaches.jsonl").open(encoding="utf-8") as lines:
        for line in lines:
            approach = json.loads(line)
            for thing in approach["objects"]:
                objects[approach["scenario"], thing["name"]] = thing
    return objects


def main(one, other):
    ours, theirs = read_approaches(one), read_approaches(other)
    if ours.keys() != theirs.keys() or any(ours[key]["drawn"] != theirs[key]["drawn"] for key in ours):
        sys.exit(f"{other}: must have the draws of {one}")
    both = [key for key in ours if ours[key]["detected"] and theirs[key]["detected"]]
    differences_m = [ours[key]["distance_m"] - theirs[key]["distance_m"] for key in both]
    if len(differences_m) < 2:
        sys.exit(f"{one}: must detect two objects or more that {other} detects, too (got {len(differences_m)})")
    half_m = 1.96 * statistics.stdev(differences_m) / math.sqrt(len(differences_m))
    mean_m = statistics.mean(differences_m)
    magnitudes_m = statistics.quantiles(map(abs, differences_m), n=10)
    print(f"{len(both)} of {len(ours)} objects are detected in both, {sum(ours[key]['detected'] for key in ours) - len(both)} "
          f"in the first alone, {sum(theirs[key]['detected'] for key in ours) - len(both)} in the second alone")
    print(f"distance: {mean_m:+.2f} m [{mean_m - half_m:.2f}, {mean_m + half_m:.2f}], magnitude {magnitudes_m[4]:.2f} m in the "
          f"median, more than {magnitudes_m[8]:.2f} m in one of ten")


if __name__ == "__main__":
    main(*sys.argv[1:])
