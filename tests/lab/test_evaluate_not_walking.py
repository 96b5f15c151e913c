"""What is scored where nobody takes a step, and of slow walks."""

from __future__ import annotations

import pytest

from solepath.emulate.routes.route import Route
from solepath.emulate.walk import sampled
from solepath.events import ActivityChanged, Defect
from solepath.session import Session
from solepath.types import Activity
from solepath.walk.walk import Walk
from solepath_lab.evaluate.not_walking import walking_share
from solepath_lab.measures.alarms import is_alarm
from solepath_lab.measures.not_walking import NotWalking
from solepath_lab.measures.score import Scored, summarise


def reported(*changes: tuple[float, Activity]) -> Walk:
    return Walk.of([ActivityChanged(t=t, known_at=t, activity=activity, probability=None) for t, activity in changes])


def test_time_before_the_first_report_is_unknown_and_time_outside_does_not_count() -> None:
    walk = reported((20.0, Activity.STANDING), (40.0, Activity.RUNNING))
    figures = NotWalking.of(walk, 10.0, 60.0).figures
    assert figures["share_unknown"] == pytest.approx(0.2)
    assert figures["share_standing"] == pytest.approx(0.4)
    assert figures["share_running"] == figures["share_moving"] == pytest.approx(0.4)
    assert figures["strides_a_minute"] == 0.0


def test_shares_of_several_recordings_weigh_their_time() -> None:
    riding = NotWalking.of(reported((0.0, Activity.ELEVATOR_UP)), 0.0, 10.0)
    sitting = NotWalking.of(reported((0.0, Activity.STANDING)), 0.0, 30.0)
    pooled = summarise([Scored("a", idle=riding), Scored("b", idle=sitting)], "all").together
    assert pooled["share_lifts"] == pytest.approx(0.25) and pooled["share_standing"] == pytest.approx(0.75)


def test_a_walk_at_a_usual_pace_is_called_walking_from_its_first_to_its_last_stride() -> None:
    session = Session()
    walk = sampled(Route().stand(4.0).walk(20.0, 1.2).stop(3.0), seed=3)
    found = Walk.of(session.feed(walk.samples) + session.finish())
    strides = NotWalking.of(found, 0.0, walk.truth.duration)
    assert strides.strides == sum(len(kept) for kept in found.strides.values()) > 20
    assert strides.distance == pytest.approx(2 * 20.0, rel=0.1)  # of both feet
    assert walking_share(found) > 0.9


def test_a_sensor_on_no_foot_may_be_told_that_it_moves_oddly_but_not_that_gravity_is_gone() -> None:
    assert is_alarm("sevivi_hops", Defect.NO_GRAVITY) and not is_alarm("sevivi_hops", Defect.AXES)
    assert is_alarm("slow_gait", Defect.AXES) and not is_alarm("slow_gait", Defect.CLIPPED)
