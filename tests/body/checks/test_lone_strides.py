"""Clocks that are seconds apart: one foot walks while the other one stands, which nobody can."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest
from walks import RIGHT, of, samples

from solepath import GaitCycleMeasured, Sample, Session, StrideTaken
from solepath.emulate.routes.route import Route
from solepath.events import Defect, DefectFound, Event
from solepath.recording import open_source, shift_clock
from solepath.recording.errors import printable

THERE = Route().stand(6.0).walk(12.0, 1.3).stop(6.0)


@cache
def walk() -> tuple[Sample, ...]:
    return samples(THERE, cells=0)


def shifted(delay: float, walked: tuple[Sample, ...] | None = None) -> list[Sample]:
    """Return a walk with a right foot whose clock is late by `delay`, s."""
    return list(shift_clock(walk() if walked is None else walked, delay))


def found(events: list[Event]) -> list[DefectFound]:
    return [event for event in of(DefectFound, events) if event.defect is Defect.CLOCKS]


@pytest.mark.parametrize("delay", [3.0, -10.0])
def test_clocks_that_are_seconds_apart_are_reported_without_an_offset(delay: float) -> None:
    defect = found(Session().feed(shifted(delay)))[-1]
    assert (defect.site, defect.offset, defect.sigma, defect.spoils) == (RIGHT, None, None, False)
    assert defect.needs_action and printable(f"right foot: {defect.what}").endswith(defect.what), "printed whole"
    assert "walked while the left foot stood" in defect.what or "stood while the left foot walked" in defect.what


def test_what_compares_the_feet_is_left_out_once_one_foot_has_walked_alone() -> None:
    session = Session()
    events = session.feed(shifted(-5.0, samples(Route().stand(6.0).walk(24.0, 1.3).stop(6.0), cells=0)))
    (defect,) = found(events)
    later = [cycle for cycle in of(GaitCycleMeasured, events) if cycle.known_at > defect.known_at]
    assert len(later) > 5 and {cycle.step_time for cycle in later} == {None}
    assert session.gait is not None and session.gait.both.step_time is None


@pytest.mark.parametrize(
    "route",
    [
        THERE,
        Route().stand(3.0).turn(12.0, radius=0.3).stop(3.0),
        Route().stand(3.0).stairs(16, True, 0.16, 0.30).stop(2.0).stairs(16, False, 0.16, 0.30).stop(3.0),
        Route().stand(3.0).jog(25.0, 2.8).stop(3.0),
        Route().stand(3.0).walk(3.0, 0.5).stop(2.0).walk(3.0, 1.8).stop(2.0),
    ],
    ids=["a walk", "a turn on the spot", "stairs", "a run", "short walks"],
)
def test_feet_on_one_clock_never_walk_alone(route: Route) -> None:
    events = Session().feed(samples(route, cells=0))
    assert of(StrideTaken, events)
    assert not found(events)


def test_a_recorded_walk_with_a_clock_that_is_10_s_late_is_no_asymmetric_walk(data_dir: Path) -> None:
    session = Session()
    events = session.feed(shift_clock(open_source(data_dir / "ipol_10m_uturn" / "1-1.npz"), 10.0))
    assert found(events)
    assert session.gait is not None and session.gait.asymmetry("step_time") is None
