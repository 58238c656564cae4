#!/usr/bin/env python3
"""Prints docs/reference.md, the tables of all keys of a scenario, as its JSON Schema has them.

usage: write_reference.py [SCHEMA] > docs/reference.md

SCHEMA is scenarios/schema/scenario.schema.json unless given.
"""

import json
import pathlib
import sys

SCHEMA = pathlib.Path(__file__).resolve().parent.parent / "scenarios/schema/scenario.schema.json"

HEAD = """# Reference: every key of a scenario

<!-- Written by scripts/write_reference.py from scenarios/schema/scenario.schema.json: do not edit. -->

The tables follow the JSON Schema, which follows the reader; `railcast-generate check` holds a file to them.
[scenario.md](scenario.md) explains how keys work together and how a file is read, [effects.md](effects.md) and
[world.md](world.md) what they do.

- Keys that have a default may be left out. Unknown keys are errors.
- `…[]` stands for every element of a list.
- Each section, and each object or list in it that is marked *or file*, can be the name of a file that holds it. An
  object that is marked so can also have a key `file`: the file has those keys that are not given beside it
  ([inclusion](scenario.md#inclusion)). Then nothing else is required.
- A file has `"version": 1`, and may name its schema with `$schema`.
"""
INCLUSION = "Has the keys that are not given here."  # Of a key `file`.

EXPLAINED_IN = {
    "tolerance": "frontier.md#no-more-than-a-scene-needs", "effects": "effects.md",
    "lidar": "scenario.md#sensors", "lidars[]": "scenario.md#several-sensors",
    "lidar.plausibility": "effects.md#threshold", "lidar.cover": "effects.md#cover",
    "weather": "scenario.md#weather", "interfaces": "live.md", "camera": "camera.md",
    "world": "world.md", "world.alignment": "world.md#the-line", "world.catenary": "world.md#contact-line",
    "world.terrain": "world.md#ground-and-vegetation", "world.vegetation": "world.md#ground-and-vegetation",
    "models[]": "models.md", "world.structures[]": "world.md#structures", "world.objects[]": "scenario.md#objects", "vehicle": "world.md#movement",
    "output": "files.md#fields", "materials[]": "scenario.md#materials",
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


def table(schema):
    lines = ["| key | value | default | limits | meaning |", "|---|---|---|---|---|"]
    for key, value in schema["properties"].items():
        if is_explained_in_head(key, value):
            continue
        cells = (f"`{key}`", kind(value), default_of(schema, key), value_limits(value),
                 description(value) + excluded(schema, key))
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines)


def see_of(path):
    page = EXPLAINED_IN.get(path)
    return f"See [{page.split('#')[0]}]({page})." if page else ""


class Writer:
    """Writes each object once; where it comes again, a reference to the first."""

    def __init__(self):
        self.seen = {}  # The schema's text: path.
        self.parts = []

    def write(self, path, schema):
        schema, _ = without_file(schema)
        while schema.get("type") == "array":
            path += "[]"
            schema, _ = without_file(schema["items"])
        if "oneOf" in schema:
            for choice in schema["oneOf"]:
                self.write_object(f"{path} ({choice['properties']['type']['const']})", choice)
        elif schema.get("type") == "object":
            self.write_object(path, schema)

    def write_object(self, path, schema):
        text = json.dumps(schema["properties"], sort_keys=True)
        title = f"{'###' if '.' in path else '##'} `{path}`"
        if text in self.seen:
            self.parts += [title, f"As `{self.seen[text]}`. {see_of(path)}".rstrip()]
            return
        self.seen[text] = path
        self.parts += [part for part in (title, see_of(path), table(schema)) if part]
        for key, value in schema["properties"].items():
            self.write(f"{path}.{key}", value)


def reference_of(schema):
    writer = Writer()
    for key, value in schema["properties"].items():
        if not is_explained_in_head(key, value):
            writer.write(key, value)
    return "\n\n".join([HEAD.rstrip(), f"## The scenario\n\n{table(schema)}", *writer.parts]) + "\n"


def main(arguments):
    if len(arguments) > 1:
        raise SystemExit(__doc__)
    path = pathlib.Path(arguments[0]) if arguments else SCHEMA
    print(reference_of(json.loads(path.read_text(encoding="utf-8"))), end="")


if __name__ == "__main__":
    main(sys.argv[1:])
