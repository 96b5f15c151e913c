"""Measures the size of a session's state: `python tests/bench/packed.py [--fields N]`. Prints tables; asserts nothing.

A session is packed every 50 packets of a walk. Then all these sessions are unpacked, and packed, one after the other,
as an engine does with those of many wearers. Times are the processor's, in microseconds, with the garbage collector
off meanwhile. `--fields N` also prints the N fields that take the most bytes at the end.
"""

from __future__ import annotations

import argparse
import gc
import json
from collections import Counter
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
from solepath.saving.nodes import (
    DictNode,
    EnumNode,
    MaybeNode,
    Node,
    OpenNode,
    RecordNode,
    RowNode,
    ScalarNode,
    TupleNode,
)
from solepath.saving.schema import record_in
from solepath.saving.streams import to_bytes
from solepath.session.packed import STATE

ROUTE = Route().stand(2.0).walk(40.0, 1.3).turn(1.57, radius=1.5).walk(20.0).turn(-0.8, radius=2.0).walk(10.0).stop(2.0)
"""A walk of about a minute."""
RADIO = Radio(loss=0.01, duplicate=0.002, latency=0.01, jitter=0.03)
EVERY = 50

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
    given = work()
    took = (thread_time() - started_at) * 1e6
    gc.enable()
    return given, took


def nearly_most(values: list[float]) -> float:
    """Return the value below which 95 % lie."""
    return quantiles(values, n=20, method="inclusive")[-1]


def walked(name: str) -> Session:
    """Print the figures of the session of this walk, and return it."""
    recipe, device = WALKS[name]
    session, moments = Session(recipe), list[bytes]()
    for i, packet in enumerate(packets(device)):
        session.feed(packet)
        if i % EVERY == 0:
            moments.append(session.pack())
    show(name, moments, partial(Session.unpack, recipe=recipe), Session.pack)
    texts = [json.dumps(Session.unpack(data, recipe).snapshot()) for data in moments[::10]]
    show("  as JSON", texts, lambda text: Session.restore(json.loads(text)), lambda one: json.dumps(one.snapshot()))
    return session


COLUMNS = (
    "bytes, mean", "bytes, most", "pack, median", "pack, 95 %", "pack, most", "unpack, median", "unpack, 95 %",
)  # fmt: skip


def show(name: str, moments: list[Any], load: Callable[[Any], Session], save: Callable[[Session], Any]) -> None:
    """Print the sizes and the times of all sessions, one after the other, after a round that is not counted."""
    for _ in range(2):
        loaded = [microseconds(partial(load, saved)) for saved in moments]
        packed = [microseconds(partial(save, session)) for session, _ in loaded]
    if [saved for saved, _ in packed] != moments:
        raise SystemExit(f"{name}: what was unpacked is packed in other bytes")
    sizes, packing, unpacking = [len(saved) for saved in moments], [took for _, took in packed], [t for _, t in loaded]
    figures = (
        *(mean(sizes), max(sizes)),
        *(median(packing), nearly_most(packing), max(packing)),
        *(median(unpacking), nearly_most(unpacking)),
    )
    cells = [f"{value:{len(column)}.0f}" for column, value in zip(COLUMNS, figures, strict=True)]
    print(f"{name:34}  " + "  ".join(cells), flush=True)


class Account:
    """Sums bytes by field."""

    def __init__(self) -> None:
        self.bytes: Counter[str] = Counter()
        self.counts: Counter[str] = Counter()

    def add(self, at: str, bits: float) -> None:
        self.bytes[at] += bits / 8.0
        self.counts[at] += 1

    def value(self, node: Node, value: Any, at: str) -> None:
        match node:
            case RecordNode(cls, _, fields):
                for field, inner in fields.items():
                    self.value(inner, getattr(value, field), f"{cls.__name__}.{field}")
            case ScalarNode(kind):
                self.scalar(kind, value, at)
            case EnumNode():
                self.add(at, 10)
            case OpenNode():
                self.add(at, 10)
                self.value(record_in(node, type(value)), value, at)
            case MaybeNode(of):
                self.add(at, 1)
                if value is not None:
                    self.value(of, value, at)
            case TupleNode(items):
                for item, held in zip(items, value, strict=True):
                    self.value(item, held, at)
            case RowNode(_, of):
                self.add(at, 10)
                for held in value:
                    self.value(of, held, at)
            case DictNode(key, of):
                self.add(at, 10)
                for name, held in value.items():
                    self.value(key, name, at)
                    self.value(of, held, at)

    def scalar(self, kind: type, value: Any, at: str) -> None:
        if kind is float:
            self.add(at, 3 + 8 * (len(to_bytes([value], [], [], [], (0.05000000074505806, 0.0))) - NOTHING - 3))
        elif kind is int:
            self.add(at, 8 * (len(to_bytes([], [value], [], [], (0.0, 0.0))) - NOTHING - 2) + 2)
        elif kind is bool:
            self.add(at, 1)
        else:
            self.add(at, 8 * len(value) + 10)


NOTHING = len(to_bytes([], [], [], [], (0.0, 0.0)))


def fields(session: Session, most: int) -> None:
    """Print the fields that take the most bytes."""
    account = Account()
    account.value(STATE, session._state, "")
    for at, size in account.bytes.most_common(most):
        print(f"{size:8.0f} bytes, {account.counts[at]:4} items   {at}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fields", type=int, default=0, metavar="N")
    arguments = parser.parse_args()
    print(f"{machine()}, one used; bytes of a state, us to pack and unpack")
    print(f"{'':34}  " + "  ".join(COLUMNS))
    for name in WALKS:
        session = walked(name)
        if arguments.fields:
            fields(session, arguments.fields)


if __name__ == "__main__":
    main()
