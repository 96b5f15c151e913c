"""Walking mode by how the feet turn: the curvature of the path, which is what a bend is.

Ours, in the place of the loaded regions of table 2 of Gong et al. 2023 (mode.py), which only `walking-modes-printed`
has: insoles do not agree on where the load moves in a bend. Under the heel it moves outward, under the metatarsal heads
inward (Turcato et al. 2015, J NeuroEng Rehabil 12:4), and from step to step by some millimetres anyway.

In a bend of radius r every foot turns from one stance to its next by the angle by which the path turns, so the angle
over the length of the stride is the curvature 1 / r. The angle comes from the foot's own gyroscope, over a second or
less. The limits are halfway between the paper's modes: r = 2 m, 4 m, and straight on.

Two further signs of a bend would add next to nothing, and are not used. The outer foot's strides are longer than the
inner foot's by the share w / r, with w = 0.14 m between the feet: 3 % at 4 m, where strides vary by as much by
themselves. A turn of 0.3 rad a stride, in contrast, is ten times what feet turn by chance. The load is no sign for the
reason above."""

from __future__ import annotations

from collections.abc import Sequence

from ...events import StrideTaken
from ...foot.view import FootView
from ...types import Phase, Quat, WalkingMode
from ...types.attrs import define, field
from ...types.vector import heading_turned

WIDE_RADIUS, TIGHT_RADIUS = 4.0, 2.0
"""Radii of the paper's bends, m (section 3.3)."""
LEAST_CURVATURE = 0.5 / WIDE_RADIUS
"""Curvature from which the path is a bend, 1/m: half that of the wide bend."""
LEAST_TIGHT_CURVATURE = 0.5 * (1.0 / WIDE_RADIUS + 1.0 / TIGHT_RADIUS)
"""Curvature from which the bend is tight, 1/m: halfway between the two."""


def mode_of_curvature(curvature: float) -> WalkingMode:
    """Return the mode of walking on a path of this curvature, 1/m, left positive."""
    if abs(curvature) < LEAST_CURVATURE:
        return WalkingMode.STRAIGHT
    if abs(curvature) < LEAST_TIGHT_CURVATURE:
        return WalkingMode.LEFT_WIDE if curvature > 0.0 else WalkingMode.RIGHT_WIDE
    return WalkingMode.LEFT_TIGHT if curvature > 0.0 else WalkingMode.RIGHT_TIGHT


@define
class StrideTurn:
    """The turn of one foot in its newest stride."""

    flat: Quat | None = field(default=None, init=False)
    """Attitude of the sensor while the foot was last stationary, navigation frame; None before."""
    newest: Quat | None = field(default=None, init=False)
    """Newest attitude of the sensor, navigation frame; None while the foot is stationary."""
    stride_turn: float | None = field(default=None, init=False)
    """Turn in the last complete stride, rad, left positive; None before the first."""

    def add_view(self, view: FootView, events: Sequence[object]) -> None:
        """Add a sample of the foot with its events."""
        if not view.levelled:
            return
        for event in events:
            if isinstance(event, StrideTaken):
                self.stride_turn = event.heading_change
        if view.phase is Phase.STATIONARY:
            self.flat, self.newest = view.attitude, None
        else:
            self.newest = view.attitude

    def turn(self) -> float | None:
        """Return the turn since the foot was last stationary or, if it is so now, that of its last stride, rad."""
        if self.newest is None:
            return self.stride_turn
        return None if self.flat is None else heading_turned(self.flat, self.newest)

    def reset(self) -> None:
        """Discard the attitudes, because the foot's clock restarts."""
        self.flat = self.newest = None
