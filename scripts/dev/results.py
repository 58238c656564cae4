#!/usr/bin/env python3
"""Holds the figures of the pages against docs/results/results.json, which scripts/dev/measure_results.py writes.

    results.py [check] [ROOT]   prints a line for each place where a page and the file differ; exits 1 if there is any
    results.py fill [ROOT]      puts the file's figures into the pages

A page takes figures in these ways:

    <!-- results: PART/TABLE -->       the table below has the file's figures in the columns and rows that it names.
                                       With "all" after the table's name it has all of the file's rows.
    <!-- results: PART/TABLE whole --> the table below is the file's, with its heading; fill writes all of it
    6.7<!-- r: PART/TABLE ; ROW ; COLUMN -->   the number before the mark is a cell of the file; rows with several
                                               keys are named by all of them, divided by ;
                                               ROW may be "least" or "most": the column's least or greatest number
    <!-- made: PART... -->             the line below says where and when these parts were measured

The page decides how many digits it shows: the file's figure is rounded to as many. A column that the file's table
does not have is the page's own, and holds no figures. A whole table shows three digits of numbers with a point.
"""

import decimal
import json
import pathlib
import re
import sys

FILE = "docs/results/results.json"
NUMBER = re.compile(r"[-+]?\d[\d,]*(?:\.\d+)?")
TABLE = re.compile(r"<!-- results: (\S+?)( all)? -->\n(?:\n)?((?:\|.*\n)+)")
WHOLE = re.compile(r"<!-- results: (\S+) whole -->\n(?:\|.*\n)*")
INLINE = re.compile(r"([-+]?\d[\d,]*(?:\.\d+)?)<!-- r:\s+(\S+)\s+;\s+([^>]*?)\s+;\s+([^;>]*?)\s+-->")
MADE = re.compile(r"<!-- made: (\S+(?: \S+)*) -->\n(?:\*.*\*\n)?")
MARK = re.compile(r"<!-- (?:results|r|made):\s")


class Fault(Exception):
    """A mark that the file cannot answer."""


def rounded(figure, shown):
    """A figure of the file with as many decimal places as the shown one has, at most its own."""
    places = len(shown.partition(".")[2])
    if places >= len(figure.partition(".")[2]):
        return figure
    value = decimal.Decimal(figure.replace(",", ""))
    value = value.quantize(decimal.Decimal(1).scaleb(-places), rounding=decimal.ROUND_HALF_UP)
    text = f"{value:,}" if "," in figure else str(value)
    return "+" + text if figure.startswith("+") else text


def as_shown(cell, shown):
    """A cell of the file, its numbers rounded as on the page where the page shows the same but for numbers."""
    numbers = NUMBER.findall(shown)
    if NUMBER.sub("#", cell) != NUMBER.sub("#", shown):
        return cell
    return NUMBER.sub(lambda match: rounded(match[0], numbers.pop(0)), cell)


def cells_of(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def plain(cell):
    return " ".join(cell.replace("`", "").split())


def table_of(results, name):
    part, _, table = name.partition("/")
    if table not in results.get(part, {}).get("tables", {}):
        raise Fault(f"the file has the table ({name})")
    return results[part]["tables"][table]


def row_of(table, keys):
    """The file's row with these keys."""
    for row in table["rows"]:
        if [plain(cell) for cell in row[:table["keys"]]] == keys:
            return row
    raise Fault(f"the file has the row ({' | '.join(keys)})")


def column_of(table, heading):
    headings = [plain(each) for each in table["columns"]]
    if plain(heading) not in headings:
        raise Fault(f"the file has the column ({heading})")
    return headings.index(plain(heading))


def figure_of(table, keys, heading):
    """A cell of the file, or the least or greatest number of a column."""
    column = column_of(table, heading)
    if keys not in (["least"], ["most"]):
        return row_of(table, keys)[column]
    numbers = [row[column] for row in table["rows"] if NUMBER.fullmatch(row[column])]
    if not numbers:
        raise Fault(f"the file's column has numbers ({heading})")
    return {"least": min, "most": max}[keys[0]](numbers, key=lambda cell: float(cell.replace(",", "")))


def in_three_digits(cell):
    """A number with a point in three digits, or fewer if it has fewer; anything else as it is."""
    if "." not in cell or not NUMBER.fullmatch(cell):
        return cell
    places = max(0, 2 - decimal.Decimal(cell.replace(",", "")).adjusted())
    return rounded(cell, "." + places * "0")


def whole_table(table):
    """The lines of the file's table, with its heading."""
    lines = [table["columns"], *([in_three_digits(cell) for cell in row] for row in table["rows"])]
    heading, *rows = ["| " + " | ".join(cells) + " |" for cells in lines]
    return [heading, "|" + "---|" * len(table["columns"]), *rows]


def table_as_measured(results, name, is_whole, lines):
    """The lines of a page's table with the file's figures."""
    table = table_of(results, name)
    headings = cells_of(lines[0])
    known = [plain(each) for each in table["columns"]]
    places = [known.index(plain(each)) if plain(each) in known else None for each in headings]
    missing = [each for each in table["columns"][:table["keys"]] if plain(each) not in map(plain, headings)]
    if missing:
        raise Fault(f"the table has the columns of the rows' names ({', '.join(missing)})")
    shown = {}
    for line in lines[2:]:
        cells = cells_of(line)
        shown[tuple(plain(cells[places.index(key)]) for key in range(table["keys"]))] = cells
    rows = [tuple(plain(cell) for cell in row[:table["keys"]]) for row in table["rows"]] if is_whole else list(shown)
    made = lines[:2]
    for keys in rows:
        row, cells = row_of(table, list(keys)), shown.get(keys, [""] * len(headings))
        own = [cell for cell, place in zip(cells, places) if place is None]
        if any(re.match(r"[-+]?\d", cell) for cell in own):
            raise Fault(f"figures stand in columns of the file ({' | '.join(keys)}: {', '.join(own)})")
        made.append("| " + " | ".join(cell if place is None else as_shown(row[place], cell)
                                      for cell, place in zip(cells, places)) + " |")
    return made


def made_line(results, parts):
    """Where and when parts were measured, as a line of a page; parts are named where they differ in it."""
    parts_by_words = {}
    for part in parts:
        if part not in results:
            raise Fault(f"the file has the part ({part})")
        made = results[part]["made"]
        said = [made["machine"], made["date"], f"revision {made['revision']}", made.get("note", "")]
        parts_by_words.setdefault("; ".join(each for each in said if each), []).append(part)
    if len(parts_by_words) == 1:
        return f"*{next(iter(parts_by_words))}.*"
    return "*" + " ".join(f"{', '.join(named)}: {words}." for words, named in parts_by_words.items()) + "*"


def filled(text, results, complain):
    """A page with the file's figures. `complain` is called with a place and a rule for each mark without an answer."""
    def replaced(pattern, replacement, text):
        def one(match):
            try:
                return replacement(match)
            except Fault as fault:
                complain(match.start(), str(fault))
                return match[0]
        return pattern.sub(one, text)

    def table(match):
        lines = match[3].splitlines()
        head = match[0][:len(match[0]) - len(match[3])]
        return head + "\n".join(table_as_measured(results, match[1], match[2], lines)) + "\n"

    def inline(match):
        keys = [plain(each) for each in match[3].split(";")]
        figure = figure_of(table_of(results, match[2]), keys, match[4])
        if not NUMBER.fullmatch(figure):
            raise Fault(f"the file's cell is a number ({figure})")
        return rounded(figure, match[1]) + match[0][len(match[1]):]

    def whole(match):
        return "\n".join([f"<!-- results: {match[1]} whole -->", *whole_table(table_of(results, match[1])), ""])

    text = replaced(TABLE, table, text)
    text = replaced(WHOLE, whole, text)
    text = replaced(INLINE, inline, text)
    return replaced(MADE, lambda match: f"<!-- made: {match[1]} -->\n{made_line(results, match[1].split())}\n", text)


def pages_of(root):
    return sorted([root / "README.md", *(root / "docs").rglob("*.md"), *(root / "scenarios").glob("*.md")])


def lint(root):
    """A line for each place where a page and the file differ."""
    results = json.loads((root / FILE).read_text(encoding="utf-8"))
    for page in pages_of(root):
        text, name, faults = page.read_text(encoding="utf-8"), page.relative_to(root).as_posix(), []
        new = filled(text, results, lambda place, rule: faults.append((text.count("\n", 0, place) + 1, rule)))
        read = sum(len(pattern.findall(text)) for pattern in (TABLE, WHOLE, INLINE, MADE))
        if read != len(MARK.findall(text)):
            faults.append((1, f"every mark stands at a table, after a number or above a line "
                              f"({len(MARK.findall(text)) - read} do not)"))
        if not faults:
            pairs = zip(text.splitlines(), new.splitlines())
            faults = [(line + 1, f"figures are those of {FILE} ({was} instead of {now})")
                      for line, (was, now) in enumerate(pairs) if was != now]
            if not faults and new != text:
                faults = [(1, f"tables have the rows of {FILE}")]
        for line, rule in faults:
            yield f"{name}:{line}: {rule}"


def fill(root):
    results = json.loads((root / FILE).read_text(encoding="utf-8"))
    for page in pages_of(root):
        text = page.read_text(encoding="utf-8")
        new = filled(text, results, lambda place, rule: None)
        if new != text:
            page.write_text(new, encoding="utf-8")


def main(arguments):
    command = arguments.pop(0) if arguments and arguments[0] in ("check", "fill") else "check"
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parents[2]).resolve()
    if command == "fill":
        fill(root)
    faults = list(lint(root))
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
