"""Cases for what the other cases do not meet of feet and body: odd values, loose sensors, wrong units, named places."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

from attrs import evolve
from cases import STARTS, calibrated, half, here, known, live, of, planned, sole
from changes import LEFT, RIGHT, added, calls, cells, clipped, draws, each, later, ordered, swapped, without
from corpus import Case, given, kept

from solepath import Calibration, Cell, Foot, Layout, Sample, Session
from solepath.calibration.records import HeadingCalibration, InsoleCalibration
from solepath.foot.navigate.dedrift import LinearDedrift
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.phase import describe
from solepath.foot.stance.shoe import ShoeDetector
from solepath.papers.walking_modes.mode import regions
from solepath.recipes import Recipe


def of_other_shoes(drift: float) -> Calibration:
    """Return a calibration of the heading that these shoes do not have."""
    return Calibration(headings={foot: HeadingCalibration(drift, 0.01, 1e-3, 2e-3) for foot in Foot})


def crossed() -> dict[str, Any]:
    """Return layouts of insoles of the other foot each."""
    shape = [Cell(0.02 + 0.04 * (k // 2), 0.02 * (1 - 2 * (k % 2))) for k in range(12)]
    return {
        "calibration": Calibration(
            insoles={
                foot: InsoleCalibration(Layout(7, other, tuple(shape), 0.26))
                for foot, other in ((Foot.LEFT, Foot.RIGHT), (Foot.RIGHT, Foot.LEFT))
            }
        )
    }


def mirrored() -> dict[str, Any]:
    """Return layouts that are mirror images of each other."""
    right = sole(12, Foot.RIGHT)
    left = evolve(right, foot=Foot.LEFT, cells=tuple([evolve(cell, y=-cell.y) for cell in right.cells]))
    return {"calibration": Calibration(insoles={one.foot: InsoleCalibration(one) for one in (left, right)})}


def loose(items: tuple[Any, ...], since: float) -> Iterator[Sample]:
    """Let the left sensor swing to and fro in the shoe from a time on."""
    drawn = draws(9)
    push = 0.0
    for item in items:
        if item.site is LEFT and item.t >= since:
            push = 0.8 * push + 12.0 * (next(drawn) - 0.5)
            item = added(item, (push, -0.6 * push, 0.4 * push), (0.1 * push, 0.05 * push, 0.0))
        yield item


def stood(items: tuple[Any, ...], since: float) -> Iterator[Sample]:
    """Let the right foot stand from a time on while the left one walks on."""
    last, drawn = None, draws(4)
    for item in items:
        if item.site is RIGHT and item.t > since:
            last = last or item
            item = evolve(last, t=item.t, known_at=item.known_at, gyro=(0.002 * next(drawn), 0.0, 0.0))
        yield item


def rested(items: tuple[Any, ...], by: float) -> list[Sample]:
    """Let the wearer stand for 15 s at the end, and walk once more; the left gyroscope's bias changes meanwhile."""
    end = items[-1].t
    stood = [later(item, float(k)) for k in range(1, 16) for item in items if item.t > end - 1.0]
    made = [*items, *stood, *(later(item, end + 15.02) for item in items if item.t < end)]
    return [added(item, gyro=(0.0, 0.0, by)) if item.site is LEFT and item.t > end + 0.5 else item for item in made]


def fourfold(items: tuple[Any, ...]) -> list[Sample]:
    """Give each sample four times, at four times the rate."""
    return ordered(later(item, 0.0025 * k) for item in items for k in range(4))


def in_bursts(item: Sample) -> Sample:
    """Give a sample the time of the packet of 0.2 s that brings it, and a little more for each sample in it."""
    start = int(item.t / 0.2) * 0.2
    return later(evolve(item, t=start + 0.01 * (item.t - start)))


def apart(items: tuple[Any, ...]) -> Iterator[Sample]:
    """Send the cells and the inertial sensor of each foot separately."""
    for item in items:
        yield evolve(item, acc=None, gyro=None)
        yield evolve(item, t=item.t + 0.001, known_at=item.t + 0.001, pressure=None)


def beyond(items: tuple[Any, ...]) -> Iterator[Any]:
    """Give values that are larger than any sensor has, each in turn, and at last nothing else."""
    huge = 10**400
    odd: tuple[dict[str, Any], ...] = (
        {"acc": (huge, 0, 0)}, {"gyro": (0, huge, 0)}, {"pressure": (huge,) * 12}, {"pressure": (1e200,) * 12},
        {"acc": (0.0, 4096.0, 9.8)}, {"gyro": (0.0, 0.0, -4096.0)}, {"acc": (0.0, 1e7, 0.0)}, {"gyro": (1e9, 0.0, 0.0)},
        {"t": 1.7e12}, {"t": 1e30}, {"t": float("inf")}, {"known_at": -1e30}, {"quat": (2.0, 0.0, 0.0, 0.0)},
        {"quat": (1e-200, 0.0, 0.0, 0.0)}, {"pressure": (None, huge, *(1.0,) * 10)},
    )  # fmt: skip
    for k, item in enumerate(items):
        yield item
        if k % 30 == 7:
            yield evolve(item, **{"t": item.t + 0.001, **odd[k // 30 % len(odd)]})


def in_unit(name: str, by: float) -> Any:
    return each(lambda item: evolve(item, **{name: tuple(by * value for value in getattr(item, name))}))


def broken(values: tuple[float, ...], t: float) -> tuple[Any, ...]:
    """Return cells of which one always loads, two die, one hangs from 8 s to 20 s, one has no number for a while."""
    made: list[Any] = [*values]
    made[3] = 400.0
    if t > 12.0:
        made[0] = made[11] = 0.0
    made[6] = 40.0 if 8.0 < t < 20.0 else made[6]
    made[8] = None if 6.0 < t < 9.0 else made[8]
    return tuple(made)


def of_no_number(values: tuple[float, ...], t: float) -> tuple[Any, ...]:
    return (None,) * len(values) if 6.0 < t < 8.5 else values


NAMED = calls(
    here(5.0, (0.0, 0.0), 0.3),
    here(8.0, "door"),
    here(10.7, (69.9, 39.4), 1.0),
    here(20.4, (59.3, 38.0), 1.0),
    here(28.0, "stairs", 0.5),
    here(34.0, (160.0, 40.0), 0.2),
    here(47.0, "stairs", 2.0),
    here(52.0, None, 0.5),
    here(56.0, "door", 1.0),
)
OFTEN = calls(*(here(4.0 + 0.7 * k, (0.8 * k if k < 8 else 6.0, 0.1 * k % 7), 60.0) for k in range(60)))
ON_PLAN = calls(here(9.0, (6.9, 4.9), 0.5, level="1"), here(14.0, (7.5, 9.0), 0.7, level="1"))
ASIDE = each(lambda item: added(item, gyro=(0.0, 0.0, 3.0)), 3.0, 3.4, RIGHT)
"""The first strides of both feet diverge."""


def figures() -> Iterator[Any]:
    """Yield what the means of a walk and of a run say, and the table of phases."""
    for name in ("stroll", "running"):
        session = Session()
        session.feed(list(given(name)[:3000]))
        gait = session.gait
        yield gait
        for one in gait.values() if isinstance(gait, dict) else (gait,):
            if one is None:
                continue
            yield [one.cadence, one.coordination]
            for figure in (one.both, *one.feet.values()):
                yield [figure.share("stance_time"), figure.double_support]
                yield evolve(figure, stride_time=None).share("stance_time")
            yield [one.asymmetry(name) for name in ("swing_time", "step_time", "stride_length")]
    yield describe()
    for foot in Foot:
        yield [regions(sole(count, foot)) for count in (6, 7, 24, 48, 90)]


def textbook() -> Iterator[Any]:
    """Yield the events with the detector and each corrector of the textbooks, and the numbers that they keep."""
    for corrector in (ErrorStateFilter(), LinearDedrift()):
        session = Session(Recipe("textbook", ShoeDetector(), corrector))
        yield from session.feed(half(until=5.0)())
        yield kept(session.snapshot())


def wrong(count: int) -> dict[str, Any]:
    return {"calibration": known(count), **live()}


BODY: tuple[Case, ...] = (
    Case("a calibration of other shoes", of("there-and-back", until=45.0), "default",
         lambda: {"calibration": of_other_shoes(0.04)}),
    Case("a calibration that turns the track far", of("there-and-back", until=45.0), "default",
         lambda: {"calibration": of_other_shoes(-0.05)}),
    Case("a sensor that comes loose", of("there-and-back", partial(loose, since=38.0)), "default"),
    Case("a rest in which a bias changes", half(partial(rested, by=0.004)), "default"),
    Case("a foot that stands while the other walks on to the right",
         of("building-8", partial(stood, since=15.3), until=24.0), "default"),
    Case("named places", of("there-and-back", NAMED, until=58.0), "default"),
    Case("a place that is reported often", of("there-and-back", OFTEN, until=46.0), "default"),
    Case("a foot that first steps aside", half(ASIDE, until=12.0), "default", live),
    Case("places on a plan", of("building-3", ON_PLAN, until=16.0), "default", partial(planned, STARTS[3])),
    Case("bursts", half(each(in_bursts), until=16.0), "default"),
    Case("milliseconds", half(each(lambda item: later(item, rate=1000.0)), until=2.5), "default"),
    Case("a time that hardly passes", half(each(lambda item: later(item, rate=1e-3)), until=8.0), "default"),
    Case("values beyond all", half(beyond, until=10.0), "default", live),
    Case("milli-g alone", half(in_unit("acc", 1000.0 / 9.80665), until=3.0), "default"),
    Case("thousandths of a degree alone", half(in_unit("gyro", 57295.78), until=3.0), "default"),
    Case("cells and inertial sensors apart", half(apart, until=8.0), "default", live),
    Case("insoles on the wrong feet, cells alone", half(without("acc", "gyro"), each(swapped)), "default", mirrored),
    Case("layouts of the other foot", half(until=12.0), "default", crossed),
    Case("cells that fail in turn", half(cells(broken), until=33.0), "default", calibrated),
    Case("no number from any cell", half(cells(of_no_number, RIGHT), until=10.0), "default", live),
    Case("an insole that shows nothing", half(cells(lambda values, t: (0.0,) * 12, LEFT), until=20.0), "default"),
    Case("a calibration of another insole", half(until=12.0), "default", partial(wrong, 8)),
    Case("a foot that stands while the other walks and is silent for a second",
         of("building-8", partial(stood, since=15.3), each(swapped), each(lambda item: None, 19.0, 20.0, LEFT),
            until=25.0), "default"),
    Case("cut off at 400 samples a second",
         of("stroll", fourfold, each(lambda item: clipped(item, 25.0, 5.0)), until=5.0), "default"),
    Case("textbook detector", textbook),
    Case("figures of a walk", figures),
)  # fmt: skip
"""What joins the table of cases.py."""
