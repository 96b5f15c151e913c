"""The part that measures steps by ranges: exact input, silence, impossible ranges, either side, and saving."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from operator import attrgetter

import numpy as np
import pytest

from solepath import Foot, GaitCycleMeasured, Sample, Session
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


@pytest.mark.parametrize("width", [NARROW, WIDE])
@pytest.mark.parametrize("foot", [Foot.LEFT])
def test_exact_ranges_show_width_and_length_whichever_foot_has_them(width: float, foot: Foot) -> None:
    found = cycles(in_order(inertial(width), measure_ranges(walker(width), EXACT, foot=foot)))
    assert len(widths(found)) > 0.8 * len(found)
    assert np.mean(widths(found)[4:]) == pytest.approx(width, abs=0.006)
    for one in [one for one in found if one.steady][4:]:
        assert one.step_length is not None and one.stride_length is not None
        assert one.step_length == pytest.approx(0.5 * one.stride_length, abs=0.06)
        assert one.step_width_sigma is not None and 0.0 < one.step_width_sigma <= 0.05
        assert one.step_length_sigma is not None and 0.0 < one.step_length_sigma <= 0.05


def test_the_means_and_the_events_of_a_cycle_have_the_same_width() -> None:
    session = Session()
    session.feed(in_order(inertial(WIDE), measure_ranges(walker(WIDE), EXACT)))
    session.finish()
    assert session.gait is not None and session.gait.both.step_width is not None
    assert session.gait.both.step_width.mean == pytest.approx(WIDE, abs=0.01)
