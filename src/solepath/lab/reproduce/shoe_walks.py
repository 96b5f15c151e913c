"""What one wearer of the shoe-sensing experiments walks: straight on, at a jog, up and down the stairs, five minutes.

One MPU-6050 on the laces of the right shoe at 100 Hz, without a wire; another part and other footsteps every time.
"""

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
from ..measures.strides import ALIGNED_OVER
from .walks import heard, laid, thinned

FOOT = Foot.RIGHT
"""Whose shoe ("attached to one of the user's shoes"); which of them is assumed."""
WALKING, JOGGING = 1.0, 2.1
"""m/s (assumed): strides of about the paper's 1.20 m and 1.60 m."""
STEPS = 100
"""Of each level walk (section 4.2.3)."""
STRAIGHT = 19.2
"""m (section 4.2.5): how far a heading is followed."""
RISERS = 11
"""Of a flight (assumed); 0.16 m by 0.30 m each, as the paper's."""
LAPS = 2
"""Round the corridors of each storey, for five minutes in all."""
SAME = 0.3
"""s: a step that ends further than this from a true one is another's."""
STATES = ("walking", "jogging", "upstairs", "downstairs")
LAST = 9
"""Steps whose directions say how far the heading is off."""
TO_HALT = 1.5
"""Strides of a walk that are not whole, before and after."""


@frozen
class Steps:
    """What one session made of one walk. By true step that was found: `angles` (degrees/m), errors of length and height
    and the true ones (m), `courses` (degrees, of the first 19.2 m), `right`: whether the state is, `late`: how much
    later than the true one it begins, s. `found`, `missed` and `invented`: how many; `height`: what the track gained
    over all of it that the wearer did not, m."""

    angles: tuple[float, ...]
    lengths: tuple[tuple[float, float], ...]
    heights: tuple[tuple[float, float], ...]
    courses: tuple[float, ...]
    right: tuple[bool, ...]
    late: tuple[float, ...]
    found: int
    missed: int
    invented: int
    height: float

    @property
    def merged(self) -> int:
        """Steps that were told as one with the step before, whose end was missed."""
        return sum([late < -SAME for late in self.late])

    @property
    def parted(self) -> int:
        """Steps that were told in two pieces, of which the last counts as found."""
        return sum([late > SAME for late in self.late])

    @property
    def whole(self) -> tuple[float, ...]:
        """Errors of length of the others, m."""
        both = zip(self.lengths, self.late, strict=True)
        return tuple(error for (error, _), late in both if abs(late) <= SAME)

    @property
    def judged_right(self) -> float:
        """Steps whose state is right, per cent."""
        return 100.0 * sum(self.right) / max(1, len(self.right))

    @property
    def extracted(self) -> float:
        """F1 of the steps, per cent: twice those found over all true and all told ones."""
        return 100.0 * self.found / max(1.0, self.found + 0.5 * (self.missed + self.invented))


@frozen
class Tour:
    """Five minutes in a building: how far the end is off along the floor and in height, and the way along the floor, m;
    flights told and true (up or not); the tracks seen from above and from the side, ours and the true one."""

    off: float
    way: float
    heading: float
    """How far the direction of the last steps is off, degrees."""
    height: float
    told: tuple[bool, ...]
    true: tuple[bool, ...]
    above: tuple[tuple[tuple[float, float], ...], tuple[tuple[float, float], ...]]
    aside: tuple[tuple[tuple[float, float], ...], tuple[tuple[float, float], ...]]


@frozen
class ShoeWalked:
    """By state: as the recipe has it, without the elimination of heights, and by the magnitude."""

    energy: dict[str, Steps]
    before: dict[str, Steps]
    magnitude: dict[str, Steps]
    tour: Tour


def route_of(state: str) -> Route:
    """A hundred strides on the level, or two flights with a landing between."""
    begun = Route().stand(4.0)
    if state == "walking":
        return begun.walk((STEPS + TO_HALT) * 1.22, WALKING).stop(2.0)
    if state == "jogging":
        return begun.jog((STEPS + TO_HALT) * 1.60, JOGGING).stop(2.0)
    up = state == "upstairs"
    begun = begun.walk(4.0, 1.2)
    return begun.stairs(RISERS, up=up).turn(radians(180), 0.7).stairs(RISERS, up=up).walk(4.0).stop(2.0)


def tour_route() -> Route:
    """Fig. 35: corridors of two storeys and the stairs between them, for five minutes."""
    route = Route().stand(4.0)
    for up in (True, False):
        for _ in range(LAPS):
            route = route.walk(19.2, 1.2).turn(radians(90), 1.0).walk(9.0).turn(radians(90), 1.0)
            route = route.walk(19.2).turn(radians(90), 1.0).walk(9.0).turn(radians(90), 1.0)
        route = route.walk(4.0)
        route = route.stairs(RISERS, up=up).turn(radians(180), 0.7).stairs(RISERS, up=up).walk(4.0)
    return route.stop(3.0)


def walked(seed: int) -> ShoeWalked:
    """All of it by one wearer."""
    plain = evolve(SHOE_SENSING, corrector=ShoeSensing(ShoeSensingSettings(eliminate=False)))
    energy, before, magnitude = {}, {}, {}
    for k, state in enumerate(STATES):
        samples, truth = worn(route_of(state), 10 * seed + k)
        energy[state] = judged(heard(SHOE_SENSING, samples), truth, state)
        before[state] = judged(heard(plain, samples), truth, state)
        magnitude[state] = judged(heard(SHOE_MAGNITUDE, samples), truth, state)
    return ShoeWalked(energy, before, magnitude, toured(10 * seed + len(STATES)))


def worn(route: Route, seed: int) -> tuple[list[Sample], Truth]:
    """What the sensor says, and what was so."""
    walker = Walker(route, seed=seed)
    return walker.samples(FOOT, 100.0, MPU6050, mounting=ON_INSTEP), walker.truth({FOOT: ON_INSTEP})


def judged(events: Sequence[Event], truth: Truth, state: str) -> Steps:
    """Steps found against the true ones. On the stairs, those that climb two risers count, and nothing else."""
    steps = [event for event in events if isinstance(event, StrideTaken)]
    together = matched(steps, truth.steps(FOOT))
    stairs = state in ("upstairs", "downstairs")
    way = {"upstairs": 1, "downstairs": -1}.get(state, 0)
    counted = [(step, true) for step, true in together if not stairs or abs(true.displacement[2]) > 0.25]
    wanted = [true for true in truth.steps(FOOT) if not stairs or abs(true.displacement[2]) > 0.25]
    taken = [step for step, _ in together]
    during = [step for step in steps if not stairs or any(true.t_start < step.t < true.t_end for true in wanted)]
    return Steps(
        angles=tuple(degrees(angle_per_metre(step.length, step.height_change)) for step, _ in counted),
        lengths=tuple((step.length - true.length, true.length) for step, true in counted),
        heights=tuple((step.height_change - true.displacement[2], true.displacement[2]) for step, true in counted),
        courses=() if stairs else _courses(together),
        right=tuple(steepness(step.length, step.height_change) == way for step, _ in counted),
        late=tuple(step.t_start - true.t_start for step, true in counted),
        found=len(counted),
        missed=len(wanted) - len(counted),
        invented=sum([step not in taken for step in during]),
        height=steps[-1].position[2] - sum([true.displacement[2] for true in truth.steps(FOOT)]) if steps else 0.0,
    )


def matched(steps: Sequence[StrideTaken], true: Sequence[TrueStride]) -> list[tuple[StrideTaken, TrueStride]]:
    """Each true step with the found one that ends nearest to it, one to one."""
    ends = [one.t_end for one in true], [step.t_end for step in steps]
    return [(steps[j], true[i]) for i, j in pairs(*ends, SAME)]


def _courses(together: Sequence[tuple[StrideTaken, TrueStride]]) -> tuple[float, ...]:
    """Direction of each step less the true one, degrees, when the first two metres are laid on the truth."""
    if len(together) < 2:
        return ()
    ours = np.cumsum([step.displacement[:2] for step, _ in together], axis=0)
    true = np.cumsum([one.displacement[:2] for _, one in together], axis=0)
    far = np.linalg.norm(true, axis=1)
    ours, true = (np.vstack([np.zeros(2), track[far < STRAIGHT]]) for track in (ours, true))
    count = 2 + int(np.sum(far < ALIGNED_OVER))
    ours = align(ours[:count], true[:count]).apply(ours)
    return tuple(_directions_off(ours, true).tolist())


def _directions_off(ours: Floats, true: Floats) -> Floats:
    """Direction of each way from row to row less the true one, degrees, in (-180, 180]."""
    angles = [np.arctan2(way[:, 1], way[:, 0]) for way in (np.diff(ours, axis=0), np.diff(true, axis=0))]
    off = angles[0] - angles[1]
    degrees_off: Floats = np.degrees(np.arctan2(np.sin(off), np.cos(off)))
    return degrees_off


def toured(seed: int) -> Tour:
    """Five minutes, by the recipe."""
    samples, truth = worn(tour_route(), seed)
    events = heard(SHOE_SENSING, samples)
    steps = [event for event in events if isinstance(event, StrideTaken)]
    ours = np.array([(0.0, 0.0, 0.0), *(step.position for step in steps)])
    true = truth.pose(FOOT, np.array([0.0, *(step.t_end for step in steps)])).position
    true = true - true[0]
    flat = laid(ours[:, :2], true[:, :2])
    gone = distances(true)
    return Tour(
        off=hypot(*(flat[-1] - true[-1, :2])),
        way=float(gone[-1]),
        heading=float(np.median(_directions_off(flat, true[:, :2])[-LAST:])),
        height=float(ours[-1, 2] - true[-1, 2]),
        told=tuple(event.up for event in events if isinstance(event, FlightClimbed)),
        true=tuple(flight.up for flight in truth.flights),
        above=(thinned(flat), thinned(true)),
        aside=(thinned(np.column_stack([gone, ours[:, 2]])), thinned(np.column_stack([gone, true[:, 2]]))),
    )
