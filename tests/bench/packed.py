"""Measures the size of a session's state: `python tests/bench/packed.py`. Prints tables; asserts nothing.

A session is packed (`Session.pack`) after every 50 packets of a walk. Then all these states are unpacked and packed
again, one after the other, as a stream engine does with those of many wearers. Times are processor times in
microseconds, with the garbage collector off.
"""

from __future__ import annotations

import gc
import json
from collections.abc import Callable
from functools import partial
from statistics import mean, median, quantiles
from time import thread_time
from typing import Any

from measure import machine

from solepath import Packet, Recipe, Session, Site, recipes
from solepath.emulate.radio import Radio
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2650
from solepath.emulate.walk import emulate

ROUTE = Route().stand(2.0).walk(40.0, 1.3).turn(1.57, radius=1.5).walk(20.0).turn(-0.8, radius=2.0).walk(10.0).stop(2.0)
"""A walk of about a minute."""
RADIO = Radio(loss=0.01, duplicate=0.002, latency=0.01, jitter=0.03)
PACK_INTERVAL = 50

WALKS: dict[str, tuple[Recipe, Callable[[], Any]]] = {
    "default, two insoles of 48 cells": (recipes.DEFAULT, partial(Insole, cells=48)),
    "default, two insoles of 96 cells": (recipes.DEFAULT, partial(Insole, cells=96)),
    "default, two SensorTags": (recipes.DEFAULT, CC2650),
    "kupt-dfpc, two insoles of 48 cells": (recipes.by_name("kupt-dfpc"), partial(Insole, cells=48)),
    "footstep-tracker, two SensorTags": (recipes.by_name("footstep-tracker"), CC2650),
}


def packets(device: Callable[[], Any]) -> tuple[Packet, ...]:
    """Return the packets of both feet, over a radio that loses some."""
    return emulate(ROUTE, devices={site: device() for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT)}, radio=RADIO).packets


def microseconds(work: Callable[[], Any]) -> tuple[Any, float]:
    """Return the result of `work`, and its time in microseconds."""
    gc.disable()
    started_at = thread_time()
    result = work()
    duration = (thread_time() - started_at) * 1e6
    gc.enable()
    return result, duration


def percentile_95(values: list[float]) -> float:
    """Return the value below which 95 % lie."""
    return quantiles(values, n=20, method="inclusive")[-1]


def measure_walk(name: str) -> None:
    """Print the sizes and times of the session of this walk."""
    recipe, device = WALKS[name]
    session, saved_states = Session(recipe), list[bytes]()
    for i, packet in enumerate(packets(device)):
        session.feed(packet)
        if i % PACK_INTERVAL == 0:
            saved_states.append(session.pack())
    print_row(name, saved_states, partial(Session.unpack, recipe=recipe), Session.pack)
    texts = [json.dumps(Session.unpack(data, recipe).snapshot()) for data in saved_states[::10]]
    print_row(
        "  as JSON", texts, lambda text: Session.restore(json.loads(text)), lambda one: json.dumps(one.snapshot())
    )


COLUMNS = (
    "bytes, mean", "bytes, most", "pack, median", "pack, 95 %", "pack, most", "unpack, median", "unpack, 95 %",
)  # fmt: skip


def print_row(
    name: str, saved_states: list[Any], load: Callable[[Any], Session], save: Callable[[Session], Any]
) -> None:
    """Print sizes and times of all states. The first of two rounds is not counted."""
    for _ in range(2):
        loaded = [microseconds(partial(load, saved)) for saved in saved_states]
        packed = [microseconds(partial(save, session)) for session, _ in loaded]
    if [saved for saved, _ in packed] != saved_states:
        raise SystemExit(f"{name}: what was unpacked is packed in other bytes")
    sizes, packing, unpacking = (
        [len(saved) for saved in saved_states],
        [duration for _, duration in packed],
        [t for _, t in loaded],
    )
    figures = (
        *(mean(sizes), max(sizes)),
        *(median(packing), percentile_95(packing), max(packing)),
        *(median(unpacking), percentile_95(unpacking)),
    )
    cells = [f"{value:{len(column)}.0f}" for column, value in zip(COLUMNS, figures, strict=True)]
    print(f"{name:34}  " + "  ".join(cells), flush=True)


def main() -> None:
    print(f"{machine()}, one used; bytes of a state, us to pack and unpack")
    print(f"{'':34}  " + "  ".join(COLUMNS))
    for name in WALKS:
        measure_walk(name)


if __name__ == "__main__":
    main()
