"""Checks of samples, and the event for a sample that cannot be used."""

from __future__ import annotations

from math import inf, isfinite

from ..events import Rejection, SampleRejected
from ..types import Sample, Vec3
from ..types.attrs import evolve
from ..types.vector import normalise

ABSURD_ACC = 500.0
"""Limit of an acceleration, m/s^2; no foot sensor measures more."""
ABSURD_GYRO = 100.0
"""Limit of an angular rate, rad/s; no foot sensor measures more."""
ABSURD_TOTAL = 1e7
"""Limit of the sum over all cells, in newtons or counts; no insole measures more."""
ABSURD_TIME = 1e11
"""Limit of a time, s; its negative is the lower limit."""

LEAST_TOTAL, LEAST_TIME = -ABSURD_TOTAL, -ABSURD_TIME
"""Lower limits of the sum over all cells and of a time, s."""
SOUND_ACC_SQUARE, SOUND_GYRO_SQUARE = ABSURD_ACC**2, ABSURD_GYRO**2
"""Squares of vectors, (m/s^2)^2 and (rad/s)^2, below which each axis is within its limit."""

SHORTEST_QUAT = 1e-12
"""Square of the least length of an attitude quaternion."""

RejectionReason = tuple[Rejection, str]
"""Kind of the rejection, and a text for people."""


def rejection_reason(sample: Sample, newest: float | None) -> RejectionReason | None:
    """Return why `sample` cannot be used after one at `newest`, s; None when it can."""
    t, known_at = sample.t, sample.known_at
    if (
        not LEAST_TIME <= t <= ABSURD_TIME
        or (known_at is not None and not LEAST_TIME <= known_at <= ABSURD_TIME)
        or (newest is not None and t <= newest)
    ):
        return wrong_time(sample) or _wrong_order(t, t if newest is None else newest)
    acc, gyro = sample.acc, sample.gyro
    sound = True
    try:
        if acc is not None:
            x, y, z = acc
            sound = x * x + y * y + z * z < SOUND_ACC_SQUARE
        if gyro is not None and sound:
            x, y, z = gyro
            sound = x * x + y * y + z * z < SOUND_GYRO_SQUARE
    except OverflowError:  # an int may be too large for a float
        sound = False
    if not sound and (wrong := _wrong_vector("acc", acc, ABSURD_ACC) or _wrong_vector("gyro", gyro, ABSURD_GYRO)):
        return wrong
    if sample.pressure:
        try:
            total: float = sum(sample.pressure)
        except (OverflowError, TypeError):
            total = inf
        if not LEAST_TOTAL < total < ABSURD_TOTAL:
            total = _total_of_numbers(sample.pressure)
            if not LEAST_TOTAL < total < ABSURD_TOTAL:
                much = "hundreds of digits" if abs(total) == inf else f"{_format_number(total)} in all"
                return Rejection.ABSURD, f"pressure of {much}"
    return None


def _wrong_order(t: float, newest: float) -> RejectionReason:
    if t == newest:
        return Rejection.DUPLICATE, f"a second sample for {t:.6g} s"
    return Rejection.TIME_BACKWARDS, f"{newest - t:.6g} s before the sample before"


def _wrong_vector(name: str, vector: Vec3 | None, limit: float) -> RejectionReason | None:
    worst = next((value for value in vector or () if not -limit < value < limit), None)
    if worst is None:
        return None
    if worst != worst or abs(worst) == inf:
        return Rejection.NOT_FINITE, f"{name} is not a number"
    return Rejection.ABSURD, f"{name} of {_format_number(worst)}"


def _total_of_numbers(cells: tuple[float, ...]) -> float:
    """Return the sum of the cells that are numbers; cell_health.py handles the others."""
    try:
        return sum([value for value in cells if value is not None and isfinite(value)])
    except OverflowError:  # an int may be too large for a float
        return inf


def with_sound_attitude(sample: Sample) -> Sample:
    """Return the sample with a unit quaternion, or without attitude if its quaternion has no valid length."""
    if sample.quat is None:
        return sample
    w, x, y, z = sample.quat
    square = w * w + x * x + y * y + z * z
    if 1.0 - 1e-9 < square < 1.0 + 1e-9:
        return sample
    if not SHORTEST_QUAT < square < 1.0 / SHORTEST_QUAT:  # also true for nan
        return evolve(sample, quat=None)
    return evolve(sample, quat=normalise(sample.quat))


def wrong_time(sample: Sample) -> RejectionReason | None:
    """Return why the times of a sample are invalid by themselves; None when they are valid."""
    for t in (sample.t, sample.known_at):
        if t is not None and not -ABSURD_TIME <= t <= ABSURD_TIME:
            if t != t or abs(t) == inf:
                return Rejection.NOT_FINITE, "time is not a number"
            return Rejection.ABSURD, f"time of {_format_number(t)} s"
    return None


def rejected(sample: Sample, why: RejectionReason, newest: float | None) -> SampleRejected:
    """Return the event for a rejected sample, with valid times; `newest` as in `rejection_reason`."""
    reason, detail = why
    t, known_at = sample.t, sample.known_at
    if not -ABSURD_TIME <= t <= ABSURD_TIME:
        t = 0.0 if newest is None else newest
    if known_at is None or not t <= known_at <= ABSURD_TIME:
        known_at = t
    return SampleRejected(t=t, known_at=known_at, site=sample.site, reason=reason, detail=detail)


def _format_number(value: float) -> str:
    """Return a number as text; an int may be too large even for that."""
    try:
        return f"{value:.4g}"
    except OverflowError:
        return "hundreds of digits"
