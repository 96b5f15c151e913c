"""Samples of the left foot: in a walk, with gaps, on a sole of four cells, and damaged."""

from __future__ import annotations

from collections.abc import Callable

from attrs import evolve
from kept import kept
from walks import of

from solepath import (
    Cell,
    DefectFound,
    Event,
    Foot,
    FootFlat,
    HeelOff,
    HeelStrike,
    Layout,
    Sample,
    Session,
    StrideTaken,
    ToeOff,
)
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.truth import TrueStride
from solepath.emulate.wearers.walker import Walker
from solepath.types import Vec3

PHASES = HeelStrike | FootFlat | HeelOff | ToeOff
SOLE = Layout(7, Foot.LEFT, (Cell(0.05, 0.01), Cell(0.05, -0.01), Cell(0.13, 0.0), Cell(0.20, 0.02)), 0.26)
"""Two cells at the heel (x < 0.33 x 0.26), one under the arch, one at the forefoot (x > 0.55 x 0.26)."""
TARE = (10.0, 20.0, 0.0, 30.0)
"""Values of the cells of SOLE while the foot is in the air."""
STRAIGHT = Route().stand(2.0).walk(12.0, 1.3).stop(2.0)


def above(*loads: float) -> tuple[float, ...]:
    """Return the values of the cells of SOLE under these loads."""
    return tuple(zero + load for zero, load in zip(TARE, loads, strict=True))


@kept
def walked(route: Route = STRAIGHT, seed: int = 5) -> tuple[tuple[Sample, ...], tuple[TrueStride, ...]]:
    """Return the samples of the left foot at 100 Hz without cells, and its true strides."""
    walker = Walker(route, seed=seed)
    return tuple(walker.samples(Foot.LEFT, 100.0, LSM6DSOX)), walker.truth().strides(Foot.LEFT)


def without(samples: tuple[Sample, ...], *gaps: tuple[float, float]) -> list[Sample]:
    """Return the samples outside the gaps (start, end), s."""
    return [sample for sample in samples if not any(a < sample.t < b for a, b in gaps)]


def feed_new_session(samples: list[Sample] | tuple[Sample, ...]) -> tuple[list[Event], Session]:
    session = Session()
    return session.feed(samples), session


Change = Callable[[Sample], Sample]


def vectors(acc: Callable[[Vec3], Vec3] = lambda v: v, gyro: Callable[[Vec3], Vec3] = lambda v: v) -> Change:
    def change(sample: Sample) -> Sample:
        assert sample.acc is not None and sample.gyro is not None
        return evolve(sample, acc=acc(sample.acc), gyro=gyro(sample.gyro))

    return change


def scaled(k: float) -> Callable[[Vec3], Vec3]:
    return lambda v: (k * v[0], k * v[1], k * v[2])


def clipped(limit: float) -> Callable[[Vec3], Vec3]:
    def clip(v: Vec3) -> Vec3:
        x, y, z = [max(-limit, min(limit, value)) for value in v]
        return x, y, z

    return clip


def signed(x: float, y: float, z: float) -> Callable[[Vec3], Vec3]:
    return lambda v: (x * v[0], y * v[1], z * v[2])


def run(samples: list[Sample]) -> tuple[list[DefectFound], list[StrideTaken]]:
    session = Session()
    events = session.feed(samples) + session.finish()
    return of(DefectFound, events), of(StrideTaken, events)
