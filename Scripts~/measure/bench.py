# SPDX-License-Identifier: MIT
"""Runs `quickses bench` for the scripts beside this file, and reads its reports."""

import functools
import json
import os
import re
import subprocess
import sys

PLACES = ("device", "host")  # where the mesh is when the time is up


class MeasureError(Exception):
    """What went wrong, in one sentence for the user."""


def run(command, **keywords):
    """What the command prints. Raises MeasureError with its last words if it fails."""
    try:
        done = subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace", check=False, **keywords)
    except OSError as error:
        raise MeasureError(f"{command[0]} can't be run: {error.strerror}") from error
    if done.returncode != 0:
        words = [line for line in done.stderr.splitlines() if line.strip()] or [f"exit status {done.returncode}"]
        raise MeasureError(f"{' '.join(command)}: {words[-1]}")
    return done.stdout


@functools.lru_cache(maxsize=None)
def knows(program, flag):
    """Whether the bench of this program, which may be an older release, has a flag."""
    return re.search(rf"(?<![\w-]){re.escape(flag)}(?![\w-])", run([program, "bench", "--help"])) is not None


def bench(program, files, options=()):
    """The report of the program about these files."""
    output = run([program, "bench", *files, "--quiet", "--json", "-", *options])
    try:
        return json.loads(output)
    except ValueError as error:
        raise MeasureError(f"{program} bench: its report is no JSON ({error})") from error


def medians(entry):
    """{place: ms} of one structure of a report. In reports before --delivery, `host` is a number."""
    times = {place: entry[place] for place in PLACES if place in entry}
    if not times:
        raise MeasureError(f"the report about {entry['input']} has no times of whole surfaces")
    return {place: time["median"] if isinstance(time, dict) else time for place, time in times.items()}


def name_of(path):
    """Of a structure, from its file: 3EAM of data/3EAM.pdb.gz."""
    return os.path.basename(path).split(".")[0]


def split_arguments(arguments):
    """(those of the script, those behind --, which are for bench)"""
    if "--" not in arguments:
        return arguments, []
    place = arguments.index("--")
    return arguments[:place], arguments[place + 1:]


def main(script, arguments):
    """Ends with the exit status that script(arguments) gives, or with 2 and what stopped it."""
    try:
        sys.exit(script(arguments))
    except MeasureError as error:
        print(f"{os.path.basename(sys.argv[0])}: {error}", file=sys.stderr)
        sys.exit(2)
