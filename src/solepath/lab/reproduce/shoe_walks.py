"""Walks of one wearer of the shoe-sensing experiments: walking, jogging, up and down the stairs, five minutes.

One MPU-6050 sits on the laces of the right shoe and samples at 100 Hz without a wire. Every walk has another part and
other footsteps."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees, hypot, radians

import numpy as np
from attrs import evolve, frozen

from ...body.activity.steepness import angle_per_metre, steepness
from ...emulate.routes.route import Route
from ...emulate.sensors.parts import MPU6050
from ...emulate.wearers.shoe import ON_INSTEP
from ...emulate.wearers.truth import TrueStride, Truth
from ...emulate.wearers.walker import Walker
from ...events import Event, FlightClimbed, StrideTaken
from ...papers.shoe_sensing.gated_tilt import ShoeSensing, ShoeSensingSettings
from ...papers.shoe_sensing.recipe import SHOE_MAGNITUDE, SHOE_SENSING
from ...types import Foot, Sample
from ..measures.alignment import Floats, align, distances
from ..measures.matching import pairs
from ..measures.strides import ALIGNMENT_LENGTH
from .walks import align_track, run_session, thin_out

FOOT = Foot.RIGHT
"""Foot that wears the sensor ("attached to one of the user's shoes"); the side is assumed."""
WALKING, JOGGING = 1.0, 2.1
"""Walking and jogging speed, m/s (assumed): strides of about the paper's 1.20 m and 1.60 m."""
STEPS = 100
"""Number of strides of each level walk (section 4.2.3)."""
STRAIGHT = 19.2
"""Length over which a heading is compared, m (section 4.2.5)."""
RISERS = 11
"""Number of steps in a flight (assumed); 0.16 m by 0.30 m each, as the paper's."""
LAPS = 2
"""Number of rounds of the corridors of each storey, for five minutes in all."""
SAME = 0.3
"""Largest time between the ends of a stride and its true one, s."""
STATES = ("walking", "jogging", "upstairs", "downstairs")
LAST = 9
"""Number of strides at the end whose directions give the heading error."""
TO_HALT = 1.5
"""Length of the partial strides at the start and end of a walk, in whole strides."""


@frozen
class StrideErrors:
    """Strides of one session on one walk, compared with the truth.

    By true stride that was found: `angles` (degrees/m), pairs of error and true value of length and of height (m),
    `courses` (error of the direction, degrees, over the first 19.2 m), `right` (whether the state is right) and `late`
    (start less the true start, s). `found`, `not_found` and `invented` are numbers of strides. `height` is the height
    error of the track over the whole walk, m."""

    angles: tuple[float, ...]
    lengths: tuple[tuple[float, float], ...]
    heights: tuple[tuple[float, float], ...]
    courses: tuple[float, ...]
    right: tuple[bool, ...]
    late: tuple[float, ...]
    found: int
    not_found: int
    invented: int
    height: float

    @property
    def merged(self) -> int:
        """Number of strides that were reported as one with the stride before, whose end was not found."""
        return sum([late < -SAME for late in self.late])

    @property
    def split(self) -> int:
        """Number of strides that were reported in two pieces, of which the last counts as found."""
        return sum([late > SAME for late in self.late])

    @property
    def whole(self) -> tuple[float, ...]:
        """Length errors of the strides that are neither merged nor split, m."""
        both = zip(self.lengths, self.late, strict=True)
        return tuple(error for (error, _), late in both if abs(late) <= SAME)

    @property
    def judged_right(self) -> float:
        """Percentage of strides whose state is right."""
        return 100.0 * sum(self.right) / max(1, len(self.right))

    @property
    def extracted(self) -> float:
        """F1 of the strides, per cent: twice those found over all true and all reported ones."""
        return 100.0 * self.found / max(1.0, self.found + 0.5 * (self.not_found + self.invented))


@frozen
class TourErrors:
    """A walk of five minutes in a building, compared with the truth."""

    off: float
    """Horizontal error of the end, m."""
    way: float
    """Length of the true path along the floor, m."""
    heading: float
    """Error of the direction of the last strides, degrees."""
    height: float
    """Height error of the end, m."""
    reported: tuple[bool, ...]
    """Direction of each flight that was reported: True for up."""
    true: tuple[bool, ...]
    """Direction of each flight that was climbed: True for up."""
    above: tuple[tuple[tuple[float, float], ...], tuple[tuple[float, float], ...]]
    """Estimated and true track seen from above, (x, y), m."""
    aside: tuple[tuple[tuple[float, float], ...], tuple[tuple[float, float], ...]]
    """Estimated and true track seen from the side: (distance along the floor, height), m."""


@frozen
class ShoeWalked:
    """Results of one wearer by state: by the recipe, without the elimination of heights, and by the magnitude."""

    energy: dict[str, StrideErrors]
    before: dict[str, StrideErrors]
    magnitude: dict[str, StrideErrors]
    tour: TourErrors


def route_of(state: str) -> Route:
    """Return a hundred strides on the level, or two flights with a landing between."""
    route = Route().stand(4.0)
    if state == "walking":
        return route.walk((STEPS + TO_HALT) * 1.22, WALKING).stop(2.0)
    if state == "jogging":
        return route.jog((STEPS + TO_HALT) * 1.60, JOGGING).stop(2.0)
    up = state == "upstairs"
    route = route.walk(4.0, 1.2)
    return route.stairs(RISERS, up=up).turn(radians(180), 0.7).stairs(RISERS, up=up).walk(4.0).stop(2.0)


def tour_route() -> Route:
    """Return the route of fig. 35: corridors of two storeys and the stairs between them, for five minutes."""
    route = Route().stand(4.0)
    for up in (True, False):
        for _ in range(LAPS):
            route = route.walk(19.2, 1.2).turn(radians(90), 1.0).walk(9.0).turn(radians(90), 1.0)
            route = route.walk(19.2).turn(radians(90), 1.0).walk(9.0).turn(radians(90), 1.0)
        route = route.walk(4.0)
        route = route.stairs(RISERS, up=up).turn(radians(180), 0.7).stairs(RISERS, up=up).walk(4.0)
    return route.stop(3.0)


def walked(seed: int) -> ShoeWalked:
    """Return the results of all walks of one wearer."""
    plain = evolve(SHOE_SENSING, corrector=ShoeSensing(ShoeSensingSettings(eliminate=False)))
    energy, before, magnitude = {}, {}, {}
    for k, state in enumerate(STATES):
        samples, truth = worn(route_of(state), 10 * seed + k)
        energy[state] = score_strides(run_session(SHOE_SENSING, samples), truth, state)
        before[state] = score_strides(run_session(plain, samples), truth, state)
        magnitude[state] = score_strides(run_session(SHOE_MAGNITUDE, samples), truth, state)
    return ShoeWalked(energy, before, magnitude, score_tour(10 * seed + len(STATES)))


def worn(route: Route, seed: int) -> tuple[list[Sample], Truth]:
    """Return the samples of the sensor, and the truth."""
    walker = Walker(route, seed=seed)
    return walker.samples(FOOT, 100.0, MPU6050, mounting=ON_INSTEP), walker.truth({FOOT: ON_INSTEP})


def score_strides(events: Sequence[Event], truth: Truth, state: str) -> StrideErrors:
    """Score found strides against the true ones. On stairs only strides that climb two risers count."""
    steps = [event for event in events if isinstance(event, StrideTaken)]
    together = matched(steps, truth.steps(FOOT))
    stairs = state in ("upstairs", "downstairs")
    way = {"upstairs": 1, "downstairs": -1}.get(state, 0)
    counted = [(step, true) for step, true in together if not stairs or abs(true.displacement[2]) > 0.25]
    expected = [true for true in truth.steps(FOOT) if not stairs or abs(true.displacement[2]) > 0.25]
    taken = [step for step, _ in together]
    during = [step for step in steps if not stairs or any(true.t_start < step.t < true.t_end for true in expected)]
    return StrideErrors(
        angles=tuple(degrees(angle_per_metre(step.length, step.height_change)) for step, _ in counted),
        lengths=tuple((step.length - true.length, true.length) for step, true in counted),
        heights=tuple((step.height_change - true.displacement[2], true.displacement[2]) for step, true in counted),
        courses=() if stairs else _courses(together),
        right=tuple(steepness(step.length, step.height_change) == way for step, _ in counted),
        late=tuple(step.t_start - true.t_start for step, true in counted),
        found=len(counted),
        not_found=len(expected) - len(counted),
        invented=sum([step not in taken for step in during]),
        height=steps[-1].position[2] - sum([true.displacement[2] for true in truth.steps(FOOT)]) if steps else 0.0,
    )


def matched(steps: Sequence[StrideTaken], true: Sequence[TrueStride]) -> list[tuple[StrideTaken, TrueStride]]:
    """Return pairs of a found stride and the true one that ends nearest to it, one to one."""
    ends = [one.t_end for one in true], [step.t_end for step in steps]
    return [(steps[j], true[i]) for i, j in pairs(*ends, SAME)]


def _courses(together: Sequence[tuple[StrideTaken, TrueStride]]) -> tuple[float, ...]:
    """Return the direction of each stride less the true one, degrees, after alignment over the first two metres."""
    if len(together) < 2:
        return ()
    ours = np.cumsum([step.displacement[:2] for step, _ in together], axis=0)
    true = np.cumsum([one.displacement[:2] for _, one in together], axis=0)
    far = np.linalg.norm(true, axis=1)
    ours, true = (np.vstack([np.zeros(2), track[far < STRAIGHT]]) for track in (ours, true))
    count = 2 + int(np.sum(far < ALIGNMENT_LENGTH))
    ours = align(ours[:count], true[:count]).apply(ours)
    return tuple(_directions_off(ours, true).tolist())


def _directions_off(ours: Floats, true: Floats) -> Floats:
    """Return the direction from each row to the next less the true one, degrees, in (-180, 180]."""
    angles = [np.arctan2(way[:, 1], way[:, 0]) for way in (np.diff(ours, axis=0), np.diff(true, axis=0))]
    off = angles[0] - angles[1]
    degrees_off: Floats = np.degrees(np.arctan2(np.sin(off), np.cos(off)))
    return degrees_off


def score_tour(seed: int) -> TourErrors:
    """Score the walk of five minutes with the recipe."""
    samples, truth = worn(tour_route(), seed)
    events = run_session(SHOE_SENSING, samples)
    steps = [event for event in events if isinstance(event, StrideTaken)]
    ours = np.array([(0.0, 0.0, 0.0), *(step.position for step in steps)])
    true = truth.pose(FOOT, np.array([0.0, *(step.t_end for step in steps)])).position
    true = true - true[0]
    flat = align_track(ours[:, :2], true[:, :2])
    travelled = distances(true)
    return TourErrors(
        off=hypot(*(flat[-1] - true[-1, :2])),
        way=float(travelled[-1]),
        heading=float(np.median(_directions_off(flat, true[:, :2])[-LAST:])),
        height=float(ours[-1, 2] - true[-1, 2]),
        reported=tuple(event.up for event in events if isinstance(event, FlightClimbed)),
        true=tuple(flight.up for flight in truth.flights),
        above=(thin_out(flat), thin_out(true)),
        aside=(thin_out(np.column_stack([travelled, ours[:, 2]])), thin_out(np.column_stack([travelled, true[:, 2]]))),
    )
