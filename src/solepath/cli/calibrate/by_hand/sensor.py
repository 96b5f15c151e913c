"""Calibration of the sensors of both feet by hand, each from a recording of rests and turns."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import degrees, pi
from typing import Any

import numpy as np
from attrs import evolve, frozen

from ....calibration import Calibration, CalibrationError, SensorCalibration
from ....calibration.records import TriadCalibration
from ....types import Foot, Sample
from ....types.vector import GRAVITY
from .coverage import open_questions, sigmas
from .fit import FIRST_NODE, I3, PER_PAUSE, Fit, Unknowns, fit, integrate
from .pauses import Floats, Pause, Recorded, WayBetween, find_pauses, find_ways, recorded_of

LEAST_PAUSES = 9
"""Least number of rests: an accelerometer has nine unknowns. Twelve are asked for, because one or two may be spoilt."""
LARGEST_EXCESS = 4.0
"""Standard deviations by which a way may not close: one in three thousand of normal errors exceeds them."""
MOST_LEFT_OUT = 0.2
"""Largest share of the ways that may be left out because they do not close with the others."""
LARGEST_WAY_NOISE = 0.01
"""Largest noise of a way per root of its angle, rad; emulated hands show 0.0005, and mirrored axes 0.1 and more."""
LEAST_GRAVITY, LARGEST_GRAVITY, LARGEST_RATE = 7.5, 12.5, 70.0
"""Least and largest specific force at rest, m/s^2, and largest rate, rad/s, of sensors whose units are right."""
TURNS = 2.0
"""Number of turns from which a way counts as turns."""


@frozen(eq=False)
class SensorFit:
    """The calibration of one sensor, with what it is worth."""

    foot: Foot
    """Foot that wears the sensor."""
    calibration: SensorCalibration
    """Correction of both of its sensors."""
    pauses: int
    """Number of rests."""
    turned: tuple[int, ...]
    """Whole turns of each way with at least two, in the order of time."""
    gravity: tuple[float, float]
    """Root mean square error of gravity at the rests before and after, m/s^2."""
    closure: tuple[float, float]
    """Root mean square of the angles by which ways do not close before and after, rad."""
    duration: float
    """Time from the first to the last rest, s."""
    notes: tuple[str, ...] = ()
    """Sentences on what was left out."""


def fit_sensors(recorded: Iterable[Sample], foot: Foot | None = None) -> tuple[SensorFit, ...]:
    """Return the calibration of every foot's sensor, or of that of `foot`, from a recording of rests and turns.

    CalibrationError is raised for a recording that does not show scale, axes and bias of both of its sensors. The
    message says what is missing."""
    samples = [one for one in recorded if one.acc is not None and one.gyro is not None]
    feet = [one for one in Foot if foot in (None, one) and any(sample.site.foot is one for sample in samples)]
    if not feet:
        raise CalibrationError("no foot's accelerations and angular rates in the recording")
    return tuple([_fit_foot(one, samples) for one in feet])


def sensor_calibration(fits: Iterable[SensorFit]) -> Calibration:
    """Return the calibration that holds these sensors."""
    return Calibration(sensors={one.foot: one.calibration for one in fits})


def _fit_foot(foot: Foot, samples: Sequence[Sample]) -> SensorFit:
    recorded = recorded_of(samples, foot)
    _check_units(foot, recorded)
    pauses = find_pauses(recorded)
    if len(pauses) < LEAST_PAUSES:
        raise CalibrationError(
            f"the {foot} foot has {len(pauses)} rests of a second and more, and {LEAST_PAUSES} are the least: "
            "leave the sensor alone for three seconds in each of twelve orientations, on or against what does not move"
        )
    force = float(np.median([np.linalg.norm(rest.acc) for rest in pauses]))
    if not LEAST_GRAVITY < force < LARGEST_GRAVITY:
        raise CalibrationError(f"the {foot} foot reads {force:.3g} m/s^2 at rest: its unit is not m/s^2")
    ways = find_ways(recorded, pauses)
    found, kept, ways = _fit_what_closes(foot, pauses, ways)
    missing = open_questions(found)
    notes = [
        f"not used: {pauses[way.number].end - recorded.t[0]:.0f} to "
        f"{pauses[way.number + 1].start - recorded.t[0]:.0f} s after the start: {way.spoilt}"
        for way in ways
        if way.spoilt
    ]
    if missing:
        raise CalibrationError(f"{foot} foot: {'; '.join([*missing, *notes])}")
    turned = [round(way.angle / (2.0 * pi)) for way in kept]
    # without the calibration, the gyroscope has the bias of the rests all the same, which every recipe learns
    before = evolve(found.unknowns, acc=I3, acc_bias=np.zeros(3), gyro=I3)
    gravity, closure = zip(*[_errors(one, pauses, kept) for one in (before, found.unknowns)], strict=True)
    return SensorFit(
        foot, _record(found), len(pauses), tuple([count for count in turned if count >= TURNS]),
        gravity, closure, pauses[-1].end - pauses[0].start, tuple(notes),
    )  # fmt: skip


def _check_units(foot: Foot, recorded: Recorded) -> None:
    if not np.ptp(recorded.gyro, axis=0).any():
        raise CalibrationError(f"the {foot} foot's gyroscope always reads the same: it does not measure")
    rate = float(np.abs(recorded.gyro).max())
    if rate > LARGEST_RATE:
        raise CalibrationError(f"the {foot} foot turns by {rate:.3g} rad/s: its rates look like degrees/s")


def _fit_what_closes(
    foot: Foot, pauses: Sequence[Pause], ways: Sequence[WayBetween]
) -> tuple[Fit, list[WayBetween], list[WayBetween]]:
    """Return the fit, the ways that it uses, and all ways; ways that do not close with the others are left out.

    The way that exceeds its standard deviation most is left out first, and the others are fitted again."""
    every = list(ways)
    most = int(MOST_LEFT_OUT * len(ways))
    for left_out in range(most + 1):
        kept = [way for way in every if not way.spoilt]
        if len(kept) < LEAST_PAUSES - 1:
            reasons = "; ".join(sorted({way.spoilt for way in every if way.spoilt}))
            raise CalibrationError(f"the {foot} foot has {len(kept)} ways between rests that can be used: {reasons}")
        found = fit(pauses, kept)
        worst = int(np.argmax(found.excess))
        if found.excess[worst] < LARGEST_EXCESS or left_out == most:
            break
        angle = degrees(found.closures[worst])
        spoilt = f"gravity ends {angle:.2g} degrees off (a knock, or a slip of the clock)"
        every = [evolve(way, spoilt=spoilt) if way is kept[worst] else way for way in every]
    if not found.converged or found.noise[1] > LARGEST_WAY_NOISE or found.excess.max() >= LARGEST_EXCESS:
        raise CalibrationError(
            f"the {foot} foot's rates do not turn gravity from one rest to the next, by up to "
            f"{degrees(found.closures.max()):.2g} degrees: are axes mirrored or exchanged, is a unit wrong, or were "
            "samples lost? `solepath check` on a recording of a walk says more"
        )
    return found, kept, every


def _record(found: Fit) -> SensorCalibration:
    acc_sigma, acc_bias_sigma, gyro_sigma = sigmas(found)
    unknowns = found.unknowns
    nodes = np.diag(found.covariance)[FIRST_NODE:].reshape(-1, PER_PAUSE)
    bias_sigma = np.sqrt(np.mean(nodes[:, :3], axis=0) + unknowns.biases.var(axis=0))
    return SensorCalibration(
        _triad(unknowns.acc, unknowns.acc_bias, acc_sigma, acc_bias_sigma),
        _triad(unknowns.gyro, unknowns.biases.mean(axis=0), gyro_sigma, bias_sigma),
    )


def _triad(*parts: Floats) -> TriadCalibration:
    """Return a record of matrix, bias, and standard deviations of both."""
    values: list[Any] = [tuple(part.ravel().tolist()) for part in parts]
    return TriadCalibration(*values)


def _errors(unknowns: Unknowns, pauses: Sequence[Pause], ways: Sequence[WayBetween]) -> tuple[float, float]:
    """Return the root mean squares of errors of gravity, m/s^2, and of closures, rad, of corrected readings."""
    force = (np.array([rest.acc for rest in pauses]) - unknowns.acc_bias) @ unknowns.acc.T
    length = np.linalg.norm(force, axis=1)
    up = force / length[:, None]
    angles = []
    for way in ways:
        turn, _ = integrate(way, unknowns)
        turned, target = turn.T @ up[way.number], up[way.number + 1]
        angles.append(np.arctan2(np.linalg.norm(np.cross(turned, target)), turned @ target))
    return float(np.sqrt(np.mean((length - GRAVITY) ** 2))), float(np.sqrt(np.mean(np.square(angles))))
