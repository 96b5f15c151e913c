"""Parameters of strides that are not walking ahead: running, stairs up and down, walking backwards and sideways.

Running: at 2.6 m/s a foot is on the ground for 38 % of the stride, and for less at higher speeds; between the stances
both feet are in the air (Novacheck 1998, Gait & Posture 7). The cadence is about 160 steps a minute and grows little
with the speed (Cavagna et al. 1988, J. Physiol. 399). The heel lands at more than twice its speed in walking.

Stairs, foot over foot: Riener et al. 2002 (Gait & Posture 15) and Nadeau et al. 2003 (Clin. Biomech. 18). The
horizontal speed along the flight is about 0.5 m/s, a little more downwards. Upwards the foot lands flat or forefoot
first; downwards it lands with the toe down by some 20 degrees, and the forefoot brakes. Angles, rates and impacts were
compared with recordings on an instep (HuGaDB: Chereshnev and Kertesz-Farkas 2018) and on a shoe (MaD stair ambulation).
Backwards the foot lands with the toes first (Thorstensson 1986, Acta Physiol. Scand. 127); people leave the ground with
the heel last, while the foot here is lifted nearly flat. The strides are shorter and slower than ahead. Sideways the
leading foot steps aside and the other one closes up to it, both nearly flat. All numbers of both are assumed.

Numbers without a source were chosen by hand in view of these papers and recordings and not swept."""

from __future__ import annotations

from enum import Enum

from attrs import frozen

MIN_RUNNING_SPEED = 1.95
"""Least speed of running, m/s (Hreljac 1993, J. Sports Sci. 11: transition from walking at about 2 m/s)."""
RUN_ACCELERATION = 2.0
"""Acceleration of a runner who speeds up or slows down, m/s^2 (assumed)."""
MAX_SLOPE = 0.2
"""Steepest ramp, as rise over run (assumed).

Ramps for wheelchairs rise by up to 1 in 12 (ADA Standards for Accessible Design, 405.2), those of car parks by some 15
in 100."""
LANDING = 1.5
"""Least length of the level between a ramp and a flight of stairs, m: that of landings of ramps (ADA, 405.7)."""
STAIRS_UP_SPEED, STAIRS_DOWN_SPEED = 0.50, 0.55
"""Default horizontal speed along a flight of stairs upwards and downwards, m/s."""


BACKWARDS_SPEED, SIDEWAYS_SPEED = 0.5, 0.25
"""Default speed of walking backwards and sideways, m/s (assumed)."""
BACKWARDS_RATIO = 0.41
"""Walk ratio of walking backwards, as a ratio to that ahead, no unit (assumed).

At BACKWARDS_SPEED the default wearer then makes 107 steps of 0.28 m a minute, strides of 0.56 m."""
SHUFFLING_SPEED, SHUFFLING_STEP = 0.3, 0.15
"""Speed of shuffling ahead in a queue, m/s, and length of its steps, m (assumed).

People move at 0.3 m/s where there are three in a square metre (Weidmann 1993, Transporttechnik der Fussgaenger)."""
SIDE_STEP = 0.30
"""Length of a side step, m (assumed); the step that closes up to it brings the feet together."""


class StrideKind(Enum):
    """A kind of stride: walking ahead, backwards or sideways, running, or stairs up or down."""

    WALK = "walk"
    RUN = "run"
    UP = "up"
    DOWN = "down"
    BACK = "back"
    SIDE = "side"


@frozen
class Style:
    """The parameters of a kind of stride."""

    double_support_share: float
    """Time from the other foot's heel-strike to toe-off, as a share of the stride; negative when there is flight."""
    heel_off_share: float
    """Time from heel-off to the other foot's heel-strike, as a share of the stride."""
    foot_flat_share: float
    """Time from heel-strike to foot-flat, as a share of the stride."""
    toe_off_pitch: float
    """Pitch at toe-off, rad; positive when the heel is up."""
    strike_pitch: float
    """Pitch at heel-strike, rad; positive when the toe is up."""
    forward_speed: float
    """Forward speed of the shoe when it touches the ground, m/s."""
    sink_speed: float
    """Downward speed of the shoe when it touches the ground, m/s."""
    clearance: float
    """Least height of the sole in mid-swing, m."""
    mid_swing_shift: float = 0.0
    """Horizontal shift of the path in mid-swing, as a share of the stride's length; positive forwards."""
    early_rise: float = 0.0
    """Weight of LEVELLING (curves.py) in the height of the foot in swing, per two risers, no unit; the foot rises
    earlier."""
    deviation_factor: float = 1.0
    """Roll and yaw of the foot in mid-swing, as a ratio to those in walking."""
    forefoot_share: float = 0.0
    """Share of the load that the forefoot takes at the landing."""
    load_amplitude: float = 0.0
    """Amplitude of the load about the weight, as a share of the weight; 0: it follows from the speed."""


UPSTAIRS = Style(
    double_support_share=0.12,
    heel_off_share=0.08,
    foot_flat_share=0.08,
    toe_off_pitch=0.66,
    strike_pitch=-0.08,
    forward_speed=0.20,
    sink_speed=0.45,
    clearance=0.05,
    mid_swing_shift=-0.27,
    early_rise=25.0,
    forefoot_share=0.7,
    load_amplitude=0.10,
)
DOWNSTAIRS = Style(
    double_support_share=0.10,
    heel_off_share=0.08,
    foot_flat_share=0.10,
    toe_off_pitch=0.70,
    strike_pitch=-0.33,
    forward_speed=0.15,
    sink_speed=0.45,
    clearance=0.04,
    mid_swing_shift=0.12,
    forefoot_share=0.9,
    load_amplitude=0.20,
)
BACKWARDS = Style(
    double_support_share=0.15,
    heel_off_share=0.06,
    foot_flat_share=0.09,
    toe_off_pitch=0.12,
    strike_pitch=-0.22,
    forward_speed=-0.10,
    sink_speed=0.10,
    clearance=0.02,
    forefoot_share=0.8,
    load_amplitude=0.05,
)
SIDEWAYS = Style(
    double_support_share=0.15,
    heel_off_share=0.05,
    foot_flat_share=0.07,
    toe_off_pitch=0.15,
    strike_pitch=-0.04,
    forward_speed=0.0,
    sink_speed=0.08,
    clearance=0.02,
    deviation_factor=0.5,
    forefoot_share=0.3,
    load_amplitude=0.03,
)
_STYLES = {StrideKind.UP: UPSTAIRS, StrideKind.DOWN: DOWNSTAIRS, StrideKind.BACK: BACKWARDS, StrideKind.SIDE: SIDEWAYS}


def style_of(kind: StrideKind, speed: float) -> Style:
    """Return the parameters of a kind of stride that is not WALK, at `speed` m/s along the path."""
    if kind is StrideKind.RUN:
        share = min(max(0.38 - 0.03 * (speed - 2.6), 0.25), 0.44)
        return Style(
            double_support_share=share - 0.5,
            heel_off_share=0.5 - 0.40 * share,
            foot_flat_share=0.09,
            toe_off_pitch=0.95,
            strike_pitch=0.24,
            forward_speed=0.25 * speed,
            sink_speed=0.33 * speed,
            clearance=0.15,
            deviation_factor=2.0,
        )
    return _STYLES[kind]


def running_cadence(speed: float) -> float:
    """Return the cadence of running at `speed` m/s, steps per minute."""
    return 60.0 * (2.4 + 0.1 * speed)
