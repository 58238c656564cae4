#!/usr/bin/python3
"""Measures `study --rare` beside plain studies, for docs/results/rare.md: scripts/dev/rare_results.py BUILD FOLDER

Each study is made plain, without certificates, and with --rare for each margin of braking, on which no distance of
detection depends, and each precision. FOLDER keeps what was made, with the processor seconds: a plain study that was
interrupted counts as far as it came, and goes on where its line in FOLDER/seconds.json is removed. It takes two hours of
one processor.
"""

import json
import pathlib
import re
import resource
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "results" / "rare.md"
SCENARIOS = ROOT / "scenarios"
Z = statistics.NormalDist().inv_cdf(0.975)

# Margins in metres, the study's own first, with the precision that is asked for. Numbers of plain approaches.
CASES = {"lying_worker": (((2, 0.3), (2, 0.1), (1, 0.3), (8, 0.3)), 4000), "curve_wagon": (((8, 0.3),), 3000),
         "thin_post": (((3, 0.3),), 3000)}


def read(path):
    return json.loads(path.read_text())


def parts_of(name):
    """The study and its recipe, which can be written to any folder."""
    study = read(SCENARIOS / "studies" / f"{name}.json")
    recipe = read(SCENARIOS / "studies" / study["recipe"])
    recipe["bases"] = [{"file": str((SCENARIOS / "studies" / base["file"]).resolve())} for base in recipe["bases"]]
    return study, recipe


def run(build, folder, name, study, recipe, options=()):
    """Makes a study in a folder of its own, unless FOLDER/seconds.json has it, and returns its seconds."""
    seconds = read(folder / "seconds.json") if (folder / "seconds.json").exists() else {}
    if name not in seconds:
        recipe_file = f"{name}_recipe.json"
        (folder / recipe_file).write_text(json.dumps(recipe))
        (folder / f"{name}.json").write_text(json.dumps({**study, "recipe": recipe_file}))
        begin_s = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        said = subprocess.run([build / "analysis" / "railcast-analyze", "study", folder / f"{name}.json", *options, "--out",
                               folder / name], stdout=subprocess.PIPE, text=True, check=False).stdout
        (folder / f"{name}.txt").write_text(said)
        seconds[name] = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - begin_s
        (folder / "seconds.json").write_text(json.dumps(seconds, indent=1))
    return seconds[name]


def share(failed, num):
    """A share with Wilson's interval."""
    middle = (failed + Z * Z / 2) / (num + Z * Z)
    half = Z / (num + Z * Z) * (failed * (num - failed) / num + Z * Z / 4) ** 0.5
    return {"value": failed / num, "low": middle - half, "high": middle + half}


def shown(estimate):
    return f"{estimate['value']:.2g} [{estimate['low']:.2g}, {estimate['high']:.2g}]"


def spare_m(line):
    return min((o["distance_m"] or 0) - o["needed_m"] for o in line["objects"])


def rows_of(build, folder, name):
    cases, num = CASES[name]
    study, recipe = parts_of(name)
    plain = {key: value for key, value in study.items() if key != "rare"}
    plain_s = run(build, folder, f"{name}_plain", plain, {**recipe, "num_scenarios": num}, ("--certify", "off"))
    spares_m = [spare_m(json.loads(line)) for line in (folder / f"{name}_plain/approaches.jsonl").open()]
    each_s = plain_s / len(spares_m)
    for margin_m, precision in cases:
        braking = {**study["braking"], "margin_m": margin_m}
        rare = {**study.get("rare", {}), "precision": precision}
        rare_name = f"{name}_{margin_m}_{precision}"
        rare_s = run(build, folder, rare_name, {**study, "braking": braking, "rare": rare}, recipe)
        report = read(folder / rare_name / "report.json")
        failed = sum(spare < margin_m - study["braking"]["margin_m"] for spare in spares_m)
        num_made = sum(1 for _ in (folder / rare_name / "approaches.jsonl").open())
        row = [name, margin_m, precision, f"{failed} of {len(spares_m)}", shown(share(failed, len(spares_m))), f"{each_s:.3f}"]
        figure = report["headlines"][0]["value"]
        if figure["value"] is None:
            reason = re.search(r"There is no figure: (.*?)\.\n", (folder / f"{rare_name}.txt").read_text(), re.DOTALL)
            yield [*row, "none: " + " ".join(reason[1].split()), num_made, round(rare_s), "", ""]
            continue
        error = (figure["high"] - figure["low"]) / (2 * Z)
        wanted = figure["value"] * (1 - figure["value"]) / error ** 2
        yield [*row, shown(figure), num_made, round(rare_s), f"{wanted:,.0f}", f"{wanted * each_s / rare_s:.1f}"]


def main():
    build, folder = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    folder.mkdir(parents=True, exist_ok=True)
    text, begin = PAGE.read_text(), "| study |"
    table = [text[text.index(begin):].splitlines()[0], "|" + "---|" * 11]
    for name in CASES:
        table += ["| " + " | ".join(map(str, row)) + " |" for row in rows_of(build, folder, name)]
    PAGE.write_text(text[:text.index(begin)] + "\n".join(table) + "\n")


if __name__ == "__main__":
    main()
