"""Reads what the programs print with --help, so that manual pages and completions say the same."""

import dataclasses
import pathlib
import re
import subprocess

MORE = re.compile(r" {20,}(\S.*)$")
SECTION = re.compile(r"\s*(?:\[Option Group: (.+)\]|([A-Z]\w*):)$")
NOTE = re.compile(r"\s*\[(.+)\]$")
# CLI11 writes a default as "=all", from its version 2.4 on as " [all] ".
NAME = re.compile(r"(?P<names>\S+)"
                  r"(?: (?P<type>[A-Z]\S*?)(?::(?P<values>\{[^}]*\}|\S+ to [-+.\w]+))?(?:=(?P<default>\S+)| \[(?P<newer_default>.*)\])?"
                  r"(?P<several> x \d+| \.\.\.)?)?"
                  r"(?P<required> REQUIRED)?(?P<relations>(?:  ?(?:Needs|Excludes):(?: --[-\w]+)+)*)$")
COLUMN = 28  # Where texts begin, beyond the indentation of the names.


@dataclasses.dataclass
class Option:
    """An option or a positional argument."""
    names: list[str]
    type: str = ""  # Empty for a flag.
    values: str = ""  # {a,b,c}, or a range in words.
    default: str = ""
    several: str = ""
    is_required: bool = False
    relations: str = ""
    text: str = ""

    def choices(self):
        return self.values.strip("{}").split(",") if self.values.startswith("{") else []


@dataclasses.dataclass
class Command:
    """A program or one of its subcommands."""
    words: list[str]
    description: str
    usage: str
    sections: list[tuple[str, str, list[Option]]]  # Title, note, options.
    subcommands: list["Command"]
    footer: list[str]  # Lines as they are.

    def options(self):
        return [option for _, _, options in self.sections for option in options]


def split_entry(line):
    """(name, text) of the first line of an entry; the text may begin on the next line."""
    name = line.strip()
    if NAME.fullmatch(name):
        return [name, ""]
    column = len(line) - len(line.lstrip()) + COLUMN
    return [line[:column].strip(), line[column:].strip()]


def read_option(name, text):
    match = NAME.fullmatch(name)
    if not match:
        raise ValueError(f"cannot read the option {name!r}")
    return Option(match["names"].split(","), match["type"] or "", match["values"] or "", match["default"] or match["newer_default"] or "",
                  (match["several"] or "").strip(), bool(match["required"]), " ".join(match["relations"].split()), text or "")


def read_help(words, text):
    """Returns the command whose help `text` is, and the names of its subcommands."""
    lines = text.splitlines()
    usage_at = next(i for i, line in enumerate(lines) if line.startswith("Usage: "))
    description = " ".join(lines[:usage_at]).rstrip(".")
    usage = lines[usage_at].removeprefix("Usage: ")
    sections, subcommands, footer = [], [], []
    entries, note = None, ""
    for line in lines[usage_at + 1:]:
        section = SECTION.match(line)
        if section:
            title = section[1] or section[2]
            if section[1] is None and line.startswith(" "):
                continue  # "Options:" within a group.
            entries, note = [], ""
            sections.append([title, "", entries])
        elif entries is not None and line.startswith(" "):
            if not line.strip():
                continue
            if NOTE.match(line):
                sections[-1][1] = NOTE.match(line)[1]
            elif MORE.match(line):
                entries[-1][1] = f"{entries[-1][1]} {line.strip()}".strip()
            else:
                entries.append(split_entry(line))
        elif line.strip() or footer:
            entries = None
            footer.append(line)
    options = []
    for title, note, entries in sections:
        if title == "Subcommands":
            subcommands = [name for name, _ in entries]
        else:
            options.append((title, note, [read_option(name, text) for name, text in entries]))
    return Command(words, description, usage, options, [], footer), subcommands


def ask(program, subcommands=(), required=None):
    """Returns the command of `program` (a path), with all below it. What is not installed is left out, and None itself, if
    there are `required` commands and it is none of them."""
    answer = subprocess.run([str(program), *subcommands, "--help"], check=False, capture_output=True, text=True)
    is_missing = "which is not installed" in answer.stderr
    if is_missing and required is not None and subcommands[-1] not in required:
        return None
    if answer.returncode != 0:
        raise ValueError(f"{' '.join([str(program), *subcommands])}: {answer.stderr.strip()}")
    command, names = read_help([pathlib.Path(program).name, *subcommands], answer.stdout)
    command.subcommands = list(filter(None, (ask(program, (*subcommands, name), required) for name in names)))
    return command
