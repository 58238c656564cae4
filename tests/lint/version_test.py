"""Whether everything that names railcast's version names the one of CMakeLists.txt."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def found(file, pattern):
    return re.findall(pattern, (ROOT / file).read_text(encoding="utf-8"), re.MULTILINE)


class Version(unittest.TestCase):
    """The wheel of the Python module takes it from CMakeLists.txt."""

    number = found("CMakeLists.txt", r"^project\(railcast VERSION (\d+\.\d+\.\d+) ")[0]
    version = number + found("CMakeLists.txt", r'^set\(RAILCAST_PRERELEASE "(.*)"\)')[0]

    def test_the_citation_names_it(self):
        self.assertEqual(found("CITATION.cff", r"^version: (.*)$"), [self.version])

    def test_the_list_of_changes_begins_with_it(self):
        self.assertEqual(found("CHANGELOG.md", r"^## (.*)$")[0], self.version)

    def test_examples_and_pages_ask_for_it(self):
        for file in ("examples/CMakeLists.txt", "docs/embedding.md", "docs/engine.md"):
            self.assertEqual(found(file, r"find_package\(railcast (\S+) "), [self.number.rpartition(".")[0]], file)


if __name__ == "__main__":
    unittest.main()
