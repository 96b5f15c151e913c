"""Walks of one wearer of the shoe-sensing experiments: walking, jogging, up and down the stairs, five minutes.

One MPU-6050 sits on the laces of the right shoe and samples at 100 Hz, without radio losses. Every walk has other
sensor errors and other strides. The paper's "step" is the stride of one foot."""

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
WALKING_SPEED, JOGGING_SPEED = 1.0, 2.1
"""Walking and jogging speed, m/s: assumed, so that strides are about as long as the paper's 1.20 m and 1.60 m."""
STRIDES = 100
"""Number of strides of each level walk (section 4.2.3)."""
HEADING_LENGTH = 19.2
"""Length over which the directions of strides are compared, m (section 4.2.5)."""
RISERS = 11
"""Number of stairs in a flight (assumed). Each is 0.16 m high and 0.30 m deep, as in the paper."""
LAPS = 2
"""Number of laps of the corridors of each storey, so that the walk takes five minutes."""
MATCHING_TIME = 0.3
"""Largest time between the ends of a found stride and the true one that it matches, s."""
STATES = ("walking", "jogging", "upstairs", "downstairs")
LAST_STRIDES = 9
"""Number of strides at the end of a walk whose directions give the heading error."""
PARTIAL_STRIDES = 1.5
"""Total length of the shorter strides at the start and at the end of a walk, in whole strides."""
TWO_RISERS = 0.25
"""Height change that only a stride over two risers of 0.16 m exceeds, m."""


@frozen
class StrideErrors:
    """The comparison of the strides of one session on one walk with the truth; errors are estimated minus true."""

    angles: tuple[float, ...]
    """Angle per metre of each matched stride (body/activity/steepness.py), degrees/m, positive upwards."""
    lengths: tuple[tuple[float, float], ...]
    """Error and true value of the length of each matched stride, m."""
    heights: tuple[tuple[float, float], ...]
    """Error and true value of the height change of each matched stride, m."""
    course_errors: tuple[float, ...]
    """Direction error of each matched stride in the first HEADING_LENGTH m, degrees; empty on stairs."""
    right: tuple[bool, ...]
    """True for each matched stride whose state (level, upstairs, downstairs) is right."""
    start_offsets: tuple[float, ...]
    """Start of each matched stride minus the true start, s."""
    found: int
    """Number of matched strides."""
    not_found: int
    """Number of true strides without a match."""
    invented: int
    """Number of reported strides without a match."""
    height: float
    """Height error of the track at the end of the walk, m."""

    @property
    def merged(self) -> int:
        """Number of strides that were reported as one with the stride before, whose end was not found."""
        return sum([offset < -MATCHING_TIME for offset in self.start_offsets])

    @property
    def split(self) -> int:
        """Number of strides that were reported in two pieces, of which the last counts as found."""
        return sum([offset > MATCHING_TIME for offset in self.start_offsets])

    @property
    def whole(self) -> tuple[float, ...]:
        """Length errors of the strides that are neither merged nor split, m."""
        pairs = zip(self.lengths, self.start_offsets, strict=True)
        return tuple(error for (error, _), offset in pairs if abs(offset) <= MATCHING_TIME)

    @property
    def right_share(self) -> float:
        """Percentage of strides whose state is right."""
        return 100.0 * sum(self.right) / max(1, len(self.right))

    @property
    def stride_f1(self) -> float:
        """F1 of the strides, %: 2 x found / (true + reported)."""
        return 100.0 * self.found / max(1.0, self.found + 0.5 * (self.not_found + self.invented))


@frozen
class TourErrors:
    """The comparison of a walk of five minutes in a building with the truth."""

    end_error: float
    """Horizontal distance between estimated and true end, m."""
    path_length: float
    """Horizontal length of the true path, m."""
    heading_error: float
    """Median error of the direction of the last strides, degrees, positive to the left."""
    height_error: float
    """Estimated minus true height of the end, m."""
    reported: tuple[bool, ...]
    """Direction of each flight that was reported: True for up."""
    true: tuple[bool, ...]
    """Direction of each flight that was climbed: True for up."""
    top_view: tuple[tuple[tuple[float, float], ...], tuple[tuple[float, float], ...]]
    """Estimated and true track seen from above, (x, y), m."""
    side_view: tuple[tuple[tuple[float, float], ...], tuple[tuple[float, float], ...]]
    """Estimated and true track seen from the side: (distance along the floor, height), m."""


@frozen
class ShoeResults:
    """The results of one wearer, by state of STATES."""

    energy: dict[str, StrideErrors]
    """Results of the recipe, which finds strides by energy."""
    before: dict[str, StrideErrors]
    """Results of the recipe without the elimination of height errors."""
    magnitude: dict[str, StrideErrors]
    """Results of the variant that finds strides by the magnitude of the specific force."""
    tour: TourErrors


def route_of(state: str) -> Route:
    """Return a hundred strides on the level, or two flights with a landing between."""
    route = Route().stand(4.0)
    if state == "walking":
        return route.walk((STRIDES + PARTIAL_STRIDES) * 1.22, WALKING_SPEED).stop(2.0)
    if state == "jogging":
        return route.jog((STRIDES + PARTIAL_STRIDES) * 1.60, JOGGING_SPEED).stop(2.0)
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


def score_wearer(seed: int) -> ShoeResults:
    """Return the results of all walks of one wearer."""
    plain = evolve(SHOE_SENSING, corrector=ShoeSensing(ShoeSensingSettings(eliminate=False)))
    energy, before, magnitude = {}, {}, {}
    for k, state in enumerate(STATES):
        samples, truth = sample_walk(route_of(state), 10 * seed + k)
        energy[state] = score_strides(run_session(SHOE_SENSING, samples), truth, state)
        before[state] = score_strides(run_session(plain, samples), truth, state)
        magnitude[state] = score_strides(run_session(SHOE_MAGNITUDE, samples), truth, state)
    return ShoeResults(energy, before, magnitude, score_tour(10 * seed + len(STATES)))


def sample_walk(route: Route, seed: int) -> tuple[list[Sample], Truth]:
    """Return the samples of the sensor on a walk along `route`, and the truth."""
    walker = Walker(route, seed=seed)
    return walker.samples(FOOT, 100.0, MPU6050, mounting=ON_INSTEP), walker.truth({FOOT: ON_INSTEP})


def score_strides(events: Sequence[Event], truth: Truth, state: str) -> StrideErrors:
    """Score found strides against the true ones. On stairs only strides over two risers count."""
    strides = [event for event in events if isinstance(event, StrideTaken)]
    matches = matched(strides, truth.strides(FOOT))
    stairs = state in ("upstairs", "downstairs")
    direction = {"upstairs": 1, "downstairs": -1}.get(state, 0)
    counted = [(stride, true) for stride, true in matches if not stairs or abs(true.displacement[2]) > TWO_RISERS]
    expected = [true for true in truth.strides(FOOT) if not stairs or abs(true.displacement[2]) > TWO_RISERS]
    matched_strides = [stride for stride, _ in matches]
    counted_strides = [
        stride for stride in strides if not stairs or any(true.t_start < stride.t < true.t_end for true in expected)
    ]
    return StrideErrors(
        angles=tuple(degrees(angle_per_metre(stride.length, stride.height_change)) for stride, _ in counted),
        lengths=tuple((stride.length - true.length, true.length) for stride, true in counted),
        heights=tuple((stride.height_change - true.displacement[2], true.displacement[2]) for stride, true in counted),
        course_errors=() if stairs else _courses(matches),
        right=tuple(steepness(stride.length, stride.height_change) == direction for stride, _ in counted),
        start_offsets=tuple(stride.t_start - true.t_start for stride, true in counted),
        found=len(counted),
        not_found=len(expected) - len(counted),
        invented=sum([stride not in matched_strides for stride in counted_strides]),
        height=strides[-1].position[2] - sum([true.displacement[2] for true in truth.strides(FOOT)])
        if strides
        else 0.0,
    )


def matched(found: Sequence[StrideTaken], true: Sequence[TrueStride]) -> list[tuple[StrideTaken, TrueStride]]:
    """Return the pairs of a found and a true stride whose ends are at most MATCHING_TIME apart, one to one."""
    ends = [one.t_end for one in true], [stride.t_end for stride in found]
    return [(found[j], true[i]) for i, j in pairs(*ends, MATCHING_TIME)]


def _courses(matches: Sequence[tuple[StrideTaken, TrueStride]]) -> tuple[float, ...]:
    """Return the direction of each stride minus the true one, degrees, after alignment over the first two metres."""
    if len(matches) < 2:
        return ()
    ours = np.cumsum([stride.displacement[:2] for stride, _ in matches], axis=0)
    true = np.cumsum([one.displacement[:2] for _, one in matches], axis=0)
    far = np.linalg.norm(true, axis=1)
    ours, true = (np.vstack([np.zeros(2), track[far < HEADING_LENGTH]]) for track in (ours, true))
    count = 2 + int(np.sum(far < ALIGNMENT_LENGTH))
    ours = align(ours[:count], true[:count]).apply(ours)
    return tuple(_direction_errors(ours, true).tolist())


def _direction_errors(ours: Floats, true: Floats) -> Floats:
    """Return the direction from each row to the next minus the true one, degrees, positive to the left, within 180."""
    angles = [np.arctan2(d[:, 1], d[:, 0]) for d in (np.diff(ours, axis=0), np.diff(true, axis=0))]
    errors = angles[0] - angles[1]
    errors_degrees: Floats = np.degrees(np.arctan2(np.sin(errors), np.cos(errors)))
    return errors_degrees


def score_tour(seed: int) -> TourErrors:
    """Score the recipe on the walk of five minutes."""
    samples, truth = sample_walk(tour_route(), seed)
    events = run_session(SHOE_SENSING, samples)
    strides = [event for event in events if isinstance(event, StrideTaken)]
    ours = np.array([(0.0, 0.0, 0.0), *(stride.position for stride in strides)])
    true = truth.pose(FOOT, np.array([0.0, *(stride.t_end for stride in strides)])).position
    true = true - true[0]
    horizontal = align_track(ours[:, :2], true[:, :2])
    travelled = distances(true)
    return TourErrors(
        end_error=hypot(*(horizontal[-1] - true[-1, :2])),
        path_length=float(travelled[-1]),
        heading_error=float(np.median(_direction_errors(horizontal, true[:, :2])[-LAST_STRIDES:])),
        height_error=float(ours[-1, 2] - true[-1, 2]),
        reported=tuple(event.up for event in events if isinstance(event, FlightClimbed)),
        true=tuple(flight.up for flight in truth.flights),
        top_view=(thin_out(horizontal), thin_out(true)),
        side_view=(
            thin_out(np.column_stack([travelled, ours[:, 2]])),
            thin_out(np.column_stack([travelled, true[:, 2]])),
        ),
    )
