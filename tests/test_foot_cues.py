"""Where cues, tilt and heading come from when there are no cells to ask."""

from __future__ import annotations

from math import hypot
from statistics import median

import pytest

from solepath import Foot, Sample, Session, Site, ToeOff
from solepath.events import HeelStrike
from solepath.foot.eskf import ErrorStateFilter
from solepath.foot.stance import Stance
from solepath.sim import Route, Walker
from solepath.types import Phase
from solepath.vector import GRAVITY, ZERO, from_rotation_vector, rotate


def walked(speed: float) -> tuple[Walker, list[Sample]]:
    walker = Walker(Route().stand(2).walk(15, speed).stop(2), seed=5)
    return walker, [Sample(s.t, s.site, s.acc, s.gyro) for s in walker.samples(Foot.LEFT, 100)]


@pytest.mark.parametrize("speed", [0.9, 1.3, 1.7])
def test_without_cells_toe_off_and_heel_strike_are_seen_by_how_the_foot_turns(speed: float) -> None:
    walker, samples = walked(speed)
    events = Session().feed(samples)
    truth = walker.truth().feet[Foot.LEFT]
    for kind, true in ((ToeOff, truth.toe_offs), (HeelStrike, truth.heel_strikes)):
        seen = [event.t for event in events if isinstance(event, kind)]
        assert len(seen) == len(true)
        offsets = [a - b for a, b in zip(seen, true, strict=True)]
        assert abs(median(offsets)) < 0.045, kind.__name__
        assert max(offsets) - min(offsets[1:]) < 0.2, kind.__name__


def test_gravity_rights_a_standing_foot_even_when_the_filter_is_sure_of_its_tilt() -> None:
    filter_ = ErrorStateFilter()
    filter_.start(from_rotation_vector((0.02, -0.01, 0.0)), 0.0)
    still = Stance(ZERO, 0.01, 100.0, Phase.STATIONARY)
    for k in range(600):
        filter_.predict(0.005, (0.0, 0.0, GRAVITY), ZERO)
        assert filter_.correct(0.005 * k, still)
    x, y, _ = rotate(filter_.attitude, (0.0, 0.0, 1.0))
    assert hypot(x, y) < 0.001


def test_heading_grows_less_certain_with_time() -> None:
    _, samples = walked(1.3)
    session = Session()
    session.feed(samples)
    foot = session.feet[Foot.LEFT]
    lasted = samples[-1].t - 2.0  # what comes before the first heel-off is one stretch, and so is what is under way
    assert foot.gait.way.yaw == pytest.approx(foot.corrector.heading_drift**2 * lasted, rel=0.4)
    assert session.position is not None and session.position.covariance[3] > foot.gait.way.yaw * 10.0**2 / 4


def test_sites_are_their_own_foot() -> None:
    assert Site.LEFT_FOOT.foot is Foot.LEFT and Site.PELVIS.foot is None
