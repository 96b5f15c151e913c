"""Makes events that a page can show."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from math import pi

from walks import ROUGH, SHORT, insoles

from solepath import (
    BatteryLevel,
    Candidate,
    Connected,
    Disconnected,
    Event,
    Foot,
    FootMoved,
    Packet,
    Phase,
    Placed,
    PlaceLost,
    PlanContradicted,
    Sample,
    Session,
    Site,
    TurnMade,
)
from solepath.types import Turn
from solepath.types.vector import ZERO


def feed_session(items: Iterable[Packet | Sample]) -> tuple[Session, list[Event]]:
    """Return a session that was fed with all packets or samples, and its events."""
    session = Session(poses=True, pressures=True, losses=True)
    return session, session.feed(items)


@cache
def rough_walk() -> tuple[Session, tuple[Event, ...]]:
    """Return the session and the events of a short walk with insoles over a bad radio."""
    session, events = feed_session(insoles(SHORT, ROUGH).packets)
    return session, tuple(events)


def foot_moved(t: float, foot: Foot = Foot.LEFT, known_at: float | None = None) -> FootMoved:
    """Return an event of a foot in swing at the origin."""
    reported_at = t if known_at is None else known_at
    return FootMoved(t=t, known_at=reported_at, foot=foot, position=ZERO, velocity=ZERO, phase=Phase.SWING)


def events_of_all_kinds() -> list[Event]:
    """Return the events of the rough walk, and events of all other classes that a page shows."""
    events = list(rough_walk()[1])
    start, end = events[0].known_at, events[-1].known_at
    middle, third = events[len(events) // 2].known_at, events[len(events) // 3].known_at
    candidate = Candidate("0", (1.0, 2.0, 0.0), 0.5, 0.75, "stairs A")
    other = Candidate("1", (1.0, 2.0, 3.0), None, 0.25, "stairs A")
    others = [
        Connected(t=start, known_at=start, site=Site.LEFT_FOOT, device="", name="Insole", signal=-60),
        Connected(t=start, known_at=start, site=Site.PELVIS, device="", name="", signal=None),
        Placed(t=third, known_at=third, level="0", position=(1.0, 2.0, 0.0), spread=2.0, candidates=(candidate, other)),
        Placed(t=middle, known_at=middle, level="0", position=(1.0, 2.0, 0.0), spread=0.5, candidates=(candidate,)),
        PlaceLost(t=end, known_at=end, what="the track goes where the plan has no way"),
        PlanContradicted(t=end, known_at=end, what="the first heading does not fit the plan", heading_off=0.8),
        Disconnected(t=third, known_at=third, site=Site.LEFT_FOOT),
        BatteryLevel(t=third, known_at=third, site=Site.LEFT_FOOT, level=0.1),
        Connected(t=middle, known_at=middle, site=Site.LEFT_FOOT, device="", name="Insole", signal=-60),
        TurnMade(t=middle, known_at=middle, t_start=third, angle=pi / 2, turn=Turn.LEFT),
    ]
    return sorted([*events, *others], key=lambda event: event.known_at)
