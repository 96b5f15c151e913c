"""Wearers of a stature, a mass and a foot length, and those of Gong et al. 2023."""

from __future__ import annotations

from attrs import evolve

from solepath.calibration import Limbs
from solepath.emulate.wearers.curves import Rng
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.shoe import Rocker, Shoe

DEFAULT_FOOT_LENGTH = 0.275
"""Length of the foot that the default shoe (size 43) fits, m."""
DEFAULT_STATURE = 1.75
"""Stature of the default wearer, m."""
SPINE_DISTANCE_SHARE = 0.137
"""Distance of the anterior iliac spines as a share of the stature: 0.24 m at 1.75 m (Bell et al. 1989)."""


def hip_joint_distance(spines: float) -> float:
    """Return the distance between the hip joints, m, of a pelvis whose anterior iliac spines are `spines` m apart.

    Either joint is 0.33 of that distance and 7.3 mm from the middle (Harrington et al. 2007, J Biomech 40: images of
    the joints themselves). The 0.191 of the stature in Drillis and Contini (1966) is the breadth of the hips."""
    return 2.0 * (0.33 * spines + 0.0073)


def scaled_wearer(stature: float, mass: float, foot_length: float) -> Wearer:
    """Return a wearer of this stature, m, and mass, kg, in the default shoe scaled to a foot of `foot_length` m.

    The limbs have the proportions of `Limbs`; their `foot` is the length of the shoe ahead of the ankle. By dynamic
    similarity, the step length is proportional to the leg length, and the cadence to the frequency of a pendulum as
    long as the leg (Alexander 1989, Physiol. Rev. 69). The walk ratio therefore grows with stature^1.5."""
    default, scale = Wearer(), foot_length / DEFAULT_FOOT_LENGTH
    sole = default.shoe
    shoe = Shoe(
        length=scale * sole.length,
        width=scale * sole.width,
        heel=Rocker(scale * sole.heel.x, scale * sole.heel.radius),
        forefoot=Rocker(scale * sole.forefoot.x, scale * sole.forefoot.radius),
        ankle=(scale * sole.ankle[0], scale * sole.ankle[1], scale * sole.ankle[2]),
    )
    limbs = Limbs(
        hip_width=hip_joint_distance(SPINE_DISTANCE_SHARE * stature),
        thigh=0.245 * stature,
        shank=0.246 * stature,
        foot=shoe.length - shoe.ankle[0],
        ankle_height=0.039 * stature,
    )
    return Wearer(
        mass=mass,
        shoe=shoe,
        limbs=limbs,
        centre_height=default.centre_height * stature / DEFAULT_STATURE,
        walk_ratio=default.walk_ratio * (stature / DEFAULT_STATURE) ** 1.5,
    )


def random_wearer(rng: Rng) -> tuple[Wearer, float]:
    """Return a random wearer and the stature, m: 1.55 to 1.92 m, with a body mass index of 21 to 28 kg/m^2."""
    stature = float(rng.uniform(1.55, 1.92))
    return scaled_wearer(stature, float(rng.uniform(21.0, 28.0)) * stature**2, 0.153 * stature), stature


SUBJECTS = tuple(
    evolve(scaled_wearer(stature, mass, foot_length), number=number)
    for number, (stature, mass, foot_length) in enumerate(
        ((1.72, 63.0, 0.245), (1.68, 52.5, 0.255), (1.60, 50.0, 0.235), (1.83, 81.0, 0.270)), 1
    )
)
"""Wearers with stature, mass and foot length of the subjects of Gong et al. 2023 (Sensors 23, 5417), table 3."""
