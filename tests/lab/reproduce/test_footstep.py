"""The experiments of footstep-tracker: what is counted, by hand."""

from __future__ import annotations

from collections import Counter

import pytest

from solepath.events import ActivityChanged
from solepath.types import Activity, Site
from solepath.types.vector import GRAVITY, ZERO
from solepath.walk.timeline import Timeline
from solepath_lab.measures.confusion import ActivityScore
from solepath_lab.reproduce.footstep.activities import class_share, fitted_climb, stair_stretches
from solepath_lab.reproduce.footstep.corridor import WatchedZones

UP, DOWN, WALK = Activity.STAIRS_UP, Activity.STAIRS_DOWN, Activity.WALKING


def test_a_stretch_of_stairs_is_one_whatever_directions_were_reported_in_it() -> None:
    timeline = Timeline()
    for t, activity in ((0.0, WALK), (5.0, DOWN), (8.0, UP), (11.0, DOWN), (12.0, WALK), (20.0, UP)):
        timeline.add(ActivityChanged(t=t, known_at=t, activity=activity, probability=None))
    assert stair_stretches(timeline, 24.0) == [(5.0, 12.0), (20.0, 24.0)]


def test_the_climb_is_the_slope_of_both_barometers_whatever_their_offsets() -> None:
    left = [(float(t), 50.0 - 0.3 * t) for t in range(10)]
    right = [(t + 0.5, -80.0 - 0.3 * t) for t in range(10)]
    assert fitted_climb({Site.LEFT_FOOT: left, Site.RIGHT_FOOT: right}, 0.0, 9.5) == pytest.approx(-0.3)
    assert fitted_climb({Site.LEFT_FOOT: left}, 20.0, 30.0) == 0.0


def test_shares_leave_out_walks_without_the_class() -> None:
    scores = [ActivityScore(Counter({(UP, UP): 3, (UP, DOWN): 1})), ActivityScore(Counter({(DOWN, DOWN): 2}))]
    assert [class_share(score, UP) for score in scores] == [(75.0,), ()]


def test_a_zone_counts_as_strict_when_six_samples_were_at_rest_in_it() -> None:
    zones = WatchedZones()
    t = 0.0
    for force in [0.0] * 8 + [8.0] * 3 + [0.0, 1.2] * 3 + [8.0] * 3:  # eight at rest; then six uneven ones
        zones.update(t, 0.05, (force, 0.0, GRAVITY), ZERO, None)
        t += 0.05
    assert (zones.zones, zones.strict_zones) == (2, 1)
