"""Sensors of one foot that fail in mid-walk: where the wearer is said to be a minute later, and how sure that is.

    solepath-lab damage faults DIR [--only NAME] [--walks N] [--seed K] [--processes N]

prints a table as Markdown. In emulated walks of both feet, and in the recordings of DIR that are
long enough, the sensor of one foot fails at each of INSTANTS moments and stays so. The truth is the true middle of both
sensors of an emulated walk, to which the track is aligned over its first metres, and in a recording the position that
the session gives without the fault. A position holds if it is within NEAR of the truth, or if the truth is inside its
95 % ellipse and that is not longer than LONGEST_AXIS. Instants from which a position does not hold without a fault, by
the drift of the heading, are counted in the first row alone. Seeds from 9001 on are for scores; numbers were chosen on
501 to 507."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Iterator, Sequence
from math import sqrt
from pathlib import Path
from statistics import median

import numpy as np
from attrs import evolve, frozen

from solepath.cli.common.processes import run_jobs
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.events import DefectFound
from solepath.recording.samples import load_samples
from solepath.session import Session
from solepath.types import SITE_OF_FOOT, Foot, Sample, Vec3
from solepath.types.vector import GRAVITY
from solepath.validate.alignment import Floats, align, distances

from ..emulated.heading import middle
from ..measures.consistency import HELD
from ..tables import markdown

DATA_SETS = ("hugadb", "tripod_treadmill", "felius_2min_walk")
"""Folders of data sets with recordings of both feet that are long enough."""
INSTANTS = 24
"""Number of moments of a walk at which a sensor fails."""
LATER = 60.0
"""Time from the fault to the position that is scored, s."""
BEFORE = 12.0
"""Time of a walk before the first fault, s."""
NEAR, LONGEST_AXIS = 3.0, 6.0
"""Distance from the truth that always holds, and longest half-axis of an ellipse that may hold, m."""
ALIGNED_LENGTH = 10.0
"""Length of path over which a track is aligned with the truth, m."""
RATES = (20.0, 50.0, 100.0)
"""Rates of emulated sensors, Hz."""
FULL_SCALE = 16.0 * GRAVITY
"""End of the range at which an accelerometer sticks, m/s^2."""

Reading = tuple[Vec3, Vec3]
"""Specific force, m/s^2, and angular rate, rad/s."""
Fail = Callable[[Reading, Reading, int], Reading]
"""Function of the last reading before the fault, a later one, and the axis that fails, which returns what is read."""


def _add_offset(before: Reading, now: Reading, axis: int) -> Reading:
    acc = [*now[0]]
    acc[axis] += 2.0 * GRAVITY
    return (acc[0], acc[1], acc[2]), now[1]


NONE = "none"
FAULTS: dict[str, Fail] = {
    NONE: lambda before, now, axis: now,
    "all values stuck": lambda before, now, axis: before,
    "accelerometer reads 2 g more": _add_offset,
    "accelerometer stuck at full scale": lambda before, now, axis: ((FULL_SCALE,) * 3, now[1]),
    "gyroscope stuck": lambda before, now, axis: (now[0], before[1]),
}


@frozen
class Failing:
    """A walk whose sensors fail: a seed of an emulated wearer, or a recording."""

    seed: int
    path: Path | None = None


@frozen
class Failure:
    """What a session says a minute after a fault."""

    walk: str
    fault: str
    t: float
    """Time of the fault, s."""
    error: float
    """Distance of the position from the truth, m."""
    half_axis: float
    """Longer half-axis of the 95 % ellipse, m."""
    inside: bool
    """Flag: the truth is inside the ellipse."""
    named: float | None
    """Time from the fault to the first finding about that foot, s; None without one."""

    @property
    def holds(self) -> bool:
        return self.error < NEAR or (self.inside and self.half_axis < LONGEST_AXIS)


def wander(seed: int) -> Walker:
    """Return a walk of a minute and a half with turns, drawn from its seed."""
    rng = np.random.default_rng([seed, 71])
    route = Route(speed=float(rng.uniform(0.9, 1.5))).stand(3.0)
    for _ in range(6):
        route = route.walk(float(rng.uniform(6.0, 18.0))).turn(
            float(rng.uniform(-2.5, 2.5)), float(rng.uniform(0.5, 2))
        )
    return Walker(route.walk(30.0).stop(2.0), seed=seed)


def samples_of(walk: Failing) -> tuple[str, list[Sample], Walker | None]:
    """Return the name of a walk, its samples in their order, and its wearer if it is emulated."""
    if walk.path is not None:
        return f"{walk.path.parent.name}/{walk.path.stem}", list(load_samples(walk.path)), None
    walker, rate = wander(walk.seed), RATES[walk.seed % len(RATES)]
    samples = [sample for foot in Foot for sample in walker.samples(foot, rate, LSM6DSOX)]
    return f"seed {walk.seed}, {rate:g} Hz", sorted(samples, key=lambda sample: sample.t), walker


def examine(walk: Failing) -> list[Failure]:
    """Return what becomes of a walk with each fault at each of its instants."""
    name, samples, walker = samples_of(walk)
    session, places, forks = Session(), list[tuple[float, Floats, Floats]](), list[tuple[int, object]]()
    first, last = samples[0].t + BEFORE, samples[-1].t - LATER
    if last < first:
        return []
    rng = np.random.default_rng([walk.seed, 72])
    instants = np.sort(rng.uniform(first, last, INSTANTS)).tolist()
    for i, sample in enumerate(samples):
        if len(forks) < INSTANTS and sample.t >= instants[len(forks)]:
            forks.append((i, session.snapshot()))
        session.feed(sample)
        if not places or sample.t - places[-1][0] >= 0.25:
            places.append(_place(session, sample.t))
    times = np.array([t for t, _, _ in places])
    own = np.array([place for _, place, _ in places])
    if walker is None:
        truth = own
    else:
        truth = middle(walker.truth(), times)[:, :2]
        count = max(2, int(np.searchsorted(distances(truth), ALIGNED_LENGTH)) + 1)
        truth = align(truth[:count], own[:count]).apply(truth)
    failures = []
    for number, (i, saved) in enumerate(forks):
        foot, axis = (Foot.LEFT, Foot.RIGHT)[number % 2], number // 2 % 3
        for fault in FAULTS:
            t, (place, covariance), named = samples[i].t, *_fail(samples[i:], saved, foot, axis, FAULTS[fault])
            error = place - np.array([np.interp(t + LATER, times, truth[:, k]) for k in (0, 1)])
            inside = float(error @ np.linalg.solve(covariance, error)) < HELD
            half_axis = sqrt(HELD * float(np.linalg.eigvalsh(covariance)[-1]))
            failures.append(Failure(name, fault, t, float(np.linalg.norm(error)), half_axis, inside, named))
    return failures


def _place(session: Session, t: float) -> tuple[float, Floats, Floats]:
    """Return a time, the position (2,), m, and its covariance (2,2), m^2."""
    position = session.position
    if position is None:
        return t, np.zeros(2), np.eye(2)
    xx, xy, _, yy, *_ = position.covariance
    return t, np.array(position.position[:2]), np.array([[xx, xy], [xy, yy]])


def _fail(
    samples: Sequence[Sample], saved: object, foot: Foot, axis: int, fail: Fail
) -> tuple[tuple[Floats, Floats], float | None]:
    """Return the place and its covariance a minute after one foot failed, and the time until that was reported, s."""
    session, site, start, named = Session.restore(saved), SITE_OF_FOOT[foot], samples[0].t, None
    before: Reading | None = None
    for sample in samples:
        if sample.t > start + LATER:
            break
        if sample.site is site and sample.acc is not None and sample.gyro is not None:
            now = sample.acc, sample.gyro
            before = before or now
            acc, gyro = fail(before, now, axis)
            sample = evolve(sample, acc=acc, gyro=gyro)
        for event in session.feed(sample):
            if named is None and isinstance(event, DefectFound) and event.site is site:
                named = event.known_at - start
    _, place, covariance = _place(session, 0.0)
    return (place, covariance), named


def table(failures: Sequence[Failure]) -> list[str]:
    """Return the lines of the table: a row for each fault, at the instants from which a position without one holds."""
    rows, sound = [], {(one.walk, one.t) for one in failures if one.fault == NONE and one.holds}
    for fault in FAULTS:
        of_fault = [one for one in failures if one.fault == fault and (fault == NONE or (one.walk, one.t) in sound)]
        named = [one.named for one in of_fault if one.named is not None]
        errors = [one.error for one in of_fault]
        rows.append(
            (
                fault,
                len(of_fault),
                f"{100.0 * float(np.mean([one.holds for one in of_fault])):.1f}",
                f"{median(errors):.1f} / {np.quantile(errors, 0.95):.1f}",
                f"{median([one.half_axis for one in of_fault]):.1f}",
                f"{100.0 * len(named) / len(of_fault):.1f}",
                f"{median(named):.1f}" if named else "-",
            )
        )
    header = ("fault", "instants", "holds %", "error m, median / 95 %", "half-axis m", "named %", "after, median s")
    return markdown.table(header, rows)


def walks(options: Namespace) -> Iterator[Failing]:
    """Yield the emulated walks and the recordings of both feet."""
    for k in range(options.walks):
        yield Failing(options.seed + k)
    for name in options.only or DATA_SETS:
        for k, path in enumerate(sorted((options.dir / name).glob("*.npz"))):
            if {"acc_left", "acc_right", "gyro_left", "gyro_right"} <= set(np.load(path).files):
                yield Failing(k, path)


def run(options: Namespace) -> int:
    """Print the table of emulated walks and that of recordings; return the exit status."""
    found = [one for failures in run_jobs(examine, [*walks(options)], processes=options.processes) for one in failures]
    for title, emulated in (("Emulated walks", True), ("Recordings", False)):
        of_kind = [one for one in found if one.walk.startswith("seed") is emulated]
        if of_kind:
            print("\n".join([f"{title}: {len({one.walk for one in of_kind})}", "", *table(of_kind), ""]))
    return 0
