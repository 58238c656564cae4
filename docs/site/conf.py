"""Sphinx's settings for the site that scripts/make_site.sh makes of README, docs and the public interfaces."""

import os
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]

project = "railcast"
html_title = "railcast"
copyright = "the railcast authors"  # pylint: disable=redefined-builtin
_cmake = (ROOT / "CMakeLists.txt").read_text("utf-8")
version = re.search(r"^project\(railcast VERSION (\S+)", _cmake, re.M)[1]
version += re.search(r'^set\(RAILCAST_PRERELEASE "(.*)"\)', _cmake, re.M)[1]
html_theme = "furo"  # Light and dark, and for narrow screens, too.
html_copy_source = False
root_doc = "README"

extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc"]
myst_heading_anchors = 6
# What scripts/dev/lint_docs.py holds: links. Headings and pieces of JSON are read by people.
suppress_warnings = ["myst.header", "ref.myst", "misc.highlighting_failure"]
breathe_projects = {project: os.environ["RAILCAST_DOXYGEN_XML"]}
breathe_default_project = project
breathe_domain_by_file_pattern = {"*/c_api.h": "c"}
breathe_show_include = False
primary_domain = "cpp"


def contents(all_pages):
    """The trees of contents: pages in the groups of docs/index.md, interfaces, the rest."""
    text = "## Start\n[](index.md)" + (ROOT / "docs/index.md").read_text("utf-8")
    parts = re.split(r"^## (.*)$", text, flags=re.MULTILINE)
    groups, seen = {}, {root_doc}
    for caption, part in zip(parts[1::2], parts[2::2]):
        links = (os.path.normpath(f"docs/{link}") for link in re.findall(r"\]\(([^)#]+)\.md", part))
        groups[caption] = [page for page in dict.fromkeys(links) if page not in seen]
        seen.update(groups[caption])
    groups["Interfaces"] = ["api/cpp", "api/c", "api/python"]
    groups["More"] = [page for page in sorted(all_pages - seen) if not page.startswith("api/")]
    return "".join(f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n\n" + "\n".join(pages) + "\n```\n"
                   for caption, pages in groups.items())


def add_contents(app, name, text):
    if name == root_doc:
        text[0] += contents(app.env.found_docs)


def keep_indented_blocks(_app, _what, _name, _object, _options, lines):
    """Indented blocks of docstrings stand as they are written."""
    is_inside = False
    for at in range(len(lines) - 1, -1, -1):
        is_block = lines[at].startswith("    ") or (is_inside and not lines[at])
        if is_inside and not is_block:
            lines[at + 1:at + 1] = ["", "::", ""]
        is_inside = is_block


def setup(app):
    app.connect("source-read", add_contents)
    app.connect("autodoc-process-docstring", keep_indented_blocks)
