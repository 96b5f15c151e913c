"""The cases of the golden corpus: which input goes through which recipe, and what is done to it before (changes.py)."""

from __future__ import annotations

import json
import lzma
import os
from collections.abc import Callable, Iterable, Iterator
from functools import cache, partial
from itertools import takewhile
from pathlib import Path
from typing import Any

from attrs import evolve
from changes import (
    LEFT,
    RIGHT,
    Change,
    added,
    bursts,
    calls,
    cells,
    each,
    frozen_values,
    halved,
    later,
    left_handed,
    noisy,
    ordered,
    received,
    restarted,
    scaled,
    set_back,
    shuffled,
    smooth,
    strange,
    swapped,
    without,
)
from corpus import FOLDER, Call, Case, Item, given

from solepath import Calibration, Cell, Foot, IndexedPlan, Layout, Sample, Start, read_floorplan, recipes
from solepath.calibration.records import (
    HeadingCalibration,
    InsoleCalibration,
    Limbs,
    Newtons,
    SensorCalibration,
    ShoeGeometry,
    TriadCalibration,
)
from solepath.floorplan.importers.reading import parse_floorplan
from solepath.floorplan.plan import Anchor
from solepath.papers import WalkingMode
from solepath.recording import read_samples
from solepath.session.heading_walk import heading_calibration, heading_walk
from solepath.session.json_host import JsonHost

PROTOCOL = Path(__file__).resolve().parents[2] / "protocol"
G = 9.80665
"""Standard gravity, m/s^2."""


# --- options ----------------------------------------------------------------------------------------------------------


def sole(count: int, foot: Foot) -> Layout:
    """Return a layout of cells in two columns from heel to toe."""
    made = [Cell(0.02 + 0.22 * (k // 2) / (count // 2), 0.02 * (1 - 2 * (k % 2)), 4e-4) for k in range(count)]
    return Layout(7, foot, tuple(made), 0.26, 1.0, 400.0)


def known(count: int = 12) -> Calibration:
    """Return a calibration with a value for everything that can be calibrated."""
    triad = TriadCalibration(
        (1.01, 0.002, 0.0, 0.0, 0.99, -0.003, 0.001, 0.0, 1.005), (0.02, -0.03, 0.05), (1e-3,) * 9, (0.01,) * 3
    )
    rates = TriadCalibration(
        (1.0, 0.01, 0.0, -0.01, 1.0, 0.0, 0.0, 0.0, 1.0), (0.002, 0.001, -0.003), (1e-3,) * 9, (1e-4,) * 3
    )
    cubic = Newtons((0.5, 0.9, 1e-3, -1e-6), 3.0, 180.0)
    return Calibration(
        insoles={foot: InsoleCalibration(sole(count, foot), cubic, (2.0,) * count) for foot in Foot},
        shoe=ShoeGeometry(heel_radius=0.12, height=0.031),
        drift={Foot.LEFT: (0.003, -0.002), Foot.RIGHT: (-0.001, 0.004)},
        limbs=Limbs(hip_width=0.18, thigh=0.44, shank=0.42, foot=0.21, ankle_height=0.07),
        weight=720.0,
        modes={foot: {mode: (0.01 * k, -0.005 * k) for k, mode in enumerate(WalkingMode)} for foot in Foot},
        toe_out={Foot.LEFT: 0.1, Foot.RIGHT: 0.16},
        headings={
            Foot.LEFT: HeadingCalibration(0.002, 0.01, 1e-3, 2e-3),
            Foot.RIGHT: HeadingCalibration(-0.001, 0.0, 1e-3, 3e-3),
        },
        sensors={Foot.LEFT: SensorCalibration(triad, rates), Foot.RIGHT: SensorCalibration(triad, rates)},
    )


STARTS = {
    3: Start("1", (6.9, 4.9), 0.0, 0.5),
    8: Start("1", (22.9, 45.9), 0.0, 0.5),
    12: Start("0", (26.7, 53.897), 0.0, 0.5),
}
"""Place on the plan at which each walk through the building begins (level, m, rad, m)."""
WRONG_START, PLACE_ALONE = Start("0", (6.9, 4.9), 1.0, 2.0), Start("1", (22.9, 45.9))
"""A start elsewhere than the walk's, and one without a heading."""


@cache
def building() -> IndexedPlan:
    """Return the plan of the building in which the walks `building-*` take place."""
    plan = parse_floorplan(lzma.decompress((FOLDER / "inputs" / "building.geojson.xz").read_bytes()))
    return IndexedPlan(evolve(plan, anchor=Anchor(48.15, 11.57, 0.2)))


def planned(start: Start | None = None) -> dict[str, Any]:
    return {"floorplan": building(), "start": start, "poses": True}


LIVE = {"poses": True, "pressures": True}


# --- what is not a session --------------------------------------------------------------------------------------------


def plans() -> Iterator[Any]:
    """Yield every floor plan of protocol/ as it is read, and what it says of points and ways on a grid."""
    for path in sorted((PROTOCOL / "floorplans").iterdir()):
        if path.name == "invalid.json":
            continue
        plan = read_floorplan(path)
        yield plan
        yield from asked(IndexedPlan(plan))
    yield from asked(building())


def asked(plan: IndexedPlan) -> Iterator[Any]:
    """Yield what a plan says of points on a grid over all its levels, and of ways between them."""
    yield {"fingerprint": plan.fingerprint}
    for k, level in enumerate(plan.plan.levels):
        xs, ys = zip(*[end for wall in level.walls for end in (wall.start, wall.end)], strict=True)
        points = [
            (min(xs) - 1.0 + i * (max(xs) - min(xs) + 2.0) / 23, min(ys) - 1.0 + j * (max(ys) - min(ys) + 2.0) / 23)
            for i in range(24)
            for j in range(24)
        ]
        yield {
            "level": level.id,
            "points": [(plan.inside(k, x, y), plan.room(k, x, y), plan.door(k, x, y)) for x, y in points],
            "ways": [
                plan.crosses(k, *a, *b)
                for step in (1, 24, 25, 7, 190)
                for a, b in zip(points, points[step:], strict=False)
            ],
        }


def heading() -> Iterator[Any]:
    """Yield the drift of each foot from a walk there and back, and the calibration that is made of it."""
    fits = heading_walk(given("there-and-back"))
    yield from fits
    yield heading_calibration(fits)


def texts() -> Iterator[Any]:
    """Yield the answers to the texts of an app with two insoles, with two SensorTags, and with odd messages."""
    host = JsonHost()
    with lzma.open(FOLDER / "inputs" / "texts.jsonl.xz", "rt") as lines:
        for line in lines:
            yield json.loads(host.receive(line.removesuffix("\n")))


# --- the table --------------------------------------------------------------------------------------------------------


def of(name: str, *changes: Change, until: float = 1e9) -> Callable[[], Iterable[Item]]:
    """Return a function that makes the items of an input up to a time, s, changed in this order."""

    def make() -> Iterable[Item]:
        items: Iterable[Any] = [item for item in given(name) if item.t < until]
        for change in changes:
            items = list(change(tuple(items)))
        return items

    return make


def half(*changes: Change, until: float = 24.0) -> Callable[[], Iterable[Item]]:
    """Return a function that makes the stroll at 50 Hz up to a time, s, changed in this order."""
    return of("stroll", lambda items: ordered(halved(items)), *changes, until=until)


def live() -> dict[str, Any]:
    return dict(LIVE)


def posed() -> dict[str, Any]:
    return {"poses": True}


def calibrated() -> dict[str, Any]:
    return {"calibration": known(), **LIVE}


def by_every(names: Iterable[str], what: str, make: Callable[[], Iterable[Item]], **more: Any) -> list[Case]:
    """Return a case for each of these recipes."""
    return [Case(f"{what}, {name}", make, name, **more) for name in names]


def field_changed(change: Callable[[Any], Any], **when: Any) -> Change:
    """Change the magnetic field of samples that have one."""
    return each(lambda item: item if item.mag is None else evolve(item, mag=change(item.mag)), **when)


def here(t: float, *where: Any, **level: str) -> tuple[float, Call]:
    """Return the report of a person at `t`, s."""
    return t, Call("here", where, level)


DAY = of("insole", until=70.0)
MORNING = of("insole", bursts, partial(restarted, at=18.0), until=30.0)
"""A walk with losses in bursts, on which the left insole restarts."""
TAG = of("cc2541", until=50.0)
TICKS = calls(*((2.0 * k, Call("advance", (2.0 * k,))) for k in range(1, 20)))
NAMED = each(lambda item: evolve(item, device=("", "A", "B", "C")[int(item.t / 5.0)]))
"""The devices of both feet are others from time to time."""
BOUND = calls((8.0, Call("bind", (LEFT, "B"))), (12.0, Call("bind", (LEFT, ""))), (14.0, Call("bind", (RIGHT, "C"))))
LONG_BURSTS = partial(bursts, period=15.0, length=8.0)
STROLLS = ("insole-fragments", "insole-batches", "insole-cells-alone", "cc2541-10hz", "orphe", "dot", "thingy")

DEVICES: tuple[Case, ...] = (
    Case("insole of 16 cells, a day", DAY, "default", posed),
    *(Case(f"{name}, its stroll", of(name, until=13.0), "default", live) for name in STROLLS),
    Case("cc2650, a day", of("cc2650"), "default", live),
    Case("cc2541 at 20 Hz, a day", of("cc2541", until=56.0), "default", live),
    Case("insoles and a DOT at the pelvis", of("dot-orientation", until=24.0), "default", live),
    Case("a cc2650 that restarts", of("cc2650", partial(restarted, at=20.0), until=45.0), "default"),
    Case("a thingy that restarts", of("thingy", partial(restarted, at=9.0), until=18.0), "default"),
    Case("packets in every disorder", of("insole", shuffled, until=35.0), "default"),
    Case("fragments in every disorder", of("insole-fragments", shuffled, until=20.0), "default"),
    Case("cc2541 in every disorder", of("cc2541", shuffled, until=45.0), "default"),
    Case("orphe in every disorder", of("orphe", shuffled, until=20.0), "default"),
    Case("what a receiver reports", of("insole", received, until=40.0), "default"),
    Case("a clock set back", of("insole", set_back, until=40.0), "default"),
    Case("a cc2650 on a clock set back", of("cc2650", set_back, until=40.0), "default"),
    Case("time that passes", of("insole", LONG_BURSTS, TICKS, until=40.0), "default"),
    Case("a device bound anew", of("insole", NAMED, BOUND, until=20.0), "default"),
)

FAULTS: tuple[Case, ...] = tuple(
    Case(name, make, "default")
    for name, make in {
        "gravity taken away": half(each(lambda item: added(item, (0.0, 0.0, -G))), until=22.0),
        "acceleration in g": half(each(lambda item: scaled(item, acc=1.0 / G)), until=22.0),
        "rates in degrees": half(each(lambda item: scaled(item, gyro=57.29578)), until=22.0),
        "acceleration of the right foot 1.7 times": half(
            each(lambda item: scaled(item, acc=1.7), site=RIGHT), until=22.0
        ),
        "a left-handed sensor": half(each(left_handed), until=22.0),
        "feet on clocks apart": half(each(lambda item: later(item, 0.31), site=RIGHT), ordered),
        "feet on clocks that run apart": half(each(lambda item: later(item, rate=1.004), site=RIGHT), ordered),
        "sensors on the wrong feet": half(each(swapped), until=22.0),
        "a foot silent for a while": half(each(lambda item: None, 8.0, 16.0, RIGHT)),
        "samples lost in bursts": half(bursts),
        "a frozen sensor": half(frozen_values),
        "a loose sensor": half(partial(noisy, acc=40.0, share=0.1)),
        "a strong low pass": half(smooth),
        "samples that no sensor sends": half(strange),
        "no gyroscope": half(without("gyro"), until=22.0),
        "no accelerometer": half(without("acc"), until=22.0),
        "no cells": half(without("pressure"), until=22.0),
        "cells alone": half(without("acc", "gyro"), until=22.0),
        "one foot alone": half(each(lambda item: None, site=RIGHT)),
        "somebody who stands": half(until=1.9),
        "a cell that sticks": half(cells(lambda values, t: (333.0, *values[1:])), until=22.0),
        "cells without a number": half(cells(lambda values, t: (None, *values[1:-1], float("nan")), RIGHT, 9.0)),
        "another number of cells": half(cells(lambda values, t: values[:8], LEFT, 12.0)),
        "running and stairs": of("running"),
        "a compass in microtesla": of("compass", field_changed(lambda mag: tuple(1e6 * m for m in mag)), until=40.0),
        "a magnet that comes": of(
            "compass",
            field_changed(lambda mag: (mag[0] + 8e-5, mag[1], mag[2] - 5e-5), since=30.0, site=LEFT),
            until=70.0,
        ),
        "lifts and stairs with barometers": of("lifts"),
        "reports of a person": half(calls(here(6.0, (3.0, 1.0), 0.5), here(15.0, (8.0, 2.0), 1.0), here(20.0, None))),
    }.items()
)

WHOLE = ("kupt-dfpc", "pressure-contour", "footstep-tracker")
"""Recipes that share least with the default one."""
CALIBRATED = ("pressure-contour", "walking-modes", "walking-modes-printed", "footstep-tracker")
"""Recipes that are given all that can be calibrated; kupt-dfpc is given it with loads that come and go."""
AT_20_HZ = ("footstep-tracker", "footstep-tracker-printed", "shoe-sensing", "shoe-sensing-printed")
OF_LIMBS = ("walking-modes-printed", "touchdown-height")
OTHERS = tuple(name for name in recipes.NAMES if name not in ("default", *WHOLE))

RECIPES: tuple[Case, ...] = (
    *by_every(WHOLE, "a morning", MORNING, options=posed),
    *by_every(OTHERS, "a morning", MORNING),
    *by_every(AT_20_HZ, "cc2541 at 20 Hz", TAG),
    *by_every(OF_LIMBS, "seven sites", of("suit")),
    *by_every(CALIBRATED, "all that can be calibrated", half(), options=calibrated),
    Case("seven sites, a first heading", of("suit"), "walking-modes", heading=-2.0),
)

REPORTS = calls(
    here(9.0, (6.9, 4.9), 0.5, level="1"), here(50.0, (7.0, 12.0), 2.0, level="0"), here(60.0, (900.0, 0.0), level="0")
)


def walked(number: int, until: float = 1e9) -> Callable[[], Iterable[Item]]:
    """Return a function that makes a walk through the building up to a time, s."""
    return of(f"building-{number}", until=until)


PLACES: tuple[Case, ...] = (
    Case("a building, walk 8", walked(8, 70.0), "default", partial(planned, STARTS[8])),
    Case("a building, walk 12", walked(12, 60.0), "default", partial(planned, STARTS[12])),
    Case("a building, nobody knows where", walked(12, 80.0), "default", planned),
    Case("a building, another start than said", walked(8, 40.0), "default", partial(planned, WRONG_START)),
    Case("a building, reports of a person", of("building-3", REPORTS, until=80.0), "default", planned),
    Case("a building, footstep-tracker no heading", walked(8, 60.0), "footstep-tracker", partial(planned, PLACE_ALONE)),
    Case("a building, shoe-sensing", walked(3, 60.0), "shoe-sensing", partial(planned, STARTS[3])),
    Case("a building with a compass", of("compass", until=40.0), "default", planned),
    Case("floor plans", plans),
    Case("a heading walk", heading),
    Case("texts of an app", texts),
)

LONGEST = 40.0
"""Longest part of a recording that is fed, s."""
EVERY_RECIPE = ("marpino_heel_toe", "hugadb")
"""Data sets of which one recording goes through every recipe: with cells, and without."""


def read_cut(path: Path) -> list[Sample]:
    """Return the first samples of a recording."""
    samples = read_samples(path, report=lambda sentence: None)
    first = next(samples)
    return [first, *takewhile(lambda sample: sample.t < first.t + LONGEST, samples)]


def recorded() -> list[Case]:
    """Return the cases of recorded data: two recordings of each data set by the default recipe, some by all."""
    folder = Path(os.environ.get("SOLEPATH_DATA", PROTOCOL.parents[1] / "shared" / "data"))
    cases = []
    for path in sorted(folder.glob("*/dataset.json")):
        files = sorted(path.parent.glob("*.npz"))
        for number, file in enumerate(files[:: max(1, len(files) // 2)][:2]):
            every = number == 0 and path.parent.name in EVERY_RECIPE
            for name in recipes.NAMES if every else ("default",):
                cases.append(
                    Case(f"{path.parent.name} {file.stem}, {name}", partial(read_cut, file), name, recorded=True)
                )
    return cases
