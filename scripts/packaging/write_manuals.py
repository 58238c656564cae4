#!/usr/bin/env python3
"""Writes manual pages and completions of the shells for programs, from their --help.

usage: write_manuals.py OUT --with=COMMAND,... PROGRAM...

The commands of extras that are there follow --with; others that are not installed are left out.

    OUT/man1/PROGRAM.1.gz, PROGRAM-SUBCOMMAND.1.gz    manual pages
    OUT/bash/PROGRAM                                     completion for bash
    OUT/zsh/_PROGRAM                                     completion for zsh
"""

import gzip
import pathlib
import re
import subprocess
import sys

sys.dont_write_bytecode = True
from help_text import ask  # noqa: E402  # pylint: disable=wrong-import-position


def roff(text):
    """Escapes text for roff."""
    text = text.replace("\\", r"\e").replace("-", r"\-").replace("'", r"\(aq")
    return r"\&" + text if text.startswith((".", "'")) else text


def bold(text):
    return rf"\fB{roff(text)}\fR"


def heading(option):
    """The line of an option above its text."""
    value = f" \\fI{roff(option.type)}\\fR" if option.type else ""
    if option.several:
        value += " " + roff(option.several)
    return ", ".join(bold(name) for name in option.names) + value


def details(option):
    """What else the help says of an option, in sentences."""
    sentences = [re.sub(r"(?<!\.)\.$", "", option.text)] if option.text else []
    if option.choices():
        sentences.append("One of " + ", ".join(option.choices()))
    elif option.values:
        least, most = option.values.split(" to ")
        sentences.append(f"At least {least}" if float(most) >= 1e9 else f"From {least} to {most}")
    if option.default:
        sentences.append(f"Default: {option.default}")
    if option.is_required:
        sentences.append("Required")
    relations = re.sub(r" *(Needs|Excludes): ", lambda m: f". {m[1]} ", option.relations)
    sentences += [part for part in relations.split(". ") if part]
    return ". ".join(sentences) + "." if sentences else ""


def footer_sections(footer):
    """The exit status, and tables such as that of the viewer's keys."""
    for line in footer:
        if line.startswith("Exit status: "):
            yield from ('.SH "EXIT STATUS"', roff(line.removeprefix("Exit status: ")))
        elif line.endswith(":") and not line.startswith(" "):
            yield f'.SH "{roff(line.rstrip(":").upper())}"'
        elif line.startswith(" "):
            name, text = re.split(r" {2,}", line.strip(), maxsplit=1)
            yield from (".TP", bold(name), roff(text))
        else:
            yield roff(line)


def manual(command, version, others):
    name = "-".join(command.words)
    usage = command.usage.removeprefix(" ".join(command.words)).strip()
    lines = [f'.TH "{name.upper()}" 1 "" "{version}" "railcast"', ".SH NAME",
             f"{roff(name)} \\- {roff(command.description[0].lower() + command.description[1:])}", ".SH SYNOPSIS",
             f"{bold(' '.join(command.words))} {roff(usage)}"]
    for title, note, options in command.sections:
        lines.append(f'.SH "{roff(title.upper())}"')
        if note:
            lines.append(roff(note) + ".")
        for option in options:
            lines += [".TP", heading(option), roff(details(option))]
    if command.subcommands:
        lines.append(".SH SUBCOMMANDS")
        for subcommand in command.subcommands:
            lines += [".TP", bold(subcommand.words[-1]), roff(subcommand.description) + "."]
    lines += footer_sections(command.footer)
    lines += ['.SH "SEE ALSO"', ",\n".join(f".BR {roff(other)} (1)" for other in others)]
    return "\n".join(line for line in lines if line) + "\n"


def pages(command, version, programs):
    """(name, text) of the manual pages of a command and of those below it."""
    name = "-".join(command.words)
    below = ["-".join(each.words) for each in command.subcommands]
    above = ["-".join(command.words[:-1])] if len(command.words) > 1 else [each for each in programs if each != name]
    yield name, manual(command, version, above + below)
    for each in command.subcommands:
        yield from pages(each, version, programs)


def all_below(command):
    yield command
    for each in command.subcommands:
        yield from all_below(each)


def bash_completion(command):
    """A function that offers subcommands, options and their values, and files otherwise."""
    program = command.words[0]
    function = "_" + program.replace("-", "_")
    cases, values = [], []
    for each in all_below(command):
        key = " ".join(each.words[1:])
        flags = [name for option in each.options() for name in option.names if name.startswith("--")]
        words = [below.words[-1] for below in each.subcommands] + flags
        cases.append(f"    \"{key}\") words=\"{' '.join(words)}\" ;;")
        for option in each.options():
            if option.choices():
                names = "|".join(f'"{key} {name}"' for name in option.names)
                values.append(f"    {names}) words=\"{' '.join(option.choices())}\" ;;")
    subcommands = "|".join(each.words[-1] for each in command.subcommands) or "-"
    return f"""# Completion of {program} for bash, made of its --help.
{function}() {{
  local current="${{COMP_WORDS[COMP_CWORD]}}" previous="${{COMP_WORDS[COMP_CWORD - 1]}}" subcommand="" words=""
  local i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "${{COMP_WORDS[i]}}" in
      {subcommands}) subcommand="${{COMP_WORDS[i]}}"; break ;;
    esac
  done
  case "$subcommand $previous" in
{chr(10).join(values) or "    *) ;;"}
  esac
  if [[ -z "$words" ]]; then
    case "$subcommand" in
{chr(10).join(cases)}
    esac
    if [[ -n "$subcommand" || {0 if command.subcommands else 1} == 1 ]] && [[ "$current" != -* ]]; then
      words=""  # Files.
    fi
  fi
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}}
complete -o bashdefault -o default -F {function} {program}
"""


def zsh_word(text):
    return re.sub(r"([\[\]:\\'])", lambda m: r"'\''" if m[1] == "'" else "\\" + m[1], text)


def zsh_arguments(command):
    for option in command.options():
        text = zsh_word(option.text)
        action = f"({' '.join(option.choices())})" if option.choices() else "_files" if option.type == "TEXT" else " "
        if not option.names[0].startswith("-"):
            yield f"'*:{zsh_word(option.names[0])}:_files'"
            continue
        for name in option.names:
            yield f"'{name}[{text}]" + (f":{option.type}:{action}'" if option.type else "'")


def zsh_completion(command):
    program = command.words[0]
    function = "_" + program
    lines = [f"#compdef {program}", f"# Completion of {program} for zsh, made of its --help.", f"{function}() {{"]
    if command.subcommands:
        lines += ["  local -a subcommands=("]
        lines += [f"    '{each.words[-1]}:{zsh_word(each.description)}'" for each in command.subcommands]
        lines += ["  )", "  if (( CURRENT == 2 )); then", "    _describe subcommand subcommands", "    return", "  fi",
                  "  local subcommand=$words[2]", "  shift words", "  (( CURRENT-- ))", "  case $subcommand in"]
        for each in command.subcommands:
            lines.append(f"    {each.words[-1]})")
            lines.append("      _arguments \\\n        " + " \\\n        ".join(zsh_arguments(each)) + " ;;")
        lines += ["  esac"]
    else:
        lines.append("  _arguments \\\n    " + " \\\n    ".join(zsh_arguments(command)))
    return "\n".join([*lines, "}", f'{function} "$@"']) + "\n"


def main():
    if len(sys.argv) < 4 or not sys.argv[2].startswith("--with="):
        sys.exit(__doc__)
    out = pathlib.Path(sys.argv[1])
    for folder in ("man1", "bash", "zsh"):
        (out / folder).mkdir(parents=True, exist_ok=True)
    extras = sys.argv[2].removeprefix("--with=").split(",")
    programs = [pathlib.Path(name) for name in sys.argv[3:]]
    version = subprocess.run([str(programs[0]), "--version"], check=True, capture_output=True, text=True).stdout
    version = version.strip().split("+")[0]
    for program in programs:
        command = ask(program, required=extras)
        for name, text in pages(command, version, [each.name for each in programs]):
            # Without the time, so that equal pages are equal files.
            (out / "man1" / f"{name}.1.gz").write_bytes(gzip.compress(text.encode(), mtime=0))
        (out / "bash" / program.name).write_text(bash_completion(command), "utf-8")
        (out / "zsh" / f"_{program.name}").write_text(zsh_completion(command), "utf-8")


if __name__ == "__main__":
    main()
