"""Reference run of the walks through sessions without an engine: `python -m solepath.fleet.demo.bare RUN PART`.

RUN is a directory of a stage, PART the index of a partition. The wearers follow one another; the packets of a wearer
are made before its session is timed."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from time import perf_counter, process_time

from ...events import Event
from ...recipes import Recipe
from ...session import Session
from ...types import Packet
from ..fleet import Fleet
from ..parquet import PartFiles
from ..step.sent import NumberedEvent, Tick
from ..step.state import read_rest
from .child import end_with_parent, freeze_garbage
from .job import EVENTS
from .sending import DemoPayload
from .wearers import DemoWearer, Wearers

MEASURED_WEARERS = 60
"""Number of wearers whose states are measured."""


def main(run: str, part: int) -> None:
    """Write the events of the partition, and the times that its sessions took, s, into the directory `run`."""
    end_with_parent()
    directory = Path(run)
    wearers = Wearers.read(directory.parent)
    fleet = Fleet(wearers.recipe)
    part_files = PartFiles(directory / EVENTS, str(part))
    freeze_garbage()
    taken = cpu = 0.0
    for wearer in wearers.of_partition(part):
        seconds_used, cpu_used, events = _run_session(wearers.recipe, wearer.inputs())
        taken += seconds_used
        cpu += cpu_used
        part_files.write(NumberedEvent(wearer.name, number, event) for number, event in enumerate(events))
    part_files.close()
    states = _measure_states(fleet, wearers.of_partition(part)[:MEASURED_WEARERS], wearers.bundles)
    results = {"seconds": taken, "cpu": cpu, "states": states}
    (directory / f"bare-{part}.json").write_text(json.dumps(results), encoding="utf-8")


def _run_session(recipe: Recipe, inputs: list[DemoPayload]) -> tuple[float, float, list[Event]]:
    """Run a session from start to end; return its duration, s, its processor time, s, and its events."""
    events: list[Event] = []
    t_start, cpu_start = perf_counter(), process_time()
    session = Session(recipe)
    for payload in inputs:
        if type(payload) is Packet:
            events += session.feed(payload)
        elif isinstance(payload, Tick):
            events += session.advance(payload.t)
        else:
            events += session.finish()
    return perf_counter() - t_start, process_time() - cpu_start, events


def _measure_states(fleet: Fleet, wearers: list[DemoWearer], bundles: int) -> list[tuple[int, int, float]]:
    """Return size, bytes, number of held rows, and time to take it, s, of each wearer's state after each bundle.

    The states are taken one wearer after the other, as an engine does."""
    sessions, measurements = [fleet.open(wearer.name, None) for wearer in wearers], []
    for number in range(bundles):
        for keyed, wearer in zip(sessions, wearers, strict=True):
            keyed.feed(wearer.bundle(number))
        for keyed in sessions:
            t_start = perf_counter()
            state = keyed.state()
            seconds = perf_counter() - t_start
            measurements.append((len(state), len(read_rest(state).held_rows), seconds))
    return measurements


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
