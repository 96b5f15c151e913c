"""Phases and strides of one foot, from its cues and its navigation."""

from __future__ import annotations

from collections.abc import Sequence
from math import fsum, hypot

from ..calibration import HeadingCalibration, usual_strides
from ..events import Event, HeelStrike, StrideTaken
from ..types import Foot, Phase, Quat, Vec3
from ..types.attrs import evolve, field, state, stateful
from ..types.vector import ZERO, add, from_yaw, heading_turned, multiply, sub, turned
from .bearing import FARTHEST, IMPOSSIBLE, Bearing, evidence_of
from .cues.cues import Cues, TimedCue
from .gap import Infill
from .navigate.corrector import Corrector
from .phase import EVENT_OF_PHASE, PHASES, REMAINING_CUES, STRIDE, Cue
from .stride import LEAST_STRIDE_TURN, SHORTEST_STRIDE, StrideBuilder
from .template import StrideTemplate
from .world import Covariance3, PathCovariance, World

LEAST_RADIUS = 0.6
"""Least radius, m, of the path of a first stride that goes on, whose direction is that of the wearer.

In a turn on the spot each foot moves about the middle between both, by a third of this, and both in opposite ways."""
LEAST_TURN = 0.1
"""Turn of a foot on the spot that counts, rad; a smaller one is how the toes point, which differs from foot to foot."""
FLAT_SPEED = 0.35
"""Speed after a correction above which a foot is not flat, even if the evidence was accepted, m/s; chosen by hand."""


@stateful
class Gait:
    """The phases and strides of one foot, each of which becomes an event as soon as its cue is seen."""

    foot: Foot = field()
    heading: HeadingCalibration | None = field()
    """Drift of the heading that is removed at the end of every stride; None when it was not calibrated."""
    every_stride: bool = field()
    """Report every stride at once, whether or not the foot carries its walker."""
    phase: Phase = Phase.STATIONARY
    phase_start: float | None = None
    """Start of the current phase, s; None before the first change of phase and after times restarted."""
    impact_at: float | None = None
    """Time of the heel-strike of this swing that was reported before it was final, s; None without one."""
    template: StrideTemplate = state(factory=StrideTemplate)
    stride: StrideBuilder = field(init=False)
    path: PathCovariance = state(factory=PathCovariance)
    """Covariance of the path up to the last anchor, navigation frame; an anchor is the heel-off that ends a stretch."""
    anchor_position: Vec3 = ZERO
    """Position at the last anchor, navigation frame, m."""
    world: World = state(factory=World)
    heading_settled: bool = False
    """The heading of the world frame is final."""
    turned: float = 0.0
    """Angle by which the foot has turned before its heading was final, rad."""
    bearing: Bearing = state(factory=Bearing)
    number: int = 0
    """Number of the last stride that was reported, counted from 1."""

    def __attrs_post_init__(self) -> None:
        self.stride = StrideBuilder(self.foot)

    def covariance(self, corrector: Corrector) -> Covariance3:
        """Return the covariance of the live position, world frame, m^2."""
        path = self.path.extend(sub(corrector.position, self.anchor_position), corrector.covariance())
        return self.world.rotate_covariance(path.position)

    def reset(self) -> None:
        """Discard what depends on unbroken samples, because times restart."""
        self.phase_start = self.impact_at = None
        self.stride.cut()
        self.template.reset()
        self.bearing = Bearing(self.bearing.evidence)

    def start_walking(self, on_ground: bool) -> None:
        """Start with a foot that walks already; its first stride starts at the next foot-flat."""
        self._change_phase(Cue.GROUND if on_ground else Cue.AIR)
        self.stride.t_start = self.impact_at = None

    def shift(self, yaw: float, by: Vec3) -> Vec3:
        """Turn a flat foot by `yaw` rad and move it by `by` m, world frame; return `by` in the navigation frame."""
        x, y, z = by
        if self.world.north is not None:
            c, s = self.world.north  # inverse of the rotation from navigation to world frame
            x, y = c * x + s * y, c * y - s * x
        stride, by = self.stride, (x, y, z)
        stride.start = add(stride.start, by)
        stride.attitude = multiply(from_yaw(yaw), stride.attitude)
        self.anchor_position = add(self.anchor_position, by)
        return by

    def _change_phase(self, cue: Cue) -> Phase | None:
        """Look up the phase after `cue` in the table and return it if it is another one; nothing else sets a phase."""
        phase = PHASES[self.phase][cue]
        if phase is self.phase:
            return None
        self.phase = phase
        return phase

    def apply_cue(
        self, timed_cue: TimedCue, sampled_at: float, known_at: float, corrector: Corrector | None, interval: float,
        inferred: bool = False,
    ) -> list[Event]:  # fmt: skip
        """Return the events that follow from a cue in the sample of `sampled_at`, s.

        `corrector` is None as long as the foot is not levelled. `interval` is the usual interval between samples, s.
        `inferred` marks a cue that no sample showed."""
        phase = self._change_phase(timed_cue.cue)
        if phase is None:
            return []
        # cues are dated back by different times, but phases must not go back in time
        t = timed_cue.t if self.phase_start is None else max(timed_cue.t, self.phase_start)
        self.phase_start = t
        known_at, sampled_at = max(known_at, t), max(sampled_at, t)
        kind = EVENT_OF_PHASE[phase]
        event = kind(t=t, known_at=known_at, foot=self.foot, inferred=inferred, sampled_at=sampled_at)
        if self.impact_at is not None and isinstance(event, HeelStrike):
            event = evolve(event, revises=self.impact_at)
        self.impact_at = None
        events: list[Event] = [event]
        if phase is Phase.SWING:
            self.stride.add_toe_off(t, interval)
        elif phase is Phase.LOADING:
            self.stride.add_heel_strike(t, interval)
        elif phase is Phase.PUSH_OFF and corrector is not None:
            self.template.start_stride(t)
            self.stride.t_heel_off = t
            self._anchor(corrector)
        elif phase is Phase.STATIONARY and corrector is not None:
            events += self._end_stride(t, known_at, corrector, interval)
        return events

    def add_impact(self, t: float, sampled_at: float, known_at: float) -> HeelStrike:
        """Return the heel-strike of an impact at `t`, s, which changes no phase yet; the final one will revise it."""
        self.impact_at = t = t if self.phase_start is None else max(t, self.phase_start)
        sampled_at = max(sampled_at, t)
        return HeelStrike(t=t, known_at=max(known_at, t), final=False, foot=self.foot, sampled_at=sampled_at)

    def apply_infill(
        self, infill: Infill, cues: Cues, sampled_at: float, known_at: float, corrector: Corrector, interval: float
    ) -> list[Event]:
        """Return the events of the phases that a gap before the sample of `sampled_at`, s, has hidden."""
        self.template.add_infill(infill.t_heel_off, infill.duration)
        path = REMAINING_CUES[self.phase]
        if self.phase is Phase.PUSH_OFF or self.phase is Phase.LOADING:
            # a runner's foot pushes off again without foot-flat; a heel may come down again before toe-off
            path = REMAINING_CUES[Phase.PUSH_OFF if self.stride.t_toe_off is None else Phase.LOADING]
        times = (infill.t_heel_off, infill.t_toe_off, infill.t_heel_strike, infill.t_foot_flat)
        events: list[Event] = []
        for cue, t in zip(STRIDE, times, strict=True):
            if t is not None and cue in path:
                timed_cue = cues.make_hidden_toe_off(t) if cue is Cue.CLEAR else TimedCue(cue, t)
                events += self.apply_cue(timed_cue, sampled_at, known_at, corrector, interval, inferred=True)
        return events

    def _end_stride(self, t: float, known_at: float, corrector: Corrector, interval: float) -> list[Event]:
        """End the stride at a foot-flat and start the next one; return its event, if there was a stride."""
        stride, world = self.stride, self.world
        turn = heading_turned(stride.attitude, corrector.attitude)
        path = sub(corrector.position, stride.start)
        repair = self.template.end_stride(t, stride.t_toe_off, stride.t_heel_strike, turn, path, interval)
        if repair is not None:
            corrector.repair(repair.turn, add(stride.start, repair.displacement))
        if self.heading is not None:
            self._turn_back(self.heading, corrector, path, turn)
        rise = corrector.position[2] - stride.start[2]
        corrector.flat(stride.start, turn)
        way = self._way(corrector.position)
        if not self.heading_settled and stride.t_toe_off is not None and self._find_heading(way, turn):
            self.heading_settled = True
            self.bearing.waiting = self._in_world(self.bearing.waiting)
        # until the heading is final, strides wait in the navigation frame
        frame = world if self.heading_settled else World()
        ended, shaking = stride.finish(t, known_at, corrector, frame, rise), stride.shaking
        stride.start_stride(t, corrector.position, corrector.attitude)
        if not self.heading_settled:
            self.turned += turn
        if ended is None:
            return []
        strides, dropped = ([ended], []) if self.every_stride else self.bearing.add(ended, shaking)
        if strides and not self.heading_settled:
            # the frame of a final stride must not change, even if none went on or was long enough to give a direction
            self.heading_settled = True
            if not world.find_heading(turned(way, 0.5 * turn - self.turned), SHORTEST_STRIDE):
                world.settle()
            strides = self._in_world(strides)
        if dropped:
            self._undo(dropped, corrector)
        events: list[Event] = []
        for one in strides:
            self.number += 1
            events.append(evolve(one, number=self.number))
        return events

    def follow_heading(self, position: Vec3, attitude: Quat) -> None:
        """Turn the live track, whose first heading is not final, as if the stride under way ended at this sample."""
        turn = heading_turned(self.stride.attitude, attitude)
        self.world.find_heading(turned(self._way(position), -self._turned_before(turn)))

    def _way(self, position: Vec3) -> Vec3:
        """Return the way by which the first heading is found, m: the stride under way if the foot has turned before."""
        return sub(position, self.stride.start) if abs(self.turned) > LEAST_TURN else position

    def _turned_before(self, turn: float) -> float:
        """Return how far the foot has turned up to the direction of a stride that turned by `turn`, both rad."""
        before = self.turned if abs(self.turned) > LEAST_TURN else 0.0
        # an arc's chord has the mean of its headings; in a straight stride a turn is one of the toes alone
        return before if self.every_stride or abs(turn) <= LEAST_STRIDE_TURN else before + 0.5 * turn

    def _find_heading(self, way: Vec3, turn: float) -> bool:
        """Set the world's heading by a stride along `way`, m, that turned by `turn`, rad; return whether it goes on.

        The heading is that before the foot has turned. Strides that are all reported at once cannot wait for one that
        goes on: the first of them sets it."""
        if not self.every_stride and hypot(way[0], way[1]) <= LEAST_RADIUS * abs(turn):
            return False
        return self.world.find_heading(turned(way, -self._turned_before(turn)), SHORTEST_STRIDE)

    def _in_world(self, strides: Sequence[StrideTaken]) -> list[StrideTaken]:
        """Return strides of the navigation frame in the world frame."""
        world = self.world
        return [
            evolve(
                one,
                displacement=world.rotate_vector(one.displacement),
                position=world.rotate_vector(one.position),
                covariance=world.rotate_covariance(one.covariance),
            )
            for one in strides
        ]

    def _undo(self, dropped: Sequence[StrideTaken], corrector: Corrector) -> None:
        """Move a foot that carries nobody back to where the strides began that were none."""
        apply_shift = getattr(corrector, "shift", None)
        # a lone stride is no bout, but it moved the foot all the same
        moves = [one.displacement for one in dropped if evidence_of(one, None) < IMPOSSIBLE]
        if apply_shift is None or not moves or not hypot(*[hypot(*move) for move in moves]) < FARTHEST:
            return
        if not self.heading_settled:
            self.world.north = None  # what was dropped is in the navigation frame, too
        x, y, z = [-fsum(values) for values in zip(*moves, strict=True)]
        apply_shift(0.0, self.shift(0.0, (x, y, z)))
        waiting = self.bearing.waiting
        self.bearing.waiting = [evolve(one, position=add(one.position, (x, y, z))) for one in waiting]

    @staticmethod
    def _turn_back(heading: HeadingCalibration, corrector: Corrector, path: Vec3, turn: float) -> None:
        """Remove the drift of a stride along `path`, m, that turned by `turn` rad; half of it turned the path."""
        x, y, _ = path
        yaw = heading.drift * usual_strides(hypot(x, y)) + heading.turning * turn
        by = (-0.5 * yaw * y, 0.5 * yaw * x, 0.0)
        shift = getattr(corrector, "shift", None)
        if shift is not None:
            shift(yaw, by)
            return
        corrector.repair(yaw, add(corrector.position, by))

    def _anchor(self, corrector: Corrector) -> None:
        """Add the stretch since the last anchor to the path."""
        position = corrector.position
        stretch = corrector.anchor()
        self.path = self.path.extend(sub(position, self.anchor_position), stretch)
        self.anchor_position = position
