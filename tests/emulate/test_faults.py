"""What goes wrong with insoles goes wrong in the samples of that site, from then on, and nowhere else."""

from collections.abc import Callable
from math import isnan

import pytest
from attrs import evolve

from solepath.emulate.faults import cut_off, dead, missing, never_unloads, saturated, silent, stuck, swapped
from solepath.emulate.radio import Radio
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.suit import limb_samples
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot, Sample, Site
from solepath.wire.insole import parse_frame

LEFT, RIGHT = Site.LEFT_FOOT, Site.RIGHT_FOOT
WALKER = Walker(Route().stand(1.0).walk(3.0, 1.2).stop(1.0), seed=2)
SAMPLES = sorted(
    [sample for foot in Foot for sample in WALKER.samples(foot, 50.0, layout=layout(24, foot))],
    key=lambda sample: sample.t,
)


def loads(samples: list[Sample], site: Site, cell: int, since: float = 0.0) -> list[float]:
    return [s.pressure[cell] for s in samples if s.site is site and s.pressure is not None and s.t >= since]


@pytest.mark.parametrize(
    "spoil",
    [
        lambda samples: dead(samples, LEFT, {3, 7}, 2.0),
        lambda samples: stuck(samples, LEFT, {3, 7}, since=2.0),
        lambda samples: saturated(samples, LEFT, {3, 7}, 204.75, 2.0),
        lambda samples: missing(samples, LEFT, {3, 7}, 2.0),
    ],
    ids=["dead", "stuck", "saturated", "missing"],
)
def test_only_the_cells_of_that_foot_fail_and_only_from_then_on(
    spoil: Callable[[list[Sample]], list[Sample]],
) -> None:
    found = spoil(SAMPLES)
    assert len(found) == len(SAMPLES)
    for one, now in zip(SAMPLES, found, strict=True):
        assert evolve(now, pressure=None) == evolve(one, pressure=None)
        if one.site is RIGHT or one.t < 2.0:
            assert now == one
        else:
            assert one.pressure is not None and now.pressure is not None
            for k, (was, is_now) in enumerate(zip(one.pressure, now.pressure, strict=True)):
                assert k in {3, 7} or was == is_now


def test_failed_cells_say_what_such_cells_say() -> None:
    assert set(loads(dead(SAMPLES, LEFT, [5]), LEFT, 5)) == {0.0}
    assert set(loads(stuck(SAMPLES, LEFT, [5], 12.0), LEFT, 5)) == {12.0}
    first = loads(SAMPLES, LEFT, 5, 2.0)[0]
    assert set(loads(stuck(SAMPLES, LEFT, [5], since=2.0), LEFT, 5, 2.0)) == {first}
    assert set(loads(saturated(SAMPLES, LEFT, [5], 204.75), LEFT, 5)) == {204.75}
    assert all(isnan(load) for load in loads(missing(SAMPLES, LEFT, [5]), LEFT, 5))
    assert {len(s.pressure or ()) for s in cut_off(SAMPLES, LEFT, 10) if s.site is LEFT} == {10}
    assert {s.pressure for s in cut_off(SAMPLES, LEFT, 0) if s.site is LEFT} == {None}


def test_an_insole_that_never_unloads_bears_something_in_the_air_too() -> None:
    found = never_unloads(SAMPLES, RIGHT, 3.0)
    for cell in range(24):
        was, now = loads(SAMPLES, RIGHT, cell), loads(found, RIGHT, cell)
        assert min(now) >= 3.0 and now == [load + 3.0 for load in was]
    assert [s for s in found if s.site is LEFT] == [s for s in SAMPLES if s.site is LEFT]


def test_swapped_feet_are_each_other_s_and_twice_swapped_as_before() -> None:
    found = swapped(SAMPLES)
    assert [s.acc for s in found if s.site is LEFT] == [s.acc for s in SAMPLES if s.site is RIGHT]
    assert swapped(found) == SAMPLES
    limbs = limb_samples(WALKER, 10.0, seed=1)
    whole = swapped(limbs, whole_legs=True)
    assert [s.quat for s in whole if s.site is Site.LEFT_THIGH] == [s.quat for s in limbs if s.site is Site.RIGHT_THIGH]
    assert [s for s in whole if s.site is Site.PELVIS] == [s for s in limbs if s.site is Site.PELVIS]
    assert [s for s in swapped(limbs) if s.site is Site.LEFT_SHANK] == [s for s in limbs if s.site is Site.LEFT_SHANK]


def test_a_silent_foot_says_nothing_for_a_while() -> None:
    found = silent(SAMPLES, LEFT, 1.5, 3.0)
    assert not [s for s in found if s.site is LEFT and 1.5 <= s.t < 3.0]
    assert [s for s in found if s.site is LEFT] == [s for s in SAMPLES if s.site is LEFT and not 1.5 <= s.t < 3.0]
    assert max(s.t for s in silent(SAMPLES, RIGHT, 2.0) if s.site is RIGHT) < 2.0


def test_broken_cells_of_a_device_say_the_same_in_every_frame() -> None:
    device = Insole(cells=24, broken=((2, 0), (9, 300)))
    walk = emulate(WALKER.route, devices={LEFT: device}, radio=Radio(), seed=2)
    whole = emulate(WALKER.route, devices={LEFT: Insole(cells=24)}, radio=Radio(), seed=2)
    frames, sound = (
        [parse_frame(p.data).samples[0] for p in one.packets if p.channel == "insole/frame"] for one in (walk, whole)
    )
    for frame, as_it_was in zip(frames, sound, strict=True):
        assert frame.cells[2] == 0 and frame.cells[9] == 300 and frame.imu == as_it_was.imu
        assert [c for k, c in enumerate(frame.cells) if k not in (2, 9)] == [
            c for k, c in enumerate(as_it_was.cells) if k not in (2, 9)
        ]
