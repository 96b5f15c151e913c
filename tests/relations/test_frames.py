"""One table of relations: what becomes of the events of a walk in another frame, at another time, or in a mirror."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from copy import deepcopy
from math import inf
from typing import Any

import pytest
from attrs import field, frozen
from transforms import FIELD, WALKING_MODES, WALKS, Change, differences, events_of, headless, in_order, remounted, run
from walks import SELDOM, often

from solepath import Foot, Sample, Session, Site, StrideTaken, WearerMoved, recipes
from solepath.papers import TouchedDown
from solepath.types.vector import from_rotation_vector

EXACT = {"": 1e-9}
MIRRORED = Change(mirrored=True)
LATER = Change(later=2.0**31)
TURNED = Change(yaw=0.7)
NORTH = Change(north=0.7)
MOUNTED = from_rotation_vector((0.4, -0.7, 0.5))
MUCH_LATER = {
    "": 1e-5, "cadence": 1e-4, "velocity": 3e-5, "peak_speed": 3e-5, "position": 2e-5, "probability": 1e-3
}  # fmt: skip
"""At 2^31 s a time has steps of 0.24 us; cadence is 120 over a time of 1 s, velocities are up to 5 m/s. Velocities that
speak for an activity are kept to 0.1 mm/s, whose last digit may be another one."""
STRIDES_ALONE = {"": inf, "strides alone": 0.0}
"""Tolerances for recipes whose strides alone are compared, and of these what has a tolerance of its own."""


def in_another_field(walk: str) -> Iterable[Sample]:
    """Return the walk in a world whose north is elsewhere, for the field and for the attitudes of devices."""
    samples = WALKS[walk]() if walk == "suit" else WALKS[walk](TURNED.vector(FIELD))
    return map(TURNED.sample, samples)


@frozen
class Relation:
    """What is done to the samples of a walk, and how the events correspond."""

    samples: Callable[[str], Iterable[Sample]]
    event: Callable[[Any], Any] = field(default=lambda event: event)
    """Event of the changed walk for an event of the walk as it is."""
    within: Mapping[str, float] = EXACT
    """Tolerance of each quantity, "" for all others."""
    exceptions: Mapping[str, tuple[str, Mapping[str, float]]] = {}
    """Larger tolerances by the first letters of a recipe, by walk, or by both; and the reason."""
    ordered: bool = True
    """False where events of one time may come in another order."""
    starts: bool = False
    """True where the direction of vectors is arbitrary until the first heading is known."""


RELATIONS = {
    "mirrored left to right": Relation(
        lambda walk: map(MIRRORED.sample, WALKS[walk]()),
        MIRRORED.event,
        EXACT,
        {
            "footstep-tracker-printed": (
                "the wearer is where the right foot is, until the one-metre rule",
                STRIDES_ALONE | {"t": 1e-9, "displacement": 1e-9, "length": 1e-9, "heading_change": 1e-9},
            ),
            "walking-modes-printed": (
                "table 1 of the paper is no mirror image, and no calibration replaces it",
                {"compensation": 0.03, "position": 0.03, "WearerMoved.covariance": 1e-3, "legs": 2e-3},
            ),
        },
        ordered=False,
    ),
    "shifted in time": Relation(lambda walk: map(LATER.sample, WALKS[walk]()), LATER.event, MUCH_LATER),
    "with another heading": Relation(in_another_field, NORTH.event, {"": 1e-6}, starts=True),
    "in another sensor frame": Relation(
        lambda walk: [remounted(sample, MOUNTED) for sample in WALKS[walk]()],
        within={"": 1e-4, "cadence": 1e-3},
        exceptions={
            "default": (
                "nothing turns a standing foot back to gravity, so a tilt by rounding stays",
                {"velocity": 2e-4},
            ),
            "footstep-tracker": (
                "static zones are of single axes, so that one may end some samples earlier",
                STRIDES_ALONE | {"t": 0.05, "position": 0.02, "displacement": 0.01, "heading_change": 1e-3},
            ),
            "gaps footstep-tracker": (
                "the drift in a gap lasts up to the end of a static zone",
                {"displacement": 0.05, "length": 0.05, "position": 0.1, "heading_change": 0.02},
            ),
            "shoe-sensing-printed": (
                "tilts are of single axes",
                STRIDES_ALONE | {"t": 1e-3, "position": 5e-3, "displacement": 1e-3, "heading_change": 5e-3},
            ),
            "touchdown": (
                "the height, or the axis, that touches first decides the sample",
                {"": 5e-4, "position": 0.05},
            ),
            "walking-modes": ("as for touchdown", {"": 5e-4, "position": 0.05}),
            "suit": (
                "at 25 Hz a smooth maximum of one axis may look like the end of its range",
                {"": 0.3, "position": 0.3},
            ),
        },
        starts=True,
    ),
}

CASES = [
    *(("feet", recipe) for recipe in recipes.NAMES),
    *(("stairs", recipe) for recipe in ("default", "footstep-tracker", "shoe-sensing")),
    *(("gaps", recipe) for recipe in ("default", "footstep-tracker", "shoe-sensing", "kupt-dfpc", "pressure-contour")),
    *(("suit", recipe) for recipe in WALKING_MODES),
]
HEADED_AT = 3.2
"""Time at which both feet have ended a stride, s."""


@pytest.mark.parametrize(
    ("walk", "recipe"), [pytest.param(*one, marks=pytest.mark.soak) if one[1] in SELDOM else one for one in CASES]
)
@pytest.mark.parametrize("name", RELATIONS)
def test_the_events_of_a_walk_are_as_the_relation_says(name: str, walk: str, recipe: str) -> None:
    relation = RELATIONS[name]
    expected, found = map(relation.event, events_of(recipe, walk)), run(recipe, relation.samples(walk))
    within = dict(relation.within)
    for start, (_, larger) in relation.exceptions.items():
        if recipe.startswith(start) or start in (walk, f"{walk} {recipe}"):
            within |= larger
    if "strides alone" in within:
        expected, found = ([one for one in events if isinstance(one, StrideTaken)] for events in (expected, found))
    if relation.starts:
        expected, found = ([*started(events)] for events in (expected, found))
    if not relation.ordered:
        expected, found = in_order(expected), in_order(found)
    assert sum(isinstance(one, StrideTaken) for one in found) >= 2
    assert differences(expected, found, within) == []


def started(events: Iterable[Any]) -> Iterator[Any]:
    """Yield the events without what is arbitrary before the first headings are known."""
    for event in events:
        if event.known_at >= HEADED_AT:
            yield event
        elif not isinstance(event, WearerMoved | TouchedDown):
            yield headless(event)


@pytest.mark.parametrize("recipe", WALKING_MODES)
def test_the_world_of_devices_may_be_turned_if_the_first_heading_in_it_is_given(recipe: str) -> None:
    walk, usual = WALKS["suit"](), recipes.by_name(recipe)
    events = [run(usual.with_heading(heading), map(Change(yaw=heading).sample, walk)) for heading in (0.3, 1.0)]
    before, after = ([one for one in each if isinstance(one, TouchedDown | WearerMoved)] for each in events)
    assert len(after) > 10 and differences(before, after, {"": 1e-6}) == []


@pytest.mark.parametrize("name", ["feet", "gaps"])
@pytest.mark.parametrize("recipe", often(recipes.NAMES))
def test_a_foot_that_is_turned_and_moved_at_a_foot_flat_goes_on_from_there(recipe: str, name: str) -> None:
    session, walk, strides = Session(recipes.by_name(recipe), poses=True), iter(WALKS[name]()), 0
    while strides < 2:
        strides += sum(isinstance(one, StrideTaken) and one.foot is Foot.LEFT for one in session.feed(next(walk)))
    usual, moved = (deepcopy(session.feet[Foot.LEFT]) for _ in range(2))
    by, turn, (x, y, z) = (0.5, -0.3, 0.0), Change(yaw=0.4), usual.position
    moved.shift(0.4, by)
    if not hasattr(moved.corrector, "shift"):
        assert moved.position == usual.position
        return
    rest = [sample for sample in walk if sample.site is Site.LEFT_FOOT]
    u, v, _ = turn.vector((x, y, z))
    corresponding = Change(yaw=0.4, offset=(x - u + by[0], y - v + by[1], 0.0))
    before, after = ([event for sample in rest for event in foot.feed(sample)] for foot in (usual, moved))
    assert sum(isinstance(one, StrideTaken) for one in after) >= 4
    is_filtered = hasattr(moved.corrector, "uncertainty")  # which is not turned, and is not round after a gap
    assert (
        differences(map(corresponding.event, before), after, {"": 0.05 if name == "gaps" and is_filtered else 2e-5})
        == []
    )
