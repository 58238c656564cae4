"""Stands under a railcast program's name in a folder of page_commands_test.py, and runs it so that it ends soon:
run_small.py BUILD_DIR NAME WORD...
"""

import os
import pathlib
import sys

MOST_FRAMES = 5
MOST_S = 20  # Of streams, which the end of a block ends.


def added_options(program, words):
    """What a command is given besides what a page gives it."""
    command = words[0] if words else ""
    if program == "railcast-view":
        writes = "--screenshot" in words or "--video" in words
        return [*([] if writes else ["--screenshot", f"view_{os.getpid()}.png"]),
                *(["--frames", "2"] if "--video" in words else []),
                *([] if "--size" in words else ["--size", "160x100"])]
    if program == "railcast-c-bench":
        return ["2"]
    if program == "railcast-measure":
        return ["tiny.json", "--scans" if command == "modules" else "--turns", "2"]
    return {"stream": [] if "--duration" in words else ["--duration", str(MOST_S)],
            "receive": [] if "--frames" in words else ["--frames", "1", "--duration", "2"],
            "sequence": [] if "--frames" in words else ["--frames", "2"],
            "frontier": ["--frames", "1", "--rows", "geometry"],
            "sight": ["--step-m", "50"]}.get(command, [])


def small_words(program, words):
    """The words of a command at its smallest size."""
    small = list(words)
    if words[:1] == ["frontier"] and pathlib.Path(words[1]).exists():
        small[1] = "tiny.json"
    for place, (option, value) in enumerate(zip(words, words[1:]), 1):
        if option == "--frames" and value.isdigit():
            small[place] = str(min(int(value), 1 if "--ablate" in words else MOST_FRAMES))
        elif option == "--duration" and "--pcap" in words:
            small[place] = "0.2"
        elif option == "--shard" and value.endswith("00"):
            small[place] = "1/2"
    return small + added_options(program, words)


def main(build, name, words):
    program = pathlib.Path(name).name
    path = next(build / place / program for place in ("generator", "analysis", "viewer", "tests/bench")
                if (build / place / program).exists())
    os.environ["PATH"] = "/usr/bin:/bin"  # For what draws and typesets.
    os.execv(path, [str(path), *small_words(program, words)])


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3:])
