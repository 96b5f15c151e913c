"""Activities of the wearer: standing, walking, running, stairs and elevators, for any recipe.

The samples of each foot are cut into blocks of half a second (foot_blocks.py), and every block gives a likelihood of
each motion (motion.py). Three kinds of evidence feed a Markov chain of sixteen states (chain.py): the likelihoods of
both feet's motion, the force that an elevator adds on a standing foot (elevator_evidence.py), and the height by air
pressure, if there is a barometer (pressure_height.py). Viterbi's algorithm finds the sequence (hypotheses.py).

Latency: a block enters the sequence when two more blocks have come, 1 to 1.5 s after it. Until then a state machine
(early.py) reports what the newest blocks show, up to half a second after it happens, and each stride at the sample
after its end, unless its block is judged then. All of that is not final. The segments on which all likely sequences
agree are reported again as final, mostly seconds later. Standing may turn out to be a ride whose start was not
detected, so it becomes final after up to a minute; the end of a ride becomes final after 12 s."""

from __future__ import annotations

from math import floor, inf
from typing import TYPE_CHECKING

from ...events import ActivityChanged, Defect, DefectFound, Event, StrideTaken
from ...events.activity import Ride
from ...events.happening import BaseEvent
from ...foot.view import FootView
from ...types import OTHER, Activity, Foot, PerFoot, Site, Vec3, per_foot
from ...types.attrs import evolve, field, frozen, state, stateful
from ...types.vector import TIME_EPSILON
from ..part import ActivityPart, Inputs, Outputs, PartOutput
from .early import NO_ACTIVITY, ActivityCue, ActivityReport, BlockSigns, Early, cue_of_stride, follow, follow_block
from .elevator_evidence import BlockForce, ElevatorEvidence
from .flights import Flights, FlightStride, integrated_rise
from .foot_blocks import BLOCK_DURATION, MAX_LENGTH, MAX_RISE, MAX_STRIDE_TIME, WINDOW_REACH, BlockFeatures, FootBlocks
from .hypotheses import BLOCKS_BEFORE, NO_EVIDENCE, BlockEvidence, Hypotheses, activity_at
from .motion import MotionModel, block_force, load_released_model, motion_votes, slope_evidence
from .reconcile import GAITS

if TYPE_CHECKING:
    from .pressure_height import PressureHeight

SILENT_BLOCKS = 3
"""Number of blocks without samples after which a foot is no longer waited for."""
MAX_EMPTY_BLOCKS = 60
"""Largest number of consecutive empty blocks that are judged; the rest of a longer gap is skipped."""
MAX_WAITING_STRIDES = 8
"""Largest number of strides whose activity is not known yet; older ones are discarded."""
STAIR_DIRECTIONS: dict[Activity | None, int] = {Activity.STAIRS_UP: 1, Activity.STAIRS_DOWN: -1}


@frozen
class ActivitiesSettings:
    """The settings of `Activities`."""

    model: MotionModel | None = None
    """Motion model; None: the model of this release."""


@stateful
class Activities(ActivityPart):
    """Reports the wearer's activity, flights of stairs and elevator rides."""

    needs_samples = True

    settings: ActivitiesSettings = field(default=ActivitiesSettings())
    origin: float | None = None
    """Start of block 0, s."""
    next_block: int = 0
    """Number of the block that is judged next."""
    feet: PerFoot[FootBlocks] = state(factory=lambda: per_foot(FootBlocks))
    pressure_height: PressureHeight | None = None
    """Heights by the barometers; None before any reading."""
    walked: bool = False
    """Flag: the wearer has taken a stride. Before, no force can have shown that an elevator set off, and a slope of the
    air pressure alone is no ride."""
    hypotheses: Hypotheses = state(factory=Hypotheses)
    report: ActivityReport = state(factory=ActivityReport)
    newest_block: int = -1
    """Number of the newest block that is complete in all feet that give samples."""
    early: list[Early] = state(factory=lambda: [(NO_ACTIVITY, 1.0)])
    """Newest activity of the likeliest sequence and those in the blocks since, each with its probability."""
    stride_cue: tuple[int, ActivityCue, float] | None = None
    """Number of the block of the newest stride with a cue, its cue, and the probability of that; None before any."""
    waits: float | None = None
    """Time at which a complete block or a stride's cue was known that is not judged yet, s; None if none waits."""
    flights: Flights = state(factory=Flights)
    held: list[ActivityChanged | Ride] = state(factory=list)
    """Last activities before a reset of all feet, and that nothing is known from then on, until something is fed."""
    strides: list[FlightStride] = state(factory=list)
    """Strides whose activity is not known yet."""
    spoilt: list[Foot] = state(factory=list)
    """Feet whose data cannot be right. Beside one whose data are right they say nothing about the activity."""

    @property
    def activity(self) -> Activity:
        """The newest activity that was reported, final or not."""
        return self.report.activity

    @property
    def _model(self) -> MotionModel:
        return self.settings.model or load_released_model()

    def ready(self) -> None:
        """Read the motion model of this release, unless the settings have one."""
        if self.settings.model is None:
            load_released_model()

    def reset(self, site: Site) -> None:
        """Discard the waiting strides, the flight under way, and the blocks of a foot with a new clock or device."""
        if site.foot is None:
            return
        known = self._open_blocks
        self.feet[site.foot].restart()
        self.spoilt = [foot for foot in self.spoilt if foot is not site.foot]
        if self.pressure_height is not None:
            self.pressure_height.restart(site.foot)
        self.flights.reset()
        self.strides.clear()
        if known and not self._open_blocks:
            t, activity = self._time(max(known) + 1), self.activity
            last = self.report.add(self.hypotheses, (), 1e6 + t, t, True)
            self.held = [one for one in last if one.t < t and isinstance(one, ActivityChanged | Ride)]
            if self.held or activity is not Activity.UNKNOWN:
                self.held.append(self.report.end(t))
            self._restart()

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        """Add a sample of a foot with its air pressure and events; return activities, flights and rides."""
        outputs: list[PartOutput] = []
        if self.held:
            times = [event.known_at for event in events if isinstance(event, BaseEvent)]
            outputs += self._take_held(min(times, default=-inf) if view is None else view.known_at)
        for event in events:
            if isinstance(event, DefectFound):
                self._leave_out(event)
        if self.spoilt and view is not None and self._is_left_out(view.foot):
            return outputs
        if view is not None and (self.origin is not None or view.sample.acc is not None):
            sample, t, side = view.sample, view.t, self.feet[view.foot]
            acc: Vec3 | None = sample.acc  # declared, because the fields of a compiled Sample have any type
            if self.origin is None:
                self.origin = t
            block_number = (t - self.origin + TIME_EPSILON) / BLOCK_DURATION
            if sample.air_pressure is not None and side.index is not None:
                air = self.pressure_height or self._make_pressure_height()
                air.add(view.foot, floor(block_number), sample.air_pressure)
            if acc is not None:
                has_waited = self.waits is not None
                if side.index is None or block_number >= side.index + 1:
                    side.close()
                    self.report.strides.tracked = self.report.strides.tracked or side.tracked
                    side.start_block(floor(block_number), view.gyro_bias, view.acc_grain)
                    if self.waits is None and self._newest_complete > self.newest_block:
                        self.waits = view.known_at
                if self.waits is not None and (has_waited or not any([isinstance(one, StrideTaken) for one in events])):
                    outputs += self._judge(t, max(view.known_at, self.waits))
                side.add(acc, sample.gyro, view.velocity if view.levelled else None)
            if events:
                side.add_events(events, view.position[2])
                if view.after is not None:
                    self.report.strides.bearing[view.foot] = not view.after.bears_none
                for event in events:
                    self.report.strides.add_event(event, view.attitude)
                    if isinstance(event, StrideTaken):
                        self._add_stride(event, floor(block_number))
        return outputs

    def _take_held(self, now: float) -> list[PartOutput]:
        """Return what was the last before a reset, unless times start again earlier."""
        held, self.held = self.held, []
        is_past = held[-1].t < now + BLOCK_DURATION
        return [evolve(one, t=min(one.t, now), known_at=now) for one in held if is_past]

    def _leave_out(self, found: DefectFound) -> None:
        """Leave out a barometer that contradicts the strides, and a foot whose data cannot be right."""
        foot = found.site.foot
        if foot is not None and found.defect is Defect.AIR_PRESSURE:
            air = self.pressure_height or self._make_pressure_height()
            air.leave_out(foot)
        if foot is not None and foot is found.spoilt_foot and foot not in self.spoilt:
            self.spoilt.append(foot)
            if self._is_left_out(foot):
                self.feet[foot].restart()

    def _is_left_out(self, foot: Foot) -> bool:
        other = OTHER[foot]
        return foot in self.spoilt and other not in self.spoilt and self.feet[other].index is not None

    def _make_pressure_height(self) -> PressureHeight:
        from .pressure_height import PressureHeight  # few sensors have a barometer

        air = self.pressure_height = PressureHeight()
        return air

    @property
    def _open_blocks(self) -> list[int]:
        """Numbers of the blocks under way, of the feet that give samples."""
        return [side.index for side in self.feet.values() if side.index is not None]

    @property
    def _newest_complete(self) -> int:
        """Number of the newest block that is complete in all feet that give samples."""
        open_blocks = self._open_blocks
        newest = max(open_blocks)
        return min([index for index in open_blocks if newest - index < SILENT_BLOCKS]) - 1

    def finish(self, now: float) -> Outputs:
        """Return the final activities, including the last second, because no more samples come."""
        if self.held:
            return self._take_held(now)
        for side in self.feet.values():
            side.close()
        last = max(self._open_blocks, default=-1)
        while self.next_block <= last and last - self.next_block < MAX_EMPTY_BLOCKS:
            self._judge_block(self.next_block)
            self.next_block += 1
        return self.report.add(self.hypotheses, (), 1e6 + now, now, True)

    def _judge(self, t: float, known_at: float) -> list[Event]:
        """Judge the blocks that are complete in all feet that give samples, and the newest stride.

        A sample that ends a stride makes the most work in all parts, so what it completes waits for the next sample,
        whatever that ends."""
        self.waits, complete = None, self._newest_complete
        if complete <= self.newest_block:
            return self._report_early(known_at)
        followed, self.newest_block = self.newest_block, complete
        empty_blocks = 0
        while self.next_block <= complete - WINDOW_REACH:
            empty_blocks = 0 if self._judge_block(self.next_block) else empty_blocks + 1
            self.next_block += 1
            if empty_blocks > MAX_EMPTY_BLOCKS:
                self.next_block = complete
        return self._report(followed, known_at) + self._count_flights(t, known_at)

    def _judge_block(self, index: int) -> bool:
        """Judge one block and return whether it has samples."""
        model, air, features = self._model, self.pressure_height, self._features(index)
        pressure_scores, before, after = NO_EVIDENCE, None, None
        if air is not None:
            if self.walked:
                pressure_scores = air.score_slope(index, BLOCK_DURATION)
            before, after = air.height(index - BLOCKS_BEFORE, index - 1), air.height(index, index + WINDOW_REACH)
        for side in self.feet.values():
            if (block := side.block(index)) is not None:
                self.report.strides.add_block(self._time(index), block)
        forces = self._forces(index)
        if (leans := ElevatorEvidence(forces).leans) is not None:
            self.report.strides.forces.append((self._time(index), leans))
        self.hypotheses.update(
            BlockEvidence(
                t=self._time(index),
                motion_scores=motion_votes(model, features),
                forces=forces,
                pressure_scores=pressure_scores,
                before=before,
                after=after,
            ),
            model.chain,
        )
        return any([one is not None for one in features])

    def _features(self, index: int) -> list[BlockFeatures | None]:
        """Return the features of a block of both feet, with as many later blocks as there are."""
        t = self._time(index) + 0.5 * BLOCK_DURATION
        return [side.features(index, t) for side in self.feet.values()]

    def _forces(self, index: int) -> tuple[BlockForce | None, ...]:
        return tuple([block_force(side.block(index), side.resolution) for side in self.feet.values()])

    def _report(self, followed: int, known_at: float) -> list[Event]:
        """Return the events by which what was reported changes with the newest block.

        `followed` is the newest block of the report before. When that one, the newest block and the sequence all show
        the same activity, it goes on; otherwise every block that is not in the sequence yet is judged again."""
        best, chain = self.hypotheses.best, self._model.chain
        newest = NO_ACTIVITY if best is None or not best.path else best.path[-1]
        levels = None if best is None else best.ride.levels
        t, shown = self._time(self.newest_block), self._show(self.newest_block)
        early = [(newest, 1.0)]
        follow_block(early, t, shown, levels, chain)
        is_same = early[-1][0].activity is newest.activity and self.early[-1][0].activity is newest.activity
        if shown is None or followed != self.newest_block - 1 or not is_same:
            early = [(newest, 1.0)]
            for index in range(max(self.next_block, self.newest_block + 1 - WINDOW_REACH), self.newest_block):
                follow_block(early, self._time(index), self._show(index), levels, chain)
            follow_block(early, t, shown, levels, chain)
        self.early = early
        return self._report_early(known_at)

    def _show(self, index: int) -> BlockSigns | None:
        """Return what a block shows, with as many later blocks as there are; None without samples."""
        features = self._features(index)
        if all([one is None for one in features]):
            return None
        return motion_votes(self._model, features), ElevatorEvidence(self._forces(index))

    def _report_early(self, known_at: float) -> list[Event]:
        """Return the events by which what was reported changes with the newest stride."""
        early = [*self.early]
        if self.stride_cue is not None and self.stride_cue[0] > self.newest_block:
            follow(early, self._time(self.stride_cue[0]), self.stride_cue[1:], self._model.chain)
        return self.report.add(self.hypotheses, early[1:], self._time(self.next_block), known_at)

    def _add_stride(self, stride: StrideTaken, block: int) -> None:
        """Keep a stride that ends in a block for `flights`, and the cue of its slope."""
        self.walked = True
        self.strides.append(FlightStride.of(stride))
        del self.strides[:-MAX_WAITING_STRIDES]
        length, rise = min(stride.length, MAX_LENGTH), max(-MAX_RISE, min(MAX_RISE, integrated_rise(stride)))
        self.report.strides.add(stride, length, rise)
        cue = cue_of_stride(slope_evidence(length, rise))
        if cue is not None:
            self.stride_cue, self.waits = (block, *cue), stride.known_at

    def _time(self, index: int) -> float:
        return (self.origin or 0.0) + index * BLOCK_DURATION

    def _restart(self) -> None:
        self.origin = None
        self.next_block = 0
        self.pressure_height, self.walked = None, False
        self.hypotheses = Hypotheses()
        self.report, self.newest_block, self.stride_cue = ActivityReport(), -1, None
        self.waits = None
        self.early = [(NO_ACTIVITY, 1.0)]

    def _count_flights(self, t: float, known_at: float) -> list[Event]:
        """Pass the strides up to the newest judged block to `flights`, with the activity at the middle of each."""
        t_judged = self._time(self.next_block)
        best = self.hypotheses.best
        events: list[Event] = []
        while self.strides and 0.5 * (self.strides[0].t_start + self.strides[0].t_end) < t_judged:
            stride = self.strides.pop(0)
            middle = 0.5 * (max(stride.t_start, stride.t_end - MAX_STRIDE_TIME) + stride.t_end)
            activity = None if best is None else activity_at(best.path, middle, None)
            if activity not in GAITS:
                activity = self.report.strides.gait(stride.t_start, stride.t_end)
            direction = STAIR_DIRECTIONS.get(activity, 0)
            events += self.flights.add_stride(stride, direction, known_at)
        return events + self.flights.advance(t, known_at)
