"""Lifts detected by feet that stand: the error of the sensor is larger than the pulses."""

from __future__ import annotations

from collections.abc import Callable
from math import sin

from views import fed

from solepath.body.activity.activities import Activities
from solepath.events import ActivityChanged, Event, LiftRidden
from solepath.foot.cues.gait_cues import GaitCues
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.foot.stance.cycle import Cycle
from solepath.foot.tracker import FootTracker
from solepath.types import SITE_OF_FOOT, Activity, Foot, Sample

RATE = 50.0
ACC_ERROR = {Foot.LEFT: 0.4, Foot.RIGHT: -0.3}
"""Error that each foot's accelerometer adds to 1 g, m/s^2."""


def pulse(t: float, start: float, size: float) -> float:
    """Return a pulse of acceleration of two seconds, m/s^2."""
    return size * max(0.0, min(1.0, 2.0 * (t - start), 2.0 * (start + 2.0 - t)))


def standing_events(
    lift: Callable[[float], float], until: float, shuffles: tuple[tuple[float, float], ...] = ()
) -> list[Event]:
    """Return the events of two feet that stand in a lift with this acceleration, and shuffle in these intervals, s."""
    part = Activities()
    feet = {foot: FootTracker(foot, Cycle(), ErrorStateFilter(), GaitCues()) for foot in Foot}
    events: list[Event] = []
    for k in range(int(until * RATE)):
        t = k / RATE
        shuffling = any(start <= t < end for start, end in shuffles)
        for foot, tracker in feet.items():
            shake = (6.0 * sin(31.0 * t) if shuffling else 0.0) + 0.02 * sin(1000.0 * t)
            turn = 1.5 * sin(31.0 * t) if shuffling else 0.0
            up = 9.80665 + ACC_ERROR[foot] + lift(t) + shake
            sample = Sample(t=t, site=SITE_OF_FOOT[foot], acc=(0.02, 0.0, up), gyro=(0.001, turn, 0.0))
            events += fed(part, tracker, sample, tracker.feed(sample))
    return events + part.finish(until)


def rides(events: list[Event]) -> list[LiftRidden]:
    return [event for event in events if isinstance(event, LiftRidden)]


def test_a_pair_of_pulses_is_a_ride_in_the_direction_of_the_first() -> None:
    (up,) = rides(standing_events(lambda t: pulse(t, 10.0, 0.6) - pulse(t, 16.0, 0.6), 40.0))
    (down,) = rides(standing_events(lambda t: pulse(t, 16.0, 0.6) - pulse(t, 10.0, 0.6), 40.0))
    assert up.up and not down.up
    assert abs(up.t_start - 10.0) < 1.0 and abs(up.t - 18.0) < 1.0


def test_the_height_of_a_ride_is_that_of_its_pulses() -> None:
    (ride,) = rides(standing_events(lambda t: pulse(t, 10.0, 0.6) - pulse(t, 16.0, 0.6), 40.0))
    assert ride.height is not None and abs(ride.height - 0.9 * 6.0) < 0.7  # 0.6 m/s^2 for 1.5 s, 6 s apart


def test_who_stands_on_the_ground_rides_nowhere() -> None:
    assert not rides(standing_events(lambda t: 0.0, 60.0))


def test_standing_that_may_still_be_a_ride_is_not_final_at_once() -> None:
    events = standing_events(lambda t: pulse(t, 10.0, 0.6) - pulse(t, 16.0, 0.6), 40.0)
    changes = [event for event in events if isinstance(event, ActivityChanged)]
    riding = [event for event in changes if event.activity is Activity.ELEVATOR_UP]
    assert not riding[0].final and riding[-1].final and riding[0].known_at < 14.0
