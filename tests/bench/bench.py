"""Measures processing times: `python tests/bench/bench.py`. Prints a table; asserts nothing.

Medians of five runs in one process on one core, with the garbage collector off while the clock runs, as in timeit. The
last column is the time as a multiple of the yardstick (yardstick.py), which depends less on the machine.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from functools import partial
from statistics import median
from time import perf_counter
from typing import Any

from measure import RUNS, held, machine, seconds, uncollected
from yardstick import Tuned, Usual

from solepath import Calibration, Foot, Packet, Recipe, Sample, Session, Site, StrideTaken, recipes
from solepath.body.gait.turns import Turns
from solepath.body.part import ActivityPart, Part, TrackPart
from solepath.body.place.place_hypotheses import PlaceHypotheses
from solepath.body.worn.wear import Wear
from solepath.calibration import InsoleCalibration
from solepath.emulate.radio import CLEAN
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.route import Route
from solepath.emulate.routes.ways import wandering
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.sensors.suit import limb_samples
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.walker import Walker
from solepath.floorplan.index import IndexedPlan
from solepath.foot.navigate.dedrift import LinearDedrift
from solepath.foot.stance.cycle import Cycle
from solepath.link.decoder import Decoder
from solepath.types import SITE_OF_FOOT

ROUTE = Route().stand(2.0).walk(50.0, 1.3).stop(2.0)
"""A walk of about 43 s, of which the foot stands 10 %."""


def each(items: list[Any], make: Callable[[], Any], prepare: Iterable[Any] = ()) -> float:
    """Return microseconds an item: a new object is fed `prepare` unmeasured, then all items one by one."""
    found = []
    for _ in range(RUNS):
        one = make()
        for item in prepare:
            one.feed(item)
        feed = one.feed
        with uncollected():
            started_at = perf_counter()
            for item in items:
                feed(item)
            found.append((perf_counter() - started_at) / len(items) * 1e6)
    return median(found)


def fed(items: Iterable[Any]) -> Session:
    """Return a session after all these items."""
    session = Session()
    for item in items:
        session.feed(item)
    return session


def session_with_layout(recipe: Recipe, infos: list[Packet]) -> Session:
    """Return a session that has received the positions of the cells."""
    session = Session(recipe)
    session.feed(infos)
    return session


class Timed:
    """Wraps a part and sums the time of its calls, with or without the garbage collector.

    Fields are the part's own, and the wrapper passes for an instance of the part's class.
    """

    def __init__(self, part: Any) -> None:
        self.part = part
        self.taken = 0.0
        self.calls = 0

    @property  # type: ignore[misc]
    def __class__(self) -> Any:
        return type(self.part)

    def receive(self, event: Any) -> Any:
        """Forward an event; a method of the class, because a wearer tests the class for it."""
        return self.__getattr__("receive")(event)

    def __setattr__(self, name: str, value: Any) -> None:
        if name in ("part", "taken", "calls"):
            object.__setattr__(self, name, value)
        else:
            setattr(self.part, name, value)

    def __getattr__(self, name: str) -> Any:
        what = getattr(self.part, name)
        if not callable(what):
            return what

        def timed(*arguments: Any) -> Any:
            started_at = perf_counter()
            try:
                return what(*arguments)
            finally:
                self.taken += perf_counter() - started_at
                self.calls += 1

        return timed


OF_A_SAMPLE: dict[str, str | type[Part]] = {
    "rest": "rest",
    "detector": "detector",
    "filter": "corrector",
    "cues": "cues",
    "cells": "sole",
    "activities": ActivityPart,
    "turns": Turns,
    "how it is worn": Wear,
    "body": TrackPart,
}
"""The part of a sample's time that a row shows: a field of the foot, or a kind of part."""


def shares_of(items: list[Sample], make: Callable[[], Session]) -> dict[str, float]:
    """Return microseconds a sample that each part of a foot and of a wearer takes, less the clock's own time."""
    return {name: median([_share(items, make(), what) for _ in range(RUNS)]) for name, what in OF_A_SAMPLE.items()}


def _share(items: list[Sample], session: Session, what: str | type[Part]) -> float:
    """Return the time of one part; one at a time, because a timed part would slow down a part that reads it."""
    session.feed(items[0])
    part = _watched(session, what)
    with uncollected():
        for item in items[1:]:
            session.feed(item)
    return (part.taken - part.calls * overhead()) / len(items) * 1e6


def _watched(session: Session, what: str | type[Part]) -> Timed:
    wearer = session._state.wearer
    if isinstance(what, str):
        foot = next(iter(wearer.feet.values()))
        part = Timed(getattr(foot, what))
        setattr(foot, what, part)
    else:
        place = next(k for k, one in enumerate(wearer.parts) if isinstance(one, what))
        part = wearer.parts[place] = Timed(wearer.parts[place])
        wearer._choose_sampled()
    return part


def overhead() -> float:
    """Return the time that `Timed` measures for a call that does nothing, s."""

    class Idle:
        def call(self, one: int, other: int) -> None:
            pass

    idle = Timed(Idle())
    for _ in range(20_000):
        idle.call(1, 2)
    return idle.taken / idle.calls


def parts_of(items: list[Sample], recipe: Recipe, plan: IndexedPlan) -> dict[str, float]:
    """Return microseconds a sample that activities, turns and the place on a plan take in a walk through a building."""
    kinds: dict[str, type[Part]] = {"activity": ActivityPart, "turns": Turns, "place": PlaceHypotheses}
    found: dict[str, list[float]] = {name: [] for name in kinds}
    for _ in range(RUNS):
        session = Session(recipe, floorplan=plan)
        watched = {name: _watched(session, kind) for name, kind in kinds.items()}
        with uncollected():
            for item in items:
                session.feed(item)
        for name, part in watched.items():
            found[name].append(part.taken / len(items) * 1e6)
    return {name: median(taken) for name, taken in found.items()}


def _moment(sample: Sample) -> float:
    return sample.t


def main() -> None:
    walker = Walker(ROUTE, seed=1)
    bare: list[Sample] = walker.samples(Foot.LEFT, 100.0, LSM6DSOX)
    pressed: list[Sample] = walker.samples(Foot.LEFT, 100.0, LSM6DSOX, layout=layout(96, Foot.LEFT))
    walk = emulate(ROUTE, radio=CLEAN, seed=1)
    left = [packet for packet in walk.packets if packet.site is Site.LEFT_FOOT]
    info = [packet for packet in left if packet.channel != "insole/frame"]
    frames = [packet for packet in left if packet.channel == "insole/frame"]
    (info_packet,) = [packet for packet in info if packet.channel == "insole/info"]
    small = Insole(cells=24, mtu=23)
    fragments = list(emulate(ROUTE, devices={Site.LEFT_FOOT: small}, seed=1).packets)
    linear = Recipe("linear", Cycle(), LinearDedrift())

    faster: list[Sample] = walker.samples(Foot.LEFT, 200.0, LSM6DSOX)

    yard = each(bare, Usual)
    rows: list[tuple[str, float, str]] = []

    def add(what: str, microseconds: float, unit: str = "us a sample") -> None:
        rows.append((what, microseconds, unit))

    def decoder() -> Decoder:
        return Decoder(Site.LEFT_FOOT)

    def knowing(**given: bool) -> Session:
        session = Session(**given)
        session.feed(info_packet)
        return session

    add("yardstick: numpy, nine states, SHOE, the usual way", yard)
    add("the same, tuned", each(bare, Tuned))
    add("foot sample, inertial", each(bare, Session))
    add("foot sample, inertial at 200 Hz", each(faster, Session))
    add("foot sample, inertial, FootMoved", each(bare, lambda: Session(poses=True)))
    add("foot sample, 96 cells", each(pressed, knowing))
    add("foot sample, 96 cells, FootMoved", each(pressed, partial(knowing, poses=True)))
    add("foot sample, 96 cells, FootMoved and FootPressed", each(pressed, partial(knowing, poses=True, pressures=True)))
    add("foot sample, inertial, linear dedrift", each(bare, lambda: Session(linear)))
    infos = [packet for packet in walk.packets if packet.channel == "insole/info"]
    two_feet = walker.samples(Foot.RIGHT, 100.0, LSM6DSOX, layout=layout(96, Foot.RIGHT)) + pressed
    two_feet.sort(key=_moment)
    for recipe in map(recipes.by_name, recipes.NAMES):
        add(f"both feet, 96 cells, {recipe.name}", each(two_feet, partial(session_with_layout, recipe, infos)))
    layouts = {site: layout(99, foot) for foot, site in SITE_OF_FOOT.items()}
    suit = limb_samples(walker, 50.0, seed=1, layouts=layouts)
    insoles = sum(sample.pressure is not None for sample in suit)
    worn = Calibration(insoles={foot: InsoleCalibration(layout(99, foot)) for foot in Foot})
    microseconds = each(suit, partial(Session, recipes.by_name("walking-modes"), calibration=worn))
    add("both feet, 99 cells, five limbs, walking-modes", microseconds * len(suit) / insoles, "us an insole sample")
    add("insole frame, 96 cells: decode", each(frames, decoder, info), "us a packet")
    add("insole frame, 96 cells: session", each(frames, Session, info), "us a packet")
    add("insole frame, 96 cells: session, FootMoved", each(frames, lambda: Session(poses=True), info), "us a packet")
    add("insole fragment of 20 bytes: session", each(fragments, Session), "us a packet")

    for name, took in shares_of(bare, Session).items():
        add(f"of a foot sample, inertial: {name}", took)
    pressing = shares_of(pressed, knowing)
    add("of a foot sample, 96 cells: cells", pressing["cells"])

    way = wandering(1)
    indoors = Walker(way.route, seed=1)
    wandered = [sample for foot in Foot for sample in indoors.samples(foot, 100.0, LSM6DSOX)]
    wandered.sort(key=_moment)
    for recipe in (recipes.DEFAULT, recipes.by_name("footstep-tracker"), recipes.by_name("shoe-sensing")):
        took = parts_of(wandered, recipe, IndexedPlan(BUILDING))
        for name, what in (("activity", "activities"), ("turns", "turns"), ("place", "place on a floor plan")):
            add(f"of it {what}, {recipe.name}", took[name])

    duration = walk.packets[-1].t
    real_time = duration / seconds(lambda: fed(walk.packets))

    session = Session()
    steps = sum(isinstance(event, StrideTaken) for event in session.feed(walk.packets))
    saved = session.snapshot()
    text = json.dumps(saved)
    save, load = seconds(session.snapshot), seconds(lambda: Session.restore(saved))

    print(f"{machine()}, one used; medians of {RUNS}")
    print(f"{len(bare)} samples, {len(frames)} frames, {steps} steps of both feet in {duration:.0f} s of walking")
    print()
    width = max(len(what) for what, _, _ in rows)
    print(f"{'':{width}}  {'time':>8} {'':<19} {'of the yardstick':>16}")
    for what, value, unit in rows:
        print(f"{what:{width}}  {value:8.1f} {unit:<19} {value / yard:16.2f}")
    print()
    print(f"real-time factor, both feet with 96 cells at 100 Hz: {real_time:.0f}")
    print(f"snapshot {save * 1e3:.1f} ms, restore {load * 1e3:.1f} ms, {len(text) / 1000:.1f} kB as JSON")
    print(f"memory of a session: {held(lambda: fed(bare)) / 1000:.0f} kB one foot, inertial; ", end="")
    print(f"{held(lambda: fed(walk.packets)) / 1000:.0f} kB both feet with 96 cells and links")


if __name__ == "__main__":
    main()
