#!/usr/bin/env python3
"""Prints docs/reference.md, the tables of all keys of a scenario, as its JSON Schema has them.

usage: write_reference.py [SCHEMA] > docs/reference.md

SCHEMA is scenarios/schema/scenario.schema.json unless given.
"""

import itertools
import json
import pathlib
import sys

SCHEMA = pathlib.Path(__file__).resolve().parents[2] / "scenarios/schema/scenario.schema.json"

HEAD = """# Reference: every key of a scenario

<!-- Written by scripts/dev/write_reference.py from scenarios/schema/scenario.schema.json: do not edit. -->

[scenario.md](scenario.md) explains how keys work together and how a file is read. [effects.md](effects.md) describes
the effects, [world.md](world.md) and the pages that it leads to describe the world.

- Keys may be left out unless *required* is in brackets. Unknown keys are errors. A range such as *0 to 1* is that of a number.
- `…[]` stands for every element of a list. An object whose heading ends in parentheses has the required key `type`
  with that value.
- What is marked *or file* can be the name of a file that holds it. Such an object can also have a key `file`: the file
  has the keys that are not given beside it ([inclusion](scenario.md#inclusion)), and nothing else is required.
- A file has `"version": 1`, and may name its schema with `$schema`.
"""
INCLUSION = "Has the keys that are not given here."  # Of a key `file`.

EXPLAINED_IN = {
    "tolerance": "frontier.md#no-more-than-a-scene-needs", "effects": "effects.md",
    "lidar": "scenario.md#sensors", "lidars[]": "scenario.md#several-sensors",
    "lidar.plausibility": "effects.md#threshold", "lidar.cover": "effects.md#cover",
    "weather": "scenario.md#weather", "interfaces": "live.md", "camera": "camera.md",
    "motion_sensors": "motion.md",
    "world": "world.md", "world.alignment": "world.md#the-line", "world.catenary": "structures.md#contact-line",
    "world.terrain": "land.md#terrain", "world.vegetation": "land.md#ground-and-vegetation",
    "world.structures[]": "structures.md#structures", "world.objects[]": "scenario.md#objects",
    "models[]": "models.md",
    "vehicle": "world.md#movement", "output": "files.md#fields", "materials[]": "scenario.md#materials",
}


def number(value):
    """Shortest text of a number, without a trailing .0."""
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e6:
        return str(int(value))
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def without_file(schema):
    """(the schema of what is written in place, whether a file may hold it)."""
    choices = schema.get("anyOf", [])
    in_place = [choice for choice in choices if choice.get("type") in ("object", "array")]
    if "type" not in schema and "oneOf" not in schema and len(in_place) == 1 and len(choices) == 2:
        return in_place[0], True
    return schema, False


def limits(schema):
    if "enum" in schema:
        return ", ".join(f"`{name}`" for name in schema["enum"])
    if "examples" in schema:
        return ", ".join(f"`{name}`" for name in schema["examples"]) + ", or a model of `models`"
    above, least = schema.get("exclusiveMinimum"), schema.get("minimum")
    below, most = schema.get("exclusiveMaximum"), schema.get("maximum")
    low = f"above {number(above)}" if above is not None else None if least is None else number(least)
    high = f"below {number(below)}" if below is not None else None if most is None else number(most)
    if low is not None and high is not None:
        return f"{low} to {high}"
    return f"at least {low}" if low is not None else f"at most {high}" if high is not None else ""


def count_of(schema):
    """How many elements a list has."""
    least, most = schema.get("minItems", 0), schema.get("maxItems")
    if most is None:
        return f"{least} or more " if least > 0 else ""
    return f"{most} " if least == most else f"{least} to {most} "


def kind(schema):
    schema, may_be_file = without_file(schema)
    names = {"number": "number", "integer": "whole number", "boolean": "true, false",
             "string": "text", "object": "object"}
    if "oneOf" in schema:
        return "object"
    if schema.get("type") == "array":
        element = kind(schema["items"]).removesuffix(", or file")
        plural = element.replace("list of", "lists of") if "list of" in element else element + "s"
        name = f"list of {count_of(schema)}{plural}"
    elif "const" in schema:
        name = f"`{schema['const']}`"
    else:
        name = names[schema["type"]]
    return name + ", or file" if may_be_file else name


def value_limits(schema):
    """Limits of a value, or of the elements of a list."""
    schema, _ = without_file(schema)
    return value_limits(schema["items"]) if schema.get("type") == "array" else limits(schema)


def required_keys(schema):
    keys = set(schema.get("required", []))
    for choice in schema.get("anyOf", []):
        if choice.get("required", ["file"]) != ["file"]:
            keys.update(choice["required"])
    return keys


def excluded(schema, key):
    """What the key cannot stand beside."""
    pair = schema.get("not", {}).get("required", [])
    return f" Not together with `{next(k for k in pair if k != key)}`." if key in pair else ""


def default_of(schema, key):
    value = schema["properties"][key].get("default")
    if value is None:
        return "required" if key in required_keys(schema) else ""
    text = json.dumps(value, ensure_ascii=False)
    if isinstance(value, float):
        text = number(value)
    elif isinstance(value, list) and all(isinstance(item, float) for item in value):
        text = f"[{', '.join(number(item) for item in value)}]"
    return f"`{text}`"


def description(schema):
    """Of a key; beside a file's name the description may stand with what is written in place."""
    return schema.get("description") or without_file(schema)[0].get("description", "")


def is_explained_in_head(key, schema):
    return key in ("$schema", "version") or (key == "file" and schema["description"] == INCLUSION)


def value_of(schema):
    """What a key takes: its kind with its limits, or the names to choose from."""
    what, bounds = kind(schema), value_limits(schema)
    if not bounds:
        return what
    return bounds if what in ("text", "number") else f"{what}, {bounds}"


def cells(schema, key, as_path=None):
    """What the table says of a key; `as_path`: of the object that has the same keys."""
    value, default = schema["properties"][key], default_of(schema, key)
    what = kind(value) if as_path else value_of(value)
    what += f", as `{as_path}`" if as_path else ""
    return what + (f" ({default})" if default else ""), description(value) + excluded(schema, key)


def in_table(schema):
    """The keys that a table has: neither what the head explains nor the `type` that a heading names."""
    return [key for key, value in schema["properties"].items()
            if not is_explained_in_head(key, value) and "const" not in value]


def element(path, schema):
    """(path, schema) of an object, or of the elements of a list of any depth."""
    schema, _ = without_file(schema)
    while schema.get("type") == "array":
        path += "[]"
        schema, _ = without_file(schema["items"])
    return path, schema


def is_small(schema):
    """Whether an object has no table of its own: up to four keys, none of them an object."""
    keys = in_table(schema)
    return len(keys) <= 4 and not any({"properties", "oneOf"} & element("", schema["properties"][key])[1].keys()
                                      for key in keys)


def table(cells_of):
    """Neighbouring keys of which the same is to be said share a line."""
    lines = ["| key | value (default) | meaning |", "|---|---|---|"]
    for cells, keys in itertools.groupby(cells_of, key=cells_of.get):
        names = ", ".join(f"`{key}`" for key in keys)
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in (names, *cells)) + " |")
    return "\n".join(lines)


def given_before(cells_of, choices):
    """{name of a choice: keys that it has alike}, of the earlier choices that have a key of this one."""
    found = {}
    for key, cells in cells_of.items():
        name = next((name for name, others in choices.items() if others.get(key) == cells), None)
        if name is not None:
            found.setdefault(name, []).append(key)
    return found


def see_of(path):
    page = EXPLAINED_IN.get(path)
    return f"See [{page.split('#')[0]}]({page})." if page else ""


class Writer:
    """Writes each object once; where it comes again, a reference to the first."""

    def __init__(self):
        self.seen = {}  # The schema's text: path.
        self.tables = {}  # Path: rows, of objects without a type.
        self.parts = []

    def write(self, path, schema):
        if "oneOf" in schema:
            before = {}
            for choice in schema["oneOf"]:
                name = choice["properties"]["type"]["const"]
                before[name] = self.write_object(f"{path} ({name})", choice, before)
        else:
            self.write_object(path, schema, {})

    def cells(self, path, schema, key):
        """Cells of a key; where its names to choose from have been listed before, they say where."""
        names = schema["properties"][key].get("examples")
        first = names and self.seen.setdefault(json.dumps(names), f"{path}.{key}")
        return cells(schema, key, first if first != f"{path}.{key}" else None)

    def rows(self, path, schema):
        """({key: cells}, [(path, schema)] of what has tables of its own)."""
        cells_of, others = {}, []
        for key in in_table(schema):
            inner_path, inner = element(f"{path}.{key}", schema["properties"][key])
            cells_of[key] = self.cells(path, schema, key)
            if inner_path in EXPLAINED_IN or "oneOf" in inner:
                others.append((inner_path, inner))
            elif "properties" in inner:
                first = self.seen.setdefault(text_of(inner), inner_path)
                if first != inner_path:
                    cells_of[key] = cells(schema, key, first)
                elif is_small(inner):
                    of_list = inner_path.removeprefix(f"{path}.")
                    cells_of |= {f"{of_list}.{name}": self.cells(inner_path, inner, name) for name in in_table(inner)}
                else:
                    others.append((inner_path, inner))
        return cells_of, others

    def given_elsewhere(self, cells_of):
        """As given_before(), of all objects written so far that have several keys alike."""
        given = given_before(cells_of, self.tables)
        return {path: keys for path, keys in given.items() if len(keys) > 1}

    def write_object(self, path, schema, choices):
        """Returns the rows. `choices`: {name: rows} of the choices that come before this one."""
        title = f"{'###' if '.' in path else '##'} `{path}`"
        first = self.seen.setdefault(text_of(schema), path)
        if first != path:
            self.parts += [title, f"As `{first}`. {see_of(path)}".rstrip()]
            return {}
        cells_of, others = self.rows(path, schema)
        known = given_before(cells_of, choices) or self.given_elsewhere(cells_of)
        left = {key: row for key, row in cells_of.items() if not any(key in keys for keys in known.values())}
        as_others = "; ".join(", ".join(f"`{key}`" for key in keys) + f" as of `{name}`"
                              for name, keys in known.items())
        self.parts += [part for part in (title, see_of(path), table(left) if left else "",
                                         f"Also {as_others}." if as_others else "") if part]
        if "(" not in path:
            self.tables[path] = cells_of
        for inner_path, inner in others:
            self.write(inner_path, inner)
        return cells_of


def text_of(schema):
    return json.dumps(schema["properties"], sort_keys=True)


def reference_of(schema):
    writer, keys = Writer(), in_table(schema)
    for key in keys:
        path, inner = element(key, schema["properties"][key])
        if {"properties", "oneOf"} & inner.keys():
            writer.write(path, inner)
    of_scenario = table({key: cells(schema, key) for key in keys})
    return "\n\n".join([HEAD.rstrip(), f"## The scenario\n\n{of_scenario}", *writer.parts]) + "\n"


def main(arguments):
    if len(arguments) > 1:
        raise SystemExit(__doc__)
    path = pathlib.Path(arguments[0]) if arguments else SCHEMA
    print(reference_of(json.loads(path.read_text(encoding="utf-8"))), end="")


if __name__ == "__main__":
    main(sys.argv[1:])
