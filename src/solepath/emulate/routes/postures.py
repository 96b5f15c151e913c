"""Static postures of the emulated shoe, as somebody with a ruler measures them for `solepath calibrate shoe`.

The shoe stands on its forefoot rocker (radius R, beginning x_f before the heel's end) with the heel up by p. The sole
between heel and rocker is flat; a ruler laid along it from the point below the sensor, at x_s, meets the ground after

    L_r = x_f - x_s + R tan(p / 2),

and from there to where the tip of the flat shoe was (length l), on the ground, it is

    L_p2t = l - x_f - R (p - tan(p / 2)).

With these two, equations (6) of Chen et al. 2019 give the way of the sensor over the rocker exactly: the sole's plane
meets the ground behind the point where a round sole touches it.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable
from math import degrees, radians, tan
from pathlib import Path

import numpy as np
from attrs import frozen

from ..wearers.shoe import IN_SOLE, Mounting, Shoe

PITCHES = tuple(radians(value) for value in (10.0, 22.0, 34.0, 46.0, 58.0))
"""Five postures between flat and toe-off (section III-C, 3); the paper does not say which."""
REPEATED = 3
RULER = 0.001
"""m: a ruler is read to the millimetre."""
POSTURE_ERROR = radians(1.5)
"""rad: how far a posture differs from the one that was meant (assumed)."""
PITCH_ERROR = radians(0.5)
"""rad: of the pitch that a sensor shows at rest: an accelerometer's bias of 0.01 g or so."""


@frozen
class Posture:
    """Heel-up `pitch`, rad, and the two lengths, m."""

    pitch: float
    radius: float
    to_toe: float


def posture(pitch: float, shoe: Shoe | None = None, mounting: Mounting = IN_SOLE) -> Posture:
    """What is true of the shoe with its heel up by `pitch`, rad."""
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
    """Each posture so many times, as measured: held and read by hand."""
    rng = np.random.default_rng([seed, 8])
    found = []
    for pitch in pitches:
        for _ in range(repeated):
            held, shown = (float(value) for value in rng.standard_normal(2))
            true = posture(pitch + POSTURE_ERROR * held, shoe, mounting)
            found.append(Posture(true.pitch + PITCH_ERROR * shown, _read(true.radius), _read(true.to_toe)))
    return tuple(found)


def write_postures(path: Path | str, found: Iterable[Posture], mounting: Mounting = IN_SOLE) -> None:
    """As `solepath calibrate shoe` reads them."""
    with Path(path).open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(("pitch_deg", "L_r_m", "L_p2t_m", "H_imu_m", "heel_L_r_m"))
        x, _, z = mounting.position
        for one in found:
            measured = (f"{degrees(one.pitch):.1f}", f"{one.radius:.3f}", f"{one.to_toe:.3f}")
            rows.writerow((*measured, f"{_read(z):.3f}", f"{_read(x):.3f}"))


def _read(length: float) -> float:
    return RULER * round(length / RULER)
