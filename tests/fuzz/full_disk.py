"""Writes files of every kind while the disk is full after so many bytes: `python tests/fuzz/full_disk.py [--steps N]`.

Each program runs once undisturbed, and then N times (default: 12) with a limit of the size of a file in place of the
full disk: from no byte to one less than its largest file. Each must end with status 2 and one line on stderr; files of
an earlier run must be as they were, and a recording must hold the packets up to the error. It prints a line for each
program, and exits with 1 at the first promise that is broken. A limit of the size is idealised: a disk that is full
also allows no new file.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from attrs import frozen

from solepath.emulate import Route, emulate
from solepath.recording import PacketWriter, read_packets

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
CALIBRATOR = """
import sys
from solepath import Calibration
from solepath.calibration import ShoeGeometry
from solepath.calibration.file import write_calibration
try:
    write_calibration("wearer.json", Calibration(shoe=ShoeGeometry()))
except OSError as error:
    print(error, file=sys.stderr)
    sys.exit(2)
"""
"""Program that writes a calibration as an app does."""


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
WRITERS = (
    Writer(
        "track --out --report",
        (*SOLEPATH, "track", "walk.jsonl", "--out", "out", "--report", "r.html"),
        ("out", "r.html"),
    ),
    Writer("convert to MCAP", (*SOLEPATH, "convert", "walk.jsonl", "walk.mcap"), ("walk.mcap",)),
    Writer("a calibration of an app", ("-c", CALIBRATOR), ("wearer.json",)),
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
        if done.returncode != 2 or len(done.stderr.splitlines()) != 1:
            raise Broken(f"{writer.name}, {limit} bytes: status {done.returncode}, stderr {done.stderr!r}")
        after = contents(folder, writer)
        if writer.grows:
            (path,) = writer.outputs
            kept = list(read_packets(folder / path)) if after[path] else []
            given = list(read_packets(folder / "walk.jsonl"))
            if kept != given[: len(kept)] or after[path][-1:] not in (b"", b"\n") or len(after[path]) + 1000 < limit:
                raise Broken(f"{writer.name}, {limit} bytes: not the first packets")
        elif after != whole:
            raise Broken(f"{writer.name}, {limit} bytes: files of an earlier run are others now")
        if sorted(path.name for path in folder.iterdir()) != names:
            raise Broken(f"{writer.name}, {limit} bytes: leaves {sorted(path.name for path in folder.iterdir())}")
    return f"{writer.name}: {steps} full disks from 0 to {largest - 1:,} bytes, {len(whole)} files whole or as before"


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--steps", type=int, default=12, metavar="N")
    chosen = options.parse_args()
    for writer in WRITERS:
        with TemporaryDirectory() as name:
            folder = Path(name)
            with PacketWriter(folder / "walk.jsonl") as recording:
                for packet in emulate(Route().stand(2.0).walk(6.0, 1.3).stop(2.0), seed=1).packets:
                    recording.write(packet)
            try:
                print(check_writer(writer, folder, chosen.steps), flush=True)
            except Broken as error:
                print(f"BROKEN: {error}")
                return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
