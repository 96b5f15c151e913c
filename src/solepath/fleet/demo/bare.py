"""Reference run of the walks through sessions alone: `python -m solepath.fleet.demo.bare RUN PART`.

It writes the events, and the time that `Session.feed` takes for them, one wearer after the other and with the packets
prepared beforehand."""

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

MEASURED = 60
"""Number of wearers whose states are measured."""


def main(run: str, part: int) -> None:
    """Write the events, and the time that they took, into the directory of a run."""
    end_with_parent()
    home = Path(run)
    wearers = Wearers.read(home.parent)
    fleet = Fleet(wearers.recipe)
    parts = PartFiles(home / EVENTS, str(part))
    freeze_garbage()
    taken = cpu = 0.0
    for wearer in wearers.of_part(part):
        seconds, used, events = _through(wearers.recipe, wearer.inputs())
        taken += seconds
        cpu += used
        parts.write(NumberedEvent(wearer.name, number, event) for number, event in enumerate(events))
    parts.close()
    states = _states(fleet, wearers.of_part(part)[:MEASURED], wearers.bundles)
    found = {"seconds": taken, "cpu": cpu, "states": states}
    (home / f"bare-{part}.json").write_text(json.dumps(found), encoding="utf-8")


def _through(recipe: Recipe, inputs: list[DemoPayload]) -> tuple[float, float, list[Event]]:
    """Run a session from its start; return its duration, s, its processor time, s, and its events."""
    events: list[Event] = []
    t_start, used = perf_counter(), process_time()
    session = Session(recipe)
    for what in inputs:
        if type(what) is Packet:
            events += session.feed(what)
        elif isinstance(what, Tick):
            events += session.advance(what.t)
        else:
            events += session.finish()
    return perf_counter() - t_start, process_time() - used, events


def _states(fleet: Fleet, wearers: list[DemoWearer], bundles: int) -> list[tuple[int, int, float]]:
    """Measure the wearers' states after each bundle: bytes, rows held in it, and time to take it, s.

    The states are taken one wearer after the other, as an engine does."""
    opened, found = [fleet.open(wearer.name, None) for wearer in wearers], []
    for number in range(bundles):
        for keyed, wearer in zip(opened, wearers, strict=True):
            keyed.feed(wearer.bundle(number))
        for keyed in opened:
            t_start = perf_counter()
            state = keyed.state()
            seconds = perf_counter() - t_start
            found.append((len(state), len(read_rest(state).held), seconds))
    return found


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
