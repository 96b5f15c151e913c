"""Insoles in newtons that carry nobody, and sensors that repeat their values alone or together."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from math import hypot
from statistics import median

import pytest
from attrs import evolve
from walks import of

from solepath import Defect, DefectFound, Foot, Sample, Session, Site, StrideTaken
from solepath.calibration import Calibration, InsoleCalibration, Newtons
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.types import Vec3

WALKER = Walker(Route().stand(2.0).walk(20.0, 1.3).stop(2.0), seed=1)
MOST_PER_CELL = 1e5
"""Largest force of a cell, N, so that no value is cut."""


@cache
def walk() -> tuple[Sample, ...]:
    """Return a walk with an insole of 96 cells, whose values are forces in N."""
    return tuple(WALKER.samples(Foot.LEFT, 50.0, LSM6DSOX, layout=layout(96, Foot.LEFT)))


def reported_with(factor: float) -> tuple[list[DefectFound], list[StrideTaken]]:
    """Return the defects and strides of a wearer whose calibration multiplies all forces by `factor`."""
    newtons = Newtons((0.0, factor, 0.0, 0.0), 0.0, MOST_PER_CELL)
    session = Session(calibration=Calibration(insoles={Foot.LEFT: InsoleCalibration(newtons=newtons)}))
    events = session.feed(walk()) + session.finish()
    return of(DefectFound, events), of(StrideTaken, events)


def test_an_insole_with_the_weight_of_the_wearer_is_silent() -> None:
    found, strides = reported_with(1.0)
    assert found == [] and len(strides) > 10
    loads = [load for stride in strides if (load := stride.features.contact_load) is not None]
    assert 200.0 < median(loads) < 1200.0


@pytest.mark.parametrize("factor", [0.02, 50.0])
def test_an_insole_in_newtons_with_the_weight_of_a_bird_or_an_elephant_is_named(factor: float) -> None:
    (event,), strides = reported_with(factor)
    assert event.defect is Defect.PRESSURE_UNIT and event.site is Site.LEFT_FOOT and event.spoils
    shown = float(event.what.split()[3])
    assert event.what == f"the insole shows {shown:.3g} N on the foot that carries the wearer: " + (
        "check the unit of its values and its calibration"
    )
    assert shown < 40.0 if factor < 1.0 else shown > 4000.0
    later = [stride.degraded for stride in strides if stride.t_start > event.t]
    assert len(later) >= 3 and all(later)


def held(acc: bool, gyro: bool) -> Callable[[int, Sample], Sample]:
    """Return a change of a walk that holds every second value of the accelerometer, of the gyroscope or of both."""

    def change(number: int, sample: Sample) -> Sample:
        before = walk()[number - number % 2]
        return evolve(sample, acc=before.acc if acc else sample.acc, gyro=before.gyro if gyro else sample.gyro)

    return change


@pytest.mark.parametrize(
    ("acc", "gyro", "words"),
    [
        (True, False, "the accelerometer repeats values"),
        (False, True, "the gyroscope repeats values"),
        (True, True, "both sensors repeat values"),
    ],
)
def test_it_is_named_which_sensor_repeats_its_values(acc: bool, gyro: bool, words: str) -> None:
    change = held(acc, gyro)
    session = Session()
    events = session.feed([change(number, sample) for number, sample in enumerate(walk())]) + session.finish()
    (event,) = of(DefectFound, events)
    assert event.defect is Defect.REPEATED and not event.spoils
    assert event.what.startswith(f"{words}: samples come more often than")
    strides = of(StrideTaken, events)
    assert len(strides) > 10 and not any(stride.degraded for stride in strides)


@pytest.mark.parametrize(("name", "quantity"), [("accelerometer", "acc"), ("gyroscope", "gyro")])
def test_one_of_two_sensors_that_says_the_same_while_the_other_moves_is_stuck(name: str, quantity: str) -> None:
    fastest = max(walk(), key=lambda sample: hypot(*(sample.gyro or ())))
    stuck = {quantity: getattr(fastest, quantity)}
    session = Session()
    events = session.feed([evolve(sample, **stuck) if sample.t >= 5.0 else sample for sample in walk()])
    found = [one for one in of(DefectFound, events) if one.defect is Defect.REPEATED]
    text = f"the {name} repeats the same values while the foot moves: it is stuck; restart the sensor"
    assert found and (found[-1].what, found[-1].spoils) == (text, True)


@pytest.mark.parametrize("speed", [0.3, 1.2])
@pytest.mark.parametrize("value", [(0.0, 0.0, 0.0), (0.01, 0.02, -0.01)])
def test_a_gyroscope_that_has_shown_a_walk_and_stops_is_stuck_whatever_it_says(value: Vec3, speed: float) -> None:
    samples = Walker(Route().stand(2.0).walk(8.0, speed), seed=7).samples(Foot.LEFT, 100.0, LSM6DSOX)
    since = 0.5 * samples[-1].t
    session = Session()
    events = session.feed([evolve(sample, gyro=value) if sample.t >= since else sample for sample in samples])
    (found,) = of(DefectFound, events)
    assert found.defect is Defect.REPEATED and found.spoils and found.known_at < since + 1.5


@pytest.mark.parametrize("stuck", Foot)
@pytest.mark.parametrize("other_walks", [True, False])
def test_a_sensor_that_says_the_same_while_three_strides_of_the_other_foot_begin_is_stuck(
    stuck: Foot, other_walks: bool
) -> None:
    """A wearer who stands still may have a sensor without noise, and a foot may stand for one stride of the other."""
    quiet = sorted([one for foot in Foot for one in WALKER.samples(foot, 50.0)], key=lambda sample: sample.t)
    standing = [one for one in quiet if one.site.foot is stuck and one.t >= 8.0 and hypot(*(one.gyro or ())) < 0.05]
    walked, last, since = quiet, standing[0], standing[0].t
    session, events = Session(), []
    for sample in walked:
        is_same = sample.t >= since and (sample.site.foot is stuck or not other_walks)
        still = last if sample.site.foot is stuck else evolve(last, acc=(0.0, 0.0, 9.81), gyro=(0.0, 0.0, 0.0))
        events += session.feed(evolve(sample, acc=still.acc, gyro=still.gyro) if is_same else sample)
    found = [one for one in of(DefectFound, events) if one.defect is Defect.REPEATED]
    if not other_walks:
        assert found == []
        return
    (event,) = found
    assert event.site.foot is stuck and event.spoils
    assert event.what.startswith("every sample has been the same for ")
    assert event.what.endswith(" s, while the other foot walks: the sensor is stuck; restart it")
    began = [one.t_start for one in of(StrideTaken, events) if one.foot is not stuck and one.t <= event.t]
    assert sum(t_start >= since for t_start in began) in (3, 4), "the first one may begin before it is seen"
