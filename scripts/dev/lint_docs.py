#!/usr/bin/env python3
"""Checks the links and the length of the Markdown pages.

Usage: lint_docs.py [ROOT]

Prints one line per fault, "file:line: rule (what was found)", and exits 1 if there is any: links to
files or headings that do not exist, links of the site's pages to files that scripts/make_site.sh does
not put into it, names of files that do not exist, pages of docs that docs/index.md has no link to,
pictures of docs/images that no page shows or that lack words of their source, scripts of figures that
do not exist, quotes that are not in the file that they are from, recipes of CONTRIBUTING.md that name a
file that does not exist, more than MOST_FILES, or no test or example that is compiled, and a manual of
more words than MOST_WORDS permits. Prints how many words the manual has.
"""

import html
import pathlib
import re
import sys
import textwrap
import urllib.parse

START = "docs/index.md"
RESULTS = "docs/results"  # What was measured.
GENERATED = ("docs/reference.md", "docs/records.md", "docs/remarks.md")  # From the descriptions of keys.
# What a user reads: README and docs, without the generated reference and the results. The number only goes down.
MOST_WORDS = {"the manual": 55_000}
SITE = ("docs", "examples", "scenarios", "scripts")  # The folders whose pages and files the site has.
NOT_OURS = ("build", "out", ".git")  # Folders whose pages are not part of the project.

FENCE = re.compile(r"^(```+|~~~+).*?^\1[ \t]*$", re.MULTILINE | re.DOTALL)
INLINE_CODE = re.compile(r"(`+)(?!`).+?(?<!`)\1(?!`)")
LINK = re.compile(r"\]\(\s*<?([^()\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)")
MADE_BY = re.compile(r"<!-- figures: (scripts/\S+)")  # Beside a table: what made its figures.
QUOTE = re.compile(r"<!-- from (\S+) -->\n(?:```\w*\n(.*?)^```)?", re.MULTILINE | re.DOTALL)  # Above a quote: whose.
# A file of the project; capitals stand for any name.
NAMED_FILE = re.compile(r"`((?:core|generator|analysis|viewer|tests|scripts|examples)/[\w/.*-]+\.(?:h|cpp|py|sh|json|md))`"
                        r"(?!\s+of\s+revision)")
RECIPES = "CONTRIBUTING.md"
RECIPE = re.compile(r"^\*\*(an? [^*]+)\*\*(.*?)(?=^\*\*an? |^#|\Z)", re.MULTILINE | re.DOTALL)
FILE_OF_RECIPE = re.compile(r"`([\w./*-]+\.(?:h|cpp|c|py|sh|json|md|txt))`|\]\(([\w./-]+)\)")
MOST_FILES = 6
LABEL = re.compile(r'label="([^"]*)"')  # In a text for graphviz.
HEADING = re.compile(r"^#{1,6}[ \t]+(.+?)[ \t]*#*$", re.MULTILINE)

def blanked(match):
    """The same number of lines and letters, without content."""
    return re.sub(r"[^\n]", " ", match[0])

def slug(heading, seen):
    """The anchor that GitHub makes of a heading; `seen` counts the page's anchors so far."""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
    text = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
    count = seen.get(text, 0)
    seen[text] = count + 1
    return f"{text}-{count}" if count else text

class Page:
    """A page's links, each with its line, and its anchors."""

    def __init__(self, path):
        text = FENCE.sub(blanked, path.read_text(encoding="utf-8"))
        seen = {}
        self.anchors = {slug(match[1], seen) for match in HEADING.finditer(text)}
        self.links = [(text.count("\n", 0, match.start()) + 1, match[1])
                      for match in LINK.finditer(INLINE_CODE.sub(blanked, text))]

def read_pages(root):
    """{path: page} of all Markdown files of the project."""
    paths = [path for path in sorted(root.rglob("*.md"))
             if path.relative_to(root).parts[0] not in NOT_OURS]
    return {path: Page(path) for path in paths}

def targets_of(path, page):
    """Yields (line, link, file, anchor) of the page's links into the project."""
    for line, link in page.links:
        if re.match(r"[a-z]+:", link):
            continue
        name, _, anchor = urllib.parse.unquote(link).partition("#")
        yield line, link, (path.parent / name).resolve() if name else path, anchor

def lint_links(root, pages):
    def of_site(path):
        return path.parent == root or path.is_relative_to(root) and path.relative_to(root).parts[0] in SITE

    for path, page in pages.items():
        place = path.relative_to(root).as_posix()
        for line, link, target, anchor in targets_of(path, page):
            if not target.exists():
                yield f"{place}:{line}: a link leads to a file that exists ({link})"
            elif target.is_file() and of_site(path) and not of_site(target):
                yield f"{place}:{line}: a page of the site leads to a file of the site ({link})"
            elif anchor and target in pages and anchor not in pages[target].anchors:
                yield f"{place}:{line}: a link leads to a heading of the page ({link})"

def lint_named_files(root, pages):
    """Yields the files that pages name, but for the list of changes, and that do not exist."""
    for path in pages:
        text = path.read_text(encoding="utf-8")
        for match in NAMED_FILE.finditer(text):
            if path.name == "CHANGELOG.md" or any(root.glob(re.sub("[A-Z]{2,}", "*", match[1]))):
                continue
            line = text.count("\n", 0, match.start()) + 1
            yield f"{path.relative_to(root).as_posix()}:{line}: a file that a page names exists ({match[1]})"

def lint_start_page(root, pages):
    """Yields the pages of docs that the start page has no link to, and the results that no page has a link to."""
    start = root / START
    linked = {target for _, _, target, _ in targets_of(start, pages[start])} if start in pages else set()
    linked_anywhere = {target for path, page in pages.items()
                       for _, _, target, _ in targets_of(path, page) if target != path}
    for path in pages:
        if path.parent == start.parent and path != start and path not in linked:
            yield f"{path.relative_to(root).as_posix()}:1: {START} has a link to every page of docs"
        elif path.parent == root / RESULTS and path not in linked_anywhere:
            yield f"{path.relative_to(root).as_posix()}:1: a page has a link to every page of results"

def lint_pictures(root, pages):
    """Yields the pictures that no page shows."""
    shown = {target for path, page in pages.items() for _, _, target, _ in targets_of(path, page)}
    sources = {".dot"}  # Of drawings that stand beside them.
    for path in sorted((root / "docs/images").rglob("*")):
        if path.is_file() and path.suffix not in sources and path not in shown:
            yield f"{path.relative_to(root).as_posix()}:1: a page shows every picture of docs/images"

def lint_drawings(root):
    """Yields the words of the texts for graphviz that the drawings made of them lack."""
    for path in sorted((root / "docs/images").glob("*.dot")):
        place, drawing = path.relative_to(root).as_posix(), path.with_suffix(".svg")
        drawn = html.unescape(drawing.read_text(encoding="utf-8")) if drawing.exists() else ""
        drawn = drawn.replace("\u00a0", " ")
        for label in LABEL.findall(path.read_text(encoding="utf-8")):
            for line in label.split("\\n"):
                if line not in drawn:
                    yield f"{place}:1: the drawing has the words of its source ({line})"

def lint_figures(root, pages):
    """Yields the scripts that made figures of a page and do not exist."""
    for path in pages:
        text = path.read_text(encoding="utf-8")
        for match in MADE_BY.finditer(text):
            if not (root / match[1]).exists():
                line = text.count("\n", 0, match.start()) + 1
                yield (f"{path.relative_to(root).as_posix()}:{line}: figures are made by a script "
                       f"that exists ({match[1]})")

def lint_quotes(root, pages):
    """Yields the quotes that are no lines of their file, be they indented there or not."""
    for path in pages:
        text = path.read_text(encoding="utf-8")
        for match in QUOTE.finditer(text):
            name, quote = match[1], match[2]
            whole = "\n" + (root / name).read_text(encoding="utf-8") if (root / name).exists() else ""
            if not quote or not any("\n" + textwrap.indent(quote, " " * n) in whole for n in range(9)):
                line = text.count("\n", 0, match.start()) + 1
                yield f"{path.relative_to(root).as_posix()}:{line}: a quote stands in its file ({name})"


def compiled_sources(root):
    """What the CMakeLists.txt files of tests and examples list."""
    return {(path.parent / word).resolve() for tree in ("tests", "examples") for path in (root / tree).rglob("CMakeLists.txt")
            for word in re.findall(r"[\w./-]+\.(?:cpp|c)\b", path.read_text(encoding="utf-8"))}


def lint_recipes(root):
    """Yields the recipes that are not of few files that exist, with a test or an example among them."""
    page = root / RECIPES
    text = page.read_text(encoding="utf-8") if page.exists() else ""
    compiled = compiled_sources(root)
    for match in RECIPE.finditer(text):
        place = f"{RECIPES}:{text.count(chr(10), 0, match.start()) + 1}"
        names = sorted({code or link for code, link in FILE_OF_RECIPE.findall(match[2])})
        for name in names:
            if not any(root.glob(re.sub("[A-Z]{2,}", "*", name))):
                yield f"{place}: a file of a recipe exists ({name})"
        if len(names) > MOST_FILES:
            yield f"{place}: a recipe names at most {MOST_FILES} files ({len(names)}, {match[1]})"
        if compiled.isdisjoint(root / name for name in names):
            yield f"{place}: a recipe names a test or an example that is compiled ({match[1]})"


def words_of_manual(root):
    """How many words README and the pages of docs have that are neither generated nor results."""
    pages = [root / "README.md", *(root / "docs").rglob("*.md")]
    return sum(len(page.read_text(encoding="utf-8").split()) for page in pages
               if page.exists() and page.parent != root / RESULTS
               and page.relative_to(root).as_posix() not in GENERATED)

def lint_words(root):
    """Yields the manual if it has more words than it may."""
    words, most = words_of_manual(root), MOST_WORDS["the manual"]
    if words > most:
        yield f"docs:1: the manual has at most {most} words ({words})"

def lint(root):
    """Every fault of the pages in the tree at `root`."""
    pages = read_pages(root)
    return [*lint_links(root, pages), *lint_named_files(root, pages), *lint_start_page(root, pages),
            *lint_pictures(root, pages), *lint_drawings(root), *lint_figures(root, pages), *lint_quotes(root, pages),
            *lint_recipes(root), *lint_words(root)]

def main(arguments):
    here = pathlib.Path(__file__).resolve()
    root = pathlib.Path(arguments[1]).resolve() if len(arguments) > 1 else here.parents[2]
    faults = lint(root)
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"{words_of_manual(root)} words in the manual")
    return 1 if faults else 0

if __name__ == "__main__":
    sys.exit(main(sys.argv))
