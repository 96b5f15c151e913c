"""Gait cycles measured, against the true motion of emulated walkers."""

from __future__ import annotations

import csv
from contextlib import closing
from functools import cache
from math import degrees, pi
from pathlib import Path

import numpy as np
import pytest

from solepath import Foot, GaitCycleMeasured, GaitParameters, Sample, Session
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.truth import Truth
from solepath.emulate.wearers.walker import Walker
from solepath.show.output import CYCLE_COLUMNS, TrackFiles
from solepath.show.tables.gait import gait_lines
from solepath.walk.walk import Walk

LEVEL = Route().stand(1.5).walk(14.0, 1.3).stop(1.0)
BENT = Route().stand(1.5).walk(7.0, 1.2).turn(pi / 2, radius=1.0).walk(7.0).stop(1.0)
HALTED = Route().stand(1.5).walk(7.0, 1.2).stop(4.0).walk(7.0).stop(1.0)
JOGGED = Route().stand(1.5).jog(30.0, 2.8).stop(1.0)
OTHER = {Foot.LEFT: Foot.RIGHT, Foot.RIGHT: Foot.LEFT}


@cache
def walked(
    route: Route, cells: int = 0, feet: tuple[Foot, ...] = tuple(Foot)
) -> tuple[Truth, tuple[GaitCycleMeasured, ...], GaitParameters | None]:
    """Return the truth, the strides and the running means of an emulated walk."""
    walker = Walker(route, seed=102)
    samples = [
        sample
        for foot in feet
        for sample in walker.samples(foot, 100.0, LSM6DSOX, layout=layout(cells, foot) if cells else None)
    ]
    session = Session()
    events = session.feed(sorted(samples, key=lambda sample: sample.t)) + session.finish()
    return walker.truth(), tuple(event for event in events if isinstance(event, GaitCycleMeasured)), session.gait


def really(truth: Truth, foot: Foot) -> dict[float, dict[str, float]]:
    """Return the true values of a foot's strides, by their second contact, s."""
    own, other = truth.feet[foot], truth.feet[OTHER[foot]]
    found = {}
    for before, step in zip(own.strides, own.strides[1:], strict=False):
        start, toe_off, end = before.t_heel_strike, step.t_toe_off, step.t_heel_strike
        between = [one for one in other.strides if start < one.t_heel_strike < end]
        if toe_off - start > 2.0 or len(between) != 1:
            continue
        (across,) = between
        height = own.pose(np.linspace(step.t_start, step.t_end, 200)).position[:, 2]
        found[end] = {
            "t_toe_off": toe_off,
            "stride_time": end - start,
            "stance_time": toe_off - start,
            "swing_time": end - toe_off,
            "step_time": end - across.t_heel_strike,
            "initial_double_support": across.t_toe_off - start,
            "terminal_double_support": toe_off - across.t_heel_strike,
            "single_support": min(toe_off, across.t_heel_strike) - max(start, across.t_toe_off),
            "phase": (across.t_heel_strike - start) / (end - start),
            "stride_length": step.length,
            "speed": step.length / (end - start),
            "clearance": float(height.max() - max(height[0], height[-1])),
            "toe_off_angle": -float(own.motion.pitch(np.array([toe_off - 1e-6]))[0]),
            "heel_strike_angle": float(own.motion.pitch(np.array([end]))[0]),
            "turning_angle": step.heading_change,
            "rise": step.displacement[2],
            "cadence": 120.0 / (end - start),
        }
    return found


def errors(route: Route, name: str, cells: int = 0) -> list[float]:
    """Return the errors of a parameter over the strides of both feet; every stride is found, and none invented.

    The first two strides, in which a foot that has stood sets off, are left out.
    """
    truth, strides, _ = walked(route, cells)
    found = []
    for foot in Foot:
        true = really(truth, foot)
        mine = [stride for stride in strides if stride.foot is foot]
        assert len(mine) == len(true) > 0
        for stride, (end, values) in zip(mine, true.items(), strict=True):
            assert abs(stride.t - end) < 0.06
            if stride.number > 1:
                found.append(getattr(stride, name) - values[name])
    return found


@pytest.mark.parametrize(
    ("name", "worst"),
    [
        ("stride_time", 0.015),
        ("step_time", 0.015),
        ("cadence", 1.5),
        ("phase", 0.01),
        ("stance_time", 0.045),
        ("swing_time", 0.045),
        ("initial_double_support", 0.045),
        ("terminal_double_support", 0.045),
        ("single_support", 0.045),
        ("stride_length", 0.04),
        ("speed", 0.05),
        ("clearance", 0.02),
        ("heel_strike_angle", 0.07),
        ("turning_angle", 0.03),
        ("rise", 0.05),
    ],
)
@pytest.mark.parametrize("cells", [0, 96])
def test_each_stride_is_measured_as_it_was(name: str, worst: float, cells: int) -> None:
    assert max(map(abs, errors(LEVEL, name, cells))) <= worst


def test_the_toe_off_angle_is_as_right_as_the_time_of_toe_off() -> None:
    """The heel comes up by 8 rad/s then: 10 ms are 5 degrees."""
    truth, strides, _ = walked(LEVEL)
    for stride in strides:
        true = really(truth, stride.foot)
        values = true[min(true, key=lambda end: abs(end - stride.t))]
        late = stride.t_toe_off - values["t_toe_off"]
        assert stride.toe_off_angle is not None
        assert abs(stride.toe_off_angle - values["toe_off_angle"]) <= 0.06 + 10.0 * abs(late)


def test_one_foot_alone_gives_no_parameter_between_the_feet() -> None:
    _, strides, gait = walked(LEVEL, 0, (Foot.RIGHT,))
    assert len(strides) >= 7
    for stride in strides:
        assert stride.step_time is stride.initial_double_support is stride.terminal_double_support is None
        assert stride.single_support is stride.phase is stride.double_support is stride.double_support_share is None
        assert stride.single_support_share is None
        assert stride.stride_length is not None
    assert gait is not None and gait.coordination is None and gait.asymmetry("swing_time") is None
    assert set(gait.feet) == {Foot.RIGHT}
    assert gait.cadence == pytest.approx(cadence(LEVEL), abs=1.5)


def test_an_insole_without_an_inertial_sensor_gives_times_alone() -> None:
    walker = Walker(LEVEL, seed=102)
    both = [s for foot in Foot for s in walker.samples(foot, 100.0, LSM6DSOX, layout=layout(96, foot))]
    session = Session()
    bare = [Sample(s.t, s.site, pressure=s.pressure) for s in sorted(both, key=lambda s: s.t)]
    strides = [event for event in session.feed(bare) if isinstance(event, GaitCycleMeasured)]
    truth = walker.truth()
    assert len(strides) >= 16
    for stride in strides:
        true = really(truth, stride.foot)
        values = true[min(true, key=lambda end: abs(end - stride.t))]
        assert stride.stride_length is stride.speed is stride.clearance is stride.toe_off_angle is None
        assert stride.stride_time == pytest.approx(values["stride_time"], abs=0.03)
        assert stride.stance_time == pytest.approx(values["stance_time"], abs=0.06)
        assert stride.double_support == pytest.approx(
            values["initial_double_support"] + values["terminal_double_support"], abs=0.12
        )
    assert session.gait is not None and session.gait.both.stride_length is None
    assert session.gait.cadence == pytest.approx(cadence(LEVEL), abs=1.5)


def cadence(route: Route) -> float:
    """Return the true cadence between the first and the last stride of each foot, steps/min."""
    truth, *_ = walked(route)
    times = [values["stride_time"] for foot in Foot for values in list(really(truth, foot).values())[1:-1]]
    return 120.0 * len(times) / sum(times)


def test_a_stand_is_no_part_of_a_stride_and_the_first_after_it_is_not_steady() -> None:
    truth, strides, _ = walked(HALTED)
    assert max(stride.stride_time for stride in strides) < 2.0
    for foot in Foot:
        own = [stride for stride in strides if stride.foot is foot]
        after = [later for before, later in zip(own, own[1:], strict=False) if later.t_start > before.t + 1.0]
        assert len(after) == 1
        assert not after[0].steady and not own[0].steady


def test_strides_round_a_bend_are_not_steady() -> None:
    _, strides, gait = walked(BENT)
    turned = [stride for stride in strides if abs(stride.turning_angle or 0.0) > 0.2]
    assert len(turned) >= 2 and not any(stride.steady for stride in turned)
    assert gait is not None and gait.both.stride_time is not None
    assert gait.both.stride_time.strides <= len(strides) - len(turned)


def test_a_runner_is_in_the_air_where_a_walker_stands_on_both_feet() -> None:
    truth, strides, gait = walked(JOGGED)
    flights = [v["initial_double_support"] for foot in Foot for v in really(truth, foot).values()]
    assert np.median(flights) < 0.0
    steady = [stride for stride in strides if stride.steady]
    assert len(steady) >= 15 and all(stride.running for stride in steady)
    assert np.median([stride.initial_double_support or 0.0 for stride in steady]) < 0.0
    assert gait is not None and gait.running and gait.both.double_support is not None
    assert gait.both.double_support < 0.0
    for stride in steady:
        assert stride.single_support is not None and stride.single_support <= stride.stance_time + 1e-9


def test_gait_csv_has_a_line_for_each_stride_and_empty_fields_where_nothing_is_known(tmp_path: Path) -> None:
    _, strides, _ = walked(LEVEL, 0, (Foot.RIGHT,))
    with closing(TrackFiles(tmp_path)) as files:
        for stride in strides:
            files.write(stride)
    with (tmp_path / "gait_cycles.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(strides) and tuple(rows[0]) == CYCLE_COLUMNS
    for row, stride in zip(rows, strides, strict=True):
        assert (row["foot"], row["steady"], row["step_time_s"]) == ("right", str(int(stride.steady)), "")
        assert float(row["t_s"]) == stride.t
        assert float(row["stride_length_m"]) == pytest.approx(stride.stride_length, abs=1e-6)
        assert float(row["toe_off_angle_deg"]) == pytest.approx(degrees(stride.toe_off_angle), abs=1e-6)


def test_the_table_is_of_walking_and_of_running_each_if_there_was_any() -> None:
    walk = Walk()
    assert gait_lines(walk) == []
    for stride in walked(LEVEL)[1]:
        walk.add(stride)
    text = "\n".join(gait_lines(walk))
    assert "walking, steady strides" in text and "running" not in text
    for word in ("cadence", "stride length", "stance %", "heel-strike angle", "coordination"):
        assert word in text
    for stride in walked(JOGGED)[1]:
        walk.add(stride)
    assert "running, steady strides" in "\n".join(gait_lines(walk))
