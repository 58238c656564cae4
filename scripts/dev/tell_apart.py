#!/usr/bin/env python3
"""Says how well two classifiers tell rows of real things from ours in the same place, as
docs/results/insertion.md has it; prints the tables.

usage: /usr/bin/python3 scripts/dev/tell_apart.py BUILD_DIR

Needs scikit-learn (apt-get install python3-sklearn), the test program generator_extras_tests, and
the real captures, out of which it cuts the things of real_things_test.cpp. The classifiers are the
project's logistic regression on features, squares and products, and boosted trees. Each thing is
scored by what the others have taught, and the areas under the curve are averaged over the things.
"""

import csv
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy
from sklearn.ensemble import HistGradientBoostingClassifier
from sklearn.linear_model import LogisticRegression
from sklearn.metrics import roc_auc_score
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import PolynomialFeatures, StandardScaler

NUM_OF_SHAPE = 4  # The first features; the others are of intensity.
HELD_OUT = "OS0-128"  # Of this sensor's capture nothing was taken; its rows teach no classifier.


def logistic():
    return make_pipeline(StandardScaler(), PolynomialFeatures(2, include_bias=False),
                         StandardScaler(), LogisticRegression(C=1.0, max_iter=2000))


def trees():
    return HistGradientBoostingClassifier(max_iter=100, learning_rate=0.05, max_leaf_nodes=8,
                                          random_state=0)


def rows_of_things(build):
    """Names of the features; things, classes and features by row."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "rows.csv"
        subprocess.run([build / "tests/generator/extras/generator_extras_tests",
                        "--gtest_filter=RealThings.GiveTheirRows*"], check=True,
                       stdout=subprocess.DEVNULL, env=os.environ | {"RAILCAST_WRITE_ROWS": str(file)})
        head, *rows = csv.reader(file.read_text(encoding="utf-8").splitlines())
    if not rows:
        sys.exit("tell_apart.py: the real captures are not there")
    return (head[2:], numpy.array([row[0] for row in rows]),
            numpy.array([int(row[1]) for row in rows]),
            numpy.array([[float(value) for value in row[2:]] for row in rows]))


def areas(make, things, ours, features):
    """{thing: area on its rows of a classifier that has seen those of the others}"""
    found = {}
    teaches = numpy.array([not thing.startswith(HELD_OUT) for thing in things])
    for thing in dict.fromkeys(things):
        held = things == thing
        others = teaches & ~held
        scores = make().fit(features[others], ours[others]).predict_proba(features[held])[:, 1]
        found[thing] = roc_auc_score(ours[held], scores)
    return found


def main():
    names, things, ours, features = rows_of_things(pathlib.Path(sys.argv[1]))
    poles = numpy.array([thing.startswith("VLS-128 po") for thing in things])
    others = numpy.array([not thing.startswith(("VLS-128", HELD_OUT)) for thing in things])
    subsets = {"intensity alone": slice(NUM_OF_SHAPE, None), "shape alone": slice(0, NUM_OF_SHAPE),
               "all": slice(None)}
    subsets |= {name: slice(k, k + 1) for k, name in enumerate(names)}
    print("| features | " + " | ".join(f"{what}: {which}" for what in ("VLS-128", "others")
                                       for which in ("logistic", "trees")) + " |")
    print("|---" * 5 + "|")
    for subset, columns in subsets.items():
        cells = []
        for part in (poles, others):
            for make in (logistic, trees):
                found = areas(make, things[part], ours[part], features[part][:, columns])
                cells.append(f"{numpy.mean(list(found.values())):.2f}")
        print(f"| {subset} | " + " | ".join(cells) + " |")
    print("\n| thing | rows, real and ours | intensity alone | shape alone | all |\n" + "|---" * 5 + "|")
    by_thing = [areas(trees, things, ours, features[:, columns])
                for columns in list(subsets.values())[:3]]
    for thing in by_thing[0]:
        num = numpy.bincount(ours[things == thing])
        print(f"| {thing} | {num[0]}, {num[1]} | "
              + " | ".join(f"{found[thing]:.2f}" for found in by_thing) + " |")


if __name__ == "__main__":
    main()
