"""Clocks that are seconds apart: one foot walks while the other one stands, which nobody can."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest
from attrs import evolve
from walks import LEFT, RIGHT, of, samples

from solepath import FootFlat, GaitCycleMeasured, Sample, Session, Site, StrideFeatures, StrideTaken, ToeOff
from solepath.body.checks.clocks.foot_clocks import FootClocks
from solepath.emulate.routes.route import Route
from solepath.events import Defect, DefectFound, Event, SampleGap
from solepath.recording import open_source, shift_clock
from solepath.recording.errors import printable
from solepath.types import Foot

THERE = Route().stand(6.0).walk(12.0, 1.3).stop(6.0)


@cache
def walk() -> tuple[Sample, ...]:
    return samples(THERE, cells=0)


def shifted(delay: float, walked: tuple[Sample, ...] | None = None) -> list[Sample]:
    """Return a walk with a right foot whose clock is late by `delay`, s."""
    return list(shift_clock(walk() if walked is None else walked, delay))


def found(events: list[Event]) -> list[DefectFound]:
    return [event for event in of(DefectFound, events) if event.defect is Defect.CLOCKS]


@pytest.mark.parametrize("delay", [3.0, -5.0, 10.0, -10.0])
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
        Route().stand(3.0).jog(40.0, 2.8).stop(3.0),
        Route().stand(3.0).walk(3.0, 0.5).stop(2.0).walk(3.0, 1.8).stop(2.0),
    ],
    ids=["a walk", "a turn on the spot", "stairs", "a run", "short walks"],
)
def test_feet_on_one_clock_never_walk_alone(route: Route) -> None:
    events = Session().feed(samples(route, cells=0))
    assert of(StrideTaken, events)
    assert not found(events)


def stride(k: int, length: float = 1.3, degraded: bool = False) -> StrideTaken:
    """Return stride number k of the left foot, of one second from time k on."""
    return StrideTaken(
        t=k + 1.0, known_at=k + 1.0, foot=Foot.LEFT, number=k, t_start=float(k), t_end=k + 1.0,
        displacement=(length, 0.0, 0.0), position=(0.0, 0.0, 0.0), length=abs(length), heading_change=0.0,
        height_change=0.0, covariance=(0.0,) * 6, degraded=degraded, features=StrideFeatures(0.1, 4.0, 1.0),
    )  # fmt: skip


def standing() -> FootClocks:
    """Return the part after the right foot's foot-flat at 0 s; its samples go on for a minute."""
    part = FootClocks()
    part.lone.set_newest(Foot.LEFT, 0.0, 60.0)
    part.receive(FootFlat(t=0.0, known_at=0.0, foot=Foot.RIGHT))
    return part


def reports(part: FootClocks, *events: Event) -> int:
    return sum(len([*part.receive(event), *part.finish(event.known_at)]) for event in events)


def test_two_strides_past_a_standing_foot_are_one_too_many() -> None:
    assert reports(standing(), stride(1), stride(2)) == 1
    assert reports(standing(), *[stride(k) for k in range(1, 9)]) == 1, "once"


def test_a_leg_that_swings_or_steps_on_the_spot_goes_nowhere() -> None:
    assert not reports(standing(), *[stride(k, 1.5 * (-1.0) ** k) for k in range(1, 9)])
    assert not reports(standing(), *[stride(k, 0.1) for k in range(1, 9)])


def test_a_foot_that_moves_between_two_strides_of_the_other_stands_no_more() -> None:
    part = standing()
    for k in range(1, 9):
        lifted = ToeOff(t=k + 1.1, known_at=k + 1.1, foot=Foot.RIGHT)
        lowered = FootFlat(t=k + 1.4, known_at=k + 1.4, foot=Foot.RIGHT)
        assert not reports(part, stride(k), lifted, lowered)


def test_a_foot_whose_samples_end_or_are_missing_may_have_walked_too() -> None:
    part = standing()
    part.lone.set_newest(Foot.LEFT, 0.0, 0.5)
    assert not reports(part, *[stride(k) for k in range(1, 9)])
    gaps = [SampleGap(t=float(k), known_at=k + 1.0, site=RIGHT, duration=0.6) for k in range(1, 9)]
    assert not reports(standing(), *[event for k in range(1, 9) for event in (stride(k), gaps[k - 1])])
    assert not reports(standing(), *[stride(k, degraded=True) for k in range(1, 9)]), "nor is a poor stride a proof"


def test_strides_that_arrive_late_in_one_burst_are_compared_with_what_the_other_foot_did_then() -> None:
    part = standing()
    part.receive(FootFlat(t=20.0, known_at=20.0, foot=Foot.RIGHT))
    assert not reports(part, *[stride(k) for k in range(1, 9)])


@pytest.mark.parametrize("site", [LEFT, RIGHT])
def test_a_foot_with_a_defect_that_spoils_its_strides_proves_nothing(site: Site) -> None:
    def defect(kind: Defect) -> DefectFound:
        return DefectFound(t=0.5, known_at=0.5, site=site, defect=kind, what="", spoils=True)

    part = standing()
    assert not reports(part, defect(Defect.GYRO_UNIT), *[stride(k) for k in range(1, 9)])
    other = Site.LEFT_FOOT if site is RIGHT else RIGHT
    part.reset(other)
    part.lone.set_newest(Foot.LEFT, 9.0, 60.0)
    flat = FootFlat(t=9.0, known_at=9.0, foot=Foot.RIGHT)
    assert not reports(part, flat, *[stride(k) for k in range(9, 13)]), "another device on the other foot"
    part.reset(site)
    part.lone.set_newest(Foot.LEFT, 9.0, 60.0)
    assert reports(part, flat, *[stride(k) for k in range(9, 13)]) == 1, "another device on this foot"


def test_a_recorded_walk_with_a_clock_that_is_10_s_late_is_no_asymmetric_walk(data_dir: Path) -> None:
    session = Session()
    events = session.feed(shift_clock(open_source(data_dir / "ipol_10m_uturn" / "1-1.npz"), 10.0))
    assert found(events)
    assert session.gait is not None and session.gait.asymmetry("step_time") is None


def test_a_gyroscope_that_measures_nothing_is_no_separate_clock(data_dir: Path) -> None:
    session, events = Session(), list[Event]()
    for sample in open_source(data_dir / "gaitmap_examples" / "walk_4x10m_ic.npz"):
        assert isinstance(sample, Sample)
        events += session.feed(evolve(sample, gyro=(0.0, 0.0, 0.0)) if sample.site is LEFT else sample)
    assert [defect.site for defect in of(DefectFound, events) if defect.spoils] == [LEFT]
    assert not found(events)
