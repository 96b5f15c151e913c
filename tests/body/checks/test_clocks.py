"""Feet whose sensors have separate clocks: an event, nothing that compares the feet, and a correction on request."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from statistics import fmean, median

import numpy as np
import pytest
from attrs import evolve
from soak import soaked
from strides import stride
from views import told
from walks import RIGHT, of, samples

from solepath import Foot, GaitCycleMeasured, HeelStrike, Sample, Session, ToeOff
from solepath.body.checks.foot_clocks import MIN_COMPARISONS, FootClocks
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.events import Defect, DefectFound, Event
from solepath.recording import open_source, shift_clock
from solepath.recording.errors import printable
from solepath.show.outcomes.clinic import OutcomeRequest
from solepath.walk.walk import Walk

LEVEL = Route().stand(1.5).walk(40.0, 1.3).stop(1.0)
BETWEEN = ("step_time", "initial_double_support", "terminal_double_support", "single_support", "phase")


@cache
def level() -> tuple[Sample, ...]:
    return samples(LEVEL, cells=0)


def with_late_right_foot(walk: tuple[Sample, ...], delay: float, rate: float = 0.0) -> list[Sample]:
    """Return the walk with a right foot whose clock is late by `delay`, s, and fast by `rate`."""
    shifted = [evolve(s, t=(t := (1.0 + rate) * s.t + delay), known_at=t) if s.site is RIGHT else s for s in walk]
    return sorted(shifted, key=lambda sample: sample.t)


def found(events: list[Event]) -> list[DefectFound]:
    return [event for event in of(DefectFound, events) if event.defect is Defect.CLOCKS]


def steps(
    count: int,
    delay: float = 0.0,
    rate: float = 0.0,
    swings: tuple[float, float] = (0.42, 0.42),
    supports: tuple[float, float] = (0.13, 0.13),
    scatter: float = 0.013,
) -> Iterator[Event]:
    """Yield the contacts, strides and toe-offs of a walker in the order of the right and left foot's own clocks.

    `swings` are the swing times of the left and the right foot, `supports` the double supports after the left and after
    the right foot's contact, s. Hand labels scatter by 5 to 13 ms."""
    random, t, events = np.random.default_rng(3), 1.0, list[Event]()

    def add(kind: type[HeelStrike] | type[ToeOff], foot: Foot, at: float) -> None:
        at += float(random.normal(0.0, scatter))
        if foot is Foot.RIGHT:
            at = (1.0 + rate) * at + delay
        events.append(kind(t=at, known_at=at, foot=foot))
        if kind is HeelStrike:
            events.append(stride(foot, at + 0.05))

    for _ in range(count):
        add(HeelStrike, Foot.LEFT, t)
        add(ToeOff, Foot.RIGHT, t := t + supports[0])
        add(HeelStrike, Foot.RIGHT, t := t + swings[1])
        add(ToeOff, Foot.LEFT, t := t + supports[1])
        t += swings[0]
    return iter(sorted(events, key=lambda event: event.t))


def of_steps(events: Iterator[Event], part: FootClocks | None = None) -> list[DefectFound]:
    part = FootClocks() if part is None else part
    return [output for event in events for output in told(part, event) if isinstance(output, DefectFound)]


@pytest.mark.parametrize("delay", [-0.4, *soaked(0.05)])
def test_feet_with_separate_clocks_are_reported_once_with_the_time_to_add_to_the_right_foot(delay: float) -> None:
    (defect,) = found(Session().feed(with_late_right_foot(level(), delay)))
    assert (defect.site, defect.spoils) == (RIGHT, False)
    assert defect.offset == pytest.approx(-delay, abs=0.02)
    assert defect.sigma is not None and 0.005 < defect.sigma < 0.02
    assert f"{abs(1000.0 * defect.offset):.0f} ms {'late' if delay > 0.0 else 'early'}" in defect.what


def test_clocks_half_a_second_apart_are_found_although_the_steps_look_nearly_simultaneous() -> None:
    (defect,) = found(Session().feed(with_late_right_foot(level(), 0.5)))
    cycle = fmean(one.stride_time for one in of(GaitCycleMeasured, Session().feed(level())))
    assert defect.offset is not None
    assert (defect.offset + 0.5) / cycle == pytest.approx(round((defect.offset + 0.5) / cycle), abs=0.02)
    assert f"give or take whole cycles of {1000.0 * cycle:.0f}"[:-1] in defect.what, "the walk does not tell"
    sentence = f"{defect.site.words}: {defect.what}"
    assert printable(sentence) == sentence, "short enough for a person, and to be printed whole"


@pytest.mark.parametrize(
    "route",
    [
        LEVEL,
        Route().stand(1.5).jog(60.0, 2.8).stop(1.0),
        *soaked(
            Route().stand(1.5).walk(4.0).stairs(24, True, 0.16, 0.30).walk(4.0).stairs(24, False, 0.16, 0.30).stop(1.0),
            Route().stand(1.5).walk(60.0, 1.2).turn(12.0, radius=1.0).walk(10.0).stop(1.0),
        ),
    ],
    ids=["level", "running", "stairs", "a tight circle"],
)  # fmt: skip
def test_feet_on_one_clock_are_not_reported(route: Route) -> None:
    session = Session()
    assert not found(session.feed(samples(route, cells=0)))
    assert len(session._state.find_attribute("comparisons")) >= MIN_COMPARISONS, "enough for a report"


@pytest.mark.parametrize("foot", [Foot.RIGHT, *soaked(Foot.LEFT)])
def test_contacts_from_cells_in_one_shoe_only_are_no_separate_clock(foot: Foot) -> None:
    walker = Walker(LEVEL, seed=4)
    walk = [
        s for one in Foot for s in walker.samples(one, 100.0, LSM6DSOX, layout=layout(96, one) if one is foot else None)
    ]
    assert not found(Session().feed(sorted(walk, key=lambda sample: sample.t)))


def test_a_limp_shows_in_the_swings_and_is_no_separate_clock() -> None:
    limp = (0.48, 0.38)
    assert not of_steps(steps(60, swings=limp))
    assert not of_steps(steps(60, swings=limp, supports=(0.17, 0.11)), None), "the double supports of a limp differ too"
    (defect,) = of_steps(steps(60, delay=0.15, swings=limp))
    assert defect.offset == pytest.approx(-0.15, abs=0.01)
    assert defect.sigma is not None and defect.sigma > 0.015, "less certain than of an even walker"


def test_a_clock_that_runs_200_ppm_fast_is_found_within_ten_minutes_and_again_as_its_offset_grows() -> None:
    defects = of_steps(steps(1600, rate=200e-6))
    assert 60.0 < defects[0].t < 300.0
    assert 3 <= len(defects) <= 6, "each report is half as much again as the one before"
    for defect in defects:
        assert defect.offset == pytest.approx(-200e-6 * defect.t, abs=0.01)


def test_nothing_compares_the_feet_after_their_clocks_were_found_apart() -> None:
    session, walk = Session(), Walk()
    events: list[Event] = []
    for sample in with_late_right_foot(level(), 0.1):
        new = session.feed(sample)
        walk.take(sample, new)
        events += new
    (defect,) = found(events)
    later = [event for event in of(GaitCycleMeasured, events) if event.known_at > defect.known_at]
    assert len(later) > 10
    assert {getattr(cycle, name) for cycle in later for name in BETWEEN} == {None}
    assert all(cycle.stance_time > 0.5 for cycle in later), "a foot alone is measured as before"
    for gait in (session.gait, walk.gait.parameters, walk.recent_gait.parameters):
        assert gait is not None and gait.both.stance_time is not None and gait.asymmetry("stance_time") is not None
        assert {getattr(gait.both, name) for name in BETWEEN} == {None}, "not in the means either"
        assert (gait.asymmetry("step_time"), gait.coordination) == (None, None)
    kept = [cycle for cycles in (*walk.cycles.values(), walk.newest_cycles) for cycle in cycles]
    assert len(kept) > len(later) and {getattr(cycle, name) for cycle in kept for name in BETWEEN} == {None}
    rows = OutcomeRequest(outcomes=True).results(walk).rows
    steps = {row.part: row.value for row in rows if row.name == "step_time"}
    assert steps == {"variability": None, "asymmetry": None}, "what was measured before is withheld too"
    assert [one.what for one in walk.found_defects] == [defect.what]


def means(events: list[Event]) -> dict[tuple[Foot, str], float]:
    """Return the median of step time and double support of each foot, s."""
    cycles = of(GaitCycleMeasured, events)
    return {
        (foot, name): median(value for one in cycles if one.foot is foot and (value := getattr(one, name)) is not None)
        for foot in Foot
        for name in ("step_time", "initial_double_support", "terminal_double_support")
    }


@pytest.mark.parametrize("name", ["1-1", *soaked("5-4", "11-4", "19-4")])
@pytest.mark.soak
def test_step_time_and_double_support_of_an_even_walker_are_right_to_20_ms_once_the_offset_is_undone(
    data_dir: Path, name: str
) -> None:
    path = data_dir / "ipol_10m_uturn" / f"{name}.npz"
    true = means(Session().feed(open_source(path)))
    damaged = list(shift_clock(open_source(path), 0.2))
    (defect,) = found(Session().feed(damaged))
    assert defect.offset is not None
    assert means(Session().feed(shift_clock(damaged, defect.offset))) == pytest.approx(true, abs=0.02)


@pytest.mark.long
def test_a_treadmill_whose_light_barrier_shows_clocks_75_ms_apart_has_even_steps_once_that_is_undone(
    data_dir: Path,
) -> None:
    path = data_dir / "tripod_treadmill" / "PWS.npz"
    (defect,) = found(Session().feed(open_source(path)))
    assert defect.offset == pytest.approx(0.075, abs=0.02)
    truth = np.load(path)
    contacts = {foot: truth["gt_hs_t"][truth["gt_foot"] == number] for number, foot in enumerate(Foot)}
    cycles = of(GaitCycleMeasured, Session().feed(shift_clock(open_source(path), defect.offset)))
    for foot, other in ((Foot.LEFT, Foot.RIGHT), (Foot.RIGHT, Foot.LEFT)):
        true = median([t - contacts[other][contacts[other] < t].max() for t in contacts[foot][1:]])
        measured = median([one.step_time for one in cycles if one.foot is foot and one.step_time is not None])
        assert measured == pytest.approx(true, abs=0.02)


@pytest.mark.long
def test_ten_recorded_walkers_on_one_clock_are_not_reported(data_dir: Path) -> None:
    paths = sorted((data_dir / "ipol_10m_uturn").glob("*-4.npz"))
    assert len(paths) == 10
    for path in paths:
        assert not found(Session().feed(open_source(path))), path.stem
