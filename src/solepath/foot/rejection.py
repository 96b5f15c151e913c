"""Checks of samples, and the event for a sample that cannot be used."""

from __future__ import annotations

from math import inf
from typing import NamedTuple

from ..events import Defect, Rejection, SampleRejected
from ..types import Sample, Vec3
from ..types.records import MAX_TIME

ABSURD_ACC = 500.0
"""Limit of each axis of a specific force, m/s^2; no foot sensor measures more."""
ABSURD_GYRO = 100.0
"""Limit of each axis of an angular rate, rad/s; no foot sensor measures more."""
SHORTEST_STEP = 1e-6
"""Shortest time from one sample to the next, s: no sensor of a foot sends a million a second.

The filters divide by powers of the step, which have no value as a float if it is much shorter."""

VALID_ACC_SQUARE, VALID_GYRO_SQUARE = ABSURD_ACC**2, ABSURD_GYRO**2
"""Squared norms, (m/s^2)^2 and (rad/s)^2, below which each axis is certainly within its limit."""

LARGEST_COUNT = 32768.0
"""Largest value of a sensor with 16 bits; 16 g are 16,000 milli-g."""
LARGEST_MDPS = 4e6
"""Largest range of a gyroscope on a foot, thousandths of a degree a second."""
LARGEST_EPOCH = 1e19
"""Times up to this, in ms, us or ns since 1970, are those of clocks of computers."""


class RejectionReason(NamedTuple):
    """Reason why a sample cannot be used; the fields are those of `SampleRejected`."""

    reason: Rejection
    detail: str
    defect: Defect | None = None


def rejection_reason(sample: Sample, newest: float | None) -> RejectionReason | None:
    """Return the reason why `sample` cannot be used after one at `newest`, s; None when it can be used."""
    t: float = sample.t
    known_at: float = sample.known_at
    if (
        not -MAX_TIME <= t <= MAX_TIME
        or not -MAX_TIME <= known_at <= MAX_TIME
        or (newest is not None and t - newest < SHORTEST_STEP)
    ):
        return wrong_time(sample) or _wrong_order(t, t if newest is None else newest)
    acc: Vec3 | None = sample.acc  # declared, because the fields of a compiled Sample have any type
    gyro: Vec3 | None = sample.gyro
    vectors_valid = True
    if acc is not None:
        x, y, z = acc
        vectors_valid = x * x + y * y + z * z < VALID_ACC_SQUARE
    if gyro is not None and vectors_valid:
        x, y, z = gyro
        vectors_valid = x * x + y * y + z * z < VALID_GYRO_SQUARE
    if not vectors_valid and (
        reason := _wrong_vector("acc", acc, ABSURD_ACC) or _wrong_vector("gyro", gyro, ABSURD_GYRO)
    ):
        return reason
    return None


def _wrong_order(t: float, newest: float) -> RejectionReason:
    if 0.0 <= t - newest < SHORTEST_STEP:
        return RejectionReason(Rejection.DUPLICATE, f"a second sample for {t:.6g} s")
    return RejectionReason(Rejection.TIME_BACKWARDS, f"{newest - t:.6g} s before the sample before")


def _wrong_vector(name: str, vector: Vec3 | None, limit: float) -> RejectionReason | None:
    """Return the reason for a value of `acc` or `gyro` that no foot sensor measures, with the unit that it may have."""
    invalid = next((value for value in vector or () if not -limit < value < limit), None)
    if invalid is None:
        return None
    if invalid != invalid or abs(invalid) == inf:
        return RejectionReason(Rejection.NOT_FINITE, f"{name} is not a number")
    size, detail = abs(invalid), f"{name} of {invalid:.4g}"
    if name == "acc" and size <= LARGEST_COUNT:
        text = f"{detail} m/s^2 cannot be: it looks like milli-g or raw counts; give it in m/s^2"
        return RejectionReason(Rejection.ABSURD, text, Defect.ACC_UNIT)
    if name == "gyro" and size <= LARGEST_MDPS:
        text = f"{detail} rad/s cannot be: it looks like degrees or thousandths of a degree a second, or raw counts"
        text = f"{text}; give it in rad/s"
        return RejectionReason(Rejection.ABSURD, text, Defect.GYRO_UNIT)
    return RejectionReason(Rejection.ABSURD, detail)


def wrong_time(sample: Sample) -> RejectionReason | None:
    """Return the reason why a time of `sample` is invalid, whatever came before; None when both are valid."""
    for t in (sample.t, sample.known_at):
        if not -MAX_TIME <= t <= MAX_TIME:
            if t != t or abs(t) == inf:
                return RejectionReason(Rejection.NOT_FINITE, "time is not a number")
            detail = f"time of {t:.4g} s"
            if abs(t) > LARGEST_EPOCH:
                return RejectionReason(Rejection.ABSURD, detail)
            text = f"{detail} cannot be: it looks like milliseconds or nanoseconds; give times in seconds"
            return RejectionReason(Rejection.ABSURD, text, Defect.TIME_UNIT)
    return None


def rejected(sample: Sample, rejection: RejectionReason, newest: float | None) -> SampleRejected:
    """Return the event for a rejected sample; `newest`, s, replaces an invalid time."""
    reason, detail, defect = rejection
    t, known_at = sample.t, sample.known_at
    if not -MAX_TIME <= t <= MAX_TIME:
        t = 0.0 if newest is None else newest
    if not t <= known_at <= MAX_TIME:
        known_at = t
    return SampleRejected(t=t, known_at=known_at, site=sample.site, reason=reason, detail=detail, defect=defect)
