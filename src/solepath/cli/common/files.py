"""The check of the files that a command writes, before it starts.

Three rules hold for every command. A file that the command reads is never written, whatever its name (links). A file
that such a command wrote is replaced, and so is an empty one. Any other file, and every recording, is replaced with
--force only. Pipes and devices are written as they are."""

from __future__ import annotations

import argparse
import json
import os
import re
from collections.abc import Iterable, Sequence
from errno import EEXIST
from itertools import combinations
from pathlib import Path
from typing import Any

from attrs import frozen

from ...recording import printable
from ...saving.files import write_whole
from ...show.output import (
    CYCLE_COLUMNS,
    EVENTS_FILE,
    GAIT_CYCLES_FILE,
    PLACE_COLUMNS,
    PLACES_FILE,
    PLAN_FILE,
    STRIDE_COLUMNS,
    STRIDES_FILE,
    TRACK_COLUMNS,
    TRACK_FILE,
)
from .failure import Failure

MAX_START = 1_000_000
"""Number of bytes of an existing file that are looked at, which say what it is."""


@frozen
class Kind:
    """A kind of output file; `start` matches the first bytes of such a file, None if it is replaced with --force only.

    `is_elsewhere` says that `start` may match anywhere in the first MAX_START bytes."""

    start: re.Pattern[bytes] | None
    is_elsewhere: bool = False

    def is_own(self, path: Path) -> bool:
        """Return whether an existing file is of this kind, or empty."""
        with path.open("rb") as file:
            content = file.read(MAX_START)
        if not content:
            return True
        if self.start is None:
            return False
        return bool(self.start.search(content) if self.is_elsewhere else self.start.match(content))


def _table(columns: Sequence[str]) -> Kind:
    return Kind(re.compile(re.escape(",".join(columns).encode()) + rb"\r?\n"))


RECORDING = Kind(None)
"""A recording, of packets or MCAP: what was measured once cannot be computed again."""
REPORT = Kind(
    re.compile(rb'<!DOCTYPE html>\n<html lang="en"><head>[^\n]{0,80}<meta name="generator" content="solepath">')
)
EXPERIMENT = Kind(re.compile(rb'\{\n "name": "[^"\n]*",\n "emulated": true,\n "table": \{'))
"""JSON of `reproduce`."""
SCORES = Kind(re.compile(rb'\{\}\n|\{\n "[^"\n]*": \{\n  "[^"\n]*": \{\n   "recordings": \{'))
"""JSON of `evaluate`."""
FLEET_FIGURES = Kind(re.compile(rb'\{\n "wearers": \d+,\n "seconds": '))
"""JSON of `fleet-demo`."""
FIGURE = Kind(re.compile(rb"solepath"), is_elsewhere=True)
"""A figure of `reproduce`, whose metadata name the program."""
CALIBRATION = Kind(re.compile(rb""))
"""A calibration, which is read, checked and completed: what is none stays as it is."""
TRACK_KINDS = {
    EVENTS_FILE: Kind(re.compile(rb'\{"event": "')),
    TRACK_FILE: _table(TRACK_COLUMNS),
    STRIDES_FILE: _table(STRIDE_COLUMNS),
    GAIT_CYCLES_FILE: _table(CYCLE_COLUMNS),
}
PLACE_KINDS = {PLACES_FILE: _table(PLACE_COLUMNS)}
PLAN_KINDS = {PLAN_FILE: Kind(re.compile(rb"""<\?xml [^\n]*\n<svg [^\n>]*id="solepath-plan\""""))}


@frozen
class OutputFile:
    """A file that a command will write."""

    path: Path
    kind: Kind


def add_force(command: argparse.ArgumentParser) -> None:
    """Add --force to a command."""
    command.add_argument(
        "--force", action="store_true", help="replace recordings and files of other programs under the names given, too"
    )


def files_of_track(out: Path | None, *, places: bool, plan: bool = False) -> list[OutputFile]:
    """Return the files that are written to the directory `out`; `places`, `plan`: with a floor plan, and its picture.

    Raise OSError when there is a file in place of the directory."""
    if out is None:
        return []
    if out.exists() and not out.is_dir():
        raise FileExistsError(EEXIST, os.strerror(EEXIST), str(out))
    kinds = TRACK_KINDS | (PLACE_KINDS if places else {}) | (PLAN_KINDS if plan else {})
    return [OutputFile(out / name, kind) for name, kind in kinds.items()]


def check_outputs(outputs: Sequence[OutputFile], inputs: Iterable[Path | None], *, force: bool) -> None:
    """Check that no output is an input, another output, or a file that is replaced with `force` only.

    A directory among `inputs` stands for the files in it. No file is changed. Raise Failure, with one sentence."""
    read = [path for given in inputs if given is not None for path in _files_in(given)]
    for output in outputs:
        if any(_is_same(output.path, path) for path in read):
            raise Failure(f"{printable(str(output.path))}: is what this command reads; write to another file")
    for one, other in combinations(outputs, 2):
        if _is_same(one.path, other.path):
            raise Failure(f"{printable(str(other.path))}: two outputs cannot be one file")
    for output in () if force else outputs:
        if output.path.is_file() and not output.kind.is_own(output.path):
            why = "exists" if output.kind.start is None else "exists and is no such file that solepath wrote"
            raise Failure(f"{printable(str(output.path))}: {why}; --force replaces it")


def _files_in(path: Path) -> list[Path]:
    return sorted(path.iterdir()) if path.is_dir() else [path]


def _is_same(one: Path, other: Path) -> bool:
    """Return whether two paths are one file, also through links; of pipes and devices nothing is lost."""
    if not one.exists():
        return _real(one) == _real(other)
    return one.is_file() and other.exists() and os.path.samefile(one, other)


def check_writable(path: Path, made: Path | None = None) -> None:
    """Check that a file can be written, without changing its contents; raise OSError when it cannot.

    `made` is a directory that will be made before the file is written."""
    if made is not None and not path.parent.exists() and _real(path.parent) == _real(made):
        return
    if not path.exists():
        try:
            path.open("xb").close()
        except FileExistsError:
            pass  # another program made it just now
        else:
            path.unlink()
            return
    if path.is_file() or path.is_dir():  # closing would end a pipe
        path.open("ab").close()


def _real(path: Path) -> str:
    return os.path.realpath(path)


def write_json(path: Path, value: Any) -> None:
    """Write a value as indented JSON, whole or not at all; raise OSError when it cannot be written."""
    write_whole(path, json.dumps(value, indent=1, allow_nan=False) + "\n")
