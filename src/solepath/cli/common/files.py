"""The check of the files that a command writes, before it starts.

Three rules hold for every command. A file that the command reads is never written, whatever its name (links). A file
that such a command wrote is replaced, and so is an empty one. Any other file, and every recording, is replaced with
--force only, and none that is being recorded. Pipes and devices are written as they are. Before a file is replaced at
the end, it is checked again: --force is for the file that was there at the start."""

from __future__ import annotations

import argparse
import json
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

from attrs import field, frozen

from ...recording import printable
from ...saving.files import FileReplacements, identity, write_whole
from ...saving.lock import LOCKED, locked
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
FLEET_FIGURES = Kind(re.compile(rb'\{\n "wearers": \d+,\n "seconds": '))
"""JSON of `fleet-demo`."""
CALIBRATION = Kind(re.compile(rb""))
"""A calibration, which is read, checked and completed: what is none stays as it is."""
TRACK_KINDS = {
    EVENTS_FILE: Kind(re.compile(rb'\{"event": "[A-Z]\w*", "t": [^\s,"]+, "known_at": ')),
    TRACK_FILE: _table(TRACK_COLUMNS),
    STRIDES_FILE: _table(STRIDE_COLUMNS),
    GAIT_CYCLES_FILE: _table(CYCLE_COLUMNS),
}
PLACE_KINDS = {PLACES_FILE: _table(PLACE_COLUMNS)}
PLAN_KINDS = {PLAN_FILE: Kind(re.compile(rb"""<\?xml [^\n]*\n<svg [^\n>]*id="solepath-plan\""""))}


@frozen
class OutputFile:
    """A file that a command will write; created before the command starts, it knows the file that is there then."""

    path: Path
    kind: Kind
    _found: tuple[int, ...] | None = field(init=False)

    @_found.default
    def _identity(self) -> tuple[int, ...] | None:
        return identity(self.path)

    def check_again(self) -> None:
        """Raise Failure when another program has written the file since then, unless it is of the same kind."""
        if identity(self.path) != self._found and self.path.is_file() and not self.kind.is_own(self.path):
            raise Failure(f"{printable(str(self.path))}: another program wrote it meanwhile, so that it stays")


def replacements(outputs: Iterable[OutputFile]) -> FileReplacements:
    """Return what replaces these files at the end, each after another check."""
    by_path: Mapping[Path, OutputFile] = {output.path: output for output in outputs}
    return FileReplacements(lambda path: by_path[path].check_again())


def add_force(command: argparse.ArgumentParser) -> None:
    """Add --force to a command."""
    command.add_argument(
        "--force", action="store_true", help="replace recordings and files of other programs under the names given, too"
    )


def files_of_track(out: Path | None, *, places: bool, plan: bool = False, outcomes: bool = False) -> list[OutputFile]:
    """Return the files that are written to the directory `out`; `places`, `plan`: with a floor plan, and its picture.

    `outcomes`: with clinical outcomes. Raise Failure when there is a file in place of the directory."""
    if out is None:
        return []
    if out.exists() and not out.is_dir():
        raise Failure(f"{printable(str(out))}: is a file; --out needs a folder, which is made when there is none")
    kinds = TRACK_KINDS | (PLACE_KINDS if places else {}) | (PLAN_KINDS if plan else {})
    if outcomes:
        from ...show.outcomes.files import BOUT_COLUMNS, BOUTS_FILE, OUTCOME_COLUMNS, OUTCOMES_FILE

        kinds |= {BOUTS_FILE: _table(BOUT_COLUMNS), OUTCOMES_FILE: _table(OUTCOME_COLUMNS)}
    return [OutputFile(out / name, kind) for name, kind in kinds.items()]


def check_outputs(outputs: Sequence[OutputFile], inputs: Iterable[Path | None], *, force: bool) -> None:
    """Check that no output is an input, another output, being recorded, or replaced with `force` only.

    A directory among `inputs` stands for the files in it. No file is changed. Raise Failure, with one sentence."""
    read = [path for given in inputs if given is not None for path in _files_in(given)]
    for output in outputs:
        if any(_is_same(output.path, path) for path in read):
            raise Failure(f"{printable(str(output.path))}: is what this command reads; write to another file")
    for one, other in combinations(outputs, 2):
        if _is_same(one.path, other.path):
            raise Failure(f"{printable(str(other.path))}: two outputs cannot be one file")
    for output in outputs:
        _check_unlocked(output.path)
    for output in () if force else outputs:
        if output.path.is_file() and not output.kind.is_own(output.path):
            why = "exists" if output.kind.start is None else "exists and is no such file that solepath wrote"
            raise Failure(f"{printable(str(output.path))}: {why}; --force replaces it")


def _check_unlocked(path: Path) -> None:
    """Raise Failure when another program records into a file."""
    if path.is_file():
        try:
            with locked(path):
                pass
        except BlockingIOError:
            raise Failure(f"{printable(str(path))}: {LOCKED}") from None


def _files_in(path: Path) -> list[Path]:
    return sorted(path.iterdir()) if path.is_dir() else [path]


def _is_same(one: Path, other: Path) -> bool:
    """Return whether two paths are one file, also through links; of pipes and devices nothing is lost."""
    if not one.exists():
        return _real(one) == _real(other)
    return one.is_file() and other.exists() and os.path.samefile(one, other)


def check_writable(path: Path, made: Path | None = None) -> None:
    """Check that a file can be written, without changing its contents; raise OSError when it cannot.

    `made` is a directory that will be made, with those above it, before the file is written."""
    if made is not None and not path.parent.exists() and Path(_real(made)).is_relative_to(_real(path.parent)):
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


def write_json(output: OutputFile, value: Any) -> None:
    """Write a value as indented JSON, whole or not at all; raise OSError or Failure when it cannot be written."""
    text = json.dumps(value, indent=1, allow_nan=False) + "\n"
    write_whole(output.path, text, lambda _: output.check_again())
