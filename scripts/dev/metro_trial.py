"""The table of docs/results/metro.md of the ten objects of a metro trial, of the CSV files of their study."""

import csv

WEATHERS = ("clear", "light rain", "heavy rain", "fog", "snow")


def read(folder, name):
    with open(folder / f"{name}.csv", encoding="utf-8", newline="") as lines:
        return list(csv.DictReader(lines))


def text(row):
    """How many approaches detect an object and from where on at least, or how many alarms it raises."""
    if row["detected"] == "":
        num = int(row["alarms_at_objects"])
        return f"{num} alarm" + ("" if num == 1 else "s")
    least = f", {float(row['least_detected_at_m']):.0f} m" if row["least_detected_at_m"] else ""
    return f"{row['detected']} of {row['approaches']}{least}"


def objects(folder):
    """(columns, rows): an object each, and the false alarms of each weather."""
    by_place = {(row["target"], row["condition"]): text(row) for row in read(folder, "targets_by_condition")}
    alarms = {row["condition"]: f"{float(row['per_km']):.1f}" for row in read(folder, "false_alarms")}
    rows = [[target, *(by_place.get((target, f"weather: {weather}"), "-") for weather in WEATHERS)]
            for target in dict.fromkeys(target for target, _ in by_place) if target != "no object"]
    rows.append(["other false alarms per km", *(alarms[f"weather: {weather}"] for weather in WEATHERS)])
    return ["object", *WEATHERS], rows
