"""Feet on a ramp: the axes of the ground under a foot, and the ground below a foot in swing.

A ramp is plane and level across the heading of the foot."""

from __future__ import annotations

from math import atan, cos, sin

import numpy as np

from ..routes.path import Pose
from .curves import Array, EndState, constant


def axes(pose: Pose) -> tuple[Array, Array]:
    """Return the directions ahead along the ground and perpendicular to it, world frame, (3,) each."""
    c, s, slope = cos(pose.heading), sin(pose.heading), atan(pose.grade)
    return np.array([c * cos(slope), s * cos(slope), sin(slope)]), np.array(
        [-c * sin(slope), -s * sin(slope), cos(slope)]
    )


def steeper(pitch: EndState, pose: Pose) -> EndState:
    """Return a pitch relative to the ground as one relative to the horizontal, rad."""
    return pitch[0] + atan(pose.grade), pitch[1], pitch[2]


def leaning(curves: list[Array], pose: Pose, radius: float) -> list[Array]:
    """Return the curves of a foot that rolls on a ramp from those whose pitch is relative to the ground.

    FootMotion moves the centre of an arc of `radius` m horizontally by radius times pitch; on a ramp it moves along the
    ramp, by radius times the pitch relative to the ground. The curves of the centre contain the difference."""
    if not pose.grade:
        return curves
    pitch, ahead = curves[3], axes(pose)[0]
    steep = pitch + constant(atan(pose.grade))
    level = (cos(pose.heading), sin(pose.heading), 0.0)
    centre = [curves[i] + radius * (level[i] * steep - float(ahead[i]) * pitch) for i in range(3)]
    return [*centre, steep, *curves[4:]]


def ramp_height(start: Pose, end: Pose, x: Array, y: Array, ahead: Array) -> Array:
    """Return the height of the ground, m, `ahead` m before points along the foot; it is bent at most once.

    It is the lower of the slopes at both ends of the stride when the ground is bent upwards, and else the higher."""
    slopes = []
    for pose in (start, end):
        along = (x - pose.x) * cos(pose.heading) + (y - pose.y) * sin(pose.heading) + ahead
        slopes.append(pose.z + pose.grade * along)
    run = (end.x - start.x) * cos(end.heading)
    run += (end.y - start.y) * sin(end.heading)
    is_crest = (start.grade - end.grade) * run > 0.0
    return np.asarray(np.minimum(*slopes) if is_crest else np.maximum(*slopes))
