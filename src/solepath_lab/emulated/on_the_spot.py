"""Feet of somebody who stays on the spot: sits and moves the legs, lets them dangle, taps, marches or jumps.

Times, heights and angles are drawn for each wearer from ranges that are stated where they are used; those without a
source are assumed. A foot that lands has the speed of its fall until it touches, and is stopped by sole and floor in 15
to 30 ms.

Idealised: the foot is rigid and touches the floor with heel or forefoot alone; chairs do not move; nobody slides."""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np

from solepath.emulate.wearers.curves import Array, Rng
from solepath.emulate.wearers.limbs import SIDE_SIGNS
from solepath.emulate.wearers.shoe import Shoe
from solepath.emulate.wearers.turning import rotation
from solepath.types import Foot
from solepath.types.vector import GRAVITY

from .courses import Course, Frames, Key, Motion, Pose

Posing = Callable[[Foot, Array], Pose]
"""Function of the foot and of increasing times, s, that returns the poses of the foot."""
SHOE = Shoe()
BALL = (SHOE.forefoot.x, 0.0, 0.0)
"""Point of the sole on which the forefoot rests, foot frame, m."""
HALF_WIDTH = 0.1
"""Distance of each foot from the middle, m."""
LAST_MOVE = 4.0
"""Time before the end in which no motion starts, s."""


def posing(motions: dict[Foot, Motion]) -> Posing:
    """Return the poses of feet with these motions."""
    return lambda foot, t: motions[foot].pose(t)


def land(frames: Frames, t: float, speed: float, rng: Rng) -> None:
    """Let a foot touch the floor at `t`, s, with `speed`, m/s; the sole is pressed in while it is stopped."""
    stop = rng.uniform(0.015, 0.030)
    frames.add(t, z=(speed * stop / 3.0, -speed))
    frames.add(t + stop, z=0.0)


def fidgeting(rng: Rng, duration: float, pause: float = 4.0) -> Posing:
    """Return the feet of somebody who sits and moves them now and then, `pause` s apart on average.

    A foot is put elsewhere, up to 30 cm away; one time in ten it is lifted over the other knee for some seconds, where
    it swings."""
    return posing({foot: _fidgeting(rng, duration, pause, SIDE_SIGNS[foot]) for foot in Foot})


def _fidgeting(rng: Rng, duration: float, pause: float, side: float) -> Motion:
    frames = Frames(x=0.0, y=side * HALF_WIDTH, z=0.0, pitch=0.0, yaw=0.0)
    t, x, y, yaw = rng.exponential(pause), 0.0, side * HALF_WIDTH, 0.0
    while t < duration - LAST_MOVE - 16.0:
        moving, tilt = rng.uniform(0.5, 1.2), rng.uniform(-0.5, 0.2)
        frames.add(t, x=x, y=y, z=0.0, yaw=yaw, pitch=0.0)
        end = t + moving
        if rng.uniform() < 0.1:
            lift, until = rng.uniform(0.25, 0.45), end + rng.uniform(5.0, 12.0)
            frames.add(end, x=x, y=y - side * 0.25, z=lift)
            while end < until:
                frames.add(end, pitch=tilt + rng.uniform(-0.15, 0.15))
                end += rng.uniform(0.5, 1.2)
            frames.add(end, x=x, y=y - side * 0.25, z=lift, pitch=tilt)
            end += moving
        else:
            frames.add(t + 0.5 * moving, z=rng.uniform(0.02, 0.12), pitch=tilt)
        x = float(np.clip(x + 0.12 * rng.standard_normal(), -0.3, 0.3))
        y = side * float(np.clip(HALF_WIDTH + 0.04 * rng.standard_normal(), 0.04, 0.2))
        yaw = 0.15 * rng.standard_normal()
        frames.add(end, x=x, y=y, yaw=yaw, pitch=0.0)
        land(frames, end, rng.uniform(0.05, 0.4), rng)
        t = end + 0.1 + rng.exponential(pause)
    return frames.motion()


def dangling(rng: Rng, duration: float) -> Posing:
    """Return the feet of somebody who sits on a high seat and lets the legs dangle from the knees.

    A shank with its foot is a pendulum with a period of 1.0 to 1.3 s (a rod of 0.45 m has 1.1 s); amplitudes of 0.15 to
    0.8 rad and pauses are assumed. The legs of one half of the wearers swing in turn, of the others each by itself."""
    period, shank = rng.uniform(1.0, 1.3), rng.uniform(0.40, 0.48)
    droop = rng.uniform(-0.6, -0.2)
    if rng.uniform() < 0.5:
        first = _dangling(rng, duration, period)
        angles = {foot: (first, SIDE_SIGNS[foot]) for foot in Foot}
    else:
        angles = {foot: (_dangling(rng, duration, period), 1.0) for foot in Foot}

    def pose(foot: Foot, t: Array) -> Pose:
        course, sign = angles[foot]
        angle, still = sign * course.at(t), np.zeros_like(t)
        turn = rotation(still, -(droop + 0.9 * angle), still)
        ankle = np.stack((shank * np.sin(angle), still + SIDE_SIGNS[foot] * HALF_WIDTH, -shank * np.cos(angle)), axis=1)
        return ankle - turn @ np.array(SHOE.ankle), turn

    return pose


def _dangling(rng: Rng, duration: float, period: float) -> Course:
    t, keys = 1.0, list[Key]([(0.0, 0.0)])
    while t < duration - LAST_MOVE:
        amplitude, end, sign = rng.uniform(0.15, 0.8), t + rng.uniform(4.0, 20.0), 1.0
        while t < end:
            value = sign * amplitude * rng.uniform(0.85, 1.0)
            keys.append((t, value, 0.0, -((2.0 * pi / period) ** 2) * value))
            t, sign = t + 0.5 * period * rng.uniform(0.96, 1.04), -sign
        keys.append((t, 0.0))
        t += rng.uniform(0.8, 4.0)
    return Course.through(*keys)


def tapping(rng: Rng, duration: float) -> Posing:
    """Return the feet of somebody who sits and taps with the forefoot at 1.5 to 4 Hz, or bounces a heel at 4 to 7 Hz.

    Bouncing is that of restless legs, 1 to 3 cm at the heel. Both come in bouts of 3 to 20 s; each foot does one."""
    return posing({foot: _tapping(rng, duration, SIDE_SIGNS[foot], bool(rng.uniform() < 0.5)) for foot in Foot})


def _tapping(rng: Rng, duration: float, side: float, bounces: bool) -> Motion:
    frames = Frames(x=BALL[0] if bounces else 0.0, y=side * HALF_WIDTH, pitch=0.0)
    rates, angles, sign = ((4.0, 7.0), (0.05, 0.15), -1.0) if bounces else ((1.5, 4.0), (0.1, 0.35), 1.0)
    t, stop = rng.uniform(0.5, 4.0), 0.02
    while t < duration - LAST_MOVE:
        usual, angle, end = rng.uniform(*rates), rng.uniform(*angles), t + rng.uniform(3.0, 20.0)
        while t < end:
            gap, up = rng.uniform(0.93, 1.07) / usual, sign * angle * rng.uniform(0.8, 1.0)
            fall = 2.0 * up / (0.45 * gap)
            frames.add(t, pitch=0.0)
            frames.add(t + 0.5 * gap, pitch=up)
            frames.add(t + 0.95 * gap - stop, pitch=(fall * stop / 3.0, -fall))
            frames.add(t + 0.95 * gap, pitch=0.0)
            t += gap
        t += rng.uniform(0.5, 5.0)
    return frames.motion(BALL if bounces else (0.0, 0.0, 0.0))


def marching(rng: Rng, duration: float) -> Posing:
    """Return the feet of somebody who marches on the spot, with 90 to 120 steps a minute, and lifts them 8 to 25 cm.

    A foot is in the air for 38 to 45 % of the time. It leaves with the forefoot, comes down with it at 0.4 to 0.9 m/s,
    and the heel follows. It lands 2 cm from where it was, with this standard deviation either way."""
    step, air = 60.0 / rng.uniform(90.0, 120.0), rng.uniform(0.38, 0.45)
    lift, speed = rng.uniform(0.08, 0.25), rng.uniform(0.4, 0.9)
    motions: dict[Foot, Motion] = {}
    for number, foot in enumerate(Foot):
        x, y, t = BALL[0], SIDE_SIGNS[foot] * HALF_WIDTH, 3.0 + number * step
        frames = Frames(x=x, y=y, z=0.0, pitch=0.0)
        while t < duration - LAST_MOVE:
            flight = 2.0 * step * air * rng.normal(1.0, 0.02)
            top, end = t + 0.45 * flight, t + flight
            frames.add(t - 0.12, pitch=0.0)
            frames.add(t, x=x, y=y, z=0.0)
            frames.add(t + 0.1 * flight, pitch=-0.55)
            frames.add(top, x=x + 0.05, z=lift * rng.normal(1.0, 0.08), pitch=-0.3)
            x, y = x + 0.02 * rng.standard_normal(), y + 0.02 * rng.standard_normal()
            frames.add(end, x=x, y=y, pitch=(-0.15, 0.5))
            land(frames, end, speed * rng.uniform(0.9, 1.1), rng)
            frames.add(end + rng.uniform(0.05, 0.09), pitch=0.0)
            t += 2.0 * step * rng.normal(1.0, 0.02)
        motions[foot] = frames.motion(BALL)
    return posing(motions)


JUMPS = 31
"""Number of jumps."""
FIRST_JUMP = 8.0
"""Time of the first jump, s."""


def jumping(rng: Rng, duration: float) -> Posing:
    """Return the feet of somebody who jumps 31 times on both feet, with a flight of 0.25 to 0.45 s each.

    The body then rises by g T^2 / 8: 8 to 25 cm. Heels leave the floor 0.15 s before the forefeet and come down after
    them. The jumps share the time up to 3 s before the end equally."""
    flight, gap = rng.uniform(0.25, 0.45), (duration - 3.0 - FIRST_JUMP) / JUMPS
    flights = [flight * rng.normal(1.0, 0.05) for _ in range(JUMPS)]
    motions: dict[Foot, Motion] = {}
    for foot in Foot:
        x, y = BALL[0], SIDE_SIGNS[foot] * HALF_WIDTH
        frames = Frames(x=x, y=y, z=0.0, pitch=0.0)
        for number, air in enumerate(flights):
            start, up = FIRST_JUMP + number * gap + 0.01 * rng.standard_normal(), 0.5 * GRAVITY * air
            leave, end = start + 0.04, start + air
            frames.add(start - 0.15, pitch=0.0)
            frames.add(start, x=x, y=y, z=0.0)
            frames.add(leave, z=(0.02 * up, up, -GRAVITY), pitch=-0.8)
            frames.add(0.5 * (leave + end), z=(GRAVITY * air**2 / 8.0, 0.0, -GRAVITY))
            frames.add(end - 0.08, pitch=-0.45)
            x, y = x + 0.03 * rng.standard_normal(), y + 0.03 * rng.standard_normal()
            frames.add(end, x=x, y=y, pitch=(-0.4, 1.0))
            land(frames, end, up, rng)
            frames.add(end + 0.09, pitch=0.0)
        motions[foot] = frames.motion(BALL)
    return posing(motions)
