"""Walks in other frames, at other times and mirrored, and what becomes of their events: one rule for each quantity."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from enum import Enum
from math import cos, hypot, inf, radians, sin
from random import Random
from re import findall
from typing import Any

import attrs
import numpy as np
from attrs import evolve, frozen
from kept import kept
from walks import suited

from solepath import Calibration, Foot, FootMoved, Sample, Session, Site, Turn, recipes
from solepath.calibration import InsoleCalibration
from solepath.emulate import Route, Walker
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.papers import WalkingMode
from solepath.types import Quat, Vec3
from solepath.types.vector import conjugate, from_yaw, multiply, rotate, rotate_back

RATE = 64.0
"""Rate of the walks, Hz: their times are whole 128ths of a second, which a float holds exactly up to 2^45 s."""
LEVEL = Route().stand(1.5).walk(4.0, 1.3).turn(radians(80.0), radius=1.5).walk(3.0).stop(1.2)
CLIMBING = Route().stand(1.5).walk(3.0, 1.2).stairs(6).walk(3.0).stop(1.2)
FIELD = (1.6e-5, 1.1e-5, -4.4e-5)
"""Magnetic flux density, world frame of the walker, T."""
PASCALS_PER_METRE = -12.0
SWAPPED: dict[Any, Any] = {
    Foot.LEFT: Foot.RIGHT,
    Site.LEFT_FOOT: Site.RIGHT_FOOT,
    Site.LEFT_THIGH: Site.RIGHT_THIGH,
    Site.LEFT_SHANK: Site.RIGHT_SHANK,
    Turn.LEFT: Turn.RIGHT,
    WalkingMode.LEFT_WIDE: WalkingMode.RIGHT_WIDE,
    WalkingMode.LEFT_TIGHT: WalkingMode.RIGHT_TIGHT,
}
SWAPPED |= {right: left for left, right in SWAPPED.items()}
MODES = {
    WalkingMode.STRAIGHT: (0.003, -0.005), WalkingMode.LEFT_WIDE: (0.002, -0.001),
    WalkingMode.LEFT_TIGHT: (0.009, -0.003), WalkingMode.RIGHT_WIDE: (-0.005, 0.009),
    WalkingMode.RIGHT_TIGHT: (-0.017, 0.012),
}  # fmt: skip
"""Compensation of the left foot by walking mode, forward and left, m."""
CALIBRATION = Calibration(
    {foot: InsoleCalibration(layout(24, foot)) for foot in Foot},
    modes={Foot.LEFT: MODES, Foot.RIGHT: {SWAPPED.get(mode, mode): (x, -y) for mode, (x, y) in MODES.items()}},
)
"""Insoles and compensations that are mirror images of each other."""
WALKING_MODES = tuple(name for name in recipes.NAMES if name.startswith(("walking-modes", "touchdown")))
"""Recipes with a use for the sensors of pelvis, thighs and shanks."""


@kept
def worn(route: Route = LEVEL, field: Vec3 = FIELD) -> tuple[Sample, ...]:
    """Return a walk with everything that a foot can send: inertial sensor, cells, compass, barometer.

    The right foot's samples lie between those of the left, so that no two are of one time."""
    walker, noise, samples = Walker(route, seed=3), Random(5), []
    for foot, later in zip(Foot, (0.0, 0.5 / RATE), strict=True):
        measured = walker.samples(foot, RATE, LSM6DSOX, layout=layout(24, foot))
        t = np.array([sample.t for sample in measured])
        moved = walker.kinematics(foot, t)
        for k, sample in enumerate(measured):
            place, attitude = moved.position[k].tolist(), tuple(moved.attitude[k].tolist())
            air = 101_325.0 + PASCALS_PER_METRE * place[2] + noise.gauss(0.0, 1.0)
            mag, at = rotate_back(attitude, field), sample.t + later
            samples.append(evolve(sample, t=at, known_at=at, mag=mag, air_pressure=air))
    return tuple(sorted(samples, key=lambda sample: sample.t))


WALKS: dict[str, Callable[..., tuple[Sample, ...]]] = {
    "feet": lambda field=FIELD: worn(LEVEL, field),
    "stairs": lambda field=FIELD: worn(CLIMBING, field),
    "gaps": lambda field=FIELD: tuple(
        one for one in worn(LEVEL, field) if not any(start <= one.t < end for start, end in _GAPS[one.site])
    ),
    "suit": lambda: tuple(evolve(one, t=(t := one.t + _OFFSET[one.site]), known_at=t) for one in suited()),
}
_GAPS = {Site.LEFT_FOOT: ((2.95, 3.15), (5.35, 5.7)), Site.RIGHT_FOOT: ((4.4, 4.7), (5.7, 5.85))}
"""Times between which samples are missing, s: of a swing and of a landing; of a toe-off and of a swing."""
_OFFSET = {site: 2.0**-9 * k for k, site in enumerate(Site)}
"""Time by which the samples of each site are moved, so that no two are of one time, s."""


def run(recipe: Any, samples: Iterable[Sample]) -> list[Any]:
    """Return the events of the samples, with every eighth live position of a foot."""
    recipe = recipes.by_name(recipe) if isinstance(recipe, str) else recipe
    session, events, count = Session(recipe, calibration=CALIBRATION, poses=True), [], 0
    for sample in sorted(samples, key=lambda sample: sample.t):
        for event in session.feed(sample):
            count += isinstance(event, FootMoved)
            if count % 8 == 0 or not isinstance(event, FootMoved):
                events.append(event)
    return events + session.finish()


@kept
def events_of(recipe: str, walk: str) -> tuple[Any, ...]:
    """Return the events of a walk as it is."""
    return tuple(run(recipe, WALKS[walk]()))


TIMES = {"t", "known_at", "sampled_at", "t_start", "t_end", "t_toe_off", "t_heel_strike", "revises"}
VECTORS = {"position", "velocity", "displacement", "compensation", "by"}
TURNS = {"heading_change", "turning_angle", "angle", "turn", "heading"}
"""Angles about the vertical, which a mirror turns round."""


@frozen
class Change:
    """A change of the world: mirrored at its x-z plane, then turned about z; events come later."""

    later: float = 0.0
    yaw: float = 0.0
    mirrored: bool = False
    offset: Vec3 = (0.0, 0.0, 0.0)
    """Vector that is added to positions, m."""
    north: float = 0.0
    """Angle that is added to the direction of magnetic north, rad."""

    @property
    def side(self) -> float:
        """-1 for the mirrored world."""
        return -1.0 if self.mirrored else 1.0

    def sample(self, sample: Sample) -> Sample:
        """Return a sample of the changed world; its frame is mirrored, and the field is mirrored as an arrow."""
        t, known_at, side = sample.t + self.later, sample.known_at + self.later, self.side
        site = SWAPPED.get(sample.site, sample.site) if self.mirrored else sample.site
        acc, mag = ((v[0], side * v[1], v[2]) if v else None for v in (sample.acc, sample.mag))
        gyro = sample.gyro and (side * sample.gyro[0], sample.gyro[1], side * sample.gyro[2])
        quat = sample.quat and (sample.quat[0], side * sample.quat[1], sample.quat[2], side * sample.quat[3])
        quat = quat and multiply(from_yaw(self.yaw), quat)
        return evolve(sample, t=t, known_at=known_at, site=site, acc=acc, gyro=gyro, mag=mag, quat=quat)

    def vector(self, v: Any) -> Any:
        """Return a vector, horizontal or not, or vectors."""
        if isinstance(v[0], tuple):
            return tuple(map(self.vector, v))
        (x, y, *z), c, s = v, cos(self.yaw), sin(self.yaw)
        y *= self.side
        return (c * x - s * y, s * x + c * y, *z)

    def covariance(self, values: Any) -> Any:
        """Return the covariance of a vector: its square root is of the same frame."""
        xx, xy, xz, yy, yz, zz = values
        columns = zip(*map(self.vector, ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))), strict=True)
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = zip(*map(self.vector, columns), strict=True)
        return xx, xy, xz, yy, yz, zz

    def event(self, value: Any, name: str = "") -> Any:
        """Return an event, or a value within one, of the changed world."""
        if attrs.has(type(value)):
            kept = {f.name: self.event(getattr(value, f.name), f.name) for f in attrs.fields(type(value))}
            return evolve(value, **kept)
        if value is None or isinstance(value, bool):
            return value
        if isinstance(value, Enum):
            return SWAPPED.get(value, value) if self.mirrored else value
        if name in TIMES:
            return value + self.later
        if name == "position":
            return tuple(a + b for a, b in zip(self.vector(value), self.offset, strict=False))
        if name in VECTORS:
            return self.vector(value)
        if name == "legs":
            return tuple(map(self.vector, value[:: 1 if self.side > 0.0 else -1]))
        if name == "covariance":
            return self.covariance(value)
        if name in TURNS or name == "y":
            return self.side * value
        if name == "north":
            return (self.side * value[0] + self.yaw + self.north, value[1])
        if name == "centre":
            return (value[0], self.side * value[1])
        if name == "cop":
            return tuple((x, self.side * y) for x, y in value)
        return tuple(self.event(one) for one in value) if isinstance(value, tuple) else value


def remounted(sample: Sample, turn: Quat) -> Sample:
    """Return the sample of a sensor that is mounted turned by the inverse of `turn`."""
    acc, gyro, mag = (v and rotate(turn, v) for v in (sample.acc, sample.gyro, sample.mag))
    return evolve(sample, acc=acc, gyro=gyro, mag=mag, quat=sample.quat and multiply(sample.quat, conjugate(turn)))


def in_order(events: Iterable[Any]) -> list[Any]:
    """Return the events in an order that does not depend on which foot is fed first."""
    return sorted(events, key=lambda one: (one.known_at, one.t, type(one).__name__, str(getattr(one, "foot", one))))


def headless(event: Any) -> Any:
    """Return a live position without its direction, which is arbitrary until the first heading is known."""
    if not isinstance(event, FootMoved):
        return event
    (x, y, z), (u, v, w) = event.position, event.velocity
    return evolve(event, position=(hypot(x, y), 0.0, z), velocity=(hypot(u, v), 0.0, w))


def _leaves(value: Any, label: str) -> Iterator[tuple[str, Any]]:
    if attrs.has(type(value)):
        for f in attrs.fields(type(value)):
            yield from _leaves(getattr(value, f.name), f"{label}.{f.name}")
    elif isinstance(value, tuple):
        yield f"{label} has", len(value)
        for one in value:
            yield from _leaves(one, label)
    else:
        # sides are in fields too, and sites may be listed in another order
        yield label, sorted({*findall(r"\w+", value)} - {"left", "right"}) if isinstance(value, str) else value


def differences(expected: Iterable[Any], found: Iterable[Any], within: Mapping[str, float]) -> list[str]:
    """Return where events differ: the kinds in order, all values, and numbers by more than `within` of their name.

    `within[""]` is for numbers without a name of their own; inf leaves out any value. The largest differences are
    given."""
    before, after = [*expected], [*found]
    kinds = [type(one).__name__ for one in before], [type(one).__name__ for one in after]
    if kinds[0] != kinds[1]:
        k = next((k for k, (a, b) in enumerate(zip(*kinds, strict=False)) if a != b), min(map(len, kinds)))
        return [f"{len(before)} events and {len(after)}; number {k}: {before[k : k + 1]} {after[k : k + 1]}"]
    worst: dict[str, tuple[float, str]] = {}
    for one, other in zip(before, after, strict=True):
        for (label, a), (_, b) in zip(_leaves(one, type(one).__name__), _leaves(other, ""), strict=False):
            limit = within.get(label, within.get(label.rpartition(".")[2], within[""]))
            if a.__class__ is b.__class__ is float:
                off = abs(a - b)
            else:
                off, limit = float(a != b), limit if limit == inf else 0.0
            if off > max(limit, worst.get(label, (0.0,))[0]):
                worst[label] = off, f"{label}: {a!r} and {b!r} at {one.t:.3f} s, by {off:.2g}"
    return [text for _, text in worst.values()]
