"""Parameters of strides other than level walking: running, and stairs up and down.

Running: at 2.6 m/s a foot is on the ground for 38 % of the stride, and for less at higher speeds; between the stances
both feet are in the air (Novacheck 1998, Gait & Posture 7). The cadence is about 160 steps a minute and grows little
with the speed (Cavagna et al. 1988, J. Physiol. 399). The heel lands at more than twice its speed in walking.

Stairs, foot over foot: Riener et al. 2002 (Gait & Posture 15) and Nadeau et al. 2003 (Clin. Biomech. 18). The speed
along is about 0.5 m/s, a little more downwards. Upwards the foot lands flat or forefoot first; downwards it lands with
the toe down by some 20 degrees, and the forefoot brakes. Angles, rates and impacts were compared with recordings on an
instep (HuGaDB: Chereshnev and Kertesz-Farkas 2018) and on a shoe (MaD stair ambulation)."""

from __future__ import annotations

from enum import Enum

from attrs import frozen

RUNNING_FROM = 1.95
"""Least speed of running, m/s (Hreljac 1993, J. Sports Sci. 11: transition from walking at about 2 m/s)."""
RUN_ACCELERATION = 2.0
"""Acceleration of a runner who speeds up or slows down, m/s^2 (assumed)."""
SPEED_UP, SPEED_DOWN = 0.50, 0.55
"""Default speed along a flight of stairs upwards and downwards, m/s."""


class StrideKind(Enum):
    """Kinds of strides."""

    WALK = "walk"
    RUN = "run"
    UP = "up"
    DOWN = "down"


@frozen
class Style:
    """The parameters of a kind of stride."""

    double: float
    """Time from heel-strike of the other foot to toe-off, as a share of the stride; negative with a flight phase."""
    early: float
    """Time from heel-off to heel-strike of the other foot, as a share of the stride."""
    flat: float
    """Time from heel-strike to foot-flat, as a share of the stride."""
    toe_off_pitch: float
    """Pitch at toe-off, rad; positive when the heel is up."""
    strike_pitch: float
    """Pitch at heel-strike, rad; positive when the toe is up."""
    slide: float
    """Forward speed of the shoe when it touches the ground, m/s."""
    sink: float
    """Downward speed of the shoe when it touches the ground, m/s."""
    clearance: float
    """Least height of the sole in mid-swing, m."""
    hold: float = 0.0
    """Horizontal deviation of the swing from a quintic in the middle, as a share of its length."""
    soon: float = 0.0
    """Weight of LEVELLING in the vertical motion of the swing: the foot rises, or sinks, earlier."""
    deviation_factor: float = 1.0
    """Roll and yaw of the foot in swing, relative to walking."""
    forefoot_share: float = 0.0
    """Share of the load that lands on the forefoot."""
    load_amplitude: float = 0.0
    """Amplitude of the load about the weight, as a share of the weight."""


CLIMBING = Style(
    double=0.12,
    early=0.08,
    flat=0.08,
    toe_off_pitch=0.66,
    strike_pitch=-0.08,
    slide=0.20,
    sink=0.45,
    clearance=0.05,
    hold=-0.27,
    soon=25.0,
    forefoot_share=0.7,
    load_amplitude=0.10,
)
DESCENDING = Style(
    double=0.10,
    early=0.08,
    flat=0.10,
    toe_off_pitch=0.70,
    strike_pitch=-0.33,
    slide=0.15,
    sink=0.45,
    clearance=0.04,
    hold=0.12,
    forefoot_share=0.9,
    load_amplitude=0.20,
)


def style_of(kind: StrideKind, speed: float) -> Style:
    """Return the parameters of any kind of stride but walking, at `speed` m/s along the path."""
    if kind is StrideKind.RUN:
        share = min(max(0.38 - 0.03 * (speed - 2.6), 0.25), 0.44)
        return Style(
            double=share - 0.5,
            early=0.5 - 0.40 * share,
            flat=0.09,
            toe_off_pitch=0.95,
            strike_pitch=0.24,
            slide=0.25 * speed,
            sink=0.33 * speed,
            clearance=0.15,
            deviation_factor=2.0,
        )
    return CLIMBING if kind is StrideKind.UP else DESCENDING


def running_cadence(speed: float) -> float:
    """Return the cadence of running at `speed` m/s, steps per minute."""
    return 60.0 * (2.4 + 0.1 * speed)
