"""Position of the wearer from the tracks of two feet that belong to one body, or from that of a foot alone.

The world frame starts between the feet. Its x axis is the wearer's first heading, the mean of the first directions of
both feet. At each stride, the foot that swung is compared with the foot that stood, and the difference of their errors
is corrected (error_filter.py). Feet that are further apart than `BothFeetSettings.reach` are always pulled together.
The errors that both feet share are those of the wearer's position (common_error.py); straight ways show the drift of
the heading among them (straightness.py). A foot alone has no other errors than these.

In the first metres, the comparison aligns the two tracks, whatever the directions of the first strides are
(walking_direction.py), and leaves the feet unchanged. From then on, corrections go to the feet, to each at its own
foot-flat (`Shift`). Live position and later strides of both feet then have the same heading.

Corrections are divided between the feet by their variances; both feet have equal weight in the mean. A foot that loses
its signal and returns is treated as in `MeanOfFeet`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from math import atan2, cos, hypot, sin

from ...calibration import Calibration
from ...events import DefectFound, PositionReported, SampleGap, StrideTaken
from ...foot.stride import usual_strides
from ...foot.view import AfterEvents, FootPose, FootView
from ...types import Foot, Site, Vec3
from ...types.attrs import define, field, frozen
from ...types.vector import ZERO, sub
from ..part import PartInput, PartOutput, Position, Shift, StartGiven
from .common_error import NO_MOVE, UNSEEN_TURN, CommonError, Move
from .error_filter import WIDTH, Pair, TrackErrorFilter, feet_apart, moves_of, phase_times, standing_foot
from .learnt_bias import has_rested
from .position import MeanOfFeet
from .shared_evidence import SPACING, STATIONARY, SharedEvidence
from .walking_direction import DirectedStride, TrackDivergence, WalkingDirection, align_tracks

MAX_TRACK_VALUE = 1e6
"""Largest coordinate of a track, m, and largest variance of a stride, m^2, that are used."""
MAX_STANDING = 600.0
"""Longest time over which the bias of a foot that stands without a rest turns the heading, s."""
FOOTPRINT_VARIANCE = 1e-4
"""Variance of a foot's position at foot-flat that is added to a stride's variance, m^2."""
ALIGNMENT_ERROR = (0.15, 0.05)
"""Standard deviations of position, m, and heading, rad, of a returned foot after its alignment with the other foot."""
STANDING_WIDTH, WALKING_WIDTH = 0.18, 0.12
"""Lateral distance of the feet when standing, and first estimate of the walking width, m."""
MIN_LENGTH, MAX_TURN, MAX_DIRECTION_DEVIATION = 0.5, 0.8, 0.6
"""Limits for a stride that is compared: length, m; turn, rad; deviation from the foot's usual direction, rad."""
GATE_LIMIT, NO_GATE = 16.0, 1e12
"""Largest squared innovation, divided by its variance, of a measurement that is used; `NO_GATE`: always."""
MAX_STRIDE_LENGTH = 2.5
"""Longest plausible stride, m; the excess of a longer stride inflates the covariance."""
UNSEEN_DISTANCE, ALIGNMENT_DISTANCE = 3.0, 5.0
"""Distance that a wearer may walk while both clocks restart, m: that of a foot in a gap (propagated.py), and distance
walked after which the tracks count as aligned and corrections go to the feet, m."""


@frozen
class BothFeetSettings:
    """The settings of `BothFeet`."""

    straightness: bool = True
    """Flag: straight ways show the drift of the heading, and whether its calibration fits (straight_ways.py)."""
    feedback: bool = True
    """Flag: corrections are returned to the feet."""
    reach: float = 1.5
    """Largest distance between the feet, m."""


@define
class BothFeet(MeanOfFeet):
    """The mean position of two feet whose headings and positions correct each other, or the position of a foot alone.

    Latency: none; a foot itself is corrected at its next foot-flat, if its corrector accepts shifts."""

    settings: BothFeetSettings = BothFeetSettings()
    errors: TrackErrorFilter = field(factory=TrackErrorFilter, init=False)
    """Covariance of the errors of both tracks, of which only the differences are used."""
    common: CommonError = field(factory=CommonError, init=False)
    """Covariance of the errors that both tracks share."""
    evidence: SharedEvidence = field(factory=SharedEvidence, init=False)
    started: bool = field(default=False, init=False)
    """Flag: both feet have had samples."""
    distance: float = field(default=0.0, init=False)
    """Distance walked, m; it is counted up to `ALIGNMENT_DISTANCE`."""
    width: float = field(default=0.0, init=False)
    """Walking width, m."""
    strides: list[DirectedStride | None] = field(factory=lambda: [None, None], init=False)
    """Newest strides of the left foot and the right foot."""
    divergence: TrackDivergence = field(factory=TrackDivergence, init=False)
    directions: list[WalkingDirection] = field(factory=lambda: [WalkingDirection(), WalkingDirection()], init=False)
    placements: list[tuple[float, Vec3]] = field(factory=lambda: [(0.0, ZERO), (0.0, ZERO)], init=False)
    """Turn, rad, and offset, m, of each track when alignment ended; later corrections go to the feet themselves."""

    def calibrated(self, calibration: Calibration) -> BothFeet:
        """Return the part for a wearer whose feet remove a drift that a calibration walk has shown."""
        if not calibration.headings:
            return self
        part = BothFeet(self.settings)
        part.common.use_calibration(calibration.headings)
        part.evidence.straight_ways.use_calibration(calibration.headings)
        return part

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        """Add one sample of a foot as `MeanOfFeet` does; return the foot's correction after a stride."""
        if view is not None:
            was_unplaced = self.left.unplaced or self.right.unplaced
            self.add_view(view)
            mag = view.sample.mag if view.phase is STATIONARY else None
            if mag is not None and not 0.0 <= view.t - self.evidence.measured_at < SPACING:
                self.evidence.add_stance_sample(view, mag)
            if not self.started and self.left.t is not None and self.right.t is not None:
                self._start()
            if was_unplaced and not self.left.unplaced and not self.right.unplaced:
                self.errors.align(0 if self.placed_last is Foot.LEFT else 1, *ALIGNMENT_ERROR)
                self._keep_placements()
        return [output for event in events for output in self._receive(event, view)] if events else ()

    def _receive(self, event: PartInput, view: FootView | None) -> Sequence[PartOutput]:
        """Receive a stride or gap, a position that a person reports, or a defect that spoils straight ways."""
        after = None if view is None or self._track(view.foot).unplaced else view.after
        if isinstance(event, StrideTaken) and after is not None:
            return self._add_stride(event, after)
        if isinstance(event, SampleGap) and after is not None:
            self.common.add_gap(event.duration, self.is_unseen(event))
        elif isinstance(event, DefectFound):
            self.evidence.straight_ways.add_defect(event)
        elif isinstance(event, StartGiven):
            self.set_start(event.start)
        elif isinstance(event, PositionReported) and (self.common.started or event.place):
            here = [not (track.absent or track.unplaced) for track in (self.left, self.right)]
            shares = self.common.shares if here[0] == here[1] else (float(here[0]), float(here[1]))
            place = partial(self.middle, shares)
            return self.evidence.use_position(event, place, self.plan_start, self.common, self._move_both)
        return ()

    def reset(self, site: Site) -> None:
        """Reset a foot as `MeanOfFeet` does, and discard its newest stride; if both are, the wearer may have moved."""
        was_unknown = self.left.t is self.right.t is None
        MeanOfFeet.reset(self, site)
        if site.foot is not None:
            self.strides[0 if site.foot is Foot.LEFT else 1] = None
            self.evidence.reset(site.foot, self.common)
            if not was_unknown and self.left.t is self.right.t is None:
                self.common.inflate(UNSEEN_DISTANCE * UNSEEN_DISTANCE, UNSEEN_TURN)

    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        """Return the wearer's position, with the covariance at the newest stride; None before any sample."""
        mean = MeanOfFeet.position(self, feet)
        if mean is None or not self.common.started:
            return mean
        xx, xy, yy = self.evidence.covariance(mean.position, self.common)
        # corrections make the covariance of height and horizontal position unknown: it is set to 0
        covariance = (xx + FOOTPRINT_VARIANCE, xy, 0.0, yy + FOOTPRINT_VARIANCE, 0.0, mean.covariance[5])
        north = self.evidence.north(self.common)
        return Position(mean.t, mean.position, covariance, self.common.heading_sigma, north)

    def _start(self) -> None:
        self.started, self.width = True, WALKING_WIDTH
        self.errors.start()
        if not self.left.unplaced and not self.right.unplaced:
            for track, k in ((self.left, 0.5), (self.right, -0.5)):
                x, y, z = track.offset
                track.offset = (x, y + k * STANDING_WIDTH, z)
        self._keep_placements()

    def _keep_placements(self) -> None:
        self.placements = [(track.turn, track.offset) for track in (self.left, self.right)]

    def _add_stride(self, event: StrideTaken, after: AfterEvents) -> Sequence[PartOutput]:
        index = 0 if event.foot is Foot.LEFT else 1
        this, other = (self.left, self.right) if index == 0 else (self.right, self.left)
        numbers = (*event.position, *event.displacement, *event.covariance)
        if not all([abs(v) < MAX_TRACK_VALUE for v in numbers]) or self.errors.diverged:
            return self._restart()
        share = self.common.start_stride(index, not self.started or other.unplaced or other.absent)
        rested = has_rested(self.common, index, after.bias)
        aligned = self.distance >= ALIGNMENT_DISTANCE
        for move in self.evidence.before_stride(event, index, after, this, self.common, aligned):
            self._move_both(move)
        own_position, c, s = event.position, cos(this.turn), sin(this.turn)
        (x, y, _), (stance, swing) = event.displacement, phase_times(event)
        dx, dy = c * x - s * y, s * x + c * y
        # correct the drift of the heading, and the displacement by the drift up to mid-swing
        rate, count = self.errors.rates[index], usual_strides(event.length)
        duration = stance + swing if rested else min(event.t_end - event.t_start, MAX_STANDING)
        drift = self.common.turn_of(index, count, event.heading_change, duration)
        mid_turn = rate * (stance + 0.5 * swing) + 0.5 * drift
        this.correct(own_position, rate * (stance + swing) + drift, -mid_turn * dy, mid_turn * dx)
        (dx, dy), (ex, ey, _) = (dx - mid_turn * dy, dy + mid_turn * dx), this.place(own_position)
        xx, xy, yy = this.turned_covariance(event.covariance)
        variance = (xx + FOOTPRINT_VARIANCE, xy, yy + FOOTPRINT_VARIANCE)
        self.common.propagate(index, count, event.heading_change, duration, (dx, dy), variance)
        excess, defect = max(0.0, event.length - MAX_STRIDE_LENGTH), event.foot in self.evidence.straight_ways.spoiled
        degraded = self.errors.judge_stride(index, event.degraded, defect) or excess > 0.0
        if self.started:
            self.errors.propagate(index, stance, swing, (ex, ey), (dx, dy), variance, degraded)
        self.errors.inflate(index, excess)
        self.common.inflate(share * share * excess * excess)
        self.distance = min(ALIGNMENT_DISTANCE, self.distance + share * event.length)
        straight = hypot(x, y) > MIN_LENGTH and abs(event.heading_change) < MAX_TURN and not degraded
        self.strides[index] = DirectedStride(event.t_end, own_position, atan2(y, x) if straight else None)
        realigned = self.started and self.distance < ALIGNMENT_DISTANCE and self._realign(index, event)
        if self.started and not realigned:
            self._compare_feet(index, event, (dx, dy), (stance, swing), degraded)
        place, straight = self.middle(self.common.shares), self.settings.straightness and not realigned
        self._move_both(self.evidence.after_stride(event, index, count, (dx, dy), self.common, place, straight))
        return [*self.evidence.found, *self._shift_foot(index, event.foot, after.takes_shifts)]

    def _move_both(self, move: Move) -> None:
        """Move and turn both tracks about the position of the wearer."""
        if move == NO_MOVE:
            return
        (lx, ly, _), (rx, ry, _) = self._end_of(0)[1], self._end_of(1)[1]
        left, right = self.common.shares
        self.evidence.turned(move[2])
        self._move_tracks((left * lx + right * rx, left * ly + right * ry), (move, move))

    def _move_tracks(self, centre: tuple[float, float], moves: tuple[Vec3, Vec3]) -> None:
        """Move each track by its x and y, m, and turn it by its third number, rad, about `centre`, m."""
        for index, (track, (dx, dy, yaw)) in enumerate(zip((self.left, self.right), moves, strict=True)):
            own, (x, y, _) = self._end_of(index)
            track.correct(own, yaw, dx - yaw * (y - centre[1]), dy + yaw * (x - centre[0]))

    def _end_of(self, index: int) -> tuple[Vec3, Vec3]:
        """Return where foot 0 or 1 stood last, on its own track and in the common frame, m."""
        track, stride = (self.left, self.right)[index], self.strides[index]
        own = track.newest_place if stride is None else stride.end
        return own, track.place(own)

    def _realign(self, index: int, event: StrideTaken) -> bool:
        """Align the tracks of both feet again if they diverge within the first metres; return whether that was done."""
        stride, other_stride = self.strides[index], self.strides[1 - index]
        if stride is None or other_stride is None or not event.t_start < other_stride.t_end < event.t_end:
            return False
        track, other_track, side = (self.left, self.right, 1.0) if index == 0 else (self.right, self.left, -1.0)
        angle = self.divergence.update(stride, track.turn, other_stride, other_track.turn, side)
        if angle is None:
            return False
        align_tracks(track, stride, other_track, other_stride, angle, 0.5 * event.length, side * WALKING_WIDTH)
        self.errors.start()
        self.evidence.straight_ways.reset()
        self.distance, self.directions = 0.0, [WalkingDirection(), WalkingDirection()]
        self._keep_placements()
        return True

    def _compare_feet(self, index: int, event: StrideTaken, moved: Pair, times: Pair, degraded: bool) -> None:
        """Compare a stride by `moved`, m, with where the other foot stood; `times` of its stance and swing are in s."""
        this, other = (self.left, self.right) if index == 0 else (self.right, self.left)
        (dx, dy), turn, length = moved, event.heading_change, hypot(*moved)
        deviation = self.directions[index].add_stride(atan2(dy, dx), turn) if length > MIN_LENGTH else 0.0
        other_stride = self.strides[1 - index]
        if other_stride is None or other.absent or other.unplaced:
            return
        ex, ey, _ = this.place(event.position)
        walks_on = length > MIN_LENGTH and abs(turn) < MAX_TURN and abs(deviation) < MAX_DIRECTION_DEVIATION
        if walks_on and event.t_start < other_stride.t_end < event.t_end and not degraded:
            qx, qy, _ = other.place(other_stride.end)
            for one in standing_foot(index, moved, (ex, ey), (qx, qy), turn, times, self.width):
                self._correct(self.errors.correct(one.terms, one.z, one.variance, GATE_LIMIT))
            ex, ey, _ = this.place(event.position)
        qx, qy, _ = other.place(other.newest_place)
        separation = hypot(qx - ex, qy - ey)
        if separation > self.settings.reach:
            # a foot that moved far without a stride has a wrong track, which must not pull the other foot
            wx, wy, _ = sub(other.newest_place, other_stride.end)
            self.errors.inflate(1 - index, max(0.0, hypot(wx, wy) - MAX_STRIDE_LENGTH))
            if other_stride.t_end < event.t_start:  # no foot stands that long: its strides were not detected
                self.errors.inflate(1 - index, event.length)
            one = feet_apart(index, (ex, ey), (qx, qy), self.settings.reach)
            self._correct(self.errors.correct(one.terms, one.z, one.variance, NO_GATE))

    def _correct(self, errors: list[float] | None) -> None:
        """Remove the estimated errors (None: no change) from both tracks."""
        if errors is not None:
            self.width += errors[WIDTH]
            self._move_tracks(self.errors.centre, moves_of(errors))

    def _shift_foot(self, index: int, foot: Foot, takes_shifts: bool) -> Sequence[PartOutput]:
        """Return the correction that has accumulated for the foot since its last one, and reset its placement."""
        this, stride = self.left if index == 0 else self.right, self.strides[index]
        if stride is not None and self.distance < ALIGNMENT_DISTANCE:
            self.placements[index] = (this.turn, this.offset)
        elif stride is not None and self.settings.feedback and takes_shifts:
            place, yaw = this.place(stride.end), this.turn
            this.turn, this.offset = self.placements[index]
            own_position = this.to_own(place)
            shift = sub(own_position, stride.end)
            (x, y, z), (dx, dy, dz) = this.newest_place, shift
            stride.end, this.newest_place = own_position, (x + dx, y + dy, z + dz)
            return [Shift(foot, yaw - this.turn, shift)]
        return ()

    def _restart(self) -> Sequence[PartOutput]:
        """Restart the error filter, because its estimates or a stride have impossible values."""
        self.errors.start()
        self.strides = [None, None]
        self.evidence.straight_ways.reset()
        (self.left.turn, self.left.offset), (self.right.turn, self.right.offset) = self.placements
        return ()
