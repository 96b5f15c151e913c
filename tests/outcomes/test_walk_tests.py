"""The six-minute walk and the timed up and go of strides made by hand, and of an emulated walk there and back."""

from __future__ import annotations

from math import pi

import pytest
from made_walks import walk, without
from strides import stride
from walks import insoles, run_session

from solepath import FootSilent, SampleGap, TurnMade
from solepath.emulate.routes.route import Route
from solepath.show.outcomes import six_minute_walk, timed_up_and_go
from solepath.types import SITE_OF_FOOT, Foot, Turn

L, R = Foot.LEFT, Foot.RIGHT


def test_six_minutes_start_with_the_first_toe_off_and_end_within_a_stride() -> None:
    six = six_minute_walk(walk(10.0, 400))
    assert six is not None and six.complete and six.duration == 360.0
    # the first toe-off is at 10.5 s, so that the end is at 370.5 s: the left foot has made strides of k = 0 to 359, and
    # the next one lifts just then; the right foot, k from 11.0 s on, has made 359, and 370.0 to 370.4 is the 360th
    assert six.t_start == 10.5
    assert six.foot_distances == pytest.approx({L: 432.0, R: 432.0})
    assert (six.distance, six.speed) == pytest.approx((432.0, 1.2))
    # in each minute 60 strides of each foot
    assert six.minutes == pytest.approx((72.0,) * 6)
    assert six.distance_index == pytest.approx(0.0)
    # contacts: left at 10.9, 11.9 ... 369.9, right at 11.4 ... 370.4: 360 each, two steps a second
    assert (six.steps, six.cadence, six.stops, six.about_turns) == (720, pytest.approx(120.0), 0, 0)


def test_a_stride_counts_with_the_share_of_its_swing() -> None:
    # from a mark at 10.7 s, half of the first left swing (10.5 to 10.9 s) and all of the first right one are in it;
    # and at its end, 370.7 s, half of the left swing that lifts at 370.5 s
    six = six_minute_walk(walk(10.0, 400), start=10.7)
    assert six is not None
    assert six.foot_distances[L] == pytest.approx(0.5 * 1.2 + 359 * 1.2 + 0.5 * 1.2)
    assert six.foot_distances[R] == pytest.approx(360 * 1.2)


def test_stops_slower_minutes_and_turns_are_counted() -> None:
    # 100 s at 1.2 m/s, a stop, then at 0.9 m/s; the last left contact is at 10 + 99 + 0.9 = 109.9 s, the last right one
    # at 110.4 s, which ends the bout; the next bout starts with the left contact at 130.9 s
    about = TurnMade(t=60.0, known_at=60.0, t_start=58.0, angle=pi, turn=Turn.ABOUT)
    left = TurnMade(t=80.0, known_at=80.0, t_start=78.0, angle=1.5, turn=Turn.LEFT)
    six = six_minute_walk([*walk(10.0, 100), about, left, *walk(130.0, 300, 0.9)])
    assert six is not None
    assert (six.stops, six.stopped_time, six.about_turns) == (1, pytest.approx(130.9 - 110.4), 1)
    # minute 1: 60 strides of 1.2 m; minute 6 (310.5 to 370.5 s): 60 of 0.9 m: a quarter less
    assert (six.minutes[0], six.minutes[5]) == pytest.approx((72.0, 54.0))
    assert six.distance_index == pytest.approx(-0.25)
    # minute 2 (70.5 to 130.5 s): the left foot has the strides of k = 60 to 99, 40 of them; the right one, k = 60 (from
    # 71.0 s) to 99: 40; and the left toe-off at 130.5 s is just the end
    assert six.minutes[1] == pytest.approx(48.0)


def test_a_recording_that_ends_early_is_no_whole_test() -> None:
    six = six_minute_walk(walk(10.0, 100), end=110.5)
    assert six is not None and not six.complete
    assert (six.duration, len(six.minutes), six.distance_index) == (100.0, 1, None)
    assert six.distance == pytest.approx(120.0)
    assert six_minute_walk([]) is None
    assert six_minute_walk(walk(10.0, 100), start=500.0) is None


def test_one_foot_and_strides_without_their_gait_events() -> None:
    one_foot = [event for event in walk(10.0, 400) if getattr(event, "foot", None) is L]
    six = six_minute_walk(one_foot)
    assert six is not None and six.foot_distances == pytest.approx({L: 432.0}) and six.distance == pytest.approx(432.0)
    assert six.steps == 720  # twice the contacts of one foot
    flat = [stride(L, 5.0, (1.0, 0.0, 0.0))]  # from 4.0 to 5.0 s, in which its swing is not known
    test = timed_up_and_go(flat, 4.5, 9.0)
    assert (test.distance, test.walking_time) == (pytest.approx(0.5), None)


def test_a_timed_up_and_go_is_the_time_between_its_marks() -> None:
    # go at 8.0 s; steps of k = 0 to 4 from 10.5 s on; seated at 18.0 s
    test = timed_up_and_go(walk(10.0, 5), 8.0, 18.0)
    assert test.duration == 10.0
    # the first toe-off is at 10.5, the last contact at 10 + 4 + 1.4 = 15.4 s; ten steps; five strides of 1.2 m
    assert (test.walking_time, test.steps) == (pytest.approx(4.9), 10)
    assert test.distance == pytest.approx(6.0)
    nothing = timed_up_and_go(walk(10.0, 5), 100.0, 110.0)
    assert (nothing.duration, nothing.steps, nothing.walking_time) == (10.0, 0, None)
    with pytest.raises(ValueError, match="start must be before stop"):
        timed_up_and_go([], 5.0, 5.0)


def test_a_single_step_of_a_wearer_of_two_sensors_is_one() -> None:
    # contacts: left at 10.9, 11.9 ... s, right at 11.4, 12.4 ... s; from 10.8 to 11.2 s there is the first left one
    assert timed_up_and_go(walk(10.0, 5), 10.8, 11.2).steps == 1


def there_and_back(crossings: int) -> Route:
    """Return a walk along a corridor of 30 m, with an about-turn in a bend of 0.5 m radius after each crossing."""
    route = Route().stand(3.0)
    for k in range(crossings):
        route = route.walk(30.0, 1.3).turn(pi if k % 2 else -pi, radius=0.5)
    return route.stop(3.0)


@pytest.mark.long
def test_an_emulated_six_minute_walk_there_and_back() -> None:
    walked = insoles(there_and_back(16), seed=11)
    six = six_minute_walk(run_session(walked.packets))
    assert six is not None and six.complete and six.stops == 0
    first = min(walked.truth.feet[foot].toe_offs[0] for foot in Foot)
    assert six.t_start == pytest.approx(first, abs=0.1)
    true = 0.0
    for one in (one for foot in Foot for one in walked.truth.strides(foot)):
        share = (first + 360.0 - one.t_toe_off) / (one.t_heel_strike - one.t_toe_off)
        true += 0.5 * min(max(share, 0.0), 1.0) * one.length
    assert six.distance == pytest.approx(true, rel=0.015)
    contacts = [t for foot in Foot for t in walked.truth.feet[foot].heel_strikes if first < t <= first + 360.0]
    assert six.steps == pytest.approx(len(contacts), abs=2)
    assert six.about_turns in (13, 14) and max(six.minutes) - min(six.minutes) < 4.0


def test_while_a_foot_sends_nothing_the_distance_is_that_of_the_other_foot() -> None:
    whole = six_minute_walk(walk(10.0, 400))
    for start, end in ((100.2, 160.3), (100.7, 102.9), (100.2, 400.0)):
        six = six_minute_walk(without(walk(10.0, 400), L, start, end))
        assert whole is not None and six is not None and six.measured and six.distance is not None
        # where the feet change over, one is up to a step ahead of the other, of which half counts
        assert six.distance == pytest.approx(whole.distance, abs=0.61)
        assert six.alone_times == {R: pytest.approx(min(end, 370.5) - start)} and six.unmeasured_time == 0.0
        assert (six.stops, [*six.foot_distances], len(six.minutes)) == (0, [R], 6)
        assert six.minutes == pytest.approx((72.0,) * 6, abs=0.61) and six.steps == pytest.approx(720, abs=2)


def test_a_foot_that_falls_silent_to_the_end_is_absent_and_does_not_stand() -> None:
    events = [one for one in walk(10.0, 400) if getattr(one, "foot", R) is R or one.t < 200.0]
    silent = FootSilent(t=203.0, known_at=203.0, foot=L, silent_for=3.0)
    six = six_minute_walk([*events, silent])
    assert six is not None and six.distance == pytest.approx(432.0, abs=0.61)
    assert six.alone_times == {R: pytest.approx(170.5)} and [*six.foot_distances] == [R]
    late = [one for one in walk(10.0, 400) if getattr(one, "foot", R) is R or getattr(one, "t_start", 0.0) > 200.0]
    six = six_minute_walk(late)
    assert six is not None and six.distance == pytest.approx(432.0, abs=0.61) and [*six.foot_distances] == [R]


def test_what_both_feet_did_while_neither_sent_anything_is_lacking_and_no_stop() -> None:
    six = six_minute_walk(without(without(walk(10.0, 400), L, 100.2, 160.3), R, 100.1, 160.0))
    assert six is not None and six.complete and not six.measured
    assert six.unmeasured_time == pytest.approx(59.8) and six.stops == 0 and six.foot_distances == {}
    assert six.distance == pytest.approx(432.0 - 60.0 * 1.2, abs=2.5)
    assert [one is None for one in six.minutes] == [False, True, True, False, False, False]
    test = timed_up_and_go(without(without(walk(10.0, 20), L, 15.0, 18.0), R, 15.0, 18.0), 9.0, 31.0)
    assert test.duration == 22.0 and not test.measured


def test_a_gap_within_a_stride_or_while_standing_is_no_absence() -> None:
    gap = SampleGap(t=100.2, known_at=100.6, site=SITE_OF_FOOT[L], duration=0.4, count=40)
    six, whole = six_minute_walk([*walk(10.0, 400), gap]), six_minute_walk(walk(10.0, 400))
    assert six == whole
