"""The check of the files that a command writes, before it starts.

Three rules hold for every command. A file that the command reads is never written, whatever its name (links). A file
that such a command wrote is replaced, and so is an empty one. Any other file, and every recording, is replaced with
--force only, and none that is being recorded. Pipes and devices are written as they are. Before a file is replaced at
the end, it is checked again: --force is for the file that was there at the start."""

from __future__ import annotations

import json
import os
import re
from argparse import Namespace
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from itertools import combinations
from pathlib import Path
from typing import Any, TypeVar

from attrs import field, frozen

from ...recording.bids.names import MOTION_END, channels_of, systems_of
from ...saving.files import FileReplacements, identity, replace_whole
from ...saving.lock import LOCKED, locked
from ...show.output import (
    CYCLE_COLUMNS,
    EVENTS_FILE,
    GAIT_CYCLES_FILE,
    PLACE_COLUMNS,
    PLACES_FILE,
    PLAN_FILE,
    RUN_FILE,
    STRIDE_COLUMNS,
    STRIDES_FILE,
    TRACK_COLUMNS,
    TRACK_FILE,
)
from .failure import Failure
from .parser import option

T = TypeVar("T")
WRITTEN = {"out", "record", "report", "export", "json", "figure", "resume", "dir"}
"""Options that name files to be written, or a folder of folders that are read."""
MAX_START = 1_000_000
"""Number of bytes of an existing file that are looked at, which say what it is."""


@frozen
class Kind:
    """A kind of output file.

    `mark` is a pattern of the first MAX_START bytes of such a file, None if it is replaced with --force only."""

    mark: bytes | None

    def is_own(self, path: Path) -> bool:
        """Return whether an existing file is of this kind, or empty."""
        with path.open("rb") as file:
            content = file.read(MAX_START)
        return not content or self.mark is not None and re.search(self.mark, content, re.DOTALL) is not None


def table_kind(columns: Sequence[str]) -> Kind:
    """Return the kind of a .csv with these columns."""
    return Kind(rb"\A" + re.escape(",".join(columns).encode()) + rb"\r?\n")


RECORDING = Kind(None)
"""A recording, of packets or MCAP: what was measured once cannot be computed again."""
REPORT = Kind(rb'\A<!DOCTYPE html>\n<html lang="en"><head>[^\n]{0,80}<meta name="generator" content="solepath">')
FLEET_FIGURES = Kind(rb'\A\{\n "wearers": \d+,\n "seconds": ')
"""JSON of `fleet-demo`."""
CALIBRATION = Kind(b"")
"""A calibration, which is read, checked and completed: what is none stays as it is."""
TRACK_KINDS = {
    EVENTS_FILE: Kind(rb'\A\{"event": "[A-Z]\w*", "t": [^\s,"]+, "known_at": '),
    TRACK_FILE: table_kind(TRACK_COLUMNS),
    STRIDES_FILE: table_kind(STRIDE_COLUMNS),
    GAIT_CYCLES_FILE: table_kind(CYCLE_COLUMNS),
    RUN_FILE: Kind(rb'\A\{\n "solepath": "[^"\n]*",\n "recipe": "'),
}
WAY_KINDS = {
    ".geojson": Kind(rb'\A\{"type": "FeatureCollection", "solepath": \{'),
    ".gpx": Kind(rb"""\A<\?xml [^\n]*\n<gpx [^>]*creator="solepath"""),
    ".kml": Kind(rb"""\A<\?xml [^\n]*\n<kml [^>]*>\s*<Document id="solepath-way">"""),
}
"""Files of --export, by the ending of their names."""
PLACE_KINDS = {PLACES_FILE: table_kind(PLACE_COLUMNS)}
PLAN_KINDS = {PLAN_FILE: Kind(rb"""\A<\?xml [^\n]*\n<svg [^\n>]*id="solepath-plan\"""")}


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
            raise Failure(f"{self.path}: another program wrote it meanwhile, so that it stays")

    def replace(self, write: Callable[[Path], T]) -> T:
        """Replace the file by what `write` writes to the path that it is given, once that is whole; return its result.

        Raise OSError or Failure when it cannot be written."""
        results: list[T] = []
        replace_whole(self.path, lambda path: results.append(write(path)), lambda _: self.check_again())
        return results[0]


def replacements(outputs: Iterable[OutputFile]) -> FileReplacements:
    """Return what replaces these files at the end, each after another check."""
    by_path: Mapping[Path, OutputFile] = {output.path: output for output in outputs}
    return FileReplacements(lambda path: by_path[path].check_again())


add_force = option(
    "--force", action="store_true", help="replace recordings and files of other programs under the names given, too"
)
"""--force."""


def files_of_track(out: Path | None, *, places: bool, plan: bool = False, outcomes: bool = False) -> list[OutputFile]:
    """Return the files that are written to the directory `out`; `places`, `plan`: with a floor plan, and its picture.

    `outcomes`: with clinical outcomes. Raise Failure when a file has the directory's name."""
    if out is None:
        return []
    if out.exists() and not out.is_dir():
        raise Failure(f"{out}: is a file; --out needs a folder, which is made when there is none")
    kinds = TRACK_KINDS | (PLACE_KINDS if places else {}) | (PLAN_KINDS if plan else {})
    if outcomes:
        from ...show.outcomes.files import BOUT_COLUMNS, BOUTS_FILE, OUTCOME_COLUMNS, OUTCOMES_FILE

        kinds |= {BOUTS_FILE: table_kind(BOUT_COLUMNS), OUTCOMES_FILE: table_kind(OUTCOME_COLUMNS)}
    return [OutputFile(out / name, kind) for name, kind in kinds.items()]


def files_read(options: Namespace) -> list[Path]:
    """Return the files that a command reads: all paths among its options, but those of options that name outputs.

    The recording is the first; a directory stands for the files in it, and a file of a Motion-BIDS dataset for those of
    its recording."""
    written = {*WRITTEN, "files"} if getattr(options, "live", False) else WRITTEN
    given = [getattr(options, "files", None), *[value for name, value in vars(options).items() if name not in written]]
    paths = [one for value in given for one in (value if isinstance(value, list) else [value]) if isinstance(one, Path)]
    return list(dict.fromkeys([file for path in paths for file in _files_in(path)]))


def check_outputs(options: Namespace, outputs: Sequence[OutputFile], *inputs: Path) -> None:
    """Check that no output is an input, another output, being recorded, not writable, or replaced with --force only.

    Inputs are `files_read` and `inputs`. No file is changed. Raise Failure, with one sentence, or OSError."""
    read = [*files_read(options), *[file for one in inputs for file in _files_in(one)]]
    for output in outputs:
        if any(_is_same(output.path, path) for path in read):
            raise Failure(f"{output.path}: is what this command reads; write to another file")
    for one, other in combinations(outputs, 2):
        if _is_same(one.path, other.path):
            raise Failure(f"{other.path}: two outputs cannot be one file")
    for output in outputs:
        path, kind = output.path, output.kind
        if path.is_file():
            try:
                with locked(path):
                    pass
            except BlockingIOError:
                raise Failure(f"{path}: {LOCKED}") from None
            if not getattr(options, "force", False) and not kind.is_own(path):
                why = "exists" if kind.mark is None else "exists and is no such file that solepath wrote"
                raise Failure(f"{path}: {why}; --force replaces it")
    for output in outputs:
        _check_writable(output.path, getattr(options, "out", None))


def _files_in(path: Path) -> list[Path]:
    if path.name.endswith(MOTION_END) and path.is_file():
        systems = systems_of(path)
        return [path, *systems, *map(channels_of, systems)]
    return sorted(path.iterdir()) if path.is_dir() else [path]


def _is_same(one: Path, other: Path) -> bool:
    """Return whether two paths are one file, also through links; of pipes and devices nothing is lost."""
    if not one.exists():
        return _real(one) == _real(other)
    return one.is_file() and other.exists() and os.path.samefile(one, other)


def _check_writable(path: Path, made: Path | None) -> None:
    """Check that a file can be written, without changing its contents; raise OSError when it cannot.

    `made` is a directory that will be made, with those above it and in it, before the file is written."""
    if made not in (None, path) and not path.parent.exists():
        one, other = Path(_real(made)), Path(_real(path.parent))
        if one.is_relative_to(other) or other.is_relative_to(one):
            return
    if path.is_file() or path.is_dir():  # closing would end a pipe
        path.open("ab").close()
    elif not path.exists():
        with suppress(FileExistsError):  # another program made it just now
            path.open("xb").close()
            path.unlink()


def _real(path: Path) -> str:
    return os.path.realpath(path)


def write_json(output: OutputFile, value: Any) -> None:
    """Write a value as indented JSON, whole or not at all; raise OSError or Failure when it cannot be written."""
    text = json.dumps(value, indent=1, allow_nan=False) + "\n"
    output.replace(lambda path: path.write_text(text, encoding="utf-8", newline="\n"))
