"""The part that measures steps by ranges: exact input, silence, impossible ranges, either side, and saving."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterable
from functools import cache
from operator import attrgetter

import numpy as np
import pytest
from attrs import evolve

from solepath import Foot, GaitCycleMeasured, Sample, Session, Site
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.ranging import RangeErrors, measure_ranges
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.walker import Walker

EXACT = RangeErrors("exact", noise=0.0, bias=0.0, blocked=0.0)
NARROW, WIDE = 0.06, 0.17


@cache
def walker(width: float) -> Walker:
    """Return a wearer with this step width, m, on a straight way."""
    wearer = Wearer(step_width=width, toe_out=0.0, width_variation=0.0)
    return Walker(Route().stand(2.0).walk(24.0, 1.3).stop(1.0), wearer, seed=5)


def inertial(width: float) -> list[Sample]:
    """Return the exact samples of both feet."""
    return [sample for foot in Foot for sample in walker(width).samples(foot, 100.0)]


def in_order(*samples: Iterable[Sample]) -> list[Sample]:
    """Return samples in the order of their times."""
    return sorted([one for some in samples for one in some], key=attrgetter("t"))


def cycles(samples: list[Sample]) -> list[GaitCycleMeasured]:
    """Return the gait cycles that a session measures."""
    session = Session()
    return [e for e in session.feed(samples) + session.finish() if isinstance(e, GaitCycleMeasured)]


def widths(found: list[GaitCycleMeasured]) -> list[float]:
    """Return the known widths, m."""
    return [one.step_width for one in found if one.step_width is not None]


@pytest.mark.parametrize("width", [NARROW, 0.11, WIDE])
@pytest.mark.parametrize("foot", list(Foot))
def test_exact_ranges_show_width_and_length_whichever_foot_has_them(width: float, foot: Foot) -> None:
    found = cycles(in_order(inertial(width), measure_ranges(walker(width), EXACT, foot=foot)))
    assert len(widths(found)) > 0.8 * len(found)
    assert np.mean(widths(found)[4:]) == pytest.approx(width, abs=0.006)
    for one in [one for one in found if one.steady][4:]:
        assert one.step_length is not None and one.stride_length is not None
        assert one.step_length == pytest.approx(0.5 * one.stride_length, abs=0.06)
        assert one.step_width_sigma is not None and 0.0 < one.step_width_sigma <= 0.05
        assert one.step_length_sigma is not None and 0.0 < one.step_length_sigma <= 0.05


def test_ranges_that_are_late_against_the_samples_are_aligned_with_them() -> None:
    ranges = measure_ranges(walker(WIDE), EXACT)
    early, late = (cycles(in_order(inertial(WIDE), [evolve(r, t=r.t + k) for r in ranges])) for k in (0.0, 0.008))
    pairs = [(a.step_length, b.step_length) for a, b in zip(early, late, strict=True) if a.steady][4:]
    assert len(pairs) > 10
    assert all(a is not None and b is not None and abs(a - b) < 0.015 for a, b in pairs)


def test_the_means_and_the_events_of_a_cycle_have_the_same_width() -> None:
    session = Session()
    session.feed(in_order(inertial(WIDE), measure_ranges(walker(WIDE), EXACT)))
    session.finish()
    assert session.gait is not None and session.gait.both.step_width is not None
    assert session.gait.both.step_width.mean == pytest.approx(WIDE, abs=0.01)


def test_steps_become_unknown_when_ranges_stop() -> None:
    ranges = [one for one in measure_ranges(walker(WIDE), EXACT) if one.t < 10.0]
    found = [one for one in cycles(in_order(inertial(WIDE), ranges)) if one.steady]
    before = [one.step_width_sigma for one in found if 6.0 < one.t < 10.0]
    after = [one.step_width_sigma for one in found if one.t > 10.5]
    assert None not in before
    assert after[-1] is None, "the tracks of the feet diverge with each stride"
    known = [sigma for sigma in after if sigma is not None]
    assert known == sorted(known), "the standard deviation grows with each stride"


def test_a_few_impossible_ranges_change_little() -> None:
    ranges = measure_ranges(walker(WIDE), EXACT)
    values = (-1.0, 0.0, 1e308, float("nan"), 2.5)
    absurd = [evolve(one, range=value) for one, value in zip(ranges[100:105], values, strict=True)]
    spoilt = cycles(in_order(inertial(WIDE), ranges[:100], absurd, ranges[105:]))
    assert np.mean(widths(spoilt)[4:]) == pytest.approx(WIDE, abs=0.01)


@pytest.mark.parametrize("value", [float("inf"), 1e308, -5.0, 0.0, 2.9])
def test_no_range_raises_an_exception_or_gives_a_value_that_is_no_number(value: float) -> None:
    ranges = [evolve(one, range=value) for one in measure_ranges(walker(NARROW), EXACT)]
    for one in cycles(in_order(inertial(NARROW), ranges)):
        assert one.step_width is None or np.isfinite(one.step_width)


def test_a_range_is_a_number() -> None:
    assert Session().feed(Sample(0.0, Site.LEFT_FOOT, range=np.float32(0.5))) == []  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="range of a sample is a number"):
        Session().feed(Sample(0.0, Site.LEFT_FOOT, range="0.5"))  # type: ignore[arg-type]


def test_a_walk_with_ranges_goes_on_after_it_was_saved_in_either_form() -> None:
    samples = in_order(inertial(WIDE), measure_ranges(walker(WIDE), EXACT))
    middle = len(samples) // 2
    whole = Session()
    whole.feed(samples[:middle])
    packed = Session.unpack(whole.pack())
    restored = Session.restore(json.loads(json.dumps(whole.snapshot())))
    expected = whole.feed(samples[middle:]) + whole.finish()
    assert any(isinstance(one, GaitCycleMeasured) and one.step_width is not None for one in expected)
    for session in (packed, restored):
        assert session.feed(samples[middle:]) + session.finish() == expected


PROGRAM = """
import sys
from solepath import Sample, Session, Site
session, loaded = Session(), []
for one in ({}, {"range": 0.4}):
    for k in range(3):
        session.feed(Sample(len(loaded) + 0.01 * k, Site.LEFT_FOOT, (0.0, 0.0, 9.81), (0.0, 0.0, 0.0), **one))
    loaded.append("solepath.body.width.between_feet" in sys.modules)
print(loaded)
"""


def test_the_part_is_loaded_with_the_first_range() -> None:
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[False, True]"
