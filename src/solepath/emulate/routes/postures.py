"""Static postures of the emulated shoe, as measured with a ruler for `solepath calibrate shoe`.

The shoe stands on its forefoot rocker (radius R, starting at x_f from the heel's end) with the heel up by p. The sole
between heel and rocker is flat; a ruler along it, from the point below the sensor at x_s, meets the ground after

    L_r = x_f - x_s + R tan(p / 2),

and the distance on the ground from there to the tip of the flat shoe (length l) is

    L_p2t = l - x_f - R (p - tan(p / 2)).

With these two, equations (6) of Chen et al. 2019 give the path of the sensor over the rocker exactly: the sole's plane
meets the ground behind the point where a round sole touches it."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from math import degrees, radians, tan
from pathlib import Path

import numpy as np
from attrs import frozen

from ..wearers.shoe import IN_SOLE, Mounting, Shoe

PITCHES = tuple(radians(value) for value in (10.0, 22.0, 34.0, 46.0, 58.0))
"""Pitches of five postures between flat and toe-off, rad (section III-C, 3); the paper does not give their values."""
REPEATED = 3
"""Number of measurements of each posture."""
RULER = 0.001
"""Resolution of the ruler, m."""
POSTURE_ERROR = radians(1.5)
"""Standard deviation of a posture's pitch about the intended one, rad (assumed)."""
PITCH_ERROR = radians(0.5)
"""Standard deviation of the pitch that a sensor measures at rest, rad: an accelerometer bias of about 0.01 g."""


@frozen
class Posture:
    """A static posture of the shoe."""

    pitch: float
    """Pitch of the sole, rad; positive when the heel is up."""
    sensor_to_ground: float
    """Distance along the sole from below the sensor to the ground (L_r), m."""
    ground_to_tip: float
    """Distance on the ground from there to the tip of the flat shoe (L_p2t), m."""


def posture(pitch: float, shoe: Shoe | None = None, mounting: Mounting = IN_SOLE) -> Posture:
    """Return the true posture of the shoe with its heel up by `pitch`, rad."""
    shoe = shoe or Shoe()
    rocker = shoe.forefoot
    raised = rocker.radius * tan(0.5 * pitch)
    return Posture(
        pitch, rocker.x - mounting.position[0] + raised, shoe.length - rocker.x - rocker.radius * pitch + raised
    )


def postures(
    shoe: Shoe | None = None,
    mounting: Mounting = IN_SOLE,
    seed: int = 1,
    pitches: Iterable[float] = PITCHES,
    repeated: int = REPEATED,
) -> tuple[Posture, ...]:
    """Return each posture `repeated` times as measured: held and read by hand."""
    rng = np.random.default_rng([seed, 8])
    found = []
    for pitch in pitches:
        for _ in range(repeated):
            held, shown = (float(value) for value in rng.standard_normal(2))
            true = posture(pitch + POSTURE_ERROR * held, shoe, mounting)
            measured = true.pitch + PITCH_ERROR * shown
            found.append(Posture(measured, _read(true.sensor_to_ground), _read(true.ground_to_tip)))
    return tuple(found)


def write_postures(path: Path | str, found: Iterable[Posture], mounting: Mounting = IN_SOLE) -> None:
    """Write postures as a csv file for `solepath calibrate shoe`."""
    with Path(path).open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(("pitch_deg", "L_r_m", "L_p2t_m", "H_imu_m", "heel_L_r_m"))
        x, _, z = mounting.position
        for one in found:
            measured = (f"{degrees(one.pitch):.1f}", f"{one.sensor_to_ground:.3f}", f"{one.ground_to_tip:.3f}")
            rows.writerow((*measured, f"{_read(z):.3f}", f"{_read(x):.3f}"))


def _read(length: float) -> float:
    return RULER * round(length / RULER)
