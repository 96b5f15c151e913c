"""Position of the wearer: the mean of both feet.

A foot without samples would hold the mean back by half of the distance walked, so an absent foot is left out. The mean
then continues with the other foot, without a jump, although the two tracks may have drifted apart. The displacement and
turn of an absent foot are not known when it returns. It stays out until each foot has taken `STRIDES_TO_ALIGN` strides,
and its track is then rotated and moved beside the other one. A foot whose first sample comes while the other foot walks
is aligned in the same way. Without absence, no track is rotated or moved.

Horizontal vectors are complex numbers x + iy, m, where they are not part of a state or an event."""

from __future__ import annotations

from cmath import phase, rect
from collections.abc import Mapping
from math import cos, fsum, hypot, sin
from typing import Final

from ...events import DefectFound, Flaw, FootFlat, StrideTaken
from ...foot.view import LONGEST_STRIDE, FootPose, FootView
from ...foot.world import Covariance2, Covariance3, turned_covariance
from ...types import OTHER, Foot, PerFoot, Site, Vec2, Vec3, per_foot
from ...types.attrs import define, field, frozen
from ...types.vector import ZERO, add, scaled, sub, turned
from ..part import Inputs, Outputs, Position, TrackPart

ABSENCE_TIME = 1.0
"""Time without samples, s, after which a foot is absent while the other foot has samples."""
STRIDES_TO_ALIGN = 3
"""Number of strides of each foot by which a returned foot is aligned with the other foot."""
MIN_ALIGNMENT_DISTANCE = 1.0
"""Least displacement over these strides, m."""
REACH = 1.5
"""Largest distance between the feet, m."""
LEAST_STRIDE = 0.5
"""Length of the shortest stride that no wearer takes with one foot alone, again and again, m."""
LARGEST_LANDING_ERROR = 3.0
"""Error of the integrated velocity of a foot that comes to stand above which its sensor is at fault, m/s.

In recordings of 500 feet it is up to 2.1, and 2.4 where the specific force clips."""
EXPLAINED: Final = frozenset((Flaw.GAP, Flaw.RANGE))
"""Flaws of a stride that explain an error of its velocity without a fault of the sensor."""
UNUSUAL = 2.0
"""Ratio to its usual error above which that is so of a sensor that always errs much: one of 10 Hz, or that clips."""
STRIDE_WEIGHT = 0.1
"""Weight of one stride in a running mean."""
MOST_ALONE = 2
"""Number of strides that one foot may take, at most, while the other takes none that is found.

It is 2 at most in recordings of 100 wearers."""


@frozen
class PlanStart:
    """The wearer's first place on the floor plan, plan frame, and the first heading, which is the world's x axis."""

    place: Vec2
    """Coordinates of the place, m."""
    heading: float
    """Angle from the plan's x axis to the world's, rad."""
    spread: float
    """Uncertainty of the place, m (rms)."""


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
    spoiled: bool = False
    """Flag: a defect spoils the data of the foot."""
    sound_landings: int = STRIDES_TO_ALIGN
    """Number of times that the foot has come to stand as a foot does, `STRIDES_TO_ALIGN` at most."""
    strides_alone: int = 0
    """Number of strides that the other foot has taken alone since this foot came to stand."""
    newest_error: float = 0.0
    """Newest error of the integrated velocity when the foot came to stand, m/s."""
    landing_error: float = 0.0
    """Usual error of the integrated velocity when the foot comes to stand, m/s."""
    stood_at: Vec3 | None = None
    """Position where the foot came to stand, with its correction, on its own track, m; None before that."""
    stands: bool = False
    """Flag: the foot has come to stand, and `stood_at` is that of the next sample."""

    out: bool = False
    """Flag: the foot counts as absent, because its position cannot be right."""

    @property
    def discredited(self) -> bool:
        """Flag: the position of the foot cannot be right."""
        return self.spoiled or self.sound_landings < STRIDES_TO_ALIGN or self.strides_alone > MOST_ALONE

    @property
    def absent(self) -> bool:
        """Flag: the foot is out, or had no samples for `ABSENCE_TIME` while the other foot had."""
        return self.out or self.absent_for >= ABSENCE_TIME

    @property
    def is_here(self) -> bool:
        """Flag: the foot has samples, and its track is aligned with the other foot's."""
        return not self.unplaced and not self.absent

    def flat(self, own: Vec3) -> complex:
        """Return the horizontal position of the place `own` of the foot's own track in the common frame, m."""
        (x, y, _), (off_x, off_y, _) = own, self.offset
        return complex(x, y) * rect(1.0, self.turn) + complex(off_x, off_y)

    def place(self, own: Vec3) -> Vec3:
        """Return the position `own` of the foot's own track in the common frame, m."""
        flat = self.flat(own)
        return (flat.real, flat.imag, own[2] + self.offset[2])

    @property
    def newest(self) -> Vec3:
        """Newest position in the common frame, m."""
        return self.place(self.newest_place)

    def to_own(self, place: Vec3) -> Vec3:
        """Return the position `place` of the common frame on the foot's own track, m."""
        (x, y, z), (off_x, off_y, off_z) = place, self.offset
        own = complex(x - off_x, y - off_y) * rect(1.0, -self.turn)
        return (own.real, own.imag, z - off_z)

    def turned_covariance(self, own: Covariance3) -> Covariance2:
        """Return the horizontal covariance `own` of the foot's own track in the common frame: xx, xy, yy, m^2."""
        xx, xy, _, yy, _, _ = own
        return turned_covariance(xx, xy, yy, cos(self.turn), sin(self.turn))

    def land(self, error: float, explained: bool) -> None:
        """Note that the foot comes to stand with an error of its velocity, m/s; a gap or clipped peaks explain it."""
        self.strides_alone, self.stands = 0, True
        if error == self.newest_error:  # the corrector has seen no other one since
            return
        self.newest_error = error
        sound = explained or error < max(LARGEST_LANDING_ERROR, UNUSUAL * self.landing_error)
        self.sound_landings = min(self.sound_landings + 1, STRIDES_TO_ALIGN) if sound else 0
        self.landing_error += STRIDE_WEIGHT * (min(error, LARGEST_LANDING_ERROR) - self.landing_error)

    def correct(self, pivot: Vec3, yaw: float, by: complex, centre: complex | None = None) -> None:
        """Rotate the track by `yaw`, rad, about the place `pivot` of the own track, m, and move it by `by`, m.

        The move is in the common frame. With a `centre`, m, of that frame, `pivot` moves as if it turned about it by a
        small angle."""
        (x, y, z), own = self.offset, complex(pivot[0], pivot[1])
        offset = complex(x, y)
        before = own * rect(1.0, self.turn) + offset
        if centre is not None:
            by += 1j * yaw * (before - centre)
        self.turn += yaw
        offset = offset + before + by - (own * rect(1.0, self.turn) + offset)
        self.offset = (offset.real, offset.imag, z)


@define
class MeanOfFeet(TrackPart):
    """The mean position of the feet that have samples, each in the world frame of its own first heading.

    After an alignment both feet have the same error, so the covariance is that of the foot that was not absent."""

    needs_samples = True

    tracks: PerFoot[PlacedTrack] = field(factory=lambda: per_foot(PlacedTrack), init=False)
    placed_last: Foot | None = field(default=None, init=False)
    """The foot that was last aligned with the other foot; None before any."""
    return_strides: list[tuple[bool, Vec3, Vec3]] = field(factory=list, init=False)
    """Newest strides of both feet while a foot is unplaced.

    Each has a flag for the left foot, the unplaced foot's position on its own track, and the other foot's position in
    the common frame, m."""

    @property
    def is_aligned(self) -> bool:
        """Flag: no foot has to be placed beside the other one."""
        left, right = self.tracks.values()
        return not (left.unplaced or right.unplaced)

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        """Add one sample of a foot and detect an absent or returned foot; returns no output."""
        if events:
            self.judge(events, view)
        if view is not None:
            self.add_view(view)
        return ()

    def judge(self, events: Inputs, view: FootView | None) -> None:
        """Note what the events say of the feet: how they come to stand, strides that no foot takes, and defects."""
        strides = [event for event in events if isinstance(event, StrideTaken)]
        for event in events:
            if isinstance(event, FootFlat) and view is not None and view.after is not None:
                now = [stride for stride in strides if stride.t_end == event.t]
                explained = any([not EXPLAINED.isdisjoint(stride.flaws) for stride in now])
                self.tracks[event.foot].land(hypot(*view.after.velocity_error), explained)
                if any([stride.length > LEAST_STRIDE for stride in now]):
                    other = self.tracks[OTHER[event.foot]]
                    other.strides_alone += not (other.absent or self.tracks[event.foot].discredited)
            elif isinstance(event, DefectFound) and event.site.foot is not None:
                # peaks that are cut off add to the drift
                self.tracks[event.site.foot].spoiled |= event.spoilt_foot is not None
        for stride in strides:
            self.tracks[stride.foot].stands = True
            if stride.length > LONGEST_STRIDE:
                self.tracks[stride.foot].sound_landings = 0

    def add_view(self, view: FootView) -> None:
        """Add one sample of a foot and detect an absent or returned foot."""
        t, foot = view.t, view.foot
        if view.sample.acc is None or view.sample.gyro is None:
            return
        this, other = self.tracks[foot], self.tracks[OTHER[foot]]
        if this.stands:
            if view.after is None:
                this.stood_at, this.stands = view.position, False
        elif (
            this.stood_at is not None
            and hypot(view.position[0] - this.stood_at[0], view.position[1] - this.stood_at[1]) > LONGEST_STRIDE
        ):
            this.sound_landings = 0
        has_returned, discredited = this.out, this.discredited
        if discredited and (this.out or (other.t is not None and not other.absent)):
            this.out = True
            return
        this.out = False
        if not has_returned:
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
        this.t, this.absent_for, this.newest_place = t, 0.0, view.position
        if view.north is not None:
            (c, s), (x, y, z) = view.north, view.position
            this.newest_place = (c * x - s * y, s * x + c * y, z)
        if has_returned:
            self._start_return(foot)
        if view.after is not None and (covariance := view.after.covariance) is not None:  # a stride has ended
            xx, _, _, yy, _, zz = covariance
            this.variance = (0.5 * (xx + yy), zz)
            if other.t is not None and not other.absent:
                self._place_returned(foot)

    def reset(self, site: Site) -> None:
        """Reset the times of a foot, so that its next sample counts as its first."""
        if site.foot is not None:
            placed = self.tracks[site.foot]
            placed.t, placed.started_at, placed.absent_for = None, None, 0.0
            placed.spoiled, placed.sound_landings, placed.landing_error = False, STRIDES_TO_ALIGN, 0.0
            placed.strides_alone, placed.stood_at = 0, None

    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        """Return the position of the wearer; None before any sample."""
        if not feet:
            return None
        poses = self._select_poses(list(feet.values()))
        place = _mean([self.tracks[pose.foot].place(pose.position) for pose in poses])
        if len(poses) == 1:
            place = add(place, self._offset_to_mean(poses[0].foot))
        elif self.placed_last is not None:
            poses = [pose for pose in poses if pose.foot is not self.placed_last]
        k = 1.0 / len(poses)
        xx, xy, xz, yy, yz, zz = [fsum(c) * k * k for c in zip(*[pose.covariance for pose in poses], strict=True)]
        if len(poses) == 1:
            more, higher = self.tracks[poses[0].foot].added_variance
            xx, yy, zz = xx + more, yy + more, zz + higher
        return Position(max([pose.t for pose in feet.values()]), place, (xx, xy, xz, yy, yz, zz))

    def _select_poses(self, poses: list[FootPose]) -> list[FootPose]:
        """Return the poses of the feet that have moved, are not absent and are placed; at least one pose."""
        moved = {pose: pose.moved_at for pose in poses if pose.moved_at is not None}
        if len(moved) < 2:
            return [*moved] or poses
        newest = max(moved.values())
        # check the poses' times too, because samples of one foot may be fed long after the other's of the same time
        sound = {pose: t for pose, t in moved.items() if not self.tracks[pose.foot].out}
        present = [pose for pose, t in sound.items() if not self.tracks[pose.foot].absent or newest - t < ABSENCE_TIME]
        return [pose for pose in present if not self.tracks[pose.foot].unplaced] or present or [*sound]

    def _offset_to_mean(self, foot: Foot) -> Vec3:
        """Return the offset from this foot to the mean of both feet at the newest strides, m; 0 if unknown."""
        one, two = [track.separation for track in self.tracks.values()]
        if one is None or two is None:
            return ZERO
        return scaled(add(one, two), -0.25 if foot is Foot.LEFT else 0.25)

    def _start_return(self, foot: Foot) -> None:
        """Mark a foot as unplaced at the other foot's position, in case the other foot becomes absent."""
        this, other = self.tracks[foot], self.tracks[OTHER[foot]]
        other.offset = add(other.offset, self._offset_to_mean(OTHER[foot]))
        this.separation = other.separation = None
        this.offset = sub(other.newest, turned(this.newest_place, this.turn))
        _set_added_variance(this, other)
        this.unplaced, other.unplaced = True, False
        self.return_strides = []

    def _place_returned(self, foot: Foot) -> None:
        """Add a stride while both feet have samples, and align the unplaced foot when there are enough strides."""
        left, right = self.tracks.values()
        if not (left.unplaced or right.unplaced):
            apart = sub(left.newest, right.newest)
            if hypot(apart[0], apart[1]) < REACH:
                self.tracks[foot].separation = apart
            return
        returned = Foot.LEFT if left.unplaced else Foot.RIGHT
        this, other = self.tracks[returned], self.tracks[OTHER[returned]]
        kept = self.return_strides[-2 * STRIDES_TO_ALIGN - 1 :]
        self.return_strides = [*kept, (foot is Foot.LEFT, this.newest_place, other.newest)]
        lefts, rights = [
            [places for was_left, *places in self.return_strides if was_left is is_left] for is_left in (True, False)
        ]
        if len(lefts) <= STRIDES_TO_ALIGN or len(rights) <= STRIDES_TO_ALIGN:
            return
        (x, y, _), (ox, oy, _) = [_mean([sub(side[-1][k], side[0][k]) for side in (lefts, rights)]) for k in (0, 1)]
        if min(hypot(x, y), hypot(ox, oy)) < MIN_ALIGNMENT_DISTANCE:
            return
        this.turn = phase(complex(x, -y) * complex(ox, oy))
        places = [*lefts, *rights]
        this.offset = sub(_mean([one for _, one in places]), _mean([turned(own, this.turn) for own, _ in places]))
        _set_added_variance(this, other)
        this.unplaced, self.placed_last, self.return_strides = False, returned, []


def _set_added_variance(this: PlacedTrack, other: PlacedTrack) -> None:
    """Set a foot's added variance so that its position is as uncertain as the other foot's."""
    own, others = this.variance or (0.0, 0.0), other.variance or (0.0, 0.0)
    across, up = [max(0.0, one + more - has) for one, more, has in zip(others, other.added_variance, own, strict=True)]
    this.added_variance = (across, up)


def _mean(vectors: list[Vec3]) -> Vec3:
    k = 1.0 / len(vectors)
    x, y, z = [fsum(values) * k for values in zip(*vectors, strict=True)]
    return (x, y, z)
