"""The same walks through sessions alone, without an engine: `python -m solepath.fleet.demo.bare RUN PART`.

What it is to be compared with: the events, and how long `Session.feed` takes for them, one wearer after the other and
with the packets ready beforehand.
"""

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
from .child import end_with_parent, settle
from .job import TOLD
from .sending import What
from .wearers import DemoWearer, Wearers

MEASURED = 60
"""Wearers whose states are looked at."""


def main(run: str, part: int) -> None:
    """Write the events, and how long they took, into the directory of a run."""
    end_with_parent()
    home = Path(run)
    wearers = Wearers.read(home.parent)
    fleet = Fleet(wearers.recipe)
    parts = PartFiles(home / TOLD, str(part))
    settle()
    taken = cpu = 0.0
    for wearer in wearers.of_part(part):
        seconds, used, events = _through(wearers.recipe, wearer.heard())
        taken += seconds
        cpu += used
        parts.write(NumberedEvent(wearer.name, number, event) for number, event in enumerate(events))
    parts.close()
    states = _states(fleet, wearers.of_part(part)[:MEASURED], wearers.bundles)
    found = {"seconds": taken, "cpu": cpu, "states": states}
    (home / f"bare-{part}.json").write_text(json.dumps(found), encoding="utf-8")


def _through(recipe: Recipe, heard: list[What]) -> tuple[float, float, list[Event]]:
    """A session from its beginning: s that it took, s of the processor, and what came out."""
    events: list[Event] = []
    began, used = perf_counter(), process_time()
    session = Session(recipe)
    for what in heard:
        if type(what) is Packet:
            events += session.feed(what)
        elif isinstance(what, Tick):
            events += session.advance(what.t)
        else:
            events += session.finish()
    return perf_counter() - began, process_time() - used, events


def _states(fleet: Fleet, wearers: list[DemoWearer], bundles: int) -> list[tuple[int, int, float]]:
    """Bytes of the wearers' states after each bundle, rows that are held in it, and s that it took to take it: one
    wearer's after the other's, as an engine does."""
    opened, found = [fleet.open(wearer.name, None) for wearer in wearers], []
    for number in range(bundles):
        for keyed, wearer in zip(opened, wearers, strict=True):
            keyed.feed(wearer.bundle(number))
        for keyed in opened:
            began = perf_counter()
            state = keyed.state()
            seconds = perf_counter() - began
            found.append((len(state), len(read_rest(state).held), seconds))
    return found


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
