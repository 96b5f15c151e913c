"""Tests the report's drawings: positions, counts and labels."""

from __future__ import annotations

import re
from math import cos, radians
from xml.etree.ElementTree import Element, tostring

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pages import parse_page

from solepath import FootPressed, GaitCycleMeasured, WearerMoved
from solepath.body.gait.means import Figure, GaitParameters, StrideFigures
from solepath.emulate.routes.building import BUILDING
from solepath.show.report.bounded import ThinnedList
from solepath.show.report.clock import ReportClock
from solepath.show.report.figures.axes import AxisScale, line, tick_labels, ticks
from solepath.show.report.figures.cycle import gaps, overlaps, stance_spans
from solepath.show.report.figures.pressure import SHADES
from solepath.show.report.figures.space import project, space_figure
from solepath.show.report.soles import MAX_SAMPLES, STATIONS, ReportSole
from solepath.show.tables.plan import PlanPicture, blend
from solepath.show.tables.table import duration_text
from solepath.types import Cell, Foot, Layout, Vec3

L, R = Foot.LEFT, Foot.RIGHT


def test_in_space_x_goes_down_to_the_right_y_up_to_the_right_and_z_up() -> None:
    side, half = cos(radians(30.0)), 0.5
    for position, place in (((2.0, 0.0, 0.0), (2 * side, 2 * half)), ((0.0, 2.0, 0.0), (2 * side, -2 * half))):
        assert project(position, 1.0) == pytest.approx(place)
    assert project((0.0, 0.0, 2.0), 5.0) == pytest.approx((0.0, -10.0))


def moves(*positions: Vec3) -> list[WearerMoved]:
    """Return events of a wearer at these positions, one a second."""
    return [
        WearerMoved(t=float(k), known_at=float(k), position=position, covariance=(0.0,) * 6)
        for k, position in enumerate(positions)
    ]


def test_a_flat_track_is_not_drawn_in_space() -> None:
    for track in ([], moves((0.0, 0.0, 0.0)), moves((0.0, 0.0, 0.0), (9.0, 2.0, 0.9))):
        parent = Element("div")
        assert not space_figure(parent, track) and not list(parent)


def test_a_flat_building_is_drawn_with_larger_heights() -> None:
    parent = Element("div")
    assert space_figure(parent, moves((0.0, 0.0, 0.0), (60.0, 0.0, 0.0), (60.0, 30.0, 3.5), (0.0, 30.0, 3.5)))
    page = parse_page(tostring(parent, encoding="unicode", method="html"))
    assert "Heights are drawn 10 times as large." in page.text
    assert "A square of the floor is 10 m wide" in page.text
    parent = Element("div")
    assert space_figure(parent, moves((0.0, 0.0, 0.0), (2.0, 0.0, 3.0)))
    assert "as large" not in parse_page(tostring(parent, encoding="unicode", method="html")).text


@given(st.lists(st.tuples(st.floats(-1e4, 1e4), st.floats(-1e4, 1e4), st.floats(-1e3, 1e3)), min_size=2, max_size=20))
def test_whatever_the_track_its_drawing_in_space_is_within_its_box(positions: list[Vec3]) -> None:
    parent = Element("div")
    if not space_figure(parent, moves(*positions)):
        return
    svg = next(parent.iter("svg"))
    width, height = (float(word) for word in svg.attrib["viewBox"].split()[2:])
    for path in svg.iter("path"):
        numbers = [float(word) for word in re.findall(r"-?[0-9.]+", path.attrib["d"].replace("h0", ""))]
        assert all(-0.1 <= x <= width + 0.1 for x in numbers[::2]) and len(numbers) % 2 == 0
        assert all(-0.1 <= y <= height + 0.1 for y in numbers[1::2])


@given(st.floats(-1e9, 1e9), st.floats(1e-3, 1e9), st.integers(2, 10))
def test_ticks_are_round_few_and_distinct(low: float, span: float, most: int) -> None:
    values = ticks(low, low + span, most)
    assert 1 <= len(values) <= most
    margin = 1e-6 * (span + abs(low))
    assert all(low - margin <= value <= low + span + margin for value in values)
    assert len(set(tick_labels(values))) == len(values)
    steps = [b - a for a, b in zip(values, values[1:], strict=False)]
    assert max(steps, default=0.0) - min(steps, default=0.0) <= 1e-3 * span + 1e-12 * abs(low)


def test_a_scale_of_nothing_and_a_line_through_one_place_are_drawn_too() -> None:
    assert AxisScale(3.0, 3.0, 10.0, 20.0).at(3.0) == 10.0
    assert line([]) == ""
    assert line([(1.0, 2.0), (1.0, 2.04)]) == "M1 2h0"
    assert line([(1.0, 2.0), (3.0, 2.0)]) == "M1 2L3 2"


@given(st.integers(0, 3000), st.integers(4, 100))
def test_of_a_long_row_few_are_kept_evenly_with_the_first_and_the_last(count: int, most: int) -> None:
    row: ThinnedList[tuple[int]] = ThinnedList()
    for k in range(count):
        row.add((k,), most)
    items = [k for (k,) in row]
    assert len(row) <= most
    assert row.count == count
    if count:
        assert items[0] == 0 and items[-1] == count - 1
        assert len({b - a for a, b in zip(items[:-1], items[1:-1], strict=False)}) <= 1, "evenly"
        assert len(items) >= min(count, most // 2)


def test_times_are_shown_in_a_suitable_unit() -> None:
    assert ReportClock(0.0, 100.0).label == "time, s"
    assert ReportClock(0.0, 900.0).axis_value(120.0) == 2.0
    assert ReportClock(1.7e9, 1.7e9 + 900.0).axis_value(1.7e9 + 120.0) == 2.0
    low, high = ReportClock(5.0, 5.0).span
    assert low < high
    assert [duration_text(t) for t in (0.0, 59.6, 90.0, 3725.0)] == ["0.0 s", "1 min 0 s", "1 min 30 s", "1 h 2 min"]


def figures(stance: float, phase: float | None) -> StrideFigures:
    def one(value: float) -> Figure:
        return Figure(value, None, 10)

    return StrideFigures(one(1.0), one(stance), one(1.0 - stance), phase=None if phase is None else one(phase))


def cycle(left: StrideFigures | None, right: StrideFigures | None, running: bool = False) -> GaitParameters:
    feet = {foot: one for foot, one in ((L, left), (R, right)) if one is not None}
    return GaitParameters(running, feet, StrideFigures(), None)


def test_a_walker_stands_on_both_feet_twice_a_cycle() -> None:
    known = stance_spans(cycle(figures(0.6, 0.5), figures(0.6, 0.5)))
    assert known[L] == [(0.0, 0.6)]
    assert known[R] == [(0.0, pytest.approx(0.1)), (0.5, 1.0)]
    assert overlaps(known[L], known[R]) == [(0.0, pytest.approx(0.1)), (0.5, 0.6)]
    assert gaps(known[L], known[R]) == []


def test_a_runner_flies_twice_a_cycle() -> None:
    known = stance_spans(cycle(figures(0.35, 0.5), figures(0.35, None), True))
    assert overlaps(known[L], known[R]) == []
    assert gaps(known[L], known[R]) == [(0.35, 0.5), (0.85, 1.0)]


def test_a_foot_that_comes_down_nobody_knows_when_is_not_drawn_beside_the_other() -> None:
    assert stance_spans(cycle(figures(0.6, None), figures(0.7, None))) == {L: [(0.0, 0.6)]}
    assert stance_spans(cycle(None, figures(0.7, None))) == {R: [(0.0, 0.7)]}
    only_right = stance_spans(cycle(figures(0.6, None), figures(0.6, 0.4)))
    assert only_right[R][-1][0] == pytest.approx(0.6)


def stride(start: float, off: float, end: float, **other: object) -> GaitCycleMeasured:
    nothing = dict.fromkeys(
        ("step_time", "initial_double_support", "terminal_double_support", "single_support", "phase", "stride_length",
         "speed", "step_length", "step_width", "clearance", "toe_off_angle", "heel_strike_angle", "turning_angle",
         "rise"))  # fmt: skip
    known = {"foot": L, "number": 1, "t": end, "known_at": end, "t_start": start, "t_toe_off": off}
    times = {"stride_time": end - start, "stance_time": off - start, "swing_time": end - off, "cadence": 110.0}
    return GaitCycleMeasured(**(nothing | known | times | {"degraded": False, "steady": True} | other))  # type: ignore[arg-type]


def add_second(sole: ReportSole, start: float, heel: float) -> None:
    """Add 1 s of samples at 100 Hz; the load goes from heel to toe within the first 0.6 s."""
    for k in range(100):
        share = min(k / 60.0, 1.0)
        load = heel if k <= 60 else 0.0
        values = (load * (1.0 - share), load * share)
        centre = (0.05 + 0.15 * share, 0.0) if load else None
        t = start + 0.01 * k
        sole.add_sample(FootPressed(t=t, known_at=t, foot=L, values=values, force=load, centre=centre))


def walked_sole() -> ReportSole:
    sole = ReportSole(Layout(1, L, (Cell(0.05, 0.0), Cell(0.2, 0.0)), 0.25, 1.0))
    for k in range(4):
        add_second(sole, 1.0 * k, 100.0)
        if k:
            sole.add_cycle(stride(1.0 * k, k + 0.6, k + 1.0))
    return sole


def test_loads_of_a_contact_are_means_and_peaks_of_each_cell_and_the_centre_goes_from_heel_to_toe() -> None:
    sole = walked_sole()
    assert sole.contacts == 3 and sole.unit == "N" and sole.drawable_layout
    assert [one / 3 for one in sole.mean_sums] == pytest.approx([50.0, 50.0], rel=0.02)
    assert [one / 3 for one in sole.peak_sums] == pytest.approx([100.0, 100.0], rel=0.02)
    assert [one / 3 for one in sole.force_sums] == pytest.approx([100.0] * STATIONS)
    path = sole.mean_path
    assert len(path) == STATIONS
    assert path[0] == pytest.approx((0.05, 0.0), abs=0.004) and path[-1] == pytest.approx((0.2, 0.0), abs=0.004)
    assert [x for x, _ in path] == sorted([x for x, _ in path])


@pytest.mark.parametrize(
    "other",
    [
        {"degraded": True, "steady": False},
        {"stance_time": 0.3},
        {"t_toe_off": 0.4},
        {"t_start": -9.0, "t_toe_off": -8.0},
        {"t_start": -9.0},
    ],
)
def test_a_contact_that_is_run_missing_or_too_long_does_not_count(other: dict[str, object]) -> None:
    sole = walked_sole()
    sole.add_cycle(stride(3.0, 3.6, 4.0, **other))
    assert sole.contacts == 3


def test_soles_keep_little_however_long_they_are_walked_on() -> None:
    sole = ReportSole()
    for k in range(30):
        add_second(sole, 1.0 * k, 100.0)
    assert len(sole.newest) <= MAX_SAMPLES
    sole.add_sample(FootPressed(t=99.0, known_at=99.0, foot=L, values=(1.0, 2.0, 3.0), force=6.0, centre=None))
    assert sole.cell_sums == [1.0, 2.0, 3.0] and sole.samples == 1, "another insole begins anew"


def test_more_load_is_darker() -> None:
    def light(colour: str) -> float:
        r, g, b = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
        return 0.2126 * r + 0.7152 * g + 0.0722 * b

    lights = [light(blend(SHADES, k / 20.0)) for k in range(21)]
    assert lights == sorted(lights, reverse=True)


def test_the_legend_of_a_narrow_plan_stays_within_the_picture() -> None:
    svg = PlanPicture(BUILDING, width=380.0, columns=1).drawn("narrow")
    width = float(svg.get("width", "0"))
    assert width < 440.0
    labels = [one for one in svg.iter("text") if one.text in {"candidate", "stairs", "lift"}]
    assert len(labels) == 3
    assert all(float(one.get("x", "0")) + 7.0 * len(one.text or "") < width for one in labels)


def test_the_reader_of_pages_rejects_unclosed_tags() -> None:
    with pytest.raises(AssertionError):
        parse_page("<p><b>no</p>")
