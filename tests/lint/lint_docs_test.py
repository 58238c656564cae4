"""Each test plants a small tree of pages and reads what scripts/dev/lint_docs.py says of it."""

import pathlib
import sys
import tempfile
import unittest
import unittest.mock

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts/dev"))
import lint_docs  # noqa: E402 (found through the line above)


def faults_of(files):
    """The faults of a tree with these files: {name: text}."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder).resolve()
        for name, text in files.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return lint_docs.lint(root)


class Links(unittest.TestCase):

    def test_a_link_leads_to_a_file_that_exists(self):
        self.assertEqual(faults_of({"README.md": "\n[a](b.md) [c](d/e.md)", "b.md": ""}),
                         ["README.md:2: a link leads to a file that exists (d/e.md)"])

    def test_a_link_leads_to_a_heading_of_the_page(self):
        self.assertEqual(faults_of({"README.md": "[a](b.md#one-two) [a](b.md#two)",
                                    "b.md": "# One: two!"}),
                         ["README.md:1: a link leads to a heading of the page (b.md#two)"])

    def test_a_page_of_the_site_leads_to_files_of_the_site(self):
        self.assertEqual(faults_of({"docs/index.md": "[a](../core/x.h) [b](../core) [c](../scripts/y.py)",
                                    "core/x.h": "", "core/z.md": "[x](x.h)", "scripts/y.py": ""}),
                         ["docs/index.md:1: a page of the site leads to a file of the site (../core/x.h)"])

    def test_a_file_that_a_page_names_exists(self):
        self.assertEqual(faults_of({"a.md": "`core/x.h` `core/NAME.h` `core/y.h`\n`core/z.h`\nof revision 1 `docs/w.md`",
                                    "CHANGELOG.md": "`core/y.h`", "core/x.h": ""}),
                         ["a.md:1: a file that a page names exists (core/y.h)"])

    def test_headings_of_the_page_itself_are_found_and_equal_ones_are_counted(self):
        self.assertEqual(faults_of({"a.md": "# `x_y` (a)\n## Same\n## Same\n"
                                            "[a](#x_y-a) [b](#same) [c](#same-1) [d](#same-2)"}),
                         ["a.md:4: a link leads to a heading of the page (#same-2)"])

    def test_code_has_no_links_and_no_headings(self):
        self.assertEqual(faults_of({"a.md": "```\n# x\n[a](b)\n```\n`[a](b)` [a](#x)"}),
                         ["a.md:5: a link leads to a heading of the page (#x)"])

    def test_addresses_of_other_sites_are_not_followed(self):
        self.assertEqual(faults_of({"a.md": "[a](https://example.org/b.md)"}), [])

    def test_folders_that_are_not_part_of_the_project_are_left_out(self):
        self.assertEqual(faults_of({"out/a.md": "[a](b.md)", "build/a.md": "[a](b.md)"}), [])


class Pages(unittest.TestCase):

    def test_the_start_page_has_a_link_to_every_page_of_docs(self):
        self.assertEqual(faults_of({"docs/index.md": "[a](a.md)", "docs/a.md": "[b](b.md)",
                                    "docs/b.md": "", "c.md": ""}),
                         ["docs/b.md:1: docs/index.md has a link to every page of docs"])

    def test_a_page_has_a_link_to_every_page_of_results(self):
        self.assertEqual(faults_of({"docs/index.md": "", "docs/notes/c.md": "[a](../results/a.md)",
                                    "docs/results/a.md": "", "docs/results/b.md": "[b](b.md)"}),
                         ["docs/results/b.md:1: a page has a link to every page of results"])

    def test_the_manual_has_no_more_words_than_it_may(self):
        files = {"README.md": "one two", "docs/index.md": "[a](results/a.md) [b](reference.md)", "docs/notes/c.md": "three",
                 "docs/results/a.md": "not counted", "docs/reference.md": "not counted", "CONTRIBUTING.md": "not counted"}
        with unittest.mock.patch.dict(lint_docs.MOST_WORDS, {"the manual": 5}):
            self.assertEqual(faults_of(files), [])
        with unittest.mock.patch.dict(lint_docs.MOST_WORDS, {"the manual": 4}):
            self.assertEqual(faults_of(files), ["docs:1: the manual has at most 4 words (5)"])

    def test_a_page_shows_every_picture(self):
        self.assertEqual(faults_of({"a.md": "![x](docs/images/x.png)", "docs/images/x.png": "",
                                    "docs/images/more/y.svg": "", "docs/images/y.dot": ""}),
                         ["docs/images/more/y.svg:1: a page shows every picture of docs/images"])

    def test_a_drawing_has_the_words_of_its_source(self):
        self.assertEqual(faults_of({"a.md": "![x](docs/images/x.svg)",
                                    "docs/images/x.dot": 'a [label="sensor&s\\nA\'s 60°"]',
                                    "docs/images/x.svg": "<text>A&#39;s 60&#176;</text>"}),
                         ["docs/images/x.dot:1: the drawing has the words of its source (sensor&s)"])

    def test_figures_are_made_by_a_script_that_exists(self):
        self.assertEqual(faults_of({"a.md": "\n<!-- figures: scripts/a.sh -->\n"
                                            "<!-- figures: scripts/b.sh OUT -->\n"
                                            "<!-- figures: build/c -->", "scripts/b.sh": ""}),
                         ["a.md:2: figures are made by a script that exists (scripts/a.sh)"])

    def test_quotes_stand_in_their_files(self):
        program = "int main() {\n  f();\n\n  g();\n}\n"
        for quote in ("int main() {\n", "f();\n\ng();\n", program):
            self.assertEqual(faults_of({"a.md": f"<!-- from b.c -->\n```c\n{quote}```\n", "b.c": program}), [])
        for quote in ("```c\ng();\n\nf();\n```", "```c\nmain() {\n```", "```c\n```", ""):
            self.assertEqual(faults_of({"a.md": f"\n<!-- from b.c -->\n{quote}\n", "b.c": program}),
                             ["a.md:2: a quote stands in its file (b.c)"])
        self.assertEqual(faults_of({"a.md": "<!-- from b.c -->\n```c\nf();\n```\n"}),
                         ["a.md:1: a quote stands in its file (b.c)"])

    def test_a_recipe_names_few_files_that_exist_and_a_test_that_is_compiled(self):
        files = {"core/x.cpp": "", "tests/core/x_test.cpp": "", "tests/CMakeLists.txt": "add(SOURCES core/x_test.cpp)",
                 "CONTRIBUTING.md": "## How\n\n**an x** (of y)\n1. In `core/x.cpp`,\n2. `tests/core/x_test.cpp`.\n"}
        self.assertEqual(faults_of(files), [])
        more = " ".join(f"`core/{letter}.h`" for letter in "abcde")
        headers = {f"core/{letter}.h": "" for letter in "abcde"}
        files["CONTRIBUTING.md"] += f"\n**a y**\n`tests/core/x_test.cpp`, {more}\n"
        self.assertEqual(faults_of({**files, **headers}), [])
        files["CONTRIBUTING.md"] += "and `core/x.cpp`\n"
        self.assertEqual(faults_of({**files, **headers}), ["CONTRIBUTING.md:7: a recipe names at most 6 files (7, a y)"])
        for name, other in {"core/z.json": ["CONTRIBUTING.md:7: a file of a recipe exists (core/z.json)"], "core/x.cpp": []}.items():
            files["CONTRIBUTING.md"] = f"\n\n\n\n\n\n**a y**\n`{name}`\n\n# After\n`tests/core/x_test.cpp` `core/n/a`\n"
            self.assertEqual([fault for fault in faults_of(files) if "that a page names" not in fault], [
                *other, "CONTRIBUTING.md:7: a recipe names a test or an example that is compiled (a y)"])


if __name__ == "__main__":
    unittest.main()
