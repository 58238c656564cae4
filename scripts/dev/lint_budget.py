#!/usr/bin/env python3
"""Holds the tree against its budget, scripts/dev/budget.json: the lines and files of each room, small private headers
with a single user, and includes that lead from the product to an extra.

Usage: lint_budget.py [ROOT]
       lint_budget.py --lower [ROOT]    write what the tree has come down to

Exits 1 if a room has more than its budget, or if the tree has a header or include that is not listed. The numbers and
lists only go down: whoever needs more raises them by hand, in a commit of its own that says why.
"""

import collections
import json
import pathlib
import sys

import lint_architecture

BUDGET = "scripts/dev/budget.json"
PRODUCT_TREES = ("core", *lint_architecture.PROGRAMS)
# What can be taken away: the product includes nothing of it.
EXTRAS = ("core/extras", "generator/extras", "analysis/extras")
SMALL_HEADER_LINES = 120


def room_of(name):
    """core/rail/track for core/rail/track/ballast.h, core/base for core/base/units.h."""
    parts = name.split("/")[:-1]
    if parts[:3] in (["core", "extras", "packets"], ["core", "extras", "ros"]):
        return "/".join(parts[:4])
    is_divided = parts[1:2] == ["extras"] or parts[:2] in (["core", "rail"], ["core", "detect"], ["core", "io"])
    return "/".join(parts[:3] if is_divided else parts[:2])


def is_of_extra(name):
    return any(lint_architecture.is_within(name, extra) for extra in EXTRAS)


def measure(root):
    """What the budget limits, as the tree has it; small headers with a single user with that user."""
    sources = {name: source for name, source in lint_architecture.read_sources(root).items()
               if name.split("/")[0] in PRODUCT_TREES}
    rooms = collections.defaultdict(lambda: {"lines": 0, "files": 0})
    users = collections.defaultdict(list)
    to_extras = []
    for name, source in sources.items():
        room = rooms[room_of(name)]
        room["lines"] += source.text.count("\n")
        room["files"] += 1
        for _, included, _ in source.includes:
            if included is None:
                continue
            # Its own source is no user.
            if included.removesuffix(".h") != name.removesuffix(".cpp"):
                users[included].append(name)
            if is_of_extra(included) and not is_of_extra(name):
                to_extras.append(f"{name} -> {included}")
    small = {name: users[name][0] for name, source in sorted(sources.items())
             if source.is_header and not source.is_public and len(users[name]) == 1
             and source.text.count("\n") < SMALL_HEADER_LINES}
    return {"rooms": dict(sorted(rooms.items())), "single_user_headers": small,
            "product_to_extras": sorted(to_extras)}


def lint(now, budget):
    """Yields what is over the budget."""
    for room, sizes in now["rooms"].items():
        for what, number in sizes.items():
            most = budget["rooms"].get(room, {}).get(what, 0)
            if number > most:
                yield f"{room}: has {number} {what}, and {most} in {BUDGET}"
    for header in sorted(set(now["single_user_headers"]) - set(budget["single_user_headers"])):
        yield (f"{header}: a private header has several users, or {SMALL_HEADER_LINES} lines; this belongs into its "
               f"only user, {now['single_user_headers'][header]}")
    for include in sorted(set(now["product_to_extras"]) - set(budget["product_to_extras"])):
        yield f"{include}: the product includes no extra"


def lowered(now, budget):
    """The budget, with nothing that the tree no longer needs."""
    return {
        "rooms": {room: {what: min(number, budget["rooms"].get(room, {}).get(what, 0)) for what, number in sizes.items()}
                  for room, sizes in now["rooms"].items() if room in budget["rooms"]},
        "single_user_headers": sorted(set(now["single_user_headers"]) & set(budget["single_user_headers"])),
        "product_to_extras": sorted(set(now["product_to_extras"]) & set(budget["product_to_extras"])),
    }


def text_of(budget):
    """One line for each room, header and include, so that changes are seen by line."""
    rooms = ",\n".join(f"    {json.dumps(room)}: {json.dumps(sizes)}" for room, sizes in budget["rooms"].items())
    lists = "".join(f',\n  "{key}": [\n' + ",\n".join(f"    {json.dumps(entry)}" for entry in budget[key]) + "\n  ]"
                    for key in ("single_user_headers", "product_to_extras"))
    return '{\n  "rooms": {\n' + rooms + "\n  }" + lists + "\n}\n"


def main(arguments):
    is_lowering = "--lower" in arguments
    roots = [argument for argument in arguments[1:] if argument != "--lower"]
    root = pathlib.Path(roots[0] if roots else pathlib.Path(__file__).resolve().parents[2]).resolve()
    budget = json.loads((root / BUDGET).read_text(encoding="utf-8"))
    now = measure(root)
    if is_lowering:
        (root / BUDGET).write_text(text_of(lowered(now, budget)), encoding="utf-8")
        budget = lowered(now, budget)
    faults = list(lint(now, budget))
    for fault in faults:
        print(fault, file=sys.stderr)
    total = {what: sum(sizes[what] for sizes in now["rooms"].values()) for what in ("lines", "files")}
    print(f"{total['lines']} lines in {total['files']} files; {len(now['single_user_headers'])} small headers with one "
          f"user; {len(now['product_to_extras'])} includes from the product to extras")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
