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
from collections.abc import Iterable
from math import degrees, radians, tan
from pathlib import Path

import numpy as np
from attrs import frozen

from solepath.emulate.routes.postures import PITCHES
from solepath.emulate.wearers.shoe import IN_SOLE, Mounting, Shoe

REPETITIONS = 3
"""Number of measurements of each posture."""
RULER_RESOLUTION = 0.001
"""Resolution of the ruler, m."""
POSTURE_ERROR = radians(1.5)
"""Standard deviation between the pitch of a shoe held by hand and the intended one, rad (assumed)."""
PITCH_ERROR = radians(0.5)
"""Standard deviation of the pitch that a sensor measures at rest, rad: an accelerometer bias of about 0.01 g."""

SHOE = Shoe()
"""Shoe that is measured."""


@frozen
class Posture:
    """A static posture of the shoe."""

    pitch: float
    """Pitch of the sole, rad; positive when the heel is up."""
    sensor_to_ground: float
    """Distance L_r along the sole from the point below the sensor to the ground, m."""
    ground_to_tip: float
    """Distance L_p2t on the ground from the end of L_r to where the tip stood before the heel was raised, m."""


def posture(pitch: float, shoe: Shoe = SHOE, mounting: Mounting = IN_SOLE) -> Posture:
    """Return the true posture of the shoe with its heel raised by `pitch`, rad."""
    rocker = shoe.forefoot
    tangent = rocker.radius * tan(0.5 * pitch)
    to_ground = rocker.x - mounting.position[0] + tangent
    return Posture(pitch, to_ground, shoe.length - rocker.x - rocker.radius * pitch + tangent)


def postures(seed: int = 1) -> tuple[Posture, ...]:
    """Return REPETITIONS measurements of each posture held by hand: pitch by the sensor, lengths by a ruler."""
    rng = np.random.default_rng([seed, 8])
    measurements = []
    for pitch in np.repeat(PITCHES, REPETITIONS).tolist():
        pitch_error, sensor_error = (float(value) for value in rng.standard_normal(2))
        true = posture(pitch + POSTURE_ERROR * pitch_error)
        measured = true.pitch + PITCH_ERROR * sensor_error
        measurements.append(Posture(measured, _read(true.sensor_to_ground), _read(true.ground_to_tip)))
    return tuple(measurements)


def write_postures(path: Path, measurements: Iterable[Posture]) -> None:
    """Write postures as a csv file for `solepath calibrate shoe`."""
    with path.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(("pitch_deg", "L_r_m", "L_p2t_m", "H_imu_m", "heel_L_r_m"))
        x, _, z = IN_SOLE.position  # x: from the heel's end to below the sensor
        for one in measurements:
            lengths = [f"{value:.3f}" for value in (one.sensor_to_ground, one.ground_to_tip, _read(z), _read(x))]
            rows.writerow((f"{degrees(one.pitch):.1f}", *lengths))


def _read(length: float) -> float:
    return RULER_RESOLUTION * round(length / RULER_RESOLUTION)
