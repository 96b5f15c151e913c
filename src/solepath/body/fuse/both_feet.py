"""Position of the wearer from the tracks of two feet that belong to one body, or from that of a foot alone.

The world frame starts between the feet. Its x axis is the wearer's first heading, the mean of the first directions of
both feet. At each stride, the foot that swung is compared with the foot that stood, and the difference of their errors
is corrected (error_filter.py). Feet that are further apart than `REACH` are always pulled together.
The errors that both feet share are those of the wearer's position (common_error.py); rests, straight ways, a compass
and reported positions show them, and ground that moves adds to them. A foot alone has no other errors than these.

In the first metres, the comparison aligns the two tracks, whatever the directions of the first strides are, and leaves
the feet unchanged. From then on, corrections go to the feet, to each at its own
foot-flat (`Shift`). Live position and later strides of both feet then have the same heading.

Corrections are divided between the feet by their variances; both feet have equal weight in the mean. A foot that loses
its signal and returns is treated as in `MeanOfFeet`."""

from __future__ import annotations

from cmath import phase, rect
from collections.abc import Mapping
from functools import partial
from math import hypot
from typing import TYPE_CHECKING, Final

from ...calibration import Calibration, usual_strides
from ...events import Defect, DefectFound, PositionReported, SampleGap, StrideTaken
from ...foot.view import AfterEvents, FootPose, FootView
from ...types import OTHER, SITE_OF_FOOT, Foot, PerFoot, Phase, Site, Vec2, Vec3, per_foot
from ...types.attrs import define, field, frozen, state, stateful
from ...types.vector import ZERO, add, sub, wrap_angle
from ..part import Inputs, Outputs, PartOutput, Position, Shift, StartGiven
from .common_error import NO_MOVE, UNSEEN_TURN, CommonError, Move
from .error_filter import FEET, RATE, WIDTH, TrackErrorFilter, feet_apart, standing_foot
from .moving_ground import MovingGround
from .position import ABSENCE_TIME, REACH, STRIDE_WEIGHT, MeanOfFeet, PlanStart
from .straight_ways import StraightWays
from .walked_path import WalkedPath

if TYPE_CHECKING:
    from .compass import Compass

STATIONARY: Final = Phase.STATIONARY
"""Local name of `Phase.STATIONARY`, because a look-up in the enum is slow."""
SPACING = 0.2
"""Least time between samples of both feet that the compass has, s: one to three in a stance, whose noise is small."""
MAX_PHASE_TIME = 1.0
"""Longest stance or swing time over which a drift rate is integrated, s; a foot that rests longer learns its bias."""
LEAST_DIVERGENCE = 0.5
"""Least angle between two tracks that is corrected, rad; first strides of a straight walk may differ by less."""
REPEAT_TOLERANCE = 0.25
"""Largest difference between two angles that count as equal, rad."""
MAX_TRACK_VALUE = 1e6
"""Largest coordinate of a track, m, and largest variance of a stride, m^2, that are used."""
MAX_STANDING = 600.0
"""Longest time over which the bias of a foot that stands without a rest turns the heading, s."""
FOOTPRINT_VARIANCE = 1e-4
"""Variance of a foot's position at foot-flat that is added to a stride's variance, m^2."""
STANDING_WIDTH, WALKING_WIDTH = 0.18, 0.12
"""Lateral distance of the feet when standing, and first estimate of the walking width, m."""
MIN_LENGTH, MAX_TURN, MAX_DIRECTION_DEVIATION = 0.5, 0.8, 0.6
"""Limits for a stride that is compared: length, m; turn, rad; deviation from the foot's usual direction, rad."""
GATE_LIMIT, NO_GATE = 16.0, 1e12
"""Largest squared innovation, divided by its variance, of a measurement that is used; `NO_GATE`: always."""
MAX_STRIDE_LENGTH = 2.5
"""Longest plausible stride, m; the excess of a longer stride inflates the covariance."""
UNSEEN_DISTANCE, ALIGNMENT_DISTANCE = 3.0, 5.0
"""Distance that a wearer may walk while both clocks restart, m, which is that of a foot in a gap
(foot/navigate/error_state.py), and distance walked after which the tracks count as aligned and corrections go to the
feet, m."""


@define
class DirectedStride:
    """The newest stride of a foot."""

    t_end: float
    """End of the stride, s."""
    end: Vec3
    """Position at the end, on the foot's own track, m."""
    direction: float | None
    """Direction on the foot's own track, rad; None for a short, turning or degraded stride."""


@define
class WalkingDirection:
    """The walking direction of a foot relative to its own heading.

    It changes when the wearer walks backwards or sideways; the usual position of the other foot does not apply then."""

    turn_sum: float = 0.0
    """Sum of the foot's turns, rad."""
    direction_offset: float | None = None
    """Mean direction of the foot's strides minus `turn_sum`, rad; None before any stride."""

    def add_stride(self, direction: float, turn: float) -> float:
        """Add a stride with this direction (common frame) and turn, rad; return its deviation from the mean, rad."""
        middle = self.turn_sum + 0.5 * turn
        self.turn_sum = wrap_angle(self.turn_sum + turn)
        if self.direction_offset is None:
            self.direction_offset = wrap_angle(direction - middle)
        deviation = wrap_angle(direction - middle - self.direction_offset)
        self.direction_offset = wrap_angle(self.direction_offset + STRIDE_WEIGHT * deviation)
        return deviation


@frozen
class BothFeetSettings:
    """The settings of `BothFeet`."""

    straightness: bool = True
    """Flag: straight ways show the drift of the heading, and whether its calibration fits (straight_ways.py)."""


@stateful
class BothFeet(MeanOfFeet):
    """The mean position of two feet whose headings and positions correct each other, or the position of a foot alone.

    Latency: none; a foot itself is corrected at its next foot-flat, if its corrector accepts shifts."""

    notices = (StartGiven,)

    settings: BothFeetSettings = field(default=BothFeetSettings())
    errors: TrackErrorFilter = state(factory=TrackErrorFilter)
    """Covariance of the errors of both tracks, of which only the differences are used."""
    common: CommonError = state(factory=CommonError)
    """Covariance of the errors that both tracks share."""
    straight_ways: StraightWays = state(factory=StraightWays)
    ground: MovingGround = state(factory=MovingGround)
    compass: Compass | None = None
    """The compass; None until a sample has a magnetic field."""
    measured_at: float = 0.0
    """Time of the newest sample that the compass has, s."""
    plan_start: PlanStart | None = None
    """Wearer's first place on the floor plan, in whose frame a person may report positions; None if it or the first
    heading is not known there."""
    path: WalkedPath = state(factory=WalkedPath)
    """Path of the wearer so far."""
    started: bool = False
    """Flag: both feet have had samples."""
    distance: float = 0.0
    """Distance walked, m; it is counted up to `ALIGNMENT_DISTANCE`."""
    width: float = WALKING_WIDTH
    """Walking width, m."""
    strides: PerFoot[DirectedStride | None] = state(factory=lambda: dict.fromkeys(Foot))
    """Newest stride of each foot."""
    divergence: float | None = None
    """The newest angle between the tracks, rad; None before any and after a correction."""
    directions: PerFoot[WalkingDirection] = state(factory=lambda: per_foot(WalkingDirection))
    placements: PerFoot[tuple[float, Vec3]] = state(factory=lambda: dict.fromkeys(Foot, (0.0, ZERO)))
    """Turn, rad, and offset, m, of each track when alignment ended; later corrections go to the feet themselves."""

    def calibrated(self, calibration: Calibration) -> BothFeet:
        """Return the part for a wearer whose feet remove a drift that a calibration walk has shown."""
        if calibration.headings:
            self.common.use_calibration(calibration.headings)
            self.straight_ways.use_calibration(calibration.headings)
        return self

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        """Add one sample of a foot as `MeanOfFeet` does; return the foot's correction after a stride."""
        if events:
            self.judge(events, view)
        if view is not None:
            returning = self.return_strides
            self.add_view(view)
            mag = view.sample.mag if view.phase is STATIONARY else None
            if mag is not None and not 0.0 <= view.t - self.measured_at < SPACING:
                self._add_magnetic_field(view, mag)
            if (
                not self.started
                and self.tracks[OTHER[view.foot]].t is not None
                and self.tracks[view.foot].t is not None
            ):
                self._start()
            if returning and not self.return_strides and self.is_aligned and self.placed_last is not None:
                self.errors.align(self.placed_last)
                self._keep_placements()
        outputs: list[PartOutput] = []
        for event in events:
            if isinstance(event, (StrideTaken, SampleGap)):
                foot = event.foot if isinstance(event, StrideTaken) else event.site.foot
                if foot is None or self.tracks[foot].unplaced or self.tracks[foot].out:
                    continue
                if isinstance(event, SampleGap):
                    # unseen: the other foot had no samples either in the first half, or the first second, of the gap
                    other_t = self.tracks[OTHER[foot]].t
                    unseen = other_t is None or other_t < event.t + min(0.5 * event.duration, ABSENCE_TIME)
                    self.common.add_gap(event.duration, unseen)
                elif view is not None and view.after is not None:
                    outputs += self._add_stride(event, view.after)
            elif isinstance(event, StartGiven):
                start = event.start
                if start.heading is not None and start.place is not None:
                    self.plan_start = PlanStart(start.place, start.heading, start.spread)
            elif isinstance(event, PositionReported) and (self.common.started or event.place):
                outputs += self._use_position(event)
        return outputs

    def _add_magnetic_field(self, view: FootView, mag: Vec3) -> None:
        """Add a sample of a foot that stands, with the magnetic flux density `mag`, T, sensor frame."""
        self.measured_at, compass = view.t, self.compass
        if compass is None:
            from .compass import Compass

            compass = self.compass = Compass()
        compass.feet[view.foot].add_sample(view, mag)

    def _use_position(self, event: PositionReported) -> Outputs:
        """Correct both tracks by a reported position, reject it, or note a new place without an event."""
        from .reported_position import ReportedPosition, in_world_frame

        here = {foot: float(track.is_here) for foot, track in self.tracks.items()}
        shares = here if len({*here.values()}) > 1 else self.common.shares
        in_world, place = in_world_frame(event, self.plan_start), partial(self._middle, shares)
        if in_world is None:
            return ()
        return ReportedPosition(in_world, place, self.common, self.path, self._move_both).use()

    def reset(self, site: Site) -> None:
        """Reset a foot as `MeanOfFeet` does, and discard its newest stride; if both are, the wearer may have moved."""
        was_known = any([track.t is not None for track in self.tracks.values()])
        MeanOfFeet.reset(self, site)
        if site.foot is not None:
            self.strides[site.foot] = None
            self.straight_ways.reset()
            self.ground, self.path.known_at = MovingGround(), None
            if self.compass is not None:
                self.compass.reset(site.foot, self.common)
            if was_known and all([track.t is None for track in self.tracks.values()]):
                self.common.inflate(UNSEEN_DISTANCE * UNSEEN_DISTANCE, UNSEEN_TURN)

    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        """Return the wearer's position, with the covariance at the newest stride; None before any sample."""
        mean, common = MeanOfFeet.position(self, feet), self.common
        if mean is None or not common.started:
            return mean
        xx, xy, yy = common.position_covariance(complex(*mean.position[:2]) - complex(*self.path.known))
        # corrections make the covariance of height and horizontal position unknown: it is set to 0
        covariance = (xx + FOOTPRINT_VARIANCE, xy, 0.0, yy + FOOTPRINT_VARIANCE, 0.0, mean.covariance[5])
        north = None if self.compass is None else self.compass.north(common)
        return Position(mean.t, mean.position, covariance, common.heading_sigma, north)

    def _start(self) -> None:
        self.started = True
        self.errors.start()
        if self.is_aligned:
            for foot, track in self.tracks.items():
                track.offset = add(track.offset, (0.0, 0.5 * _side(foot) * STANDING_WIDTH, 0.0))
        self._keep_placements()

    def _keep_placements(self) -> None:
        self.placements = {foot: (track.turn, track.offset) for foot, track in self.tracks.items()}

    def _add_stride(self, event: StrideTaken, after: AfterEvents) -> Outputs:
        """Correct a stride by what was seen before it, compare it with the other foot, and learn from the way so far.

        Returns what was found, and the correction of the foot."""
        foot, common, length, turn = event.foot, self.common, event.length, event.heading_change
        this, other = self.tracks[foot], self.tracks[OTHER[foot]]
        numbers = (*event.position, *event.displacement, *event.covariance)
        if self.errors.diverged or not all([abs(number) < MAX_TRACK_VALUE for number in numbers]):
            return self._restart()
        alone = not (self.started and other.is_here)
        share = common.start_stride(foot, alone)

        # what was seen before the stride; a compass waits until the tracks are aligned
        ground = self.ground.add_stride(event, after.velocity_error)
        if self.ground.since is not None:
            common.inflate(self.ground.variance(event.t_end))
        rested = common.has_rested(foot, after.bias)
        self._move_both(common.add_rest(foot, event.t_end, after.bias))
        fault = misfit = None
        if self.compass is not None and self.distance >= ALIGNMENT_DISTANCE:
            move, fault = self.compass.add_stride(event, this.turn, common)
            self._move_both(move)

        # the drift of the heading in the stride, which turns its displacement by the drift up to mid-swing
        t_toe_off = event.t_start if event.t_toe_off is None else event.t_toe_off
        stance = max(0.0, min(t_toe_off - event.t_start, MAX_PHASE_TIME))
        swing = max(0.0, min(event.t_end - t_toe_off, MAX_PHASE_TIME))
        duration = stance + swing if rested else min(event.t_end - event.t_start, MAX_STANDING)
        count, rate = usual_strides(length), self.errors.rates[foot]
        drift = common.turn_of(foot, count, turn, duration)
        mid_turn = rate * (stance + 0.5 * swing) + 0.5 * drift
        own = complex(*event.displacement[:2])
        stretch = own * rect(1.0, this.turn)
        aside = 1j * mid_turn * stretch
        moved = stretch + aside
        this.correct(event.position, rate * (stance + swing) + drift, aside)

        # the errors after the stride
        xx, xy, yy = this.turned_covariance(event.covariance)
        variance = (xx + FOOTPRINT_VARIANCE, xy, yy + FOOTPRINT_VARIANCE)
        common.propagate(foot, count, turn, duration, moved, variance)
        excess = max(0.0, length - MAX_STRIDE_LENGTH)
        degraded = self.errors.judge_stride(foot, bool(event.flaws), this.spoiled) or excess > 0.0
        if self.started:
            self.errors.propagate(foot, (stance, swing), this.flat(event.position), moved, variance, degraded)
        if excess > 0.0:
            self.errors.inflate(foot, excess)
            common.inflate(share * share * excess * excess)

        # the other foot
        self.distance = min(ALIGNMENT_DISTANCE, self.distance + share * length)
        has_direction = hypot(own.real, own.imag) > MIN_LENGTH and abs(turn) < MAX_TURN and not degraded
        self.strides[foot] = DirectedStride(event.t_end, event.position, phase(own) if has_direction else None)
        realigned = self.started and self.distance < ALIGNMENT_DISTANCE and self._realign(event)
        if self.started and not realigned:
            self._compare_feet(event, moved, (stance, swing), degraded, alone)

        # what the way so far shows
        self.path.add_stride(event.t_end, self._middle(common.shares), share * length)
        if self.settings.straightness and not realigned:
            move, misfit = self.straight_ways.add_stride(event, count, moved, common, this.spoiled)
            self._move_both(move)
        found: list[PartOutput] = []
        for defect, what in ((Defect.MOVING_GROUND, ground), (Defect.COMPASS, fault), (Defect.CALIBRATION, misfit)):
            if what is not None:
                site = SITE_OF_FOOT[foot]
                found.append(
                    DefectFound(t=event.t, known_at=event.known_at, site=site, defect=defect, what=what, spoils=False)
                )
        return [*found, *self._shift_foot(foot, after.takes_shifts)]

    def _move_both(self, move: Move) -> None:
        """Move and turn both tracks about the position of the wearer."""
        if move == NO_MOVE:
            return
        if self.compass is not None:
            self.compass.turned(move[2])
        left, right = [self.common.shares[foot] * track.flat(self._end_of(foot)) for foot, track in self.tracks.items()]
        for foot, track in self.tracks.items():
            track.correct(self._end_of(foot), move[2], complex(*move[:2]), left + right)

    def _middle(self, shares: PerFoot[float]) -> complex:
        """Return the newest place between both feet, m, common frame; each foot counts with its share."""
        left, right = self.tracks.values()
        return shares[Foot.LEFT] * left.flat(left.newest_place) + shares[Foot.RIGHT] * right.flat(right.newest_place)

    def _end_of(self, foot: Foot) -> Vec3:
        """Return where a foot stood last, on its own track, m."""
        stride = self.strides[foot]
        return self.tracks[foot].newest_place if stride is None else stride.end

    def _realign(self, event: StrideTaken) -> bool:
        """Align the tracks of both feet again if they diverge within the first metres; return whether that was done.

        A foot's world frame has its x axis along the foot's own first stride. When that stride leads sideways or
        backwards, the two tracks have a large angle between them, which small corrections cannot remove. Two walking
        feet must have the same direction, so each track is turned by half of the angle if it is repeated, and both are
        moved by equal distances, so that the other foot stands beside the middle of the stride."""
        foot, side = event.foot, _side(event.foot)
        this, other = self.tracks[foot], self.tracks[OTHER[foot]]
        stride, other_stride = self.strides[foot], self.strides[OTHER[foot]]
        if stride is None or other_stride is None or not event.t_start < other_stride.t_end < event.t_end:
            return False
        if stride.direction is None or other_stride.direction is None:
            return False
        previous = self.divergence
        angle = self.divergence = wrap_angle(
            side * (stride.direction + this.turn - other_stride.direction - other.turn)
        )
        if previous is None or abs(angle) < LEAST_DIVERGENCE or abs(wrap_angle(angle - previous)) > REPEAT_TOLERANCE:
            return False
        this.correct(stride.end, -0.5 * side * angle, 0j)
        other.correct(other_stride.end, 0.5 * side * angle, 0j)
        along = rect(1.0, this.turn + stride.direction)
        beside = this.flat(stride.end) - 0.5 * event.length * along - side * WALKING_WIDTH * (1j * along)
        apart = 0.5 * (beside - other.flat(other_stride.end))
        this.correct(stride.end, 0.0, -apart)
        other.correct(other_stride.end, 0.0, apart)
        self.errors.start()
        self.straight_ways.reset()
        self.distance, self.divergence, self.directions = 0.0, None, per_foot(WalkingDirection)
        self._keep_placements()
        return True

    def _compare_feet(self, event: StrideTaken, moved: complex, times: Vec2, degraded: bool, alone: bool) -> None:
        """Compare a stride by `moved`, m, with where the other foot stood, unless this one is `alone`.

        The `times` of its stance and swing are in s."""
        foot, turn, length = event.foot, event.heading_change, hypot(moved.real, moved.imag)
        this, other, other_stride = self.tracks[foot], self.tracks[OTHER[foot]], self.strides[OTHER[foot]]
        deviation = self.directions[foot].add_stride(phase(moved), turn) if length > MIN_LENGTH else 0.0
        if other_stride is None or alone:
            return
        ends = {foot: event.position, OTHER[foot]: other_stride.end}
        walks_on = length > MIN_LENGTH and abs(turn) < MAX_TURN and abs(deviation) < MAX_DIRECTION_DEVIATION
        if walks_on and event.t_start < other_stride.t_end < event.t_end and not degraded:
            middle = other.flat(other_stride.end) - (this.flat(event.position) - 0.5 * moved)
            for measured in standing_foot(foot, moved, middle, turn, times, self.width):
                self._correct(self.errors.correct(measured, GATE_LIMIT), ends)
        to_other = other.flat(other.newest_place) - this.flat(event.position)
        if hypot(to_other.real, to_other.imag) > REACH:
            # a foot that moved far without a stride has a wrong track, which must not pull the other foot
            wx, wy, _ = sub(other.newest_place, other_stride.end)
            self.errors.inflate(OTHER[foot], max(0.0, hypot(wx, wy) - MAX_STRIDE_LENGTH))
            if other_stride.t_end < event.t_start:  # no foot stands that long: its strides were not detected
                self.errors.inflate(OTHER[foot], event.length)
            self._correct(self.errors.correct(feet_apart(foot, to_other, REACH), NO_GATE), ends)

    def _correct(self, errors: list[float] | None, ends: PerFoot[Vec3]) -> None:
        """Remove the estimated errors (None: no change) from both tracks, whose feet stood last at these `ends`, m."""
        if errors is not None:
            self.width += errors[WIDTH]
            for foot, end in ends.items():
                x, y, yaw = errors[FEET[foot] : FEET[foot] + RATE]
                self.tracks[foot].correct(end, yaw, complex(x, y), complex(*self.errors.centre))

    def _shift_foot(self, foot: Foot, takes_shifts: bool) -> Outputs:
        """Return the correction that has accumulated for the foot since its last one, and reset its placement."""
        this, stride = self.tracks[foot], self.strides[foot]
        if stride is not None and self.distance < ALIGNMENT_DISTANCE:
            self.placements[foot] = (this.turn, this.offset)
        elif stride is not None and takes_shifts:
            place, yaw = this.place(stride.end), this.turn
            this.turn, this.offset = self.placements[foot]
            own_position = this.to_own(place)
            shift = sub(own_position, stride.end)
            stride.end, this.newest_place = own_position, add(this.newest_place, shift)
            return [Shift(foot, yaw - this.turn, shift)]
        return ()

    def _restart(self) -> Outputs:
        """Restart the error filter, because its estimates or a stride have impossible values."""
        self.errors.start()
        self.strides = dict.fromkeys(Foot)
        self.straight_ways.reset()
        for foot, track in self.tracks.items():
            track.turn, track.offset = self.placements[foot]
        return ()


def _side(foot: Foot) -> float:
    return 1.0 if foot is Foot.LEFT else -1.0
