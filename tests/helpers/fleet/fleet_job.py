"""A job on bytewax for a separate process: it reads the rows of phones from files of lines and writes event files.

python fleet_job.py SENT DIRECTORY STORE [--die-at N]
"""

from __future__ import annotations

import argparse
import os
import signal
from collections.abc import Callable
from datetime import timedelta
from itertools import count
from pathlib import Path

from bytewax import operators
from bytewax.dataflow import Dataflow
from bytewax.recovery import RecoveryConfig, init_db_dir
from bytewax.testing import run_main

from solepath.fleet import Fleet, Sent, Unreadable, read_lines
from solepath.fleet.bytewax import ParquetSink, gait
from solepath.fleet.lines import LineSource


def reader(die_at: int | None) -> Callable[[list[bytes]], list[tuple[str, list[Sent | Unreadable]]]]:
    """Return a reader of lines that kills this process at line number `die_at` of those that it reads."""
    numbers = count()

    def read(lines: list[bytes]) -> list[tuple[str, list[Sent | Unreadable]]]:
        if die_at in [next(numbers) for _ in lines]:
            os.kill(os.getpid(), signal.SIGKILL)
        return read_lines(lines)

    return read


def main() -> None:
    parser = argparse.ArgumentParser()
    for name in ("sent", "directory", "store"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--die-at", type=int)
    options = parser.parse_args()
    if not options.store.exists():
        options.store.mkdir()
        init_db_dir(options.store, 1)
    flow = Dataflow("job")
    lines = operators.input("phones", flow, LineSource(options.sent, batch=25))
    keyed = operators.flat_map_batch("read", lines, reader(options.die_at))
    operators.output("files", gait("gait", keyed, Fleet()), ParquetSink(options.directory, partitions=2))
    try:
        run_main(flow, epoch_interval=timedelta(milliseconds=50), recovery_config=RecoveryConfig(options.store))
    except Exception as error:  # bytewax wraps the exception of a sink in its own
        raise SystemExit(f"error: {error.__cause__ or error}") from None


if __name__ == "__main__":
    main()
