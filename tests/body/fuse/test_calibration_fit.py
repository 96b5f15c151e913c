"""A calibration of other shoes is noticed and dropped, one of these shoes is kept."""

from __future__ import annotations

from functools import cache
from math import inf
from typing import Any

import pytest
from soak import longer

from solepath import Session
from solepath.body.fuse.straight_ways import CalibrationFit, DriftHypothesis, StretchDrift
from solepath.calibration import Calibration
from solepath.emulate.walk import SampledWalk, sampled
from solepath.events import Defect, DefectFound, Event
from solepath.session.heading_walk import heading_calibration, heading_walk
from solepath.types.attrs import evolve
from solepath_lab.emulated.heading import follow, heading_figures
from solepath_lab.emulated.heading_walks import calibration_samples, heading_route, insoles_of, wearer_of

WEARER, ANOTHER = 120, 121
"""Wearers whose drift differs by 3 mrad a stride, 9 degrees a minute."""


@cache
def calibration(seed: int) -> Calibration:
    return heading_calibration(heading_walk(calibration_samples(seed)))


@cache
def walk(kind: str) -> SampledWalk:
    route = heading_route(kind, WEARER, lambda length, seconds: length >= 350.0)
    return sampled(route, wearer=wearer_of(WEARER), insoles=insoles_of(WEARER), seed=WEARER)


class Listening(Session):
    """A session that keeps the defects of its calibration."""

    def __init__(self, known: Calibration) -> None:
        super().__init__(calibration=known)
        self.misfits = list[DefectFound]()

    def feed(self, fed: Any) -> list[Event]:
        events = super().feed(fed)
        self.misfits += [one for one in events if isinstance(one, DefectFound) and one.defect is Defect.CALIBRATION]
        return events


def walked(kind: str, known: Calibration) -> tuple[list[DefectFound], float]:
    """Return the defects of the calibration, and the error at the end as a share of the way."""
    seen, session = walk(kind), Listening(known)
    error = heading_figures(follow(session, seen), seen.truth)["end_relative"]
    assert error is not None
    return session.misfits, error


@pytest.mark.parametrize("kind", longer("right_angles", "any_angles"))
def test_a_calibration_of_other_shoes_is_dropped_and_the_track_turned_back(kind: str) -> None:
    (one,), error = walked(kind, calibration(ANOTHER))
    assert "does not fit this walk" in one.what and not one.spoils
    assert error < 0.05, "0.8 rad of heading would be a fifth of the way or more"


@pytest.mark.long
def test_a_calibration_that_is_dropped_no_longer_changes_turns_either() -> None:
    """Its drift is wrong by 6 mrad a stride, and its turns by a twentieth."""
    wrong = {
        foot: evolve(one, drift=one.drift + 0.006, turning=one.turning + 0.05)
        for foot, one in calibration(WEARER).headings.items()
    }
    found, error = walked("right_angles", Calibration(headings=wrong))
    assert len(found) == 1 and error < 0.05


def stretches(*bends: float) -> CalibrationFit:
    """Return the test of a calibration after stretches that bend by this much with it, rad a stride."""
    fit = CalibrationFit(DriftHypothesis(0.0, 4e-4**2), DriftHypothesis(-0.0025, 0.0015**2))
    for bend in bends:
        if fit.add(StretchDrift(bend, 2.6e-4**2, 0.0, 1.1), bend):
            fit.count = inf
    return fit


def test_ways_that_weave_are_no_evidence_against_a_calibration() -> None:
    """Arcs of 600 m radius to the left and to the right in turn: every other one could be the drift of other shoes."""
    assert stretches(*[-0.0022, 0.0022, -0.0015, 0.0023, -0.0020, 0.0021, -0.0023] * 3).count < inf
    assert stretches(*[-0.0022, -0.0020, 0.0012, -0.0021, -0.0023, -0.0019]).count == inf


@pytest.mark.parametrize("kind", ["right_angles", "any_angles", "arcs", "ring"])
@pytest.mark.long
def test_a_calibration_of_these_shoes_is_kept_on_ways_of_any_form(kind: str) -> None:
    assert walked(kind, calibration(WEARER))[0] == []
