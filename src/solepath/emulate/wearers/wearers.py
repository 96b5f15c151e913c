"""Wearers of a given size, and the four of Gong et al. 2023."""

from __future__ import annotations

import numpy as np

from ...calibration import Limbs
from .gait import Wearer
from .shoe import Rocker, Shoe

FOOT = 0.275
"""m: foot that the default shoe is for, a size 43."""
STATURE = 1.75
"""m: of the default wearer."""


def shoe_for(foot_length: float) -> Shoe:
    """The default shoe, larger or smaller in every direction, m."""
    k = foot_length / FOOT
    plain = Shoe()
    x, y, z = plain.ankle
    return Shoe(
        length=k * plain.length,
        width=k * plain.width,
        heel=Rocker(k * plain.heel.x, k * plain.heel.radius),
        forefoot=Rocker(k * plain.forefoot.x, k * plain.forefoot.radius),
        ankle=(k * x, k * y, k * z),
    )


def wearer(stature: float, mass: float, foot_length: float) -> Wearer:
    """A wearer of so many m and kg in shoes for a foot of `foot_length` m.

    Limbs by the proportions of `Limbs`; `foot` is what of the shoe is ahead of the ankle. The walk ratio goes with the
    stature to the power of 1.5: steps then are as long as legs at cadences that go with a pendulum's, as dynamic
    similarity has it (Alexander 1989, Physiol. Rev. 69).
    """
    shoe, plain = shoe_for(foot_length), Wearer()
    limbs = Limbs(
        hip_width=0.191 * stature,
        thigh=0.245 * stature,
        shank=0.246 * stature,
        foot=shoe.length - shoe.ankle[0],
        ankle_height=0.039 * stature,
    )
    return Wearer(
        mass=mass,
        shoe=shoe,
        limbs=limbs,
        centre_height=plain.centre_height * stature / STATURE,
        walk_ratio=plain.walk_ratio * (stature / STATURE) ** 1.5,
    )


def anybody(rng: np.random.Generator) -> tuple[Wearer, float]:
    """Somebody between 1.55 m and 1.92 m tall, neither thin nor fat, and the stature, m."""
    stature = float(rng.uniform(1.55, 1.92))
    return wearer(stature, float(rng.uniform(21.0, 28.0)) * stature**2, 0.153 * stature), stature


SUBJECTS = (
    wearer(1.72, 63.0, 0.245),
    wearer(1.68, 52.5, 0.255),
    wearer(1.60, 50.0, 0.235),
    wearer(1.83, 81.0, 0.270),
)
"""Of table 3: height, weight and shoe size (Sensors 23, 5417)."""
