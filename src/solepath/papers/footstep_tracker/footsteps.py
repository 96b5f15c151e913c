"""The feet calibrate each other (Liu et al. 2015, IEEE MASS, section IV.C, "Double feet based calibration").

"If the difference of displacement for each foot is more than one meter, we chose the mean of them as the displacement,
and restart the estimation process." The feet's ways are added up since the last restart; each step goes in the common
direction, which is the mean of what both feet turned (section IV.D). What the paper leaves open:

- Up to a restart the wearer is at the mean of both ways, too. A restart moves nothing then: what it ends is the
  difference, which would otherwise tell of ever older steps.
- Half a stride lies between the feet. The difference is the mean of those after the newest step of either foot, which
  does not swing to and fro with it.
- A foot that took no step while the other took `AWAY` is absent: it counts as if it had gone with the other.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import cos, hypot, pi, sin
from typing import ClassVar

from ...body.part import PartInput, PartOutput, Position, TrackPart
from ...events import StrideTaken
from ...foot.view import FootPose, FootView
from ...types import OTHER, Foot, Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO

FURTHEST_APART = 1.0
"""The paper's one metre."""
AWAY = 3

Flat = tuple[float, float]
"""Horizontal, m."""


@define
class FootWay:
    """What one foot went since the last restart."""

    heard: bool = False
    here: Flat = (0.0, 0.0)
    turned: float = 0.0
    """Sum of the turns of all of its steps, rad."""
    own: float = 0.0
    """The same without what it was given while it was absent, rad: the heading of its own track."""
    ahead: Flat = (0.0, 0.0)
    """What it went since the other foot's last step,"""
    ahead_turned: float = 0.0
    """and what it turned, rad,"""
    ahead_steps: int = 0
    """and in how many steps."""
    beside: Flat = (0.0, 0.0)
    """The left way less the right one after its newest step."""
    stood: Vec3 = ZERO
    """Where its own track had it then, world frame, m."""


@define
class Footsteps(TrackPart):
    """Where the wearer is by the steps of both feet; between them it goes on with half of what the track of either foot
    has moved since its last step. World frame, height 0. Latency: none beyond the steps' own."""

    needs_samples: ClassVar[bool] = True

    ways: dict[Foot, FootWay] = field(init=False)
    base: Flat = field(default=(0.0, 0.0), init=False)
    """Where the wearer was at the last restart."""
    idle: bool = field(default=False, init=False)
    """Both feet were heard."""
    restarts: int = field(default=0, init=False)
    """How often the feet were a metre apart."""

    def __attrs_post_init__(self) -> None:
        self.ways = {foot: FootWay() for foot in Foot}

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        way = self.ways[view.foot]
        if not way.heard and view.sample.acc is not None and view.sample.gyro is not None:
            way.heard = True
            self.idle = all([one.heard for one in self.ways.values()])
        return ()

    def receive(self, event: PartInput) -> Sequence[PartOutput]:
        if isinstance(event, StrideTaken):
            self.step(event)
        return ()

    def step(self, taken: StrideTaken) -> None:
        """One step of either foot."""
        this, other = self.ways[taken.foot], self.ways[OTHER[taken.foot]]
        this.heard = True
        turn = taken.heading_change
        heading = 0.5 * (this.turned + other.turned)
        x, y = _turned((taken.displacement[0], taken.displacement[1]), heading - this.own - 0.25 * turn)
        this.own += turn
        this.turned += turn
        if abs(this.turned - other.turned) > pi:  # it is known but for whole turns
            this.turned -= 2.0 * pi * round((this.turned - other.turned) / (2.0 * pi))
        this.here = (this.here[0] + x, this.here[1] + y)
        this.ahead = (this.ahead[0] + x, this.ahead[1] + y)
        this.ahead_turned += turn
        this.ahead_steps += 1
        this.stood = taken.position
        other.ahead, other.ahead_turned, other.ahead_steps = (0.0, 0.0), 0.0, 0
        if not other.heard or this.ahead_steps >= AWAY:
            other.here = (other.here[0] + this.ahead[0], other.here[1] + this.ahead[1])
            other.turned += this.ahead_turned
            this.ahead, this.ahead_turned = (0.0, 0.0), 0.0
        (lx, ly), (rx, ry) = (way.here for way in self.ways.values())
        this.beside = (lx - rx, ly - ry)
        (ax, ay), (bx, by) = this.beside, other.beside
        if 0.5 * hypot(ax + bx, ay + by) > FURTHEST_APART:
            self.base = self._mean()
            for way in self.ways.values():
                way.here = way.beside = (0.0, 0.0)
            self.restarts += 1

    def _mean(self) -> Flat:
        (lx, ly), (rx, ry) = (way.here for way in self.ways.values())
        x, y = self.base
        return (x + 0.5 * (lx + rx), y + 0.5 * (ly + ry))

    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        known = list(feet.values())
        if not known:
            return None
        x, y = self._mean()
        heading = 0.5 * sum([way.turned for way in self.ways.values()])
        present = [f for f in known if self.ways[f.foot].heard and self.ways[OTHER[f.foot]].ahead_steps < AWAY] or known
        k = 1.0 / len(present)
        for foot in present:
            way, (px, py, _) = self.ways[foot.foot], foot.position
            dx, dy = _turned((px - way.stood[0], py - way.stood[1]), heading - way.own)
            x, y = x + k * dx, y + k * dy
        covariances = [foot.covariance for foot in present]
        xx, xy, xz, yy, yz, zz = (sum([c[i] for c in covariances]) * k * k for i in range(6))
        t = max([foot.t for foot in known])
        return Position(t, (x, y, 0.0), (xx, xy, xz, yy, yz, zz))


def _turned(v: Flat, yaw: float) -> Flat:
    c, s = cos(yaw), sin(yaw)
    return (c * v[0] - s * v[1], s * v[0] + c * v[1])
