"""Curves of figures 7 and 9 of Bebek et al. 2010: velocities in one stance, and the filter's bias over a walk."""

from __future__ import annotations

from math import hypot

import numpy as np

from solepath.emulate.walk import SampledWalk
from solepath.papers.pressure_contour.contour import PAPER_LEVELS, Contours, ContourSettings
from solepath.types import Foot, Layout
from solepath.types.vector import GRAVITY
from solepath.validate.alignment import Floats

from ...measures.consistency import yaws
from ..tables import DrawStyle, PictureTrack, Plot
from ..walks import thin_out

STANCE_SHOWN = 20
"""Number of the stance after the halt that figure 7 shows."""


def stance_curves(walked: SampledWalk, layout: Layout, foot: Foot, after: float) -> tuple[Plot, ...]:
    """Return figure 7, the curves over one stance: time, ms, since foot-flat, and velocities; nothing without cells.

    They are the forward velocity v_x of the heel, mm/s, by the emulator in place of the optical tracker, the pitch rate
    of the sensor, mrad/s, and the speeds of the contours, mm/s: those of shares, which are ours, and those of 20 to 70
    kPa, which are the paper's v_cntr, if the cells have a known scale."""
    strides = [one for one in walked.truth.strides(foot) if one.t_start > after]
    if len(strides) < 2:
        return ()
    k = min(STANCE_SHOWN, len(strides) - 2)
    landing, leaving = strides[k], strides[k + 1]
    both = {"ours": Contours(), "20 to 70 kPa": Contours(ContourSettings(pascals=PAPER_LEVELS))}
    contours = {name: one for name, one in both.items() if one.set_layout(layout) is None}
    if not contours:
        return ()
    samples = [one for one in walked.samples if landing.t_heel_strike <= one.t <= leaving.t_toe_off]
    t = np.array([one.t for one in samples])
    kinematics = walked.truth.pose(foot, t)
    heading = yaws(kinematics.attitude)
    forward = kinematics.velocity[:, 0] * np.cos(heading) + kinematics.velocity[:, 1] * np.sin(heading)
    since = (1e3 * (t - landing.t_end)).tolist()
    speeds: dict[str, list[tuple[float, float]]] = {name: [] for name in contours}
    for moment, sample in zip(since, samples, strict=True):
        if sample.pressure is None:
            continue
        for name, one in contours.items():
            velocity = one.velocity(sample.t, [sample.pressure[i] for i in one.cells])
            if velocity is not None:
                speeds[name].append((moment, 1e3 * hypot(*velocity)))
    rates = [(moment, 1e3 * one.gyro[1]) for moment, one in zip(since, samples, strict=True) if one.gyro is not None]
    true_velocity = tuple(zip(since, (1e3 * forward).tolist(), strict=True))
    tracks = (
        PictureTrack("v_x of the heel, true, mm/s", true_velocity, DrawStyle.TRUTH),
        PictureTrack("pitch rate by the gyroscope, mrad/s", rates),
        *[PictureTrack(f"speed of the contours, {name}, mm/s", points) for name, points in speeds.items()],
    )
    return (Plot("a stance (fig. 7)", tracks, "ms since foot-flat", "mm/s or mrad/s", (-50.0, 50.0)),)


def bias_curves(t: Floats, bias: Floats) -> tuple[Plot, ...]:
    """Return figure 9: time, min, and the bias (N, 3) of the accelerometer, mg, from times, s, and m/s^2."""
    points = [np.stack([(t - t[0]) / 60.0, bias[:, k] / GRAVITY * 1e3], axis=1) for k in range(3)]
    tracks = [PictureTrack(f"bias of {axis}", thin_out(of, 600)) for axis, of in zip("xyz", points, strict=True)]
    return (Plot("bias filter (fig. 9)", tracks, "min", "mg"),)
