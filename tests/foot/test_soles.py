"""Soles whose cells show any value without load, drift, jump, or are dead or wired the other way round.

The cells are those of a maker: counts of a 12-bit converter, with noise and a value without load."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import pi, sin
from pathlib import Path
from random import Random

import pytest
from attrs import evolve
from soak import longer
from walks import of

from solepath import Foot, HeelStrike, Limitation, Sample, Session, Site, StrideTaken, ToeOff
from solepath.emulate import Route, Walker
from solepath.emulate.sensors.insoles import layout
from solepath.events import CellFault, CellsFailed, Event, InsoleNeverUnloads
from solepath.recording.samples import load_samples
from solepath.types import Floats
from solepath.validate.matching import match

FULL = 4095
"""Full scale of a cell, counts."""
WALKER = Walker(Route().stand(2.0).walk(60.0, 1.3).stop(2.0), seed=3)
Change = Callable[[float, Floats], list[float]]
"""Function of time and counts that returns the changed counts."""
Unit = Callable[[float], float]
"""Function of a count that returns what a device with another unit sends."""


@cache
def walk(cells: int, level: float) -> tuple[Sample, ...]:
    """Return a minute of walking of the left foot, whose cells show `level` counts without load.

    Two cells are the two halves of a sole of 16."""
    shape, random = layout(max(cells, 16) if cells != 8 else 8, Foot.LEFT), Random(1)
    samples = WALKER.samples(Foot.LEFT, 100.0, layout=shape)
    loads = [sample.pressure or () for sample in samples]
    if cells == 2:
        rear = [cell.x < 0.5 * shape.length for cell in shape.cells]
        loads = [
            tuple([sum([v for v, at in zip(one, rear, strict=True) if at is side]) for side in (True, False)])
            for one in loads
        ]
    gain = 0.85 * (FULL - level) / max(max(one) for one in loads)
    counts = [tuple([clipped(level + gain * v + random.gauss(0.0, 2.0)) for v in one]) for one in loads]
    return tuple(evolve(sample, pressure=one) for sample, one in zip(samples, counts, strict=True))


def clipped(value: float) -> float:
    return float(min(FULL, max(0, round(value))))


def said(
    cells: int, level: float, inertial: bool, change: Change | None = None, every: int = 1, unit: Unit | None = None
) -> list[Event]:
    """Return the events of a walk whose counts are changed, with one in `every` samples, and in another unit."""
    session, events = Session(), list[Event]()
    for sample in walk(cells, level)[::every]:
        counts = sample.pressure or ()
        if change is not None:
            sample = evolve(sample, pressure=tuple([clipped(value) for value in change(sample.t, counts)]))
        if unit is not None:
            sample = evolve(sample, pressure=tuple(map(unit, sample.pressure or ())))
        events += session.feed(sample if inertial else evolve(sample, acc=None, gyro=None))
    return [*events, *session.finish()]


def missed(events: list[Event], since: float = 0.0) -> int:
    """Return the number of heel-strikes and toe-offs from `since` on, s, that were missed or invented."""
    truth, wrong = WALKER.truth().feet[Foot.LEFT], 0
    for kind, true in ((HeelStrike, truth.heel_strikes), (ToeOff, truth.toe_offs)):
        matching = match([t for t in true if t > since], [event.t for event in of(kind, events) if event.t > since])
        wrong += matching.n_true + matching.n_found - 2 * len(matching.offsets)
    return wrong


def named(events: list[Event]) -> list[Event]:
    """Return what is said of the cells."""
    found = [event for event in of(Limitation, events) if "insole" in event.what]
    return [*found, *of(CellsFailed | InsoleNeverUnloads, events)]


SOLES = [
    (2, 2500.0), (16, 100.0), *[pytest.param(*one, marks=pytest.mark.soak) for one in ((2, 100.0), (8, 1e3), (16, 2e3))]
]  # fmt: skip
each_sole = pytest.mark.parametrize(("cells", "level"), SOLES)
with_and_without = pytest.mark.parametrize("inertial", [True, False], ids=["inertial", "cells alone"])


@each_sole
@with_and_without
def test_contacts_are_found_whatever_cells_show_without_load(cells: int, level: float, inertial: bool) -> None:
    events = said(cells, level, inertial)
    assert named(events) == []
    assert missed(events) <= (0 if inertial else 8)  # cells alone need the first two swings to learn their level


SET_TO_ZERO = {
    "standing": lambda counts: counts[100],
    "at the largest load": lambda counts: tuple(map(max, zip(*counts, strict=True))),
}
"""Counts that cells show when somebody sets them to zero while the wearer is on them."""


@with_and_without
@pytest.mark.parametrize("when", SET_TO_ZERO)
def test_cells_that_were_set_to_zero_under_the_wearer_show_the_load_above_their_level_in_the_air(
    when: str, inertial: bool
) -> None:
    zero = SET_TO_ZERO[when]([sample.pressure or () for sample in walk(16, 100.0)])
    session, events = Session(), list[Event]()
    for sample in walk(16, 100.0):
        net = tuple([value - least for value, least in zip(sample.pressure or (), zero, strict=True)])
        sample = evolve(sample, pressure=net)
        events += session.feed(sample if inertial else evolve(sample, acc=None, gyro=None))
    assert named(events) == []
    assert missed(events) <= (0 if inertial else 8)
    loads = [event.features.contact_load for event in of(StrideTaken, events)]
    true = [event.features.contact_load for event in of(StrideTaken, said(16, 100.0, True))] if inertial else []
    assert loads[:2] == [None, None][: len(loads)], "nobody knows the level yet, and no load is below zero"
    assert loads[3:] == pytest.approx(true[3:], rel=0.02)


def step(t: float, counts: Floats) -> list[float]:
    return [value + 400.0 * (t > 30.3) for value in counts]


def slow_step(t: float, counts: Floats) -> list[float]:
    return [value + 400.0 * min(1.0, max(0.0, t - 30.0)) for value in counts]


def fall(t: float, counts: Floats) -> list[float]:
    return [value + 400.0 * (t < 30.9) for value in counts]


def drift(t: float, counts: Floats) -> list[float]:
    return [value + 12.0 * t for value in counts]


def fast_drift(t: float, counts: Floats) -> list[float]:
    return [value + 20.0 * max(0.0, t - 10.0) for value in counts]


def drift_down(t: float, counts: Floats) -> list[float]:
    return [value + 600.0 - 12.0 * t for value in counts]


def bursts(t: float, counts: Floats) -> list[float]:
    return [FULL if t > 10.0 and t % 5.3 < 0.05 else value for value in counts]


def long_bursts(t: float, counts: Floats) -> list[float]:
    return [FULL if t > 10.0 and t % 5.3 < 0.15 else value for value in counts]


def bursts_of_nothing(t: float, counts: Floats) -> list[float]:
    return [0.0 if t > 10.0 and t % 5.3 < 0.05 else value for value in counts]


def dead(t: float, counts: Floats) -> list[float]:
    return [0.0 if i in (1, len(counts) - 2) else value for i, value in enumerate(counts)]


def wired_the_other_way(t: float, counts: Floats) -> list[float]:
    return [FULL - value for value in counts]


def two_the_other_way(t: float, counts: Floats) -> list[float]:
    return [FULL - value if i in (1, len(counts) - 2) else value for i, value in enumerate(counts)]


FAULTS = (
    step, slow_step, fall, drift, fast_drift, drift_down, bursts, long_bursts, bursts_of_nothing, dead,
    wired_the_other_way, two_the_other_way,
)  # fmt: skip
UNNOTICED = {
    (dead, 2, False): "nothing is left of a sole whose two cells are dead, and a foot that rests looks the same",
    (two_the_other_way, 8, False): "the sum of the cells falls and rises twice in a stride, and nothing else shows it",
}
"""Faults of so many cells, with or without an inertial sensor, that cost contacts and are not named."""


@pytest.mark.parametrize(
    "sole", [(2, 2500.0, False), *longer((16, 100.0, True), (2, 2500.0, True), (16, 100.0, False), (8, 1e3, False))]
)
@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
def test_a_fault_of_the_cells_costs_no_contact_or_is_named(
    request: pytest.FixtureRequest, sole: tuple[int, float, bool], fault: Change
) -> None:
    cells, level, inertial = sole
    if (fault, cells, inertial) in UNNOTICED:
        request.applymarker(pytest.mark.xfail(reason=UNNOTICED[fault, cells, inertial], strict=True))
    events = said(cells, level, inertial, fault)
    assert missed(events) <= missed(said(cells, level, inertial)) or named(events)
    assert missed(events) <= 45  # of about 170
    if inertial:
        assert len(of(StrideTaken, events)) == len(of(StrideTaken, said(cells, level, inertial)))


@with_and_without
def test_cells_that_are_dead_or_fall_under_load_are_named_by_their_numbers(inertial: bool) -> None:
    for fault, kind in ((dead, CellFault.DEAD), (two_the_other_way, CellFault.INVERTED)):
        (failed,) = of(CellsFailed, said(16, 100.0, inertial, fault))
        assert (failed.fault, failed.cells) == (kind, (1, 14))


UNITS: dict[str, Unit] = {
    "counts": float, "volts": lambda count: 3.3 * count / FULL, "newtons": lambda count: max(0.0, 0.2 * count - 20.0),
}  # fmt: skip


def hum(frequency: float, size: float) -> Callable[[float], float]:
    return lambda t: 1500.0 + size * sin(2.0 * pi * frequency * t)


def white(size: float) -> Callable[[float], float]:
    return lambda t: Random(round(1000.0 * t)).gauss(1500.0, size)


NOISES = {
    "hum of 50 Hz": hum(50.13, 1000.0), "hum of 60 Hz": hum(60.0, 300.0), "white noise": white(100.0),
    "more noise": white(600.0), "rail to rail": lambda t: float(FULL * Random(round(1000.0 * t)).randrange(2)),
}  # fmt: skip
NOISY_SOLES = [
    (2, 1, "hum of 50 Hz", "counts"), (8, 2, "rail to rail", "volts"), (16, 4, "hum of 60 Hz", "newtons"),
    (16, 1, "white noise", "counts"),
    *[pytest.param(cells, 1, noise, "counts", marks=pytest.mark.soak) for cells in (2, 8, 96) for noise in NOISES],
]  # fmt: skip
"""Cells, share of the samples, noise and unit: at 25 and 50 Hz noise is named later, up to 26 s after the start."""


@with_and_without
@pytest.mark.parametrize(("cells", "every", "noise", "unit"), NOISY_SOLES)
def test_a_cell_that_jumps_from_sample_to_sample_is_named_and_costs_no_contact_from_then_on(
    cells: int, every: int, noise: str, unit: str, inertial: bool
) -> None:
    bad, value = cells // 3, NOISES[noise]

    def open_input(t: float, counts: Floats) -> list[float]:
        return [value(t) if i == bad else one for i, one in enumerate(counts)]

    events = said(cells, 100.0, inertial, open_input, every, UNITS[unit])
    (failed,) = [event for event in of(CellsFailed, events) if event.cells == (bad,)]
    assert failed.fault is CellFault.NOISY and failed.t < 14.0, "two windows of four swings"
    assert missed(events, failed.t + 2.5) <= (4 if inertial and cells == 2 else 0)
    assert len(of(CellsFailed, events)) == 1


@with_and_without
def test_a_cell_that_was_noisy_is_used_again_when_it_is_quiet_again(inertial: bool) -> None:
    def loose(t: float, counts: Floats) -> list[float]:
        return [NOISES["more noise"](t) if i == 5 and t < 20.0 else one for i, one in enumerate(counts)]

    def and_dead_later(t: float, counts: Floats) -> list[float]:
        return [100.0 if i == 5 and t > 35.0 else one for i, one in enumerate(loose(t, counts))]

    assert [event.fault for event in of(CellsFailed, said(16, 100.0, inertial, loose))] == [CellFault.NOISY]
    faults = [event.fault for event in of(CellsFailed, said(8, 100.0, inertial, and_dead_later))]
    assert faults == [CellFault.NOISY, CellFault.DEAD], "a cell that is used again can fail again"


STEPS = [
    pytest.param(cells, every, by, since, marks=[] if (cells, every, since) == (16, 1, 30.3) else [pytest.mark.long])
    for cells in (16, 96) for every in (1, 2) for by in (400.0, 900.0, -400.0, -900.0)
    for since in (30.3, 20.13, 24.86, 35.48) if every == 1 or since == 30.3
]  # fmt: skip
"""At 50 Hz a step of 400 counts in a landing of 16 cells may hide the contacts of two strides."""


@with_and_without
@pytest.mark.parametrize(("cells", "every", "by", "since"), STEPS)
def test_a_step_of_all_cells_hides_at_most_the_contacts_of_a_stride(
    cells: int, every: int, by: float, since: float, inertial: bool
) -> None:
    def jump(t: float, counts: Floats) -> list[float]:
        return [value + by * (t > since) for value in counts]

    events = said(cells, 1000.0, inertial, jump, every)
    assert missed(events) <= missed(said(cells, 1000.0, inertial, None, every)) + 2
    assert of(CellsFailed, events) == []


def test_a_sole_that_is_wired_the_other_way_round_is_turned_within_five_strides() -> None:
    events = said(2, 100.0, False, wired_the_other_way)
    (turned,) = named(events)
    assert isinstance(turned, Limitation) and "turned" in turned.what and turned.t < 8.0
    later = [event for event in events if event.t > turned.t + 2.5]
    truth = [t for t in WALKER.truth().feet[Foot.LEFT].heel_strikes if t > turned.t + 2.5]
    assert match(truth, [event.t for event in of(HeelStrike, later)]).f1 == 1.0


@pytest.mark.parametrize("zero", [0.0, 2900.0], ids=["a high level", "set to zero under the wearer"])
def test_a_wearer_who_stands_and_sways_takes_no_step_whatever_the_cells_show(zero: float) -> None:
    random, session, events, sway = Random(2), Session(), list[Event](), [0.0, 0.0]
    for k in range(6000):
        sway = [0.98 * one + random.gauss(0.0, 0.02) for one in sway]
        counts = tuple([clipped(2500.0 + 400.0 * (1.0 + one)) - zero for one in sway])
        events += session.feed(Sample(0.01 * k, Site.LEFT_FOOT, pressure=counts))
    assert of(HeelStrike | ToeOff, events) == [] and named(events) == []


@pytest.mark.soak
@pytest.mark.parametrize("name", ["fsr_treadmill", "moticon_opengo", "gaitpdb_vgrf", "smart_insole_35"])
def test_nothing_is_said_of_the_cells_of_recorded_soles(data_dir: Path, name: str) -> None:
    for path in sorted((data_dir / name).glob("*.npz")):
        session = Session()
        events = [event for sample in load_samples(path) for event in session.feed(sample)]
        found = named(events)
        if path.stem.startswith("N07"):  # the ball of the left sole shows 2.5 V all the time
            assert [event.cells for event in of(CellsFailed, found)] == [(1,)] and len(found) == 1
        else:
            assert found == [], path.name
