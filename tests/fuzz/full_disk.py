"""Writes files of every kind while the disk is full after so many bytes: `python tests/fuzz/full_disk.py [--steps N]`.

Each program runs once undisturbed, and then N times (default: 12) with a limit of the size of a file in place of the
full disk: from no byte to one less than its largest file. Each must end with status 2 and one line on stderr; files of
an earlier run must be as they were, and a recording must hold whole lines up to the error. It prints a line for each
program, and exits with 1 at the first promise that is broken. A limit of the size is idealised: a disk that is full
also allows no new file. Left out are `record` and `live` (the recording of an app is written by the same class, and
tests/life/test_recovery.py fills their disk), and `reproduce` and `evaluate`, which compute for many seconds
before they write a file as a snapshot is written here, as calibrations and other formats of recordings are.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from errno import EFBIG
from itertools import repeat
from pathlib import Path
from tempfile import TemporaryDirectory

from attrs import frozen

from solepath.emulate import Route, emulate
from solepath.recording import PacketWriter

RECORDER = """
import sys
from solepath.recording import PacketWriter, RecordingError, read_packets
try:
    with PacketWriter("new.jsonl", replace=True) as writer:
        for packet in read_packets("walk.jsonl"):
            writer.write(packet)
except RecordingError as error:
    sys.exit(print(error, file=sys.stderr) or 2)
"""
"""Program that copies a recording as an app writes it."""
SNAPSHOT = """
import json
import sys
from solepath import Session
from solepath.recording import read_packets
from solepath.saving.files import write_whole
session = Session()
session.feed(read_packets("walk.jsonl"))
try:
    write_whole("session.json", json.dumps(session.snapshot()))
except OSError as error:
    print(error, file=sys.stderr)
    sys.exit(2)
"""
"""Program that writes a snapshot as an app does."""


@frozen
class Writer:
    """A program that writes files into its working directory."""

    name: str
    arguments: tuple[str, ...]
    outputs: tuple[str, ...]
    """Files, or directories of files, that it writes."""
    grows: bool = False
    """Flag: its file grows while it runs, and keeps what was written before the error."""


SOLEPATH = ("-m", "solepath")
TOO_LARGE = (os.strerror(EFBIG).lower(), "larger than this disk allows")
"""Reason for a write beyond the limit, by the system and by the command line; other programs have not written."""
WRITERS = (
    Writer(
        "track --out --report",
        (*SOLEPATH, "track", "walk.jsonl", "--out", "out", "--report", "r.html"),
        ("out", "r.html"),
    ),
    Writer("convert to MCAP", (*SOLEPATH, "convert", "walk.jsonl", "new.mcap", "--force"), ("new.mcap",)),
    Writer(
        "demo --record",
        (*SOLEPATH, "demo", "--distance", "5", "--record", "demo.jsonl", "--force"),
        ("demo.jsonl",),
        grows=True,
    ),
    Writer("a snapshot of an app", ("-c", SNAPSHOT), ("session.json",)),
    Writer("a recording of an app", ("-c", RECORDER), ("new.jsonl",), grows=True),
)


class Broken(AssertionError):
    """A promise that did not hold."""


def run(writer: Writer, folder: Path, limit: int | None) -> subprocess.CompletedProcess[str]:
    """Run the program, with a limit of the size of each file, bytes."""

    def limit_files() -> None:
        if limit is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, *writer.arguments]
    return subprocess.run(
        command, cwd=folder, env=environment, preexec_fn=limit_files, capture_output=True, text=True, check=False
    )


def contents(folder: Path, writer: Writer) -> dict[str, bytes]:
    """Return the content of each output, by its path."""
    paths = [folder / name for name in writer.outputs]
    files = [file for path in paths for file in ([path] if path.is_file() else path.glob("*"))]
    return {str(file.relative_to(folder)): file.read_bytes() for file in files}


def check_writer(writer: Writer, folder: Path, steps: int) -> str:
    """Run a program with ever more space; return the line for it."""
    first = run(writer, folder, None)
    if first.returncode != 0:
        raise Broken(f"{writer.name} does not run: {first.stderr}")
    whole = contents(folder, writer)
    names = sorted(path.name for path in folder.iterdir())
    largest = max(map(len, whole.values()))
    for step in range(steps):
        limit = step * (largest - 1) // (steps - 1)
        done = run(writer, folder, limit)
        line = done.stderr.lower()
        if done.returncode != 2 or len(line.splitlines()) != 1 or not any(words in line for words in TOO_LARGE):
            raise Broken(f"{writer.name}, {limit} bytes: status {done.returncode}, stderr {done.stderr!r}")
        after = contents(folder, writer)
        if writer.grows:
            (path,) = writer.outputs
            kept = after[path]
            if not whole[path].startswith(kept) or kept[-1:] not in (b"", b"\n") or len(kept) + 1000 < limit:
                raise Broken(f"{writer.name}, {limit} bytes: not the first packets")
        elif after != whole:
            raise Broken(f"{writer.name}, {limit} bytes: files of an earlier run are others now")
        if sorted(path.name for path in folder.iterdir()) != names:
            raise Broken(f"{writer.name}, {limit} bytes: leaves {sorted(path.name for path in folder.iterdir())}")
    return f"{writer.name}: {steps} full disks from 0 to {largest - 1:,} bytes, {len(whole)} files whole or as before"


def check_one(number: int, steps: int) -> str:
    """Check the program of this number in a directory of its own; return the line for it."""
    walk = emulate(Route().stand(2.0).walk(6.0, 1.3).stop(2.0), seed=1).packets
    with TemporaryDirectory() as name:
        folder = Path(name)
        with PacketWriter(folder / "walk.jsonl") as recording:
            for packet in walk:
                recording.write(packet)
        return check_writer(WRITERS[number], folder, steps)


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--steps", type=int, default=12, metavar="N")
    chosen = options.parse_args()
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        try:
            for line in pool.map(check_one, range(len(WRITERS)), repeat(chosen.steps)):
                print(line, flush=True)
        except Broken as error:
            print(f"BROKEN: {error}")
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
