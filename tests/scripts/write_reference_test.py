"""Whether docs/reference.md is what scripts/dev/write_reference.py prints, and what it makes of small
schemas."""

import contextlib
import io
import json
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts/dev"))
import write_reference  # noqa: E402 (found through the line above)


def printed(*arguments):
    text = io.StringIO()
    with contextlib.redirect_stdout(text):
        write_reference.main(list(arguments))
    return text.getvalue()


def lines_of(properties, **others):
    """The lines after the head for a scenario of these keys, without empty ones."""
    schema = {"properties": properties, **others}
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "schema.json"
        path.write_text(json.dumps(schema), encoding="utf-8")
        text = printed(str(path))
    body = text.removeprefix(write_reference.HEAD)
    return [line for line in body.splitlines() if line and not line.startswith(("| key", "|---"))]


def held_by_file(schema):
    return {"anyOf": [{"type": "string", "description": "A file that holds it."}, schema]}


class Reference(unittest.TestCase):

    def test_the_kept_page_is_what_the_schema_gives(self):
        kept = (ROOT / "docs/reference.md").read_text(encoding="utf-8")
        self.assertEqual(kept, printed(), "run scripts/dev/write_reference.py > docs/reference.md")

    def test_a_key_has_its_limits_and_its_default(self):
        self.assertEqual(lines_of({
            "a_m": {"type": "number", "exclusiveMinimum": 0.0, "maximum": 1e9, "default": 2.5,
                    "description": "Length."},
            "kind": {"type": "string", "enum": ["x", "y"], "default": "x", "description": "Or."},
        })[1:], ["| `a_m` | above 0 to 1000000000 (`2.5`) | Length. |",
                 '| `kind` | `x`, `y` (`"x"`) | Or. |'])

    def test_neighbouring_keys_of_which_the_same_is_to_be_said_share_a_line(self):
        switch = {"type": "boolean", "description": "On or off."}
        self.assertEqual(lines_of({"a": switch, "b": switch, "c": {"type": "boolean"}})[1:], [
            "| `a`, `b` | true, false | On or off. |", "| `c` | true, false |  |"])

    def test_what_a_file_can_hold_says_so_and_its_keys_follow(self):
        part = held_by_file({"type": "object", "properties": {
            "file": {"type": "string", "description": write_reference.INCLUSION},
            "b": {"type": "boolean", "description": "B."}},
            "anyOf": [{"required": ["file"]}, {"required": ["b"]}]})
        self.assertEqual(lines_of({"part": {**part, "description": "Part."}})[1:], [
            "| `part` | object, or file | Part. |", "## `part`",
            "| `b` | true, false (required) | B. |"])

    def test_elements_of_lists_and_choices_have_tables_of_their_own(self):
        choice = {"type": "object", "properties": {"type": {"const": "dot"}, "b": {"type": "boolean"}},
                  "required": ["type"]}
        lines = lines_of({"all": {"type": "array", "minItems": 1, "description": "All.", "items": {
            "type": "object", "properties": {"one": {"oneOf": [choice], "description": "One."}}}}})
        self.assertEqual(lines[1:], [
            "| `all` | list of 1 or more objects | All. |", "## `all[]`",
            "| `one` | object | One. |", "### `all[].one (dot)`", "| `b` | true, false |  |"])

    def test_a_choice_names_the_keys_that_it_has_as_an_earlier_one(self):
        def choice(name, **keys):
            return {"type": "object", "properties": {"type": {"const": name}, **keys}}
        size, flag = {"type": "number", "minimum": 1.0}, {"type": "boolean"}
        lines = lines_of({"one": {"oneOf": [choice("dot", size=size), choice("bar", size=size, is_long=flag),
                                            choice("dash", size=size)]}})
        self.assertEqual(lines[1:], [
            "| `one` | object |  |", "## `one (dot)`", "| `size` | at least 1 |  |",
            "## `one (bar)`", "| `is_long` | true, false |  |", "Also `size` as of `dot`.",
            "## `one (dash)`", "Also `size` as of `dot`."])

    def test_a_small_object_has_no_table_of_its_own(self):
        point = {"type": "object", "properties": {"s_m": {"type": "number"}}}
        points = {"type": "array", "items": point}
        self.assertEqual(lines_of({"way": {"type": "object", "properties": {"from": points, "to": point}}})[1:], [
            "| `way` | object |  |", "## `way`", "| `from` | list of objects |  |",
            "| `from[].s_m` | number |  |", "| `to` | object, as `way.from[]` |  |"])

    def test_an_object_names_several_keys_that_it_has_as_an_earlier_one(self):
        place = {"s_m": {"type": "number"}, "d_m": {"type": "number", "minimum": 1.0}}
        flag = {"type": "boolean"}
        self.assertEqual(lines_of({
            "p": {"type": "object", "properties": place},
            "q": {"type": "object", "properties": {**place, "b": flag}},
            "r": {"type": "object", "properties": {"b": flag, "c": {"type": "string"}}}})[-6:], [
                "## `q`", "| `b` | true, false |  |", "Also `s_m`, `d_m` as of `p`.",
                "## `r`", "| `b` | true, false |  |", "| `c` | text |  |"])

    def test_open_lists_of_names_are_printed_once(self):
        kind = {"type": "string", "examples": ["x", "y"]}
        first = {"type": "object", "properties": {"kind": kind}}
        later = {"type": "object", "properties": {"kind": kind, "b": {"type": "boolean"}}, "required": ["kind"]}
        self.assertEqual(lines_of({"p": first, "q": later})[-3:], [
            "## `q`", "| `kind` | text, as `p.kind` (required) |  |", "| `b` | true, false |  |"])

    def test_what_has_been_described_is_not_described_again(self):
        part = {"type": "object", "properties": {"b": {"type": "boolean"}}}
        self.assertEqual(lines_of({"p": part, "q": part})[-2:], ["## `q`", "As `p`."])


if __name__ == "__main__":
    unittest.main()
