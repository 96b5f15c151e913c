"""Defects of a foot's samples: found in emulated and in recorded walks, silent on what is whole at any mounting."""

from __future__ import annotations

from math import degrees
from pathlib import Path

import pytest
from attrs import evolve
from hypothesis import given, settings
from hypothesis import strategies as st
from one_foot import Change, clipped, run, scaled, signed, vectors
from walks import of

from solepath import Defect, DefectFound, Foot, HeelStrike, Sample, Session, Site, StrideTaken
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.recording import read_samples
from solepath.types import Vec3
from solepath.types.vector import GRAVITY, normalise, rotate

WALK = Walker(Route().stand(1.5).walk(22.0, 1.3).stop(1.0), seed=1).samples(Foot.LEFT, 100.0, LSM6DSOX)
"""A walk of 22 m with an inertial sensor that has no defect."""


DAMAGES: dict[str, tuple[Defect, Change]] = {
    "in g": (Defect.ACC_UNIT, vectors(acc=scaled(1.0 / GRAVITY))),
    "a quarter of the range": (Defect.WRONG_SCALE, vectors(acc=scaled(0.25))),
    "in mg": (Defect.ACC_UNIT, vectors(acc=scaled(1e3 / GRAVITY))),
    "raw counts of the accelerometer": (Defect.ACC_UNIT, vectors(acc=scaled(2048.0 / GRAVITY))),
    "deg/s": (Defect.GYRO_UNIT, vectors(gyro=scaled(degrees(1.0)))),
    "mdeg/s": (Defect.GYRO_UNIT, vectors(gyro=scaled(1e3 * degrees(1.0)))),
    "a gyroscope that is off": (Defect.GYRO_UNIT, vectors(gyro=scaled(0.0))),
    "ms": (Defect.TIME_UNIT, lambda sample: evolve(sample, t=1e3 * sample.t, known_at=None)),
    "ms since 1970": (Defect.TIME_UNIT, lambda sample: evolve(sample, t=1.7e12 + 1e3 * sample.t, known_at=None)),
    "clipped": (Defect.CLIPPED, vectors(clipped(2.0 * GRAVITY), clipped(4.36))),
    "gyroscope x mirrored": (Defect.AXES, vectors(gyro=signed(-1.0, 1.0, 1.0))),
    "gyroscope y mirrored": (Defect.AXES, vectors(gyro=signed(1.0, -1.0, 1.0))),
    "gyroscope z mirrored": (Defect.AXES, vectors(gyro=signed(1.0, 1.0, -1.0))),
    "accelerometer x mirrored": (Defect.AXES, vectors(acc=signed(-1.0, 1.0, 1.0))),
    "axes exchanged": (Defect.AXES, vectors(gyro=lambda v: (v[1], v[0], v[2]))),
}


UNUSABLE = ("in mg", "raw counts of the accelerometer", "mdeg/s", "ms", "ms since 1970")
"""Damages whose samples give no stride at all."""

UNLIKELY = (
    "in g", "a quarter of the range", "deg/s", "a gyroscope that is off", "gyroscope y mirrored",
    "accelerometer x mirrored",
)  # fmt: skip
"""Damages after which no foot can carry a walker as the data have it, so that there is no stride."""


@pytest.mark.parametrize("name", DAMAGES)
def test_a_damaged_sensor_is_named_and_whatever_strides_follow_are_degraded(name: str) -> None:
    defect, change = DAMAGES[name]
    fed = WALK[:600] if name in UNUSABLE else WALK
    found, strides = run([change(sample) for sample in fed])
    (event,) = [event for event in found if event.defect is defect]
    assert event.site is Site.LEFT_FOOT and event.spoils and event.what
    later = [stride for stride in strides if stride.t_start > event.t]
    assert all(stride.degraded for stride in later)
    assert len(later) >= (0 if name in (*UNUSABLE, *UNLIKELY) else 3)


def without_gravity(samples: list[Sample]) -> list[Sample]:
    """Return what a device sends that subtracts gravity by its own attitude."""
    session, removed = Session(poses=True), []
    for sample in samples:
        session.feed(sample)
        w, x, y, z = session._state.feet[Foot.LEFT].corrector.attitude
        ax, ay, az = sample.acc or (0.0, 0.0, 0.0)
        ux, uy, uz = rotate((w, -x, -y, -z), (0.0, 0.0, GRAVITY))
        removed.append(evolve(sample, acc=(ax - ux, ay - uy, az - uz)))
    return removed


def test_gravity_that_a_device_removed_is_named() -> None:
    assert Defect.NO_GRAVITY in {event.defect for event in run(without_gravity(WALK))[0]}


@pytest.mark.soak
def test_the_axes_that_are_offered_close_the_strides(data_dir: Path) -> None:
    _, change = DAMAGES["axes exchanged"]
    damaged = [change(sample) for sample in read_samples(data_dir / "openshoe_loops" / "m30.npz")]
    *_, event = [event for event in run(damaged)[0] if event.defect is Defect.AXES]
    assert event.axes == (2, 1, 3)

    def corrected(sample: Sample) -> Sample:
        assert sample.gyro is not None and event.axes is not None
        x, y, z = [(1.0 if axis > 0 else -1.0) * sample.gyro[abs(axis) - 1] for axis in event.axes]
        return evolve(sample, gyro=(x, y, z))

    assert run([corrected(sample) for sample in damaged])[0] == []


def test_no_axes_are_offered_when_the_motion_stays_in_one_plane() -> None:
    _, change = DAMAGES["axes exchanged"]
    (event,) = run([change(sample) for sample in WALK])[0]
    assert event.defect is Defect.AXES and event.axes is None


quaternions = st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda q: sum(v * v for v in q) > 0.1).map(normalise)


@settings(max_examples=8)
@given(quaternions)
def test_a_whole_sensor_is_silent_at_any_mounting(mounting: tuple[float, float, float, float]) -> None:
    def turn(v: Vec3) -> Vec3:
        return rotate(mounting, v)

    found, strides = run([vectors(turn, turn)(sample) for sample in WALK])
    assert found == [] and len(strides) > 15


def test_a_defect_is_reported_again_only_for_another_device() -> None:
    _, change = DAMAGES["deg/s"]
    session = Session()
    damaged = [change(sample) for sample in WALK]
    first = session.feed(damaged)
    later = session.feed([evolve(sample, t=sample.t + 100.0) for sample in damaged])
    assert len(of(DefectFound, first)) == 1 and of(DefectFound, later) == []
    session._state.reset(Site.LEFT_FOOT)
    again = session.feed([evolve(sample, t=sample.t + 200.0) for sample in damaged])
    assert [event.defect for event in of(DefectFound, again)] == [Defect.GYRO_UNIT]


def test_an_insole_of_noise_or_of_coarse_values_is_named() -> None:
    walk = Walker(Route().stand(2.0).walk(20.0, 1.3).stop(2.0), seed=1)
    samples = walk.samples(Foot.LEFT, 100.0, LSM6DSOX, layout=layout(96, Foot.LEFT))
    assert run(samples)[0] == []
    coarse = [evolve(s, pressure=tuple([float(round(0.02 * cell)) for cell in s.pressure or ()])) for s in samples]
    session = Session()
    events = session.feed(coarse)
    assert Defect.PRESSURE_UNIT in {event.defect for event in of(DefectFound, events)}
    assert len(of(HeelStrike, events)) > 1.5 * len(of(StrideTaken, events))


RECORDED = ("openshoe_loops/m02", "xio_closed_walks/straightLine", "tripod_treadmill/PWS", "ipol_10m_uturn/1-1")


@pytest.mark.parametrize("name", RECORDED)
@pytest.mark.long
def test_a_recording_is_silent_and_with_a_mirrored_axis_it_is_not(name: str, data_dir: Path) -> None:
    samples = [sample for sample in read_samples(data_dir / f"{name}.npz") if sample.t < 60.0]
    assert [event for event in run(samples)[0] if event.defect is not Defect.CLOCKS] == []
    for change in (vectors(gyro=signed(1.0, 1.0, -1.0)), vectors(acc=signed(1.0, -1.0, 1.0))):
        found, _ = run([change(sample) for sample in samples])
        assert {event.site for event in found if event.defect is Defect.AXES} == {sample.site for sample in samples}


SLOW = Walker(Route().stand(1.5).walk(6.0, 0.4).stop(1.0), seed=3).samples(Foot.LEFT, 100.0, LSM6DSOX)
"""A walk of 6 m at 0.4 m/s, with strides of two seconds."""


def test_a_slow_walker_is_silent_and_with_a_mirrored_axis_is_not() -> None:
    assert run(SLOW)[0] == []
    found, _ = run([vectors(gyro=signed(1.0, -1.0, 1.0))(sample) for sample in SLOW])
    assert Defect.AXES in {event.defect for event in found}


@pytest.mark.parametrize("name", ["coleta1", "coleta2", "coleta3", "leituras2", "slow_walk_10hz"])
def test_patients_who_walk_slowly_have_sensors_without_fault(name: str, data_dir: Path) -> None:
    """Some of these sensors cut off peaks, and one is read too rarely."""
    found, strides = run([*read_samples(data_dir / "slow_gait" / f"{name}.npz")])
    assert strides and {event.defect for event in found} <= {Defect.CLIPPED, Defect.LOW_RATE}


@pytest.mark.parametrize("name", ["walking", "squatting", "3d_hand_movement"])
def test_hops_and_other_motion_are_no_wrong_accelerometer(name: str, data_dir: Path) -> None:
    """In a flight the specific force is nearly 0; at rest these sensors read 9.9 m/s^2."""
    found, _ = run([*read_samples(data_dir / "sevivi_hops" / f"{name}.npz")])
    assert not {event.defect for event in found} & {Defect.ACC_UNIT, Defect.NO_GRAVITY, Defect.WRONG_SCALE}


@pytest.mark.parametrize(("factor", "words"), [(1.5, "too far apart"), (1.0 / 1.5, "too close")])
@pytest.mark.parametrize("walk", [WALK, SLOW], ids=["walking", "walking slowly"])
def test_times_that_are_wrong_by_a_factor_are_named(walk: list[Sample], factor: float, words: str) -> None:
    found, _ = run([evolve(sample, t=factor * sample.t, known_at=None) for sample in walk])
    (event,) = found
    assert event.defect is Defect.CONTRADICTION and f"the times of the samples are {words}" in event.what
    found, _ = run([vectors(gyro=scaled(factor))(sample) for sample in walk])
    assert [event.what for event in found] == [event.what], "a scale of the gyroscope looks the same"


@pytest.mark.parametrize("size", [0.125, 0.25, 0.5, 2.0, 4.0, 8.0])
@pytest.mark.parametrize("walk", [WALK, SLOW], ids=["walking", "walking slowly"])
def test_a_wrong_range_of_the_gyroscope_is_named_with_its_factor(
    request: pytest.FixtureRequest, walk: list[Sample], size: float
) -> None:
    if walk is SLOW and size <= 0.25:
        request.applymarker(pytest.mark.xfail(reason="a foot that hardly turns takes no swing", strict=True))
    factor, wrong = (f"{size:g}", "large") if size > 1.0 else (f"{1.0 / size:g}", "small")
    found, _ = run([vectors(gyro=scaled(size))(sample) for sample in walk])
    (cause,) = [event for event in found if event.defect is not Defect.IMPOSSIBLE_MOTION]
    if cause.defect is Defect.GYRO_UNIT:
        assert size == 8.0 and "the range of the gyroscope is declared several times too large" in cause.what
    else:
        assert f"the range of the gyroscope is declared about {factor} times too {wrong}" in cause.what


def test_of_an_accelerometer_one_thing_is_said() -> None:
    """Findings on its size exclude each other, and axes are not judged with it."""
    for factor in (1.0 / GRAVITY, 0.02, 0.25, 2.0):
        found, _ = run([vectors(acc=scaled(factor), gyro=signed(1.0, -1.0, 1.0))(sample) for sample in WALK])
        assert len([event for event in found if event.defect is not Defect.IMPOSSIBLE_MOTION]) == 1


def test_a_gyroscope_with_a_large_bias_has_the_axes_that_it_has() -> None:
    def biased(v: Vec3) -> Vec3:
        return v[0] + 0.2, v[1] - 0.25, v[2] + 0.15  # 20 degrees/s in all, more than any sheet allows

    assert run([vectors(gyro=biased)(sample) for sample in WALK])[0] == []


def test_a_lift_is_no_wrong_scale() -> None:
    def pushed(sample: Sample) -> Sample:
        assert sample.acc is not None
        x, y, z = sample.acc
        factor = 1.2 if 5.0 <= sample.t < 7.0 else 0.8 if 15.0 <= sample.t < 17.0 else 1.0
        return evolve(sample, acc=(factor * x, factor * y, factor * z))

    rest = Walker(Route().stand(25.0), seed=2).samples(Foot.LEFT, 100.0, LSM6DSOX)
    assert run([pushed(sample) for sample in rest])[0] == []
    (event,) = run([vectors(acc=scaled(1.2))(sample) for sample in rest])[0]
    assert event.defect is Defect.WRONG_SCALE


@pytest.mark.soak
def test_a_runner_has_no_wrong_scale_and_no_wrong_axes() -> None:
    for speed in (2.2, 2.8, 3.5):
        jog = Walker(Route().stand(1.5).jog(60.0, speed).stop(1.0), seed=102)
        assert run(jog.samples(Foot.LEFT, 100.0, LSM6DSOX))[0] == []
