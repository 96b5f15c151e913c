"""How a stride is made other than walking on the level: running, and stairs up and down.

Running: at 2.6 m/s a foot is on the ground for 38 % of the stride and for less the faster one runs, in between nobody
is (Novacheck 1998, Gait & Posture 7), at about 160 steps a minute that grow little with the speed (Cavagna et al. 1988,
J. Physiol. 399). The heel comes down at more than twice the speed of walking.

Stairs, foot over foot: Riener et al. 2002 (Gait & Posture 15) and Nadeau et al. 2003 (Clin. Biomech. 18). About 0.5 m/s
along, a little faster down; the foot comes down flat or forefoot first going up, and toe down by some 20 degrees going
down, where the forefoot brakes. Angles, rates and impacts compared with recordings on an instep (HuGaDB: Chereshnev and
Kertesz-Farkas 2018) and a shoe (MaD stair ambulation).
"""

from __future__ import annotations

from enum import Enum

from attrs import frozen

RUNNING_FROM = 1.95
"""m/s: slower than this one walks (Hreljac 1993, J. Sports Sci. 11: walk to run at about 2 m/s)."""
RUN_ACCELERATION = 2.0
"""m/s^2 by which a runner speeds up and slows down (assumed)."""
SPEED_UP, SPEED_DOWN = 0.50, 0.55
"""m/s along the treads when a flight names no speed."""


class StrideKind(Enum):
    """What kind of stride it is."""

    WALK = "walk"
    RUN = "run"
    UP = "up"
    DOWN = "down"


@frozen
class Style:
    """Of a stride: shares of its time, angles in rad, speeds in m/s.

    `double`: from heel-strike of the other foot to toe-off of this one, negative when it is in the air by then.
    `early`: from heel-off to that heel-strike. `flat`: from heel-strike to foot-flat. `slide`, `sink`: how fast the
    shoe still goes ahead and down when it touches the ground. `clearance`: of the sole in swing, m. `hold`: how the
    swing lags behind a quintic in the middle, as a share of its way. `soon`: how much it rises, or sinks, early.
    `weave`: how much the foot rolls and turns in swing, relative to walking. `front`: share of the load that lands on
    the forefoot. `bounce`: amplitude of the load's swing about the weight.
    """

    double: float
    early: float
    flat: float
    toe_off_pitch: float
    strike_pitch: float
    slide: float
    sink: float
    clearance: float
    hold: float = 0.0
    soon: float = 0.0
    weave: float = 1.0
    front: float = 0.0
    bounce: float = 0.0


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
    front=0.7,
    bounce=0.10,
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
    front=0.9,
    bounce=0.20,
)


def style_of(kind: StrideKind, speed: float) -> Style:
    """For any but walking, at `speed` m/s along."""
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
            weave=2.0,
        )
    return CLIMBING if kind is StrideKind.UP else DESCENDING


def running_cadence(speed: float) -> float:
    """Steps per minute."""
    return 60.0 * (2.4 + 0.1 * speed)
