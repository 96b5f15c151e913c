"""Track of the wearer by the strides of both feet (Liu et al. 2015, IEEE MASS, section IV.C).

"Double feet based calibration": "If the difference of displacement for each foot is more than one meter, we chose the
mean of them as the displacement, and restart the estimation process." Each foot's displacement is the sum of its
strides since the last such restart. Strides are turned into the common heading, the mean of both feet's headings
(section IV.D). The paper leaves these points open:

- Where the wearer is while the feet agree. As printed (`FootstepsSettings.as_printed`) it is the displacement of one
  foot, here the right one, until the feet differ by more than 1 m. The first restart puts both feet at their mean. From
  then on the next stride of either foot, if it is longer than 1 m, is a difference of more than 1 m at once, so the
  rule restarts at every stride and the wearer is at the mean of both feet. Ours starts with that.
- The wearer is at the mean of both paths at all times, so a restart does not move the wearer. It sets the difference
  to zero, so that old strides no longer count in it.
- After a stride the foot is half a stride ahead of the other, so the difference of the paths alternates. Therefore the
  mean of the difference after the newest left stride and that after the newest right stride is compared with 1 m.
- A foot that took no stride while the other took `ABSENT_STRIDES` is absent: it counts as if it had moved with the
  other. If a later stride of it covers that time after all, as a slow turn on the spot may look like one stride of the
  pivot foot, the stride replaces what was assumed; else the wearer would turn by half of it once more.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import cos, fsum, hypot, pi, sin
from typing import ClassVar

from ...body.part import PartInput, PartOutput, Position, TrackPart
from ...events import StrideTaken
from ...foot.view import FootPose, FootView
from ...types import OTHER, Foot, Site, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import ZERO

PRINTED_FOOT = Foot.RIGHT
"""Foot whose displacement is the wearer's as printed, while the feet agree."""
LARGEST_DISTANCE = 1.0
"""Distance between the feet's paths that causes a restart, m: the paper's one metre."""
ABSENT_STRIDES = 3
"""Number of strides of the other foot after which a foot without a stride is absent."""

Horizontal = tuple[float, float]
"""Horizontal vector, m."""


@define
class FootPath:
    """The path of one foot since the last restart."""

    has_samples: bool = False
    """Flag: samples of the foot have come."""
    displacement: Horizontal = (0.0, 0.0)
    """Displacement since the last restart, m."""
    heading: float = 0.0
    """Sum of the turns of the foot's strides and of those assumed while it is absent, rad, left positive."""
    own_heading: float = 0.0
    """Heading of the foot's own track, rad: the sum of the turns that were measured on this foot."""
    lead_displacement: Horizontal = (0.0, 0.0)
    """Displacement since the other foot's last stride, m."""
    lead_turn: float = 0.0
    """Turn since the other foot's last stride, rad."""
    lead_strides: int = 0
    """Number of strides since the other foot's last stride."""
    difference: Horizontal = (0.0, 0.0)
    """Left foot's displacement minus the right foot's after the newest stride of this foot, m."""
    assumed_displacement: Horizontal = (0.0, 0.0)
    """Part of `displacement` that was assumed since the newest stride of this foot, m."""
    assumed_turn: float = 0.0
    """Part of `heading` that was assumed since then, rad."""
    t: float | None = None
    """End of the newest stride of this foot, s; None before any."""
    track_position: Vec3 = ZERO
    """Position of this foot by its own track after its newest stride, world frame, m."""

    def assume(self, displacement: Horizontal, turn: float) -> None:
        """Move and turn an absent foot as the other did."""
        dx, dy = displacement
        self.displacement = (self.displacement[0] + dx, self.displacement[1] + dy)
        self.assumed_displacement = (self.assumed_displacement[0] + dx, self.assumed_displacement[1] + dy)
        self.heading += turn
        self.assumed_turn += turn

    def replace_assumed(self, taken: StrideTaken) -> None:
        """Take back what was assumed since the newest stride, if the stride that was `taken` starts with its end."""
        if self.t is not None and taken.t_start <= self.t:
            dx, dy = self.assumed_displacement
            self.displacement = (self.displacement[0] - dx, self.displacement[1] - dy)
            self.heading -= self.assumed_turn
        self.assumed_displacement, self.assumed_turn, self.t = (0.0, 0.0), 0.0, taken.t


@frozen
class FootstepsSettings:
    """Settings of `Footsteps`."""

    as_printed: bool = False
    """Flag: the wearer is where one foot is until the one-metre rule chooses the mean of both."""


@define
class Footsteps(TrackPart):
    """Tracks the wearer by the strides of both feet.

    Between strides the position moves by the mean of what the tracks of the feet that are not absent have moved since
    their last strides. World frame, height 0. Latency: that of the strides."""

    needs_samples: ClassVar[bool] = True

    settings: FootstepsSettings = FootstepsSettings()
    paths: dict[Foot, FootPath] = field(init=False)
    restart_position: Horizontal = field(default=(0.0, 0.0), init=False)
    """Position of the wearer at the last restart, m."""
    idle: bool = field(default=False, init=False)
    """Flag: samples of both feet have come, after which `feed` does nothing (`TrackPart`)."""
    restarts: int = field(default=0, init=False)
    """Number of restarts."""

    def __attrs_post_init__(self) -> None:
        self.paths = {foot: FootPath() for foot in Foot}

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        if view is not None and view.sample.acc is not None and view.sample.gyro is not None:
            self.paths[view.foot].has_samples = True
            self.idle = all([one.has_samples for one in self.paths.values()])
        for event in events:
            if isinstance(event, StrideTaken):
                self.add_stride(event)
        return ()

    def reset(self, site: Site) -> None:
        if site.foot is not None:  # by another clock or of another device, strides do not say what they replace
            path = self.paths[site.foot]
            path.assumed_displacement, path.assumed_turn, path.t = (0.0, 0.0), 0.0, None

    def add_stride(self, taken: StrideTaken) -> None:
        """Add one stride of either foot."""
        this, other = self.paths[taken.foot], self.paths[OTHER[taken.foot]]
        this.has_samples = True
        this.replace_assumed(taken)
        turn = taken.heading_change
        heading = 0.5 * (this.heading + other.heading)
        # the chord lies halfway through the turn: half of `turn` by the own heading, a quarter by the mean of both feet
        x, y = _rotate((taken.displacement[0], taken.displacement[1]), heading - this.own_heading - 0.25 * turn)
        this.own_heading += turn
        this.heading += turn
        if abs(this.heading - other.heading) > pi:  # the feet may have counted a full circle differently
            this.heading -= 2.0 * pi * round((this.heading - other.heading) / (2.0 * pi))
        this.displacement = (this.displacement[0] + x, this.displacement[1] + y)
        this.lead_displacement = (this.lead_displacement[0] + x, this.lead_displacement[1] + y)
        this.lead_turn += turn
        this.lead_strides += 1
        this.track_position = taken.position
        other.lead_displacement, other.lead_turn, other.lead_strides = (0.0, 0.0), 0.0, 0
        if not other.has_samples or this.lead_strides >= ABSENT_STRIDES:
            other.assume(this.lead_displacement, this.lead_turn)
            this.lead_displacement, this.lead_turn = (0.0, 0.0), 0.0
        (lx, ly), (rx, ry) = (path.displacement for path in self.paths.values())
        this.difference = (lx - rx, ly - ry)
        (ax, ay), (bx, by) = this.difference, other.difference
        distance = hypot(ax, ay) if self.settings.as_printed else 0.5 * hypot(ax + bx, ay + by)
        if distance > LARGEST_DISTANCE:
            self.restart_position = self._mean()
            for path in self.paths.values():
                path.displacement = path.difference = (0.0, 0.0)
            self.restarts += 1

    def _mean(self) -> Horizontal:
        (lx, ly), (rx, ry) = (path.displacement for path in self.paths.values())
        x, y = self.restart_position
        return (x + 0.5 * (lx + rx), y + 0.5 * (ly + ry))

    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        poses = list(feet.values())
        if not poses:
            return None
        t = max([foot.t for foot in poses])
        x, y = self._mean()
        if self.settings.as_printed:
            poses = [pose for pose in poses if pose.foot is PRINTED_FOOT] or poses
            (dx, dy), (x0, y0) = self.paths[poses[0].foot].displacement, self.restart_position
            x, y = x0 + dx, y0 + dy
        heading = 0.5 * fsum([path.heading for path in self.paths.values()])
        present = [
            f
            for f in poses
            if self.paths[f.foot].has_samples and self.paths[OTHER[f.foot]].lead_strides < ABSENT_STRIDES
        ] or poses
        k = 1.0 / len(present)
        for foot in present:
            path, (px, py, _) = self.paths[foot.foot], foot.position
            dx, dy = _rotate((px - path.track_position[0], py - path.track_position[1]), heading - path.own_heading)
            x, y = x + k * dx, y + k * dy
        covariances = [foot.covariance for foot in present]
        xx, xy, xz, yy, yz, zz = (fsum([c[i] for c in covariances]) * k * k for i in range(6))
        return Position(t, (x, y, 0.0), (xx, xy, xz, yy, yz, zz))


def _rotate(v: Horizontal, yaw: float) -> Horizontal:
    c, s = cos(yaw), sin(yaw)
    return (c * v[0] - s * v[1], s * v[0] + c * v[1])
