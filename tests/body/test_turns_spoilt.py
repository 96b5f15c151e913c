"""Turns of a wearer of whom one sensor cannot be right."""

from __future__ import annotations

from attrs import evolve

from solepath import Foot, Session, TurnMade
from solepath.emulate import Route, Walker


def test_a_foot_that_alone_turned_before_its_data_were_found_wrong_takes_its_turn_with_it() -> None:
    walked = {foot: Walker(Route().stand(3.0).walk(40.0, 1.3).stop(2.0), seed=3).samples(foot, 100.0) for foot in Foot}
    wrong = [evolve(one, gyro=(one.gyro[1], one.gyro[0], one.gyro[2])) for one in walked[Foot.LEFT] if one.gyro]
    session = Session()
    events = [e for one in sorted([*wrong, *walked[Foot.RIGHT]], key=lambda s: s.t) for e in session.feed(one)]
    turns = [event for event in [*events, *session.finish()] if isinstance(event, TurnMade)]
    assert all([event.turn is None for event in turns])
