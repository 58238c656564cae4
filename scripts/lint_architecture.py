#!/usr/bin/env python3
"""Checks what the compiler does not: who may include whom, file sizes, units in names.

Usage: lint_architecture.py [ROOT]

Prints one line per fault, "file:line: rule (what was found)", and exits 1 if there is any.
Long files are listed on the way but are no fault before the hard limit.
"""

import pathlib
import re
import sys

# A folder of core includes only itself and folders before it.
CORE_ORDER = "base frame scene rail scan trace detect simulate scenario fidelity io".split()
# They share core, and nothing else.
PROGRAMS = ("generator", "analysis", "viewer")
TREES = ("core", *PROGRAMS, "tests", "scripts")

# Who may include which library; tests may include any.
LIBRARY_OWNERS = {
    "Embree": (r"embree\d/", ("core/trace",)),
    "OpenMesh": (r"OpenMesh/", ("core/scene",)),
    "nlohmann": (r"nlohmann/",
                 ("core/scenario", "core/fidelity", "core/io", "generator", "analysis")),
    "PCL": (r"pcl/", ("core/io", "generator", "analysis", "viewer")),
    "libpcap": (r"pcap/", ("core/io",)),
    "Expat": (r"expat\.h$", ("core/io",)),
    "VTK": (r"vtk[A-Z]\w+\.h$", ("viewer",)),
    "CLI11": (r"CLI/", ("core/io", *PROGRAMS)),
    "spdlog": (r"spdlog/", PROGRAMS),
}
# What a public header may ask of the programs that include it: the core is to be embedded, core/io
# is ours alone.
PUBLIC_LIBRARIES = re.compile(r"Eigen/|[a-z_0-9]+$")
PUBLIC_IO_LIBRARIES = re.compile(PUBLIC_LIBRARIES.pattern + "|pcl/")

LONG_FILE_LINES = 300
MAX_FILE_LINES = 500

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)
PUBLIC_HEADERS = re.compile(r"FILE_SET\s+HEADERS\b[^)]*?\bFILES\b([^)]*)\)")
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)

# Names declared as float or double, or as containers of them. Functions that are more than
# accessors start in upper case and are none of them.
NUMBER_DECLARATION = re.compile(r"\b(?:float|double)\b[\s>&*,\w]*?[\s>&*]"
                                r"([a-z]\w*(?:\s*,\s*[a-z]\w*)*)\s*[;,={()\[]")
DIMENSIONAL_WORD = re.compile(
    r"(?:^|_)(?:range|angle|azimuth|elevation|time|duration|speed|rate|height|length|width|radius"
    r"|distance)s?(?:_|$)")
UNIT_SUFFIX = re.compile(
    r"_(?:m|mm|km|um|nm|m2|m3|rad|mrad|deg|sr|s|ms|us|ns|hz|mps|mps2|kmph|radps|mmph|permil|px|per_[a-z]+\d?"
    # Without a unit, because divided by their like.
    r"|ratio|fraction|factor|exponent|probability)_?$")


class Source:
    """One C++ file: its text and what it includes."""

    def __init__(self, root, path):
        self.name = path.relative_to(root).as_posix()
        self.text = path.read_text(encoding="utf-8")
        self.folder = self.name.rpartition("/")[0]
        self.is_header = path.suffix == ".h"
        self.is_public = False
        self.includes = []  # (line, ours or None, library's or None)
        for match in INCLUDE.finditer(self.text):
            line = self.text.count("\n", 0, match.start(match.lastindex)) + 1
            self.includes.append((line, match[1], match[2]))


def read_sources(root):
    paths = [path for tree in TREES for path in sorted((root / tree).rglob("*"))
             if path.suffix in (".h", ".cpp")]
    sources = {source.name: source for source in (Source(root, path) for path in paths)}
    for lists in sorted((root / "core").rglob("CMakeLists.txt")):
        for header in PUBLIC_HEADERS.findall(lists.read_text(encoding="utf-8")):
            for name in header.split():
                public = sources.get((lists.parent / name).relative_to(root).as_posix())
                if public:
                    public.is_public = True
    return sources


def is_within(name, folder):
    return name == folder or name.startswith(folder + "/")


def lint_own_include(source, included, sources):
    """Yields what is wrong with including one of our own files."""
    if "/" not in included:
        yield f'our own files are included from the root ("{included}")'
        return
    tree, target_tree = source.name.split("/")[0], included.split("/")[0]
    if tree == "tests":
        return
    if target_tree != tree and target_tree != "core":
        yield f"{tree} includes no {target_tree} ({included})"
    elif tree == "core":
        folder, target = source.name.split("/")[1], included.split("/")[1]
        for unknown in {folder, target} - set(CORE_ORDER):
            yield f"{unknown} has no place in the order of core's folders ({included})"
            return
        if CORE_ORDER.index(target) > CORE_ORDER.index(folder):
            yield f"core/{folder} comes before core/{target} and includes nothing of it ({included})"
    if source.is_public and included in sources and not sources[included].is_public:
        yield f"a public header includes no private one ({included})"


def lint_library_include(source, included):
    """Yields what is wrong with including a library's file."""
    if is_within(source.folder, "tests"):
        return
    for library, (pattern, owners) in LIBRARY_OWNERS.items():
        if re.match(pattern, included) and not any(is_within(source.folder, o) for o in owners):
            yield f"only {', '.join(owners)} and tests include {library} ({included})"
    allowed = PUBLIC_IO_LIBRARIES if is_within(source.folder, "core/io") else PUBLIC_LIBRARIES
    if source.is_public and not allowed.match(included):
        yield f"public headers include the standard library and Eigen only ({included})"


def lint_includes(sources):
    for source in sources.values():
        for line, own, library in source.includes:
            faults = lint_own_include(source, own, sources) if own else lint_library_include(
                source, library)
            for fault in faults:
                yield f"{source.name}:{line}: {fault}"


def lint_cycles(sources):
    """Yields every include that closes a circle, with the circle."""
    done, trail = set(), []

    def visit(name):
        trail.append(name)
        for line, own, _ in sources[name].includes:
            if own in trail:
                circle = " -> ".join(trail[trail.index(own):] + [own])
                yield f"{name}:{line}: includes make no circle ({circle})"
            elif own in sources and own not in done:
                yield from visit(own)
        done.add(trail.pop())

    for name in sources:
        if name not in done:
            yield from visit(name)


def lint_units(sources):
    """Yields the dimensional names in headers that do not end in their unit."""
    for source in sources.values():
        if not source.is_header or is_within(source.folder, "tests"):
            continue
        code = COMMENT.sub(lambda comment: re.sub(r"[^\n]", " ", comment[0]), source.text)
        for match in NUMBER_DECLARATION.finditer(code):
            line = code.count("\n", 0, match.start(1)) + 1
            for name in re.split(r"\s*,\s*", match[1]):
                if DIMENSIONAL_WORD.search(name) and not UNIT_SUFFIX.search(name):
                    yield f"{source.name}:{line}: a dimensional name ends in its unit ({name})"


def count_lines(root):
    """(file, lines) of everything that people read as code, longest first."""
    paths = [path for tree in TREES for path in (root / tree).rglob("*")
             if path.suffix in (".h", ".cpp", ".py", ".sh", ".cmake")]
    counts = [(path.relative_to(root).as_posix(), len(path.read_text("utf-8").splitlines()))
              for path in paths]
    return sorted(counts, key=lambda count: (-count[1], count[0]))


def lint_sizes(root):
    for name, lines in count_lines(root):
        if lines > MAX_FILE_LINES:
            yield f"{name}:{MAX_FILE_LINES}: a file has at most {MAX_FILE_LINES} lines ({lines})"


def lint(root):
    """Every fault of the tree at `root`."""
    sources = read_sources(root)
    return [*lint_includes(sources), *lint_cycles(sources), *lint_units(sources),
            *lint_sizes(root)]


def main(arguments):
    here = pathlib.Path(__file__).resolve()
    root = pathlib.Path(arguments[1]).resolve() if len(arguments) > 1 else here.parent.parent
    for name, lines in count_lines(root):
        if LONG_FILE_LINES < lines <= MAX_FILE_LINES:
            print(f"long: {name}: {lines} lines")
    faults = lint(root)
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
