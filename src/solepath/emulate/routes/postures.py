"""Static postures of the emulated shoe, as measured with a ruler for `solepath calibrate shoe`.

The shoe stands on its forefoot rocker with its heel raised by the pitch p. The rocker is the round part of the sole
over which the shoe rolls, of radius R; it starts x_f in front of the heel's end. The sole between heel and rocker is
flat. A ruler along this part, from the point below the sensor at x_s, meets the ground after

    L_r = x_f - x_s + R tan(p / 2).

The distance on the ground from there to where the tip of the shoe (length l) stood before the heel was raised is

    L_p2t = l - x_f - R (p - tan(p / 2)).

With these two distances, equations (6) of Chen et al. 2019 give the exact path of the sensor over the rocker. The round
sole touches the ground further ahead than the ruler; that point is not used (papers/kupt_dfpc/shoe/fit.py)."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from math import degrees, radians, tan
from pathlib import Path

import numpy as np
from attrs import frozen

from ...types import Phase
from ..wearers.curves import constant, join
from ..wearers.motion import PHASES, FootMotion
from ..wearers.shoe import IN_SOLE, Mounting, Shoe

PITCHES = tuple(radians(value) for value in (10.0, 22.0, 34.0, 46.0, 58.0))
"""Pitches of five postures between flat and toe-off, rad (assumed: Chen et al. 2019 give no values)."""
REPETITIONS = 3
"""Number of measurements of each posture."""
RULER_RESOLUTION = 0.001
"""Resolution of the ruler, m."""
POSTURE_ERROR = radians(1.5)
"""Standard deviation between the pitch of a shoe held by hand and the intended one, rad (assumed)."""
PITCH_ERROR = radians(0.5)
"""Standard deviation of the pitch that a sensor measures at rest, rad: an accelerometer bias of about 0.01 g."""

MOVING_TIME = 1.0
"""Time in which a held shoe goes from one posture to the next, s (assumed)."""


@frozen
class Posture:
    """A static posture of the shoe."""

    pitch: float
    """Pitch of the sole, rad; positive when the heel is up."""
    sensor_to_ground: float
    """Distance L_r along the sole from the point below the sensor to the ground, m."""
    ground_to_tip: float
    """Distance L_p2t on the ground from the end of L_r to where the tip stood before the heel was raised, m."""


def posture(pitch: float, shoe: Shoe | None = None, mounting: Mounting = IN_SOLE) -> Posture:
    """Return the true posture of the shoe with its heel raised by `pitch`, rad."""
    shoe = shoe or Shoe()
    rocker = shoe.forefoot
    tangent = rocker.radius * tan(0.5 * pitch)
    to_ground = rocker.x - mounting.position[0] + tangent
    return Posture(pitch, to_ground, shoe.length - rocker.x - rocker.radius * pitch + tangent)


def postures(
    shoe: Shoe | None = None,
    mounting: Mounting = IN_SOLE,
    seed: int = 1,
    pitches: Iterable[float] = PITCHES,
    repetitions: int = REPETITIONS,
) -> tuple[Posture, ...]:
    """Return `repetitions` measurements of each posture held by hand: pitch by the sensor, lengths by a ruler."""
    rng = np.random.default_rng([seed, 8])
    measurements = []
    for pitch in pitches:
        for _ in range(repetitions):
            pitch_error, sensor_error = (float(value) for value in rng.standard_normal(2))
            true = posture(pitch + POSTURE_ERROR * pitch_error, shoe, mounting)
            measured = true.pitch + PITCH_ERROR * sensor_error
            measurements.append(Posture(measured, _read(true.sensor_to_ground), _read(true.ground_to_tip)))
    return tuple(measurements)


def write_postures(path: Path | str, measurements: Iterable[Posture], mounting: Mounting = IN_SOLE) -> None:
    """Write postures as a csv file for `solepath calibrate shoe`."""
    with Path(path).open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(("pitch_deg", "L_r_m", "L_p2t_m", "H_imu_m", "heel_L_r_m"))
        x, _, z = mounting.position
        for measurement in measurements:
            measured = (
                f"{degrees(measurement.pitch):.1f}",
                f"{measurement.sensor_to_ground:.3f}",
                f"{measurement.ground_to_tip:.3f}",
            )
            rows.writerow((*measured, f"{_read(z):.3f}", f"{_read(x):.3f}"))  # x: heel's end to below the sensor


def _read(length: float) -> float:
    return RULER_RESOLUTION * round(length / RULER_RESOLUTION)


def held_shoe(pitches: Sequence[float], hold: float, shoe: Shoe | None = None) -> FootMotion:
    """Return the motion of a shoe that is held in static postures, from 0 s on: `hold` s each, after MOVING_TIME.

    It stands flat for `hold` s at first. The `pitches`, rad, are positive when the heel is up."""
    arc = (shoe or Shoe()).forefoot
    flat, centre = constant(0.0), [constant(value) for value in (arc.x, 0.0, arc.radius)]
    starts, durations, curves = [0.0], [hold], [[*centre, flat, flat, flat]]
    before = 0.0
    for pitch in (-pitch for pitch in pitches):
        way = join((before, 0.0, 0.0), (pitch, 0.0, 0.0), MOVING_TIME)
        for duration, curve in ((MOVING_TIME, way), (hold, constant(pitch))):
            starts.append(starts[-1] + durations[-1])
            durations.append(duration)
            curves.append([*centre, curve, flat, flat])
        before = pitch
    count = len(starts)
    return FootMotion(
        start=np.array(starts),
        duration=np.array(durations),
        curves=np.array(curves),
        reference=np.tile([arc.x, arc.radius], (count, 1)),
        radius=np.full(count, arc.radius),
        phase=np.full(count, PHASES.index(Phase.PUSH_OFF), dtype=np.intp),
    )


def held_time(hold: float, pitches: Sequence[float] = PITCHES) -> float:
    """Return how long the motion of `held_shoe` takes, s."""
    return hold + len(pitches) * (MOVING_TIME + hold)
