"""Samples that reach a part: only those that it asks for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import ClassVar

import pytest
from attrs import define, evolve, field

from solepath import Foot, Session, Site, recipes
from solepath.body.part import Part, PartInput, PartOutput
from solepath.emulate import Route, Walker
from solepath.events import PositionReported
from solepath.foot.view import FootView

Waker = Callable[[Session], None]
WALK_SAMPLES = [*Walker(Route().stand(2.0).walk(6.0, 1.3).stop(1.0)).samples(Foot.LEFT, 100.0)]


@define
class WakingPart(Part):
    """A part that is idle until a position is reported or a clock restarts; then it counts samples without events."""

    needs_samples: ClassVar[bool] = True
    idle: bool = field(default=True, init=False)
    eventless: int = field(default=0, init=False)

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        if any(isinstance(event, PositionReported) for event in events):
            self.idle = False
        if not self.idle:
            self.eventless += not events
        return ()

    def reset(self, site: Site) -> None:
        self.idle = False


@define
class SatisfiedPart(Part):
    """A part that is idle from its third sample on, and counts what it is fed."""

    needs_samples: ClassVar[bool] = True
    idle: bool = field(default=False, init=False)
    eventless: int = field(default=0, init=False)

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        self.eventless += not events
        self.idle = self.eventless >= 3
        return ()


@define
class EventPart(Part):
    """A part that declares no need of samples."""

    eventless: int = field(default=0, init=False)

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        self.eventless += not events
        return ()


def with_part(part: Part) -> Session:
    return Session(evolve(recipes.DEFAULT, name="mine", parts=(*recipes.DEFAULT.parts, part)))


def last_part(session: Session) -> Part:
    return session._state.parts[-1]


def report_position(session: Session) -> None:
    session.here((2.0, 0.0))


def bind_device(session: Session) -> None:
    session.bind(Site.LEFT_FOOT, "another")


@pytest.mark.parametrize("wake", [report_position, bind_device])
def test_a_part_that_is_idle_no_longer_is_fed_from_then_on_in_a_restored_session_too(wake: Waker) -> None:
    session = with_part(WakingPart())
    session.feed(WALK_SAMPLES[:400])
    assert last_part(session) == WakingPart()
    wake(session)
    restored = Session.restore(session.snapshot(), parts=[WakingPart])
    for each_session in (session, restored):
        each_session.feed(WALK_SAMPLES[400:600])
    assert last_part(session) == last_part(restored) != WakingPart()
    assert last_part(session).eventless > 150


def test_a_part_that_becomes_idle_with_a_sample_is_not_fed_the_next_one_in_a_restored_session_or_any() -> None:
    session = with_part(SatisfiedPart())
    session.feed(WALK_SAMPLES[:50])
    assert last_part(session).eventless == 3
    restored = Session.restore(session.snapshot(), parts=[SatisfiedPart])
    for each_session in (session, restored):
        each_session.feed(WALK_SAMPLES[50:])
    assert last_part(session) == last_part(restored)


def test_a_part_that_declares_no_need_of_samples_gets_none_of_a_barometer_either() -> None:
    session = with_part(EventPart())
    session.feed([evolve(sample, air_pressure=101325.0) for sample in WALK_SAMPLES])
    assert last_part(session) == EventPart()
