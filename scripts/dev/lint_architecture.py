#!/usr/bin/env python3
"""Checks what the compiler does not: permitted includes, file sizes, units in names, how comments begin.

Usage: lint_architecture.py [ROOT]

Prints one line per fault, "file:line: rule (what was found)", and exits 1 if there is any.
Long files are listed, too, but are no fault below the hard limit.
"""

import pathlib
import re
import sys

# A folder of core may include only itself and the folders before it.
CORE_ORDER = "base frame scene mesh rail scan trace detect simulate camera motion scenario fidelity certify c io points track program extras".split()
# The rooms of a folder: each includes only itself and those before it. Files on the top of the folder come where "."
# stands; without it there may be none.
ROOM_ORDERS = {
    "core/rail": "base line network motion chunk survey clearance track landform structures ground catenary objects traffic "
                 "world".split(),
    "core/detect": "base kernels clutter detector beam effects".split(),
    "core/io": ". image cloud record run net stream recording verify".split(),
    # Of those before it, an extra includes those that its CMakeLists.txt names (lint_extras).
    "core/extras": "packets ros dds osi recipe insert survey".split(),
    "core/extras/packets": "velodyne spinning pcap ouster recording".split(),
    "core/extras/ros": "messages mcap bag recording".split(),
    "generator": ". run check sequence live trace world extras python".split(),
    "generator/extras": ". packets ros dds osi insert replay dataset convert survey import".split(),
    "generator/extras/insert": ". plan firings clouds packets run".split(),
    "generator/extras/import": "map fit heights lines network structures .".split(),
    "analysis": "estimate report limits pictures stats inspect compare detectability frontier receive . extras".split(),
    "analysis/extras": "card detectors sight track rare study preset fit dossier".split(),
    "viewer": "color frames overlays composition draw plan session pick picture gui .".split(),
}
# The public headers, included by programs that embed railcast. Each header belongs to the folder
# that implements it, or to a room of that folder.
PUBLIC_ROOT = "core/include/"
PUBLIC_OWNERS = {
    "enum_names": "base", "error": "base", "remark": "base", "transform": "base", "frame": "frame", "outcome": "frame", "material": "scene",
    "scene": "scene", "objects": "rail/base", "structures": "rail/base", "lineside": "rail/base",
    "track_side": "rail/base", "alignment": "rail/line", "world_spec": "rail/line", "rail_world": "rail/world",
    "rigid_motion": "rail/motion", "lidar": "scan", "ray_caster": "trace", "effects": "detect",
    "motion_sensors": "motion", "simulator": "simulate", "camera": "camera", "scenario": "scenario", "fidelity": "fidelity", "c_api": "c",
}
# The programs share core, and nothing else.
PROGRAMS = ("generator", "analysis", "viewer")
TREES = ("core", *PROGRAMS, "tests", "scripts")

# The folders that may include a library; tests may include any.
LIBRARY_OWNERS = {
    "Embree": (r"embree\d/", ("core/trace",)),
    "OpenMesh": (r"OpenMesh/", ("core/mesh",)),
    "assimp": (r"assimp/", ("core/mesh",)),
    "pybind11": (r"pybind11/", ("generator/python",)),
    "nlohmann": (r"nlohmann/",
                 ("core/mesh", "core/scenario", "core/fidelity", "core/io", "core/extras", "generator",
                  "analysis")),
    "PCL": (r"pcl/", ("core/io", "core/points", "core/track", "core/include/railcast/io", "generator", "analysis")),
    "libpcap": (r"pcap/", ("core/extras/packets",)),
    "yaml-cpp": (r"yaml-cpp/", ("core/io", "core/extras")),
    "Boost.Asio": (r"boost/(?:asio|beast)/", ("core/io/net",)),
    "libpng": (r"png\.h$", ("core/io",)),
    "liblzf": (r"lzf\.h$", ("core/io",)),
    "libjpeg": (r"jpeglib\.h$", ("core/io",)),
    "OpenSSL": (r"openssl/", ("core/io", "core/extras/ros")),
    "VTK": (r"vtk[A-Z]\w+\.h$", ("viewer",)),
    "CLI11": (r"CLI/", ("core/program",)),
    "Mustache": (r"kainjow/", ("analysis/report",)),
    "spdlog": (r"spdlog/", PROGRAMS),
    "Cyclone DDS": (r"dds/", ("core/extras/dds",)),
    "protobuf": (r"google/protobuf/|osi_sensor_view\.pb\.h", ("generator/extras/osi",)),
    "SQLite": (r"sqlite3\.h$", ("core/extras/ros/bag",)),
    "libsystemd": (r"systemd/", ("generator/live",)),
    "NLopt": (r"nlopt\.hpp$", ("analysis/estimate",)),
    "zstd": (r"zstd\.h$", ("core/extras/ros/mcap",)),
    "LZ4": (r"lz4\w*\.h$", ("core/extras/ros/mcap",)),
    "bzip2": (r"bzlib\.h$", ("generator/extras/import",)),
    "Expat": (r"expat\.h$", ("generator/extras/import",)),
    "libosmium": (r"osmium/", ("generator/extras/import",)),
    "protozero": (r"protozero/", ("generator/extras/import",)),
}
# The libraries that a public header may require of the programs that include it.
PUBLIC_LIBRARIES = re.compile(r"Eigen/|[a-z_0-9]+$|std(?:def|int)\.h$")
PUBLIC_IO_LIBRARIES = re.compile(PUBLIC_LIBRARIES.pattern + "|pcl/")

PAGE_OF_ROOMS = "docs/architecture.md"
LONG_FILE_LINES = 300
MAX_FILE_LINES = 500

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<([^>]+)>)', re.MULTILINE)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)

ANONYMOUS_NAMESPACE = re.compile(r"^namespace \{\n.*?^\}  // namespace\n", re.MULTILINE | re.DOTALL)
# Matches at the beginning of a line, where clang-format puts definitions at namespace scope.
TYPE_DEFINITION = re.compile(
    r"^(?:(?:struct|class|enum class)\s+(?:alignas\(\d+\) )?(\w+)(?: final)?\s*(?::(?!:)[^;{]*)?\{"
    r"|using\s+(\w+)\s*=)", re.MULTILINE)

# Sources compiled as one library; release builds compile several of them in one translation unit.
# Each extra is a library of its own.
LIBRARIES = ("core/c", "core/io", "core/points", "core/program", "core/track", "core", "generator/python", *PROGRAMS)
EXTRA = re.compile(r"(core|generator|analysis)/extras/(\w+)/")
USED_EXTRAS = re.compile(r"^railcast_extra\(\s*USES ((?:\w+/\w+\s+)+)", re.MULTILINE)
ANONYMOUS_FUNCTION = re.compile(
    r"^(?!using|return|template|TEST|struct|class|enum)(?:\[\[\w+\]\] )?[\w:<>,&*][\w:<>,&* ]*?[ *&](\w+)\(",
    re.MULTILINE)
LISTED_SOURCE = re.compile(r"\$\{PROJECT_SOURCE_DIR\}/([\w/]+\.(?:h|cpp))\b")
ANONYMOUS_CONSTANT = re.compile(r"^(?:constexpr|const|static) [\w:<>, *&]+?(\w+)(?:\[\])? ?[={]", re.MULTILINE)
ANONYMOUS_TYPE = re.compile(r"^(?:struct|class|enum class)\s+(\w+)[^;{]*\{", re.MULTILINE)
# Of a list of tests: the program that has its sources.
LISTED_TESTS = re.compile(r"^[ \t]*railcast_add_test\(\s*([^)]*)\)", re.MULTILINE)
TEST_NAME = re.compile(r"^TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", re.MULTILINE)

# Names declared as float or double, or as containers of them. Functions other than accessors start
# in upper case and are not matched.
NUMBER_DECLARATION = re.compile(r"\b(?:float|double)\b[\s>&*,\w]*?[\s>&*]"
                                r"([a-z]\w*(?:\s*,\s*[a-z]\w*)*)\s*[;,={()\[]")
DIMENSIONAL_WORD = re.compile(
    r"(?:^|_)(?:range|angle|azimuth|elevation|time|duration|speed|rate|height|length|width|radius"
    r"|distance)s?(?:_|$)")
UNIT_SUFFIX = re.compile(
    r"_(?:m|mm|km|um|nm|m2|m3|rad|mrad|deg|sr|s|ms|us|ns|hz|mps|mps2|kmph|radps|mmph|permil|px|per_[a-z]+\d?"
    # Ratios have no unit.
    r"|ratio|fraction|factor|exponent|probability)_?$")

# How no comment and no description of a key or an option begins: it would lean on a word before it.
FRAGMENT = r"(?:Of|That|Those|As above|Likewise)\b"
STRING = re.compile(r'"(?:[^"\\\n]|\\.)*"')
FRAGMENT_COMMENT = re.compile(rf"//(?:/<?)? ({FRAGMENT}.*)")
FRAGMENT_TEXT = re.compile(rf'[(,]\s*"({FRAGMENT}[^"\n]*)"')


class Source:
    """One C++ file: its text and what it includes."""

    def __init__(self, root, path):
        self.name = path.relative_to(root).as_posix()
        self.text = path.read_text(encoding="utf-8")
        self.folder = self.name.rpartition("/")[0]
        self.is_header = path.suffix == ".h"
        self.is_public = self.name.startswith(PUBLIC_ROOT)
        self.includes = []  # (line, our file or None, library file or None)
        for match in INCLUDE.finditer(self.text):
            line = self.text.count("\n", 0, match.start(match.lastindex)) + 1
            self.includes.append((line, match[1], match[2]))


def read_sources(root):
    paths = [path for tree in TREES for path in sorted((root / tree).rglob("*"))
             if path.suffix in (".h", ".cpp")]
    return {source.name: source for source in (Source(root, path) for path in paths)}


def core_folder(name):
    """The folder of core that a file belongs to; None if the file is not part of core."""
    if not name.startswith("core/"):
        return None
    if not name.startswith(PUBLIC_ROOT):
        return name.split("/")[1]
    public = name.removeprefix(PUBLIC_ROOT + "railcast/").removesuffix(".h")
    # railcast.h includes all public headers that core implements.
    return "io" if public.startswith("io/") else PUBLIC_OWNERS.get(
        public, "fidelity" if public == "railcast" else public).split("/")[0]


def is_within(name, folder):
    return name == folder or name.startswith(folder + "/")


def room_of(name, folder):
    """The room of a folder in which a file stands, or which implements it; None if the file is elsewhere."""
    if name.startswith("railcast/"):
        name = f"core/{PUBLIC_OWNERS.get(name.removeprefix('railcast/').removesuffix('.h'), '')}/{name}"
    if not name.startswith(folder + "/"):
        return None
    room, _, rest = name.removeprefix(folder + "/").partition("/")
    return room if rest else "."


def lint_rooms(sources):
    """Yields the files that stand in no known room, and the includes against the rooms' order."""
    for folder, order in ROOM_ORDERS.items():
        for source in sources.values():
            room = room_of(source.name, folder)
            if room is None:
                continue
            if room not in order:
                yield f"{source.name}:1: {folder} has the rooms {', '.join(order)} ({room})"
                continue
            for line, included, _ in source.includes:
                target = room_of(included, folder) if included else None
                # Where the product still includes extras stands in the budget.
                if target in order and target != "extras" and order.index(target) > order.index(room):
                    yield (f"{source.name}:{line}: {folder}/{room} comes before {folder}/{target} and includes "
                           f"nothing of it ({included})")


def lint_own_include(source, included):
    """Yields the faults in including one of our own files."""
    if "/" not in included:
        yield f'our own files are included from the root ("{included}")'
        return
    tree = source.name.split("/")[0]
    is_public = included.startswith("railcast/")
    name = PUBLIC_ROOT + included if is_public else included
    target_tree = name.split("/")[0]
    if tree == "tests":
        return
    if target_tree != tree and target_tree != "core":
        yield f"{tree} includes no {target_tree} ({included})"
    elif tree == "core":
        folder, target = core_folder(source.name), core_folder(name)
        for unknown in {folder, target} - set(CORE_ORDER):
            yield f"{unknown} has no place in the order of core's folders ({included})"
            return
        if target != "extras" and CORE_ORDER.index(target) > CORE_ORDER.index(folder):
            yield f"core/{folder} comes before core/{target} and includes nothing of it ({included})"
    if source.is_public and not is_public:
        yield f"a public header includes no private one ({included})"


def lint_library_include(source, included):
    """Yields the faults in including a library's file."""
    if is_within(source.folder, "tests"):
        return
    for library, (pattern, owners) in LIBRARY_OWNERS.items():
        if re.match(pattern, included) and not any(is_within(source.folder, o) for o in owners):
            yield f"only {', '.join(owners)} and tests include {library} ({included})"
    allowed = PUBLIC_IO_LIBRARIES if is_within(source.folder, PUBLIC_ROOT + "railcast/io") else PUBLIC_LIBRARIES
    if source.is_public and not allowed.match(included):
        yield f"public headers include the standard library and Eigen only ({included})"


def lint_includes(sources):
    for source in sources.values():
        for line, own, library in source.includes:
            faults = lint_own_include(source, own) if own else lint_library_include(
                source, library)
            for fault in faults:
                yield f"{source.name}:{line}: {fault}"


def lint_named_rooms(root):
    """Yields the rooms that the table of docs/architecture.md does not name in the row of their folder, or of the one
    that this folder stands in."""
    page = root / PAGE_OF_ROOMS
    if not page.exists():
        return
    rows = re.findall(r"^\| (`.*?) \| (.*) \|$", page.read_text(encoding="utf-8"), re.MULTILINE)
    for folder, order in ROOM_ORDERS.items():
        text = "".join(cells for first, cells in rows
                       if any(is_within(folder, name) for name in re.findall(r"`([\w/]+)`", first)))
        for room in order:
            if room not in (".", "extras") and f"`{room}`" not in text:
                yield f"{PAGE_OF_ROOMS}:1: the table of folders names every room ({folder}/{room})"


def first_comments(text):
    """Yields (line, comment) of each comment, without the lines that continue it."""
    before = ""  # The comment of the line before.
    for line, code in enumerate(text.split("\n"), 1):
        blank = STRING.sub(lambda match: " " * len(match[0]), code)
        place = blank.find("//")
        comment = code[place:] if place >= 0 else ""
        kind = re.match(r"/*<?", comment)[0]
        is_alone = comment and not code[:place].strip()
        if comment and not (is_alone and kind == re.match(r"/*<?", before)[0]):
            yield line, comment
        before = comment


def lint_fragments(sources):
    """Yields the comments and descriptions that begin with a word that leans on one before them."""
    for source in sources.values():
        if is_within(source.name, "tests"):
            continue
        found = [(line, match[1]) for line, comment in first_comments(source.text)
                 if (match := FRAGMENT_COMMENT.match(comment))]
        found += [(source.text.count("\n", 0, match.start(1)) + 1, match[1])
                  for match in FRAGMENT_TEXT.finditer(source.text)]
        for line, words in sorted(found):
            yield f"{source.name}:{line}: a comment or description says what it is about ({words})"


def lint_cycles(sources):
    """Yields every include that closes a cycle, with the cycle."""
    done, trail = set(), []

    def visit(name):
        trail.append(name)
        for line, own, _ in sources[name].includes:
            own = PUBLIC_ROOT + own if own and own.startswith("railcast/") else own
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


def lint_unique_types(sources):
    """Yields the types at namespace scope that are defined twice: two such definitions in one
    program break the one-definition rule, and including both does not compile."""
    first = {}
    for source in sources.values():
        if is_within(source.folder, "tests"):
            continue
        code = ANONYMOUS_NAMESPACE.sub(lambda block: "\n" * block[0].count("\n"), source.text)
        for match in TYPE_DEFINITION.finditer(code):
            name, line = match[match.lastindex], code.count("\n", 0, match.start()) + 1
            place = first.setdefault(name, f"{source.name}:{line}")
            if place != f"{source.name}:{line}":
                yield f"{source.name}:{line}: no two types have one name ({name}, also {place})"


def lint_anonymous_names(sources):
    """Yields the functions, constants and types of anonymous namespaces that two sources of a library
    call by one name. Release builds compile several sources as one: constants and types clash, and of
    two functions the other source's may silently become the better overload."""
    first = {}
    for source in sources.values():
        if source.is_header or is_within(source.folder, "tests"):
            continue
        extra = EXTRA.match(source.name)
        library = extra[0] if extra else next(name for name in LIBRARIES if is_within(source.folder, name))
        for block in ANONYMOUS_NAMESPACE.finditer(source.text):
            for pattern in (ANONYMOUS_FUNCTION, ANONYMOUS_CONSTANT, ANONYMOUS_TYPE):
                for match in pattern.finditer(block[0]):
                    other = first.setdefault((library, match[1]), source.name)
                    if other != source.name:
                        line = source.text.count("\n", 0, block.start() + match.start()) + 1
                        yield (f"{source.name}:{line}: sources of one library give their own "
                               f"functions and constants different names ({match[1]}, also {other})")


def test_programs(root):
    """{source: program} of what the CMakeLists.txt files of tests list."""
    programs = {}
    for path in sorted((root / "tests").rglob("CMakeLists.txt")):
        for match in LISTED_TESTS.finditer(path.read_text(encoding="utf-8")):
            words = match[1].split()
            program = words[words.index("WING") + 1] if "WING" in words else words[0]
            for word in words:
                if word.endswith(".cpp"):
                    programs[(path.parent / word).resolve().relative_to(root).as_posix()] = program
    return programs


def definitions_of_test(text):
    """Yields (what, place in the text) of each test, and of what an anonymous namespace has but one of: a constant, a type,
    and of the functions of one name that with the same types of parameters."""
    for match in TEST_NAME.finditer(text):
        yield f"{match[1]}.{match[2]}", match.start()
    for block in ANONYMOUS_NAMESPACE.finditer(text):
        for pattern in (ANONYMOUS_CONSTANT, ANONYMOUS_TYPE):
            for match in pattern.finditer(block[0]):
                yield match[1], block.start() + match.start()
        for match in ANONYMOUS_FUNCTION.finditer(block[0]):
            parameters = re.match(r"[^{;]*", block[0][match.end():])[0].rpartition(")")[0]
            types = (re.sub(r"\b\w+\s*(?:=.*)?$", "", each.strip()) for each in re.split(r",(?![^<]*>)", parameters))
            yield f"{match[1]}({', '.join(' '.join(each.split()) for each in types)})", block.start() + match.start()


def lint_test_names(root, sources):
    """Yields what two sources of a test program define alike: it does not compile once they come into one unit, which
    depends on how many sources there are before them."""
    first = {}
    functions = {}
    for name, program in test_programs(root).items():
        text = sources[name].text if name in sources else ""
        for what, start in definitions_of_test(text):
            function, is_function, _ = what.partition("(")
            # A function hides a type of its name.
            same = first.get((program, function)) if is_function else functions.get((program, what))
            other = same or first.setdefault((program, what), name)
            if is_function:
                functions.setdefault((program, function), name)
            if other != name:
                yield (f"{name}:{text.count(chr(10), 0, start) + 1}: sources of one test program give what they define "
                       f"different names ({what}, also {other})")


def count_lines(root):
    """(file, number of lines) of all source files, longest first."""
    paths = [path for tree in TREES for path in (root / tree).rglob("*")
             if path.suffix in (".h", ".cpp", ".py", ".sh", ".cmake")]
    counts = [(path.relative_to(root).as_posix(), len(path.read_text("utf-8").splitlines()))
              for path in paths]
    return sorted(counts, key=lambda count: (-count[1], count[0]))


def lint_extras(root, sources):
    """Yields what extras include of other extras that their CMakeLists.txt does not name, nor those that it names."""
    used = {}
    for path in root.glob("*/extras/*/CMakeLists.txt"):
        match = USED_EXTRAS.search(path.read_text(encoding="utf-8"))
        folder, _, name = path.parent.relative_to(root).parts
        used[f"{folder}/{name}"] = match[1].split() if match else []

    def reached(extra):
        return {extra}.union(*(reached(other) for other in used.get(extra, [])))

    for source in sources.values():
        extra = EXTRA.match(source.name)
        for line, own, _ in source.includes:
            other = own and EXTRA.match(own)
            if extra and other and f"{other[1]}/{other[2]}" not in reached(f"{extra[1]}/{extra[2]}"):
                yield (f"{source.name}:{line}: an extra's CMakeLists.txt names the extras that it uses "
                       f"({other[1]}/{other[2]})")


def lint_sizes(root):
    for name, lines in count_lines(root):
        if lines > MAX_FILE_LINES:
            yield f"{name}:{MAX_FILE_LINES}: a file has at most {MAX_FILE_LINES} lines ({lines})"


def lint_listed_sources(root):
    """Yields the sources that CMake's lists name below the project and that do not exist: what is
    built by an option that few use, such as the fuzzers, would be missed else."""
    for path in sorted(root.glob("*/**/CMakeLists.txt")):
        if path.relative_to(root).parts[0] not in TREES:
            continue
        text = path.read_text(encoding="utf-8")
        for match in LISTED_SOURCE.finditer(text):
            if not (root / match[1]).exists():
                line = text.count("\n", 0, match.start()) + 1
                yield f"{path.relative_to(root).as_posix()}:{line}: a source that is listed exists ({match[1]})"


def lint(root):
    """Every fault of the tree at `root`."""
    sources = read_sources(root)
    return [*lint_includes(sources), *lint_rooms(sources), *lint_fragments(sources), *lint_cycles(sources), *lint_units(sources),
            *lint_unique_types(sources), *lint_anonymous_names(sources), *lint_test_names(root, sources),
            *lint_sizes(root), *lint_extras(root, sources), *lint_listed_sources(root), *lint_named_rooms(root)]


def main(arguments):
    here = pathlib.Path(__file__).resolve()
    root = pathlib.Path(arguments[1]).resolve() if len(arguments) > 1 else here.parents[2]
    for name, lines in count_lines(root):
        if LONG_FILE_LINES < lines <= MAX_FILE_LINES:
            print(f"long: {name}: {lines} lines")
    faults = lint(root)
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
