"""A job on bytewax for a process of its own: what phones sent, from a file of lines, through the fleet into files.

    python fleet_job.py SENT DIRECTORY STORE [--die-at N]
"""

from __future__ import annotations

import argparse
import os
import signal
from collections.abc import Iterator
from datetime import timedelta
from pathlib import Path

from attrs import frozen
from bytewax import operators
from bytewax.dataflow import Dataflow
from bytewax.recovery import RecoveryConfig, init_db_dir
from bytewax.testing import TestingSource, run_main

from solepath.fleet import Fleet, Sent, Unreadable, read_line
from solepath.fleet.bytewax import ParquetSink, gait


@frozen
class Lines:
    """What is in the file. Whoever gets to line `die_at` dies there, without another word."""

    path: Path
    die_at: int | None

    def __iter__(self) -> Iterator[Sent | Unreadable]:
        for number, line in enumerate(self.path.read_bytes().splitlines()):
            if number == self.die_at:
                os.kill(os.getpid(), signal.SIGKILL)
            yield read_line(line)


def main() -> None:
    parser = argparse.ArgumentParser()
    for name in ("sent", "directory", "store"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--die-at", type=int)
    asked = parser.parse_args()
    if not asked.store.exists():
        asked.store.mkdir()
        init_db_dir(asked.store, 1)
    flow = Dataflow("job")
    sent = operators.input("sent", flow, TestingSource(Lines(asked.sent, asked.die_at), batch_size=25))
    keyed = operators.key_on("wearer", sent, lambda one: one.wearer)
    operators.output("files", gait("gait", keyed, Fleet()), ParquetSink(asked.directory, partitions=2))
    try:
        run_main(flow, epoch_interval=timedelta(milliseconds=50), recovery_config=RecoveryConfig(asked.store))
    except Exception as error:  # bytewax hangs its own around what a sink raised
        raise SystemExit(f"error: {error.__cause__ or error}") from None


if __name__ == "__main__":
    main()
