"""Place of the wearer on a floor plan: the particle filter, which the Snake game shares but for its motion.

The shape of the track is known, but its position and heading in the plan are not. Stairs, elevators and a known start
give a position. Walls do the rest: a placement of the track that leads through walls is wrong (Liu et al. 2015, section
IV.E). Stairs and elevators lead to another level and end where the plan has them.

The track itself is not changed. Latency: a place is reported with the stride that leads there; references.py has the
latency of a level."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise, repeat
from math import atan2, cos, dist, exp, fsum, hypot, isfinite, pi, sin, sqrt

from ..body.fuse.common_error import LEAST_WAY, POSITION_GATE
from ..body.part import MOVEMENTS, Inputs, Outputs, Part, PartInput, StartGiven
from ..events import (
    Event,
    Placed,
    PlaceLost,
    PositionRejected,
    PositionReported,
    StrideTaken,
    TrackRevised,
    TurnMade,
    WearerMoved,
)
from ..floorplan.index import IndexedPlan
from ..floorplan.plan import ConnectorKind, FloorPlanError, Point, Start
from ..foot.view import FootView
from ..types import Foot, Vec3
from ..types.attrs import NOT_SAVED, evolve, state, stateful
from .headings import ANY_HEADING_SHARE, START_HEADING_ERROR, Heading, KnownHeading
from .levels import (
    EXIT_ERROR,
    LEAST_REVISED_SHARE,
    contradicted_height,
    entering,
    hold_alike_levels,
    landings_of,
    leaving,
    levels_on_the_way,
    place_near,
    shares_of_levels,
    weights_of_exits,
)
from .particles import (
    MAX_MOVE,
    NOISE_ENTRIES,
    NOISE_TABLE,
    Cloud,
    Noise,
    Particle,
    after_wrong_turn,
    at_most,
    candidates_of,
    effective_count,
    have_not_moved,
    move_across_gap,
    next_random,
    resample,
    scaled,
    stored,
    sway,
    total_weight,
    turned,
)
from .references import FAIR_CERTAINTY, HEIGHT_ERROR, LevelChangePossible, LevelReached, References

MAX_PARTICLES = 260
"""Largest number of particles that are kept."""
KNOWN_PARTICLES = 64
"""Number of particles that are kept when the place is known."""
PARTICLES_PER_CANDIDATE = 30
"""Number of additional particles that are kept for each candidate but the heaviest; fewer for a weight below 0.1.

Without a start, three of 25 emulated walks with insoles lose the true place with 20, one with 30; 60 gain nothing."""
ONE_CANDIDATE_SPREAD = 1.5
"""Largest rms deviation of the places of all particles at which they form one candidate, m."""
MAX_JUMP = 100.0
"""Longest move of the track between two positions that is used, m."""
DEGRADED_FACTOR = 1.5
"""Factor of the errors of a degraded stride (mostly a clipped peak, rarely a gap), and of moves that follow a climb."""
MAX_STRIDES_OUTSIDE = 6
"""Number of strides outside of the plan after which the place is lost."""
OUTSIDE_INTERVAL, OUTSIDE_WEIGHT = 4, 0.25
"""Number of strides between two checks for particles outside of the plan, and the factor of their weight in each."""
MAX_STUCK_DISTANCE = 5.0
"""Length of track that no particle could follow after which the place is lost, m."""
ABOUT_TURN_ANGLE = 2.0
"""Least turn whose angle may be very wrong, rad, because a turn on the spot exceeds the range of many gyroscopes."""
ABOUT_TURN_STRIDES = 12
"""Number of strides after an about-turn in which all particles are kept, until the walls have decided its angle."""
ABOUT_TURN_SPREAD = 0.5
"""Largest rms deviation of the places that form one candidate during `ABOUT_TURN_STRIDES`, m."""
MIN_CLEAR_WEIGHT, FADE_FACTOR, FADE_RADIUS = 0.9, 0.88, 3.0
"""Least weight of a clear candidate; factor of the weight of particles on other levels; their distance from it, m.

When a candidate is clear, each stride reduces the weight of particles at the same place on other levels: walls do not
remove them where floors are equal, and `hold_alike_levels` keeps their share of the weight in each move."""
MAX_START_SPREAD, SPREAD_FACTOR = 20.0, 1.2
"""Largest rms error of a start place that is used, m, and ratio of the largest error on each axis to the rms error."""
START_STRETCH_ERROR = 0.05
"""Largest deviation of the stretch of a new particle from 1."""
MIN_LANDING_SHARE = 0.02
"""Least weight of the particles at exits, as a share of the others'; with less, particles were at wrong places."""
STAYING_SHARE = {ConnectorKind.STAIRS: 0.85, ConnectorKind.LIFT: 0.5}
"""Share of the weight that particles at wrong places keep, as level walking may have been reported as stairs."""
MIN_CERTAINTY = 0.3
"""Least certainty of an arrival after which the wearer may be at any landing of the plan."""
CONTRADICTED_CERTAINTY = 0.5
"""Certainty of an arrival by a ride that contradicts the plan: the wearer may be where they were."""
EXIT_TIMES = {ConnectorKind.STAIRS: (0.0, 0.4, 0.8), ConnectorKind.LIFT: (0.0,)}
"""Times before an arrival at which the wearer may have left the landing, s.

Stairs end with the end of the stride that leads from them, so that the wearer is up to a stride beyond the landing:
0.3 to 1.7 m in emulated walks. A lift ends with its stop, when the wearer stands in it."""
RESTARTS = (8, 16)
"""Numbers of strides of both feet after a first arrival at which particles start again: about 5 and 10 m of walking.

The positions of the track that are kept reach back to the arrival until then (`MAX_TRACK_POSITIONS`)."""
RESTARTED_PARTICLES = 600
"""Number of particles that start again, over all exits.

When none start again, one of 25 emulated walks loses its place at the first turn. That walk keeps it with 300, 600 and
1500 particles, and with three times instead of two. 600 take some 40 ms of a processor at the first of `RESTARTS`,
80 ms at the second."""
PARTICLE_SIGMA = 1.0
"""Standard deviation of the place of a particle on each axis, m, because there are few."""
REPORTED_SHARE = 0.1
"""Share of all weight that a report gets which no particle agrees with; the next report decides."""
NOWHERE_NEAR = 1e5
"""Distance of a report from the nearest particle on its level when there is none, m."""

SCALE_GAIN = 0.06
"""Gain of the low-pass filter of the scale of strides for one comparison."""
MIN_DISTANCE, MAX_STRIDE_LENGTH = 0.5, 3.0
"""Least distance that is compared, m (less is not walking), and longest plausible stride, m."""
MAX_TURN = 0.3
"""Largest turn of a foot in a stride that is compared, rad: a bend is longer than its chord."""
MIN_RATIO, MAX_RATIO = 0.8, 1.6
"""Least and largest ratio of stride length to distance that is used."""


@stateful
class StrideScale:
    """Scale of the wearer's path: the ratio of the feet's stride lengths to the moves of the mean of both tracks.

    The headings of the two feet's tracks drift apart. The mean of two tracks that diverge is shorter than either, by a
    quarter at an angle of 80 degrees, while the stride lengths do not change. Therefore the distance between two stride
    ends of one foot on the mean track is compared with the mean length of this stride and the other foot's last one."""

    factor: float = 1.0
    """Factor of the wearer's moves."""
    last: dict[Foot, tuple[float, float, float]] = state(factory=dict)
    """Last stride of each foot: position of the wearer after it, m, and stride length, m."""

    def add_stride(self, stride: StrideTaken, here: Vec3) -> None:
        """Add a stride of a foot; `here` is the wearer's position after it, m."""
        this = self.last.pop(stride.foot, None)
        if not stride.length < MAX_STRIDE_LENGTH:
            return
        if this is not None and self.last and abs(stride.heading_change) < MAX_TURN:
            ((_, _, other),) = self.last.values()
            distance, mean_stride = hypot(here[0] - this[0], here[1] - this[1]), 0.5 * (stride.length + other)
            if distance > MIN_DISTANCE and MIN_RATIO * distance < mean_stride < MAX_RATIO * distance:
                self.factor += SCALE_GAIN * (mean_stride / distance - self.factor)
        self.last[stride.foot] = (here[0], here[1], stride.length)


@stateful
class Particles(Part):
    """The particle filter, the default method of every recipe."""

    notices = (StartGiven,)
    needs_position = True

    particles: Cloud = state(factory=list)
    """The particles, at most `MAX_PARTICLES`."""
    random: int = 1
    """State of the random numbers."""
    plan: IndexedPlan | None = state(default=None, eq=False, repr=False, metadata=NOT_SAVED)
    """The floor plan; it is not saved, and is set when a session is made or restored."""
    pending_events: list[Event] = state(factory=list)
    """Events since the wearer's last position."""
    place: Placed | None = None
    """Place of the wearer on the plan; None while it is not known."""
    start: Start | None = None
    last_place: Point = (0.0, 0.0)
    """Newest position of the track that was used, m, world frame."""
    references: References = state(factory=References)
    stride_scale: StrideScale = state(factory=StrideScale)
    known: KnownHeading = state(factory=KnownHeading)
    stride_count: int = 0
    """Number of strides since the last check for particles outside of the plan."""
    strides_outside: int = 0
    """Number of strides since the place was last within the plan."""
    wide_strides: int = 0
    """Number of further strides in which all particles are kept."""
    stuck_distance: float = 0.0
    """Length of track since a particle could move, m."""
    rejected: tuple[Point, Point] | None = None
    """Newest rejected place of a report, plan frame, and where the track was, world frame, m; None after one fitted."""
    arrival: LevelReached | None = None
    """Newest arrival on another level, as far as it is known; None before any."""
    entered: dict[int, float] = state(factory=dict)
    """Weights of the landings from which it may have been reached, by index; empty for any."""
    level_uncertain: bool = False
    """Flag: the level depends on the reported direction of stairs, which is often wrong."""
    is_undecided: bool = False
    """Flag: it is the first arrival, or one shortly after it, and its exits are not decided."""
    strides_since: int = 0
    """Number of strides on the level since the newest arrival while it is undecided."""
    has_turned: bool = False
    """Flag: the wearer has turned about since then, by an angle that may be wrong, so that no particles start again."""
    unmapped: Cloud = state(factory=list)
    """Particles that were in a lift when it went to where the plan has no landing; empty if it did not."""
    unmapped_height: float = 0.0
    """Height of all rides since then, m, upwards."""

    def _draw(self) -> int:
        """Return a random number."""
        self.random = next_random(self.random)
        return self.random

    # How particles move, are made and are thinned out: another method has its own.

    def extend(self, plan: IndexedPlan, particles: Cloud, move: Point, error_factor: float, turn: float) -> Cloud:
        """Return the particles after a move of the track, m, without those for which the plan forbids it.

        `error_factor` is a factor of the track's usual errors, `turn` the size of the wearer's turn, rad."""
        return sway(plan, particles, move, error_factor, turn, self._draw())

    def scatter(self, k: int, count: int) -> Noise:
        """Return offsets for the k-th of `count` new particles, each from -1 to 1: x, y, heading, stretch."""
        return NOISE_TABLE[k % NOISE_ENTRIES]

    def thin(self, particles: Cloud, count: int) -> Cloud:
        """Return about `count` particles that represent the distribution of all."""
        return resample(particles, count, (self._draw() % 4093) / 4093.0)

    def set_particles(self, particles: Cloud) -> None:
        """Set the particles, thinned to the largest number that may be kept."""
        self.particles = stored(self._limited(particles))

    def _limited(self, particles: Cloud) -> Cloud:
        return particles if len(particles) <= MAX_PARTICLES else self.thin(particles, MAX_PARTICLES)

    def _move(self, plan: IndexedPlan, particles: Cloud, move: Point, error_factor: float, turn: float) -> Cloud:
        """Return all particles after a move of the track, m."""
        # on stairs a particle follows the track, because the walls of neither level apply
        moved = [one.at(*one.after(move)) for one in particles if one.landing]
        walking = [one for one in particles if not one.landing] if moved else particles
        if hypot(*move) > MAX_MOVE:
            walking = at_most(MAX_PARTICLES, move_across_gap(plan, walking, move, self._draw()))
        elif walking:
            walking = self.extend(plan, walking, move, error_factor, turn)
        return moved + walking

    def _spread(
        self,
        plan: IndexedPlan,
        level: int,
        place: Point,
        error: float,
        heading: Heading | None,
        count: int,
        weight: float = 1.0,
        origin: int = 0,
    ) -> Cloud:
        """Return `count` particles around a place with an rms error, m, in all headings when `heading` is None."""
        radius = min(max(error, 0.0), MAX_START_SPREAD) * SPREAD_FACTOR
        particles: Cloud = []
        for k in range(count):
            ex, ey, eh, es = self.scatter(k, count)
            turn = 2.0 * pi * (k + 0.5 * eh) / count if heading is None else heading[0] + heading[1] * eh
            x, y = place_near(plan, level, place, (radius * ex, radius * ey))
            stretch = 1.0 + START_STRETCH_ERROR * es
            particles.append(Particle(x, y, stretch * cos(turn), stretch * sin(turn), weight / count, level, origin))
        return particles

    # Events.

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        """Hold events back until the wearer's position after them is known, and return the place then."""
        return [output for event in events for output in self._receive(event)]

    def _receive(self, event: PartInput) -> Outputs:
        if isinstance(event, MOVEMENTS):
            self.pending_events.append(event)
        elif isinstance(event, WearerMoved) and self.plan is not None:
            events, self.pending_events = self.pending_events, []
            return self.follow(self.plan, events, event)
        elif isinstance(event, PositionReported) and event.position is not None and event.level and self.plan:
            return self._use_report(self.plan, event, event.position)
        elif isinstance(event, StartGiven):
            self.start = event.start
            if event.start.heading is not None:
                self.known.give(event.start.heading)
        elif isinstance(event, TrackRevised):
            self._revise_track(event)
        return ()

    def _revise_track(self, event: TrackRevised) -> None:
        """Move and turn what belongs to the track with it; the particles stay where they are on the plan."""
        (dx, dy), (x, y) = event.by, self.last_place
        self.last_place = (x + dx, y + dy)
        self.references.move(event.by)
        self.known.turn(event.turn)
        self.stride_scale.last.clear()
        self.particles, self.unmapped = turned(self.particles, event.turn), turned(self.unmapped, event.turn)
        if self.rejected is not None:
            place, (x, y) = self.rejected
            self.rejected = (place, (x + dx, y + dy))

    def follow(self, plan: IndexedPlan, events: list[Event], here: WearerMoved) -> list[Event]:
        """Take events after which the wearer is at `here`, and return the place; never raises."""
        if not all([isfinite(v) for v in (here.t, *here.position)]):
            return []
        outputs: list[Event] = []
        known_at, track = max([here.t, *[event.known_at for event in events]]), self.references.track
        if not track:
            self.known.since = here.t
            outputs += self._start_at(plan, here, known_at)
        elif here.t < track[-1][0] - 1.0:
            self.references.reset()
            self.arrival, self.known.since, self.unmapped, self.is_undecided = None, here.t, [], False
        self.particles = self.known.update(plan.plan, here, self.particles)
        strides = [event for event in events if isinstance(event, StrideTaken)]
        for stride in strides:
            self.stride_scale.add_stride(stride, here.position)
        if strides:
            outputs += self._follow_strides(plan, here, strides, known_at)
            self._start_again(plan)
        for event in events:
            if isinstance(event, TurnMade) and abs(event.angle) > ABOUT_TURN_ANGLE and self.particles:
                wrong = after_wrong_turn(plan, self.particles, self._displacement_since(event.t))
                self.set_particles(self.particles + wrong)
                self.wide_strides, self.has_turned = ABOUT_TURN_STRIDES, True
        levels = frozenset([particle.level for particle in self.particles])
        references = self.references.update(plan, events, here, levels)
        for reference in references:
            match reference:
                case LevelChangePossible():
                    staying = self._staying()
                    self.set_particles(staying + self._entering(plan, staying, reference))
                case LevelReached(is_revision=True):
                    self._revise_arrival(plan, reference)
                case LevelReached():
                    outputs += self._arrive(plan, reference, known_at)
                case _:
                    self.particles = stored(self._staying())
        if self.particles and (strides or any([isinstance(one, LevelReached) for one in references])):
            outputs += self.known.find_contradiction(self.particles, here.t, known_at)
            outputs.append(self._report_place(plan, here, known_at))
        return outputs

    def _start_at(self, plan: IndexedPlan, here: WearerMoved, known_at: float) -> list[Event]:
        """Start where the app has said, and return the reason if that is not possible."""
        start, (x, y, _) = self.start, here.position
        if self.particles:
            self.last_place = (x, y)
            return []  # a person has said where the wearer is
        if start is not None and start.place is not None:
            what = start_error(plan, start)
            if what is None:
                level, heading = plan.number(start.level), self.known.heading
                count = MAX_PARTICLES if start.heading is None else 2 * KNOWN_PARTICLES
                self.particles = stored(self._spread(plan, level, start.place, start.spread, heading, count))
                return []
        else:
            rest = " and the plan has neither stairs nor lifts: the place cannot be known"
            if plan.plan.connectors:
                rest = ", so the place is not known before the first stairs or lift"
            what = f"no {'start' if start is None else 'place of the start'} was given{rest}"
        self.last_place = (x, y)
        return [self._lose(here, known_at, what)]

    def _displacement_since(self, t: float) -> Point:
        """Return the displacement of the track since `t`, s, in m."""
        (x, y, _), k = self.references.position_at(t), self.stride_scale.factor
        return (self.last_place[0] - x) * k, (self.last_place[1] - y) * k

    def _follow_strides(
        self, plan: IndexedPlan, here: WearerMoved, strides: list[StrideTaken], known_at: float
    ) -> list[Event]:
        """Move all particles with the track since the last stride, and return an event if none can."""
        (x, y, _), (x0, y0), before, k = here.position, self.last_place, self.particles, self.stride_scale.factor
        self.last_place = (x, y)
        if not (abs(x - x0) < MAX_JUMP and abs(y - y0) < MAX_JUMP):
            lost = self._lose(here, known_at, f"the track leaps by more than {MAX_JUMP:.0f} m")
            return [lost] if before else []
        if not before:
            return []
        move, placed = ((x - x0) * k, (y - y0) * k), self.place
        # both feet make a turn of the wearer: half of each stride's turn counts
        turn = min(0.5 * fsum([abs(stride.heading_change) for stride in strides]), pi)
        error_factor = DEGRADED_FACTOR if any([bool(stride.flaws) for stride in strides]) else 1.0
        particles = self._move(plan, before, move, error_factor, turn)
        if placed is not None:
            particles = hold_alike_levels(plan, before, particles, move, placed)
        self.stride_count = (self.stride_count + 1) % OUTSIDE_INTERVAL
        if self.stride_count == 0:
            there = [one.landing or plan.inside(one.level, one.x, one.y) for one in particles]
            particles = scaled(particles, [1.0 if inside else OUTSIDE_WEIGHT for inside in there])
        self.stuck_distance = self.stuck_distance + hypot(*move) if have_not_moved(particles, before) else 0.0
        self.particles = stored(particles) if self.stuck_distance <= MAX_STUCK_DISTANCE else []
        if self.particles:
            return []
        what = "the track goes where the plan has no way"
        if placed is not None:
            what += f" near ({placed.position[0]:.1f}, {placed.position[1]:.1f}) on level {placed.level}"
        return [self._lose(here, known_at, what)]

    def _lose(self, here: WearerMoved, known_at: float, what: str) -> PlaceLost:
        """Lose the place, and return the event that says why."""
        self.particles, self.unmapped, self.place, self.strides_outside, self.stuck_distance = [], [], None, 0, 0.0
        return PlaceLost(t=here.t, known_at=known_at, what=what)

    def _report_place(self, plan: IndexedPlan, here: WearerMoved, known_at: float) -> Event:
        """Return the place after a stride or an arrival, and keep as many particles as it needs."""
        particles = self.particles
        with_levels, heights = levels_on_the_way(plan, particles, self.references.passage, here)
        limit = ONE_CANDIDATE_SPREAD if self.wide_strides == 0 else ABOUT_TURN_SPREAD
        height = None if plan.plan.heights_known else here.position[2]
        candidates, spread = candidates_of(with_levels, plan.plan, heights, height, limit)
        heaviest, others = candidates[0], candidates[1:]
        (x, y, _), level = heaviest.position, plan.number(heaviest.level)
        self.strides_outside = 0 if others or plan.inside(level, x, y) else self.strides_outside + 1
        if self.strides_outside >= MAX_STRIDES_OUTSIDE and self.references.passage is None:
            what = f"the track leaves the plan near ({x:.1f}, {y:.1f}) on level {heaviest.level}"
            return self._lose(here, known_at, what)
        # one candidate: 8 more particles for each metre of spread
        more = PARTICLES_PER_CANDIDATE * fsum([min(1.0, 10.0 * one.weight) for one in others])
        count = min(MAX_PARTICLES, KNOWN_PARTICLES + int(more if others else 8.0 * min(spread, 5.0)))
        if self.wide_strides > 0:
            self.wide_strides, count = self.wide_strides - 1, MAX_PARTICLES
        is_wide = self.wide_strides > 0
        is_small = len(particles) <= 1.25 * count and (is_wide or effective_count(particles) >= 0.5 * count)
        if heaviest.weight >= MIN_CLEAR_WEIGHT and others and not is_wide and not self.level_uncertain:
            fades = [one.level != level and dist(one[:2], (x, y)) < FADE_RADIUS for one in with_levels]
            particles = scaled(particles, [FADE_FACTOR if fade else 1.0 for fade in fades])
            self.particles = stored(particles)
        if not is_small:
            self.particles = stored(self.thin(particles, count))
        self.place = Placed(
            t=here.t,
            known_at=known_at,
            level=heaviest.level,
            position=heaviest.position,
            room=plan.room(level, x, y),
            door=plan.door(level, x, y),
            spread=spread,
            candidates=candidates,
        )
        return self.place

    # Changes of level.

    def _staying(self) -> Cloud:
        """Return the particles that do not change level; if all do, all as if there were no change."""
        particles = self.particles
        return [one for one in particles if not one.landing] or [one._replace(landing=0) for one in particles]

    def _arrive(self, plan: IndexedPlan, arrived: LevelReached, known_at: float) -> Sequence[Event]:
        """Arrive on another level, and return an event if the plan has no such ride."""
        height = (1.0 if arrived.up else -1.0) * (arrived.height or 0.0)
        if self.unmapped and arrived.kind is ConnectorKind.LIFT and arrived.height is not None:
            height += self.unmapped_height
            whole = evolve(arrived, up=height > 0.0, height=abs(height))
            is_back = abs(height) < HEIGHT_ERROR
            if is_back or not contradicted_height(plan, whole, self.unmapped, known_at):
                self._come_back(plan, whole, is_back)
                return []
            self.unmapped_height = height
        wrong = contradicted_height(plan, arrived, self.particles, known_at)
        if not wrong:
            self.unmapped = []
        elif not self.unmapped and arrived.height is not None:
            riders = [one for one in self.particles if one.landing] or self._entering(plan, self.particles, arrived)
            self.unmapped = stored(at_most(KNOWN_PARTICLES, riders))
            self.unmapped_height = height
        certainty = CONTRADICTED_CERTAINTY if wrong else arrived.certainty
        self._continue_from_exits(plan, evolve(arrived, certainty=certainty))
        return wrong

    def _entering(self, plan: IndexedPlan, particles: Cloud, change: LevelChangePossible | LevelReached) -> Cloud:
        return entering(plan, particles, change.kind, self._displacement_since(change.t_start))

    def _come_back(self, plan: IndexedPlan, whole: LevelReached, is_back: bool) -> None:
        """Continue the particles of a lift that stopped between landings, after the rest of its way or back."""
        riders, self.unmapped = self.unmapped, []
        random = self._draw()
        found = [one._replace(landing=0) for one in riders] if is_back else leaving(plan, riders, whole, random)
        others = resample([one._replace(landing=0) for one in self.particles], KNOWN_PARTICLES)
        weight, other_weight = total_weight(found), total_weight(others)
        k = FAIR_CERTAINTY / (1.0 - FAIR_CERTAINTY) * other_weight / weight if weight and other_weight else 1.0
        self.set_particles(self._move_from_exits(plan, scaled(found, repeat(k)), whole) + others)

    def _continue_from_exits(self, plan: IndexedPlan, arrived: LevelReached) -> None:
        """Continue each particle that may have changed level from its exits, and keep those that stayed."""
        if all([landing.kind is not arrived.kind for landing in plan.landings]):
            return
        staying, kinds = self._staying(), {landing.index: landing.kind for landing in plan.landings}
        changing = [one for one in self.particles if kinds.get(one.landing) is arrived.kind]
        changing = changing or self._entering(plan, staying, arrived)
        total = total_weight(staying)
        found = leaving(plan, changing, arrived, self._draw())
        k = arrived.certainty / (1.0 - arrived.certainty)
        if total_weight(found) > MIN_LANDING_SHARE * total:
            self.level_uncertain, self.entered = False, landings_of(changing)
        elif arrived.certainty > MIN_CERTAINTY:
            self.entered = {}
            found = self._spread_over_exits(plan, arrived, MAX_PARTICLES)
            self.is_undecided = self.known.heading is None and not staying
            self.level_uncertain = arrived.kind is ConnectorKind.STAIRS
            weight, share = total_weight(found), 1.0 - STAYING_SHARE[arrived.kind]
            k = total * share / (1.0 - share) / weight if weight > 0.0 and total > 0.0 else 1.0
        else:
            self.particles = stored(staying)
            return
        self.arrival, self.strides_since, self.has_turned = arrived, 0, False
        found = scaled(found, repeat(k))
        found = self._move_from_exits(plan, self._limited(found), arrived) + resample(staying, KNOWN_PARTICLES)
        self.set_particles(found or self.particles)

    def _spread_over_exits(self, plan: IndexedPlan, arrived: LevelReached, most: int) -> Cloud:
        """Return about `most` particles, spread over all exits that `arrived` allows and over all headings.

        With a known heading of the track, half of them have it, and nearly all of the weight."""
        heading = self.known.heading
        weights = weights_of_exits(plan, self.entered, arrived)
        roots = fsum([sqrt(weight) for weight in weights.values()])
        particles: Cloud = []
        for index, share in weights.items():
            landing, count = plan.landings[index - 1], max(int(most * sqrt(share) / roots), 8)
            at = (plan, landing.level, landing.place, EXIT_ERROR)
            if heading is not None:
                count, known = count // 2, share * (1.0 - ANY_HEADING_SHARE)
                particles += self._spread(*at, heading, count, known, landing.connector + 1)
                share *= ANY_HEADING_SHARE
            particles += self._spread(*at, None, count, share, landing.connector + 1)
        return particles

    def _revise_arrival(self, plan: IndexedPlan, revised: LevelReached) -> None:
        """Weigh the levels to which the newest arrival may have led by what is known of it now."""
        if self.arrival is None or self.arrival.t_start != revised.t_start:
            return
        before, now = [shares_of_levels(plan, self.entered, one) for one in (self.arrival, revised)]
        factors = {level: max(now.get(level, 0.0), LEAST_REVISED_SHARE) / share for level, share in before.items()}
        self.particles = stored(scaled(self.particles, [factors.get(one.level, 1.0) for one in self.particles]))
        self.arrival = revised

    def _start_again(self, plan: IndexedPlan) -> None:
        """Start particles from all exits again after a stride, if the first arrival is not decided.

        Particles of all exits and all headings are many, and few of them have the true heading, so that the true one
        may have only particles whose stretch is wrong. The walls of the first metres exclude most headings. Therefore,
        some strides later, many particles start once more from all exits, follow the track since then, and those that
        the walls leave are kept. They are alive only while this takes place; then their number is what the recipe
        keeps."""
        first = self.arrival
        if first is None or not self.is_undecided or landings_of(self.particles):
            return
        self.strides_since += 1
        if not self.particles or self.strides_since >= RESTARTS[-1]:
            self.is_undecided = False
        is_followed = bool(self.particles) and not self.has_turned and self.references.reach_back_to(first.t)
        if self.strides_since in RESTARTS and is_followed:
            particles = self._spread_over_exits(plan, first, RESTARTED_PARTICLES)
            self.set_particles(self._move_from_exits(plan, particles, first) or self.particles)

    def _move_from_exits(self, plan: IndexedPlan, particles: Cloud, arrived: LevelReached) -> Cloud:
        """Return particles at exits moved along the track up to now; they left at different times until `arrived.t`."""
        moved: Cloud = []
        times, k = EXIT_TIMES[arrived.kind], self.stride_scale.factor
        for first, dt in enumerate(times):
            some = particles[first :: len(times)]
            for (x, y, _), (x1, y1, _) in pairwise(self.references.path_since(arrived.t - dt)):
                move = ((x1 - x) * k, (y1 - y) * k)
                if some and move != (0.0, 0.0) and hypot(*move) < MAX_JUMP:
                    some = self._move(plan, some, move, DEGRADED_FACTOR, 0.0)
            moved += some
        return moved

    # Reports of a person.

    def _use_report(self, plan: IndexedPlan, event: PositionReported, place: Point) -> list[Event]:
        """Weigh the particles by the likelihood of a place that a person reports, m, or return why it is rejected.

        Before the first position, the app's start counts. If there are no particles, those there are the first ones. If
        one agrees with the report, those on other levels are dropped; on stairs they have no level. If none agrees, a
        few are added there with little weight. A place near the one that was rejected on the spot just before is
        rejected again, and nothing is added."""
        if not self.references.track and self.start is not None and self.start.place is not None:
            return []
        fault = start_error(plan, Start(event.level, place))
        if fault is not None:
            return self._reject(event, place, 0.0, fault.removeprefix("start: "))
        level, sigma, particles = plan.number(event.level), max(event.sigma, EXIT_ERROR), self.particles
        variance = sigma * sigma + PARTICLE_SIGMA * PARTICLE_SIGMA
        there = [one for one in particles if one.level == level or one.landing]
        distances = [dist(one[:2], place) for one in there]
        distance, again = min(distances, default=NOWHERE_NEAR), False
        if self.rejected is not None:
            before, track = self.rejected
            again = max(dist(self.last_place, track), dist(place, before)) < LEAST_WAY
        if not particles:
            self.particles = stored(self._spread(plan, level, place, sigma, self.known.heading, MAX_PARTICLES))
        elif distance * distance < POSITION_GATE * variance and not again:
            # the nearest particle keeps its weight, so that it does not become 0 by rounding
            self.particles = stored(
                scaled(there, [exp(-0.5 * (one * one - distance * distance) / variance) for one in distances])
            )
        else:
            where = f"the nearest is {distance:.0f} m away" if there else "none is on this level"
            if not again:
                sines = fsum([one.weight * one.b for one in particles])
                usual = atan2(sines, fsum([one.weight * one.a for one in particles])), START_HEADING_ERROR
                weight = REPORTED_SHARE * total_weight(particles)
                added = self._spread(plan, level, place, sigma, usual, KNOWN_PARTICLES, weight)
                self.set_particles(particles + added)
            what = (
                "the track may have led to several places on the plan, but not to this one: "
                f"{'it was rejected just before' if again else where}. If it is right, report another place further "
                "on: two that agree are believed"
            )
            return self._reject(event, place, distance, what)
        self.rejected, self.unmapped, self.is_undecided = None, [], False
        return []

    def _reject(self, event: PositionReported, place: Point, distance: float, what: str) -> list[Event]:
        self.rejected = (place, self.last_place)
        return [PositionRejected(t=event.t, known_at=event.known_at, distance=distance, sigma=event.sigma, what=what)]


def start_error(plan: IndexedPlan, start: Start) -> str | None:
    """Return the reason why `start` is impossible, one sentence; None when it is possible or has no place."""
    if start.place is None:
        return None
    try:
        level = plan.number(start.level)
    except FloorPlanError as error:
        return f"start: {error}"
    if not plan.inside(level, *start.place):
        x, y = start.place
        return f"start: ({x:g}, {y:g}) is nowhere on level {start.level}: no room or corridor of the plan is there"
    return None
