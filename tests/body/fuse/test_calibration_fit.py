"""A calibration of other shoes is noticed and dropped, one of these shoes is kept."""

from __future__ import annotations

from functools import cache

import pytest

from solepath import Session
from solepath.calibration import Calibration
from solepath.emulate.walk import SampledWalk, sampled
from solepath.events import Defect, DefectFound
from solepath.lab.emulated.heading import follow, heading_figures
from solepath.lab.emulated.heading_walks import calibration_samples, heading_route, insoles_of, wearer_of
from solepath.session.heading_walk import heading_calibration, heading_walk

WEARER, ANOTHER = 120, 121
"""Wearers whose drift differs by 3 mrad a stride, 9 degrees a minute."""


@cache
def calibration(seed: int) -> Calibration:
    return heading_calibration(heading_walk(calibration_samples(seed)))


@cache
def walk(kind: str) -> SampledWalk:
    route = heading_route(kind, WEARER, lambda length, seconds: length >= 350.0)
    return sampled(route, wearer=wearer_of(WEARER), insoles=insoles_of(WEARER), seed=WEARER)


def misfits(kind: str, known: Calibration) -> list[DefectFound]:
    session = Session(calibration=known)
    events = [event for sample in walk(kind).samples for event in session.feed(sample)]
    return [event for event in events if isinstance(event, DefectFound) and event.defect is Defect.CALIBRATION]


def end_error(kind: str, known: Calibration) -> float:
    """Return the error at the end, as a share of the way."""
    seen = walk(kind)
    error = heading_figures(follow(Session(calibration=known), seen), seen.truth)["end_relative"]
    assert error is not None
    return error


@pytest.mark.parametrize("kind", ["right_angles", "any_angles"])
def test_a_calibration_of_other_shoes_is_dropped_and_the_track_turned_back(kind: str) -> None:
    (one,) = misfits(kind, calibration(ANOTHER))
    assert "does not fit this walk" in one.what and not one.spoils
    assert end_error(kind, calibration(ANOTHER)) < 0.05, "0.8 rad of heading would be a fifth of the way or more"


@pytest.mark.parametrize("kind", ["right_angles", "any_angles", "ring", "arcs"])
def test_a_calibration_of_these_shoes_is_kept_on_ways_of_any_form(kind: str) -> None:
    assert misfits(kind, calibration(WEARER)) == []
