"""Track of the wearer by the strides of both feet, as printed (Liu et al. 2015, IEEE MASS, section IV.C).

"Double feet based calibration": "If the difference of displacement for each foot is more than one meter, we chose the
mean of them as the displacement, and restart the estimation process." Each foot's displacement is the sum of its
strides since the last such restart. Strides are turned into the common heading, the mean of both feet's headings
(section IV.D). Our recipe has the fusion of `recipes.DEFAULT` (body/fuse/both_feet.py) in the place of the rule. The
paper leaves these points open:

- Where the wearer is while the feet agree. Here it is the displacement of one foot, the right one if it has samples.
  The first restart puts both feet at their mean. From then on the next stride of either foot, if it is longer than 1 m,
  is a difference of more than 1 m at once, so the rule restarts at every stride and the wearer is at the mean of both.
- A foot that took no stride while the other took `ABSENT_STRIDES` is absent: it moves and turns with the other."""

from __future__ import annotations

from collections.abc import Mapping
from math import fsum, hypot, pi
from typing import ClassVar

from ...body.part import Inputs, Outputs, Position, TrackPart
from ...events import StrideTaken
from ...foot.view import FootPose, FootView
from ...types import OTHER, Foot, PerFoot, Vec2, Vec3, per_foot
from ...types.attrs import define, state, stateful
from ...types.vector import ZERO, sub, turned

PRINTED_FOOT = Foot.RIGHT
"""Foot whose displacement is the wearer's while the feet agree."""
LARGEST_DISTANCE = 1.0
"""Distance between the feet's displacements that causes a restart, m: the paper's one metre."""
ABSENT_STRIDES = 3
"""Number of strides of the other foot after which a foot without a stride is absent; chosen by hand."""


@define
class FootPath:
    """The path of one foot since the last restart."""

    strides_alone: int = ABSENT_STRIDES
    """Number of strides of the other foot since the newest one of this foot; `ABSENT_STRIDES` before any sample."""
    displacement: Vec2 = (0.0, 0.0)
    """Displacement since the last restart, m."""
    heading: float = 0.0
    """Sum of the turns of the foot's strides and of those of the other while it is absent, rad, left positive."""
    own_heading: float = 0.0
    """Heading of the foot's own track, rad: the sum of the turns that were measured on this foot."""
    track_position: Vec3 = ZERO
    """Position of this foot by its own track after its newest stride, world frame, m."""

    @property
    def is_absent(self) -> bool:
        """Flag: the foot moves with the other."""
        return self.strides_alone >= ABSENT_STRIDES


@stateful
class Footsteps(TrackPart):
    """Tracks the wearer by the strides of both feet, and between strides by what the wearer's foot has moved since.

    World frame, height 0. Latency: that of the strides."""

    needs_samples: ClassVar[bool] = True

    paths: PerFoot[FootPath] = state(factory=lambda: per_foot(FootPath))
    restart_position: Vec2 = (0.0, 0.0)
    """Position of the wearer at the last restart, m."""
    idle: bool = False
    """Flag: samples of both feet have come, after which `feed` needs strides only (`TrackPart`)."""
    restarts: int = 0
    """Number of restarts."""

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        if not self.idle and view is not None and view.sample.acc is not None and view.sample.gyro is not None:
            if self.paths[view.foot].is_absent:
                self.paths[view.foot].strides_alone = 0
            self.idle = not any([path.is_absent for path in self.paths.values()])
        for event in events:
            if isinstance(event, StrideTaken):
                self.add_stride(event)
        return ()

    def add_stride(self, taken: StrideTaken) -> None:
        """Add one stride of either foot."""
        this, other = self.paths[taken.foot], self.paths[OTHER[taken.foot]]
        turn = taken.heading_change
        heading = 0.5 * (this.heading + other.heading)
        # the chord lies halfway through the turn: half of `turn` by the own heading, a quarter by the mean of both feet
        x, y, _ = turned(taken.displacement, heading - this.own_heading - 0.25 * turn)
        this.own_heading += turn
        this.heading += turn
        if abs(this.heading - other.heading) > pi:  # the feet may have counted a full circle differently
            this.heading -= 2.0 * pi * round((this.heading - other.heading) / (2.0 * pi))
        this.displacement = (this.displacement[0] + x, this.displacement[1] + y)
        this.track_position = taken.position
        this.strides_alone, other.strides_alone = 0, min(other.strides_alone + 1, ABSENT_STRIDES)
        if other.is_absent:
            other.displacement, other.heading = this.displacement, this.heading
        (lx, ly), (rx, ry) = (path.displacement for path in self.paths.values())
        if hypot(lx - rx, ly - ry) > LARGEST_DISTANCE:
            x, y = self.restart_position
            self.restart_position = (x + 0.5 * (lx + rx), y + 0.5 * (ly + ry))
            for path in self.paths.values():
                path.displacement = (0.0, 0.0)
            self.restarts += 1

    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        if not feet:
            return None
        here = [foot for foot in (PRINTED_FOOT, OTHER[PRINTED_FOOT]) if foot in feet]
        foot = next((foot for foot in here if not self.paths[foot].is_absent), here[0])
        path, pose = self.paths[foot], feet[foot]
        (x, y), (dx, dy) = self.restart_position, path.displacement
        heading = 0.5 * fsum([one.heading for one in self.paths.values()])
        mx, my, _ = turned(sub(pose.position, path.track_position), heading - path.own_heading)
        return Position(pose.t, (x + dx + mx, y + dy + my, 0.0), pose.covariance)
