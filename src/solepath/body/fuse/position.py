"""Position of the wearer: the mean of both feet.

A foot without samples would hold the mean back by half of the distance walked, so an absent foot is left out. The mean
then continues with the other foot, without a jump, although the two tracks may have drifted apart. The displacement and
turn of an absent foot are not known when it returns. It stays out until each foot has taken `STRIDES_TO_ALIGN` strides,
and its track is then rotated and moved beside the other one. A foot whose first sample comes while the other foot walks
is aligned in the same way. Without absence, no track is rotated or moved."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import atan2, cos, fsum, hypot, sin
from typing import TYPE_CHECKING, ClassVar, Final

from ...events import SampleGap
from ...foot.view import FootPose, FootView
from ...foot.world import Covariance3
from ...types import Foot, Site, Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO, sub, turned
from ..aiding.walked_path import PlanStart
from ..part import PartInput, PartOutput, Position, TrackPart

if TYPE_CHECKING:
    from ...floorplan.plan import Start

LEFT: Final = Foot.LEFT
"""The left foot, looked up once: access to an enum member costs as much as five multiplications."""

ABSENCE_TIME = 1.0
"""Time without samples, s, after which a foot is absent while the other foot has samples."""
STRIDES_TO_ALIGN = 3
"""Number of strides of each foot by which a returned foot is aligned with the other foot."""
MIN_ALIGNMENT_DISTANCE = 1.0
"""Least displacement over these strides, m."""


@define
class PlacedTrack:
    """The placement of one foot's own track in the common frame of both feet: a rotation, then an offset."""

    t: float | None = None
    """Time of the newest sample with acc and gyro, s."""
    started_at: float | None = None
    """Time of the first sample, s."""
    absent_for: float = 0.0
    """Time for which the other foot has given samples since `t`, s."""
    newest_place: Vec3 = ZERO
    """Position at `t` on the foot's own track, m."""
    turn: float = 0.0
    """Rotation of the track into the common frame, rad, counter-clockwise positive."""
    offset: Vec3 = ZERO
    """Offset of the track after the rotation, m, common frame."""
    variance: tuple[float, float] | None = None
    """Variances of the position at the newest stride, horizontal (per axis) and vertical, m^2; None before any."""
    added_variance: tuple[float, float] = (0.0, 0.0)
    """Variances, horizontal and vertical, that the alignment with the other foot adds to `variance`, m^2."""
    separation: Vec3 | None = None
    """Left foot minus right foot after this foot's newest stride, m.

    In the mean of both feet's values, the displacement of a single stride cancels out."""
    unplaced: bool = False
    """Flag: the foot has returned, and its track is not aligned with the other foot's yet."""

    @property
    def absent(self) -> bool:
        """Flag: the foot had no samples for `ABSENCE_TIME` while the other foot had."""
        return self.absent_for >= ABSENCE_TIME

    def place(self, own: Vec3) -> Vec3:
        """Return the position `own` of the foot's own track in the common frame, m."""
        x, y, z = own
        if self.turn:
            c, s = cos(self.turn), sin(self.turn)
            x, y = c * x - s * y, s * x + c * y
        dx, dy, dz = self.offset
        return (x + dx, y + dy, z + dz)

    def turned_covariance(self, own: Covariance3) -> tuple[float, float, float]:
        """Return the horizontal covariance `own` of the foot's own track in the common frame: xx, xy, yy, m^2."""
        xx, xy, _, yy, _, _ = own
        c, s = cos(self.turn), sin(self.turn)
        cc, ss, cs = c * c, s * s, c * s
        return (cc * xx - 2.0 * cs * xy + ss * yy, cs * (xx - yy) + (cc - ss) * xy, ss * xx + 2.0 * cs * xy + cc * yy)

    def correct(self, pivot: Vec3, yaw: float, dx: float, dy: float) -> None:
        """Rotate the track by `yaw`, rad, about the place `pivot` of the own track, m, and move it by (dx, dy), m.

        The move is in the common frame."""
        x, y, _ = pivot
        ox, oy, oz = self.offset
        c, s = cos(self.turn), sin(self.turn)
        before_x, before_y = c * x - s * y + ox, s * x + c * y + oy
        self.turn += yaw
        c, s = cos(self.turn), sin(self.turn)
        self.offset = (ox + before_x + dx - (c * x - s * y + ox), oy + before_y + dy - (s * x + c * y + oy), oz)

    def to_own(self, place: Vec3) -> Vec3:
        """Return the position `place` of the common frame on the foot's own track, m."""
        x, y, z = place
        dx, dy, dz = self.offset
        c, s = cos(-self.turn), sin(-self.turn)
        return (c * (x - dx) - s * (y - dy), s * (x - dx) + c * (y - dy), z - dz)


@define
class MeanOfFeet(TrackPart):
    """The mean position of the feet that have samples, each in the world frame of its own first heading.

    After an alignment both feet have the same error, so the covariance is that of the foot that was not absent."""

    needs_samples: ClassVar[bool] = True

    left: PlacedTrack = field(factory=PlacedTrack, init=False)
    right: PlacedTrack = field(factory=PlacedTrack, init=False)
    placed_last: Foot | None = field(default=None, init=False)
    """The foot that was last aligned with the other foot; None before any."""
    plan_start: PlanStart | None = field(default=None, init=False)
    """Wearer's first place on the floor plan; None if it or the first heading is not known there."""
    return_strides: list[tuple[bool, Vec3, Vec3]] = field(factory=list, init=False)
    """Newest strides of both feet while a foot is unplaced.

    Each has a flag for the left foot, the unplaced foot's position on its own track, and the other foot's position in
    the common frame, m."""

    def set_start(self, start: Start) -> None:
        """Take the wearer's first place on the floor plan, in whose frame a person may report positions."""
        if start.heading is not None and start.place is not None:
            self.plan_start = PlanStart(start.place, start.heading, start.spread)

    def middle(self, shares: tuple[float, float]) -> tuple[float, float]:
        """Return the newest place between both feet, m, common frame; each foot counts with its share."""
        (lx, ly, _), (rx, ry, _) = [track.place(track.newest_place) for track in (self.left, self.right)]
        left, right = shares
        return (left * lx + right * rx, left * ly + right * ry)

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        """Add one sample of a foot and detect an absent or returned foot; returns no output."""
        if view is not None:
            self.add_view(view)
        return ()

    def add_view(self, view: FootView) -> None:
        """Add one sample of a foot and detect an absent or returned foot."""
        t, is_left = view.t, view.foot is LEFT
        if view.sample.acc is None or view.sample.gyro is None:
            return
        this, other = (self.left, self.right) if is_left else (self.right, self.left)
        has_returned = False
        if this.t is None:
            this.started_at = t
            # at the start the feet stand side by side, but not when a foot's first sample comes during a walk
            has_returned = (
                other.started_at is not None and t - other.started_at >= ABSENCE_TIME and other.variance is not None
            )
        elif t - this.t >= ABSENCE_TIME:
            has_returned = this.absent
        elif t > this.t and other.t is not None:
            other.absent_for += t - this.t
        newest_place = view.position
        if view.north is not None:
            (c, s), (x, y, z) = view.north, newest_place
            newest_place = (c * x - s * y, s * x + c * y, z)
        this.t, this.absent_for, this.newest_place = t, 0.0, newest_place
        if has_returned:
            self._start_return(this, other)
        if view.after is not None and (covariance := view.after.covariance) is not None:  # a stride has ended
            xx, _, _, yy, _, zz = covariance
            this.variance = (0.5 * (xx + yy), zz)
            if other.t is not None and other.absent_for < ABSENCE_TIME:
                self._place_returned(is_left, this)

    def reset(self, site: Site) -> None:
        """Reset the times of a foot, so that its next sample counts as its first."""
        if site.foot is not None:
            placed = self._track(site.foot)
            placed.t, placed.started_at, placed.absent_for = None, None, 0.0

    def is_unseen(self, gap: SampleGap) -> bool:
        """Return whether the other foot had no samples either in the first half, or the first second, of a gap."""
        other_t = (self.right if gap.site.foot is LEFT else self.left).t
        return other_t is None or other_t < gap.t + min(0.5 * gap.duration, ABSENCE_TIME)

    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        """Return the position of the wearer; None before any sample."""
        poses = list(feet.values())
        if not poses:
            return None
        poses_used = self._select_poses(poses)
        k = 1.0 / len(poses_used)
        places = [self._track(pose.foot).place(pose.position) for pose in poses_used]
        x, y, z = (fsum([place[axis] for place in places]) * k for axis in range(3))
        if len(poses_used) == 1:
            dx, dy, dz = self._offset_to_mean(poses_used[0].foot)
            x, y, z = x + dx, y + dy, z + dz
        elif self.placed_last is not None:
            poses_used = [pose for pose in poses_used if pose.foot is not self.placed_last]
            k = 1.0 / len(poses_used)
        covariances = [pose.covariance for pose in poses_used]
        xx, xy, xz, yy, yz, zz = (fsum([c[i] for c in covariances]) * k * k for i in range(6))
        if len(poses_used) == 1:
            across, up = self._track(poses_used[0].foot).added_variance
            xx, yy, zz = xx + across, yy + across, zz + up
        t = max([pose.t for pose in poses])
        return Position(t, (x, y, z), (xx, xy, xz, yy, yz, zz))

    def _select_poses(self, poses: list[FootPose]) -> list[FootPose]:
        """Return the poses of the feet that have moved, are not absent and are placed; at least one pose."""
        moving = [pose for pose in poses if pose.moved_at is not None]
        if len(moving) < 2:
            return moving or poses
        newest = max([pose.moved_at for pose in moving if pose.moved_at is not None])
        # check the poses' times too, because samples of one foot may be fed long after the other's of the same time
        present = [
            pose
            for pose in moving
            if not (
                self._track(pose.foot).absent and pose.moved_at is not None and newest - pose.moved_at >= ABSENCE_TIME
            )
        ]
        return [pose for pose in present if not self._track(pose.foot).unplaced] or present or moving

    def _track(self, foot: Foot) -> PlacedTrack:
        return self.left if foot is LEFT else self.right

    def _offset_to_mean(self, foot: Foot) -> Vec3:
        """Return the offset from this foot to the mean of both feet at the newest strides, m; 0 if unknown."""
        one, two = self.left.separation, self.right.separation
        if one is None or two is None:
            return ZERO
        k = -0.25 if foot is LEFT else 0.25
        return (k * (one[0] + two[0]), k * (one[1] + two[1]), k * (one[2] + two[2]))

    def _start_return(self, this: PlacedTrack, other: PlacedTrack) -> None:
        """Mark the foot as unplaced at the other foot's position, in case the other foot becomes absent."""
        lx, ly, lz = self._offset_to_mean(LEFT if other is self.left else Foot.RIGHT)
        x, y, z = other.offset
        other.offset = (x + lx, y + ly, z + lz)
        self.left.separation = self.right.separation = None
        this.offset = sub(other.place(other.newest_place), turned(this.newest_place, this.turn))
        self._set_added_variance(this, other)
        this.unplaced, other.unplaced = True, False
        self.return_strides = []

    def _place_returned(self, is_left: bool, this: PlacedTrack) -> None:
        """Add a stride while both feet have samples, and align the unplaced foot when there are enough strides."""
        left, right = self.left, self.right
        if not left.unplaced and not right.unplaced:
            this.separation = sub(left.place(left.newest_place), right.place(right.newest_place))
            return
        unplaced_track, other = (left, right) if left.unplaced else (right, left)
        self.return_strides = [
            *self.return_strides[-2 * STRIDES_TO_ALIGN - 1 :],
            (is_left, unplaced_track.newest_place, other.place(other.newest_place)),
        ]
        lefts = [(own, others) for was_left, own, others in self.return_strides if was_left]
        rights = [(own, others) for was_left, own, others in self.return_strides if not was_left]
        if len(lefts) <= STRIDES_TO_ALIGN or len(rights) <= STRIDES_TO_ALIGN:
            return
        own_x, own_y, _ = _mean_displacement(lefts[0][0], lefts[-1][0], rights[0][0], rights[-1][0])
        x, y, _ = _mean_displacement(lefts[0][1], lefts[-1][1], rights[0][1], rights[-1][1])
        if min(hypot(own_x, own_y), hypot(x, y)) < MIN_ALIGNMENT_DISTANCE:
            return
        unplaced_track.turn = atan2(own_x * y - own_y * x, own_x * x + own_y * y)
        mean_place = _mean([turned(own, unplaced_track.turn) for own, _ in (*lefts, *rights)])
        unplaced_track.offset = sub(_mean([others for _, others in (*lefts, *rights)]), mean_place)
        self._set_added_variance(unplaced_track, other)
        unplaced_track.unplaced = False
        self.placed_last = LEFT if unplaced_track is left else Foot.RIGHT
        self.return_strides = []

    @staticmethod
    def _set_added_variance(this: PlacedTrack, other: PlacedTrack) -> None:
        """Set the foot's added variance so that its position is as uncertain as the other foot's."""
        across, up = other.variance or (0.0, 0.0)
        own_across, own_up = this.variance or (0.0, 0.0)
        more, higher = other.added_variance
        this.added_variance = (max(0.0, across + more - own_across), max(0.0, up + higher - own_up))


def _mean_displacement(start: Vec3, end: Vec3, other_start: Vec3, other_end: Vec3) -> Vec3:
    """Return the mean of two displacements, m."""
    return _mean([sub(end, start), sub(other_end, other_start)])


def _mean(vectors: list[Vec3]) -> Vec3:
    k = 1.0 / len(vectors)
    x, y, z = (fsum([v[axis] for v in vectors]) * k for axis in range(3))
    return (x, y, z)
