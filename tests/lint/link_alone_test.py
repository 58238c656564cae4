"""Holds that the product's libraries need no symbol of an extra, and each extra none but of the product's and of those that it
says it uses: so the product can be linked without extras, and each extra with these alone.

Usage: link_alone_test.py LIBRARIES_JSON (which core/extras.cmake writes)
"""

import json
import subprocess
import sys


def symbols(library):
    """Those that the library defines, and those that it needs and does not define."""
    lines = subprocess.run(["nm", "--extern-only", "--format=posix", library], check=True, capture_output=True,
                           text=True).stdout.splitlines()
    kinds = {(words[0], words[1]) for words in map(str.split, lines) if len(words) >= 2 and len(words[1]) == 1}
    defined = {name for name, kind in kinds if kind not in "Uw"}
    return defined, {name for name, kind in kinds if kind == "U"} - defined


def faults_of(extras, product_needs, product_defines, of_extra):
    owner = {symbol: name for name, (defined, _) in of_extra.items() for symbol in defined - product_defines}

    def reached(name):
        found, left = set(), [name]
        while left:
            found.add(last := left.pop())
            left += set(extras[last]["uses"]) - found
        return found

    for name, allowed, needed in [("the product", set(), product_needs),
                                  *((name, reached(name), needed) for name, (_, needed) in of_extra.items())]:
        for symbol in sorted(needed - product_defines):
            # A symbol of several extras, as an instance of a template, may come of each of them.
            if symbol in owner and not any(symbol in of_extra[extra][0] for extra in allowed):
                yield f"{name} needs {symbol} of {owner[symbol]}"


def joined(extras):
    """Those that are one library as one extra, which uses what each of them does."""
    of_file = {}
    for name, extra in extras.items():
        of_file.setdefault(extra["file"], []).append(name)
    unit_of = {name: names[0] for names in of_file.values() for name in names}
    return {names[0]: {"file": file, "uses": sorted({unit_of[used] for name in names for used in extras[name]["uses"]} - {names[0]})}
            for file, names in of_file.items()}


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        listed = json.load(file)
    product = [symbols(library) for library in listed["product"]]
    defines, needs = (set().union(*sets) for sets in zip(*product))
    extras = joined(listed["extras"])
    of_extra = {name: symbols(extra["file"]) for name, extra in extras.items()}
    faults = list(faults_of(extras, needs, defines, of_extra))
    if faults:
        sys.exit(subprocess.run(["c++filt"], input="\n".join(faults), check=True, capture_output=True, text=True).stdout)
    # A fault would be seen: some extras cannot be linked without what they use.
    alone = {name: extra | {"uses": []} for name, extra in extras.items()}
    assert not extras or list(faults_of(alone, needs, defines, of_extra))


main()
