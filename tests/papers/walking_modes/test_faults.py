"""Walking modes when something is wrong: insoles without usable pressure, feet and sensors that fall silent."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from math import hypot

import pytest
import spoiled
from attrs import evolve
from soak import soaked
from walks import both_feet, of

from solepath.body.fuse.position import MeanOfFeet
from solepath.body.part import TrackPart
from solepath.calibration import Calibration, InsoleCalibration
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.events import Event, Limitation, TouchedDown
from solepath.recipes import DEFAULT, Recipe, by_name
from solepath.session import Session
from solepath.types import SITE_OF_FOOT, Foot, Sample, Site
from solepath_lab.emulated.limb_samples import limb_samples

LEFT, RIGHT = Site.LEFT_FOOT, Site.RIGHT_FOOT
LAYOUTS = {SITE_OF_FOOT[foot]: layout(96, foot) for foot in Foot}
KNOWN = Calibration(insoles={foot: InsoleCalibration(layout=layout(96, foot)) for foot in Foot})
WALK_LENGTH = 15.0
TRACKS_RECIPE = DEFAULT.replace_part(TrackPart, MeanOfFeet())
"""The feet's own tracks, and their mean."""
RECIPES = ("walking-modes", "touchdown-height", "touchdown-acceleration", "touchdown-pressure")


@cache
def emulated_walker() -> Walker:
    return Walker(Route().stand(2.0).walk(WALK_LENGTH, 1.2).stop(2.0), seed=1)


@cache
def insole_samples() -> tuple[Sample, ...]:
    """Return the samples of both insoles of a straight walk, 50 Hz."""
    return both_feet(emulated_walker(), 50.0, LSM6DSOX, 96)


@cache
def seven() -> tuple[Sample, ...]:
    """Return samples of seven sensors with attitudes, of the same walk."""
    return tuple(limb_samples(emulated_walker(), 50.0, seed=1, layouts=LAYOUTS))


def run_walk(
    recipe: str | Recipe, samples: Sequence[Sample], known: Calibration = KNOWN
) -> tuple[tuple[float, float], list[Event]]:
    """Return the end of the walk, x and y, m, and the events."""
    session = Session(by_name(recipe) if isinstance(recipe, str) else recipe, calibration=known)
    events = [*session.feed(samples), *session.finish()]
    assert session.position is not None
    x, y, _ = session.position.position
    return (x, y), events


def sentences(events: Sequence[Event]) -> list[str]:
    return [event.what for event in of(Limitation, list(events))]


@cache
def end_without_fault(samples: Callable[[], tuple[Sample, ...]]) -> tuple[float, float]:
    """Return the end of the walk without a fault, m."""
    return run_walk("walking-modes", samples())[0]


BROKEN: dict[str, Callable[[], Sequence[Sample]]] = {
    "no pressure from the middle on": lambda: spoiled.cut_off(insole_samples(), LEFT, 0, 10.0),
    "never unloads": lambda: spoiled.never_unloads(insole_samples(), LEFT, 30.0),
    "both never unload": lambda: spoiled.never_unloads(
        spoiled.never_unloads(insole_samples(), LEFT, 30.0), RIGHT, 30.0
    ),
}


@pytest.mark.parametrize("how", [[*BROKEN][0], *soaked(*[*BROKEN][1:])])
def test_an_insole_without_usable_pressure_does_not_lead_astray(how: str) -> None:
    (x, y), events = run_walk("walking-modes", BROKEN[how]())
    clean_x, clean_y = end_without_fault(insole_samples)
    assert hypot(x - clean_x, y - clean_y) < 1.0
    assert len([what for what in sentences(events) if "left insole" in what and "steps" in what]) == 1
    strides = sum(len(strides) for strides in emulated_walker().plan.strides.values())
    assert strides - 6 <= len(of(TouchedDown, events)) <= strides + 1


@pytest.mark.parametrize("recipe", RECIPES)
def test_the_feet_alone_go_all_the_way_by_any_method(recipe: str) -> None:
    (x, y), events = run_walk(recipe, insole_samples())
    assert hypot(x - WALK_LENGTH, y) < 2.0
    strides = sum(len(strides) for strides in emulated_walker().plan.strides.values())
    assert strides - 2 <= len(of(TouchedDown, events)) <= strides + 1
    (limitation,) = [what for what in sentences(events) if "own inertial tracks" in what]
    assert "pelvis" in limitation


def with_late_limbs(samples: Sequence[Sample]) -> list[Sample]:
    """Return the samples, with those above the ankles 0.3 s later than those of the feet."""
    late = [evolve(s, known_at=s.t + 0.3) if s.site.foot is None else s for s in samples]
    return sorted(late, key=_known_at)


def _known_at(sample: Sample) -> float:
    return sample.t if sample.known_at is None else sample.known_at


SUITS: dict[str, tuple[Callable[[], Sequence[Sample]], str]] = {
    "the pelvis falls silent": (lambda: spoiled.silent(seven(), Site.PELVIS, 8.0), "pelvis"),
    "the sensors above the ankles are late": (lambda: with_late_limbs(seven()), "old"),
    "the wearer never stood still": (lambda: [s for s in seven() if s.t > 2.6], "stand still"),
}


@cache
def by_tracks(how: str) -> float:
    """Return the length of the walk by the feet's own tracks with that suit, m."""
    return run_walk(TRACKS_RECIPE, SUITS[how][0]())[0][0]


@pytest.mark.parametrize("how", soaked(*SUITS))
def test_a_lost_chain_is_replaced_by_the_tracks_and_reported_once(how: str) -> None:
    samples, named = SUITS[how]
    (x, y), events = run_walk("walking-modes", samples())
    assert hypot(x - by_tracks(how), y) < 2.3
    (limitation,) = [what for what in sentences(events) if "own inertial tracks" in what]
    assert named in limitation
