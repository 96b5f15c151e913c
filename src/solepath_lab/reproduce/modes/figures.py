"""Panels of Gong et al. 2023: corners and deviations by method (figs. 15 and 16) and the rods of the legs (fig. 8)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from solepath.emulate.wearers.walker import Walker
from solepath.papers.walking_modes.limbs.limbs import LowerLimbs
from solepath.papers.walking_modes.settings import ModesSettings
from solepath.types import Foot

from ...emulated.laps import ACROSS, ALONG, straight
from ..tables import BoxPlots, DrawStyle, Panel, PictureTrack, Plot, Values
from ..walks import thin_out
from .walks import USUAL, corner_row, deviations

CORNER_POSITIONS = {"A": (0.0, 0.0), "B": (ALONG, 0.0), "C": (ALONG, ACROSS), "D": (0.0, ACROSS)}
"""Positions (x, y) of the corners, m; x along the first side, y to the left. The walk starts and ends at A."""
ROD_COUNT, ROD_DISTANCE = 9, 0.35
"""Number of pictures of the rods over one stride, and distance between two in the panel, m."""


def panels(results: Sequence[Values], methods: tuple[str, ...], seed: int) -> tuple[Panel, ...]:
    """Return the panels of an experiment."""
    closed_path = tuple(CORNER_POSITIONS[point] for point in "ABCDA")
    tracks, deviation_tracks = [PictureTrack("rectangle", closed_path, DrawStyle.TRUTH)], []
    for method in methods:
        off = {point: deviations(results, point, method) for point in CORNER_POSITIONS}
        places = [CORNER_POSITIONS[point] + of for point, of in off.items()]
        tracks.append(PictureTrack(method, thin_out(np.concatenate(places)), DrawStyle.DOTS))
        deviation_tracks.append(PictureTrack(method, thin_out(np.concatenate([*off.values()])), DrawStyle.DOTS))
    marks = tuple((point, x, y) for point, (x, y) in CORNER_POSITIONS.items())
    boxes = [
        BoxPlots(f"deviation in {axis} at C (fig. 16)", tuple(corner_row("C", m, axis) for m in methods), "m", 0.0)
        for axis in "xy"
    ]
    return (
        Plot("corners as estimated by the four methods (fig. 15a)", tracks, marks=marks),
        Plot("deviations at all corners (fig. 15b)", deviation_tracks, marks=(("", 0.0, 0.0),)),
        *boxes,
        rods(seed),
    )


def rods(seed: int) -> Plot:
    """Return the rods of both legs over one stride, from the left, by equation (7) from the sensors' attitudes.

    x is ahead and y is up. The pictures are `ROD_DISTANCE` apart, whatever the wearer walked between them."""
    calibration = USUAL.calibration(0)
    walker = Walker(straight(6.0, 1.1), USUAL.wearer(0), seed)
    limbs = calibration.limbs
    assert limbs is not None
    chain = LowerLimbs(ModesSettings(limbs=limbs, heading=0.0))
    stride = walker.plan.strides[Foot.LEFT][1]
    times = np.linspace(stride.foot_flat - 1.1, stride.foot_flat, ROD_COUNT).tolist()
    sides: dict[Foot, list[tuple[float, float]]] = {foot: [] for foot in Foot}
    for sample in USUAL.samples(walker, calibration, seed):
        while times and sample.t > times[0]:
            t = times.pop(0)
            ahead = ROD_DISTANCE * (ROD_COUNT - len(times) - 1)
            for foot, points in sides.items():
                rod = [(ahead + x, z) for x, _, z in chain.rods(foot, t)]
                points += [*rod, *rod[::-1], (float("nan"), float("nan"))]
        if sample.quat is not None:
            chain.add_attitude(sample.site, sample.t, sample.quat)
    tracks = [PictureTrack(f"{foot.value} leg", points[:-1]) for foot, points in sides.items()]
    return Plot("rods of the legs over one stride, from the left, y up (fig. 8)", tracks)
