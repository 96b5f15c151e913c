"""What must hold for the events and the state of a session, whatever was fed."""

from __future__ import annotations

import json
from math import isfinite
from random import Random
from typing import Any

from solepath import ActivityChanged, Packet, PacketRejected, Rejection, SampleRejected, Session
from solepath.recipes import Recipe

MOST_EVENTS = 5_000
"""Largest number of events of one packet or sample: some hundred samples, each with strides held back before it."""
MOST_PACKED = 150_000
"""Largest size of a packed session of two feet, bytes; that of a walk in a building has 20,000."""
TWIN_ITEMS = 40
"""Number of items after which a restored session is compared no more with the one that never stopped."""
CHECK_SHARE = 0.02
"""Share of the items before which the session is packed, to see whether a rejected one changes anything."""
RESTORE_SHARE = 0.003
"""Share of the items before which the session is restored."""


class Broken(AssertionError):
    """A promise that did not hold."""


class Checked:
    """A session that is fed and checked: finite events, a bounded state, restored twins, rejections without effect."""

    def __init__(self, session: Session, recipe: Recipe, random: Random) -> None:
        self.session, self.recipe, self.random = session, recipe, random
        self.events = 0
        self.open_activities: set[float] = set()
        self.twin: Session | None = None
        self.twin_items = 0

    def feed(self, item: Any, *, may_raise: bool = False) -> None:
        """Feed a packet or sample; with `may_raise`, TypeError is an answer, and must change nothing."""
        before = self.session.pack() if self.random.random() < CHECK_SHARE else None
        if self.twin is None and self.random.random() < RESTORE_SHARE:
            self._restore()
        try:
            events = self.session.feed(item)
        except TypeError:
            if not may_raise:
                raise
            if before is not None and self.session.pack() != before:
                raise Broken("a sample of wrong types changed the state") from None
            return
        self._check_events(events)
        if before is not None and events:
            self._check_unchanged(before, item, events)
        if self.twin is not None:
            if self.twin.feed(item) != events:
                raise Broken("a restored session gives other events")
            self.twin_items += 1
            if self.twin_items == TWIN_ITEMS:
                if self.twin.pack() != self.session.pack():
                    raise Broken("a restored session has another state")
                self.twin = None

    def advance(self, now: float) -> None:
        """Let time pass; the twin does not follow."""
        self.twin = None
        self._check_events(self.session.advance(now))

    def finish(self) -> None:
        """Check the size of the state and the last events."""
        if len(self.session.pack()) > MOST_PACKED:
            raise Broken(f"a state of {len(self.session.pack())} bytes")
        self._check_events(self.session.finish())

    def _restore(self) -> None:
        if self.random.randrange(4):
            self.twin = Session.unpack(self.session.pack(), self.recipe)
        else:
            self.twin = Session.restore(json.loads(json.dumps(self.session.snapshot(), allow_nan=False)))
        self.twin_items = 0

    def _check_events(self, events: list[Any]) -> None:
        if len(events) > MOST_EVENTS:
            raise Broken(f"{len(events)} events of one item")
        self.events += len(events)
        for event in events:
            if not (isfinite(event.t) and isfinite(event.known_at) and event.known_at >= event.t):
                raise Broken(f"times of {event}")
            json.dumps(event.to_dict(), allow_nan=False)
            if isinstance(event, ActivityChanged):
                if event.revises is not None and event.revises not in self.open_activities:
                    raise Broken(f"{event} revises what was final")
                if not event.final:
                    self.open_activities.add(event.t)

    def _check_unchanged(self, before: bytes, item: Any, events: list[Any]) -> None:
        for event in events:
            if not isinstance(event, PacketRejected | SampleRejected):
                return  # the item was used
            if isinstance(event, SampleRejected) and isinstance(item, Packet):
                return  # the packet was used, for the clock and the sequence of its link
            if isinstance(event, SampleRejected) and (event.defect is not None or event.site.foot is None):
                return  # the unit of a foot without usable samples is kept, and the time of a limb far ahead
            is_counted = event.reason in (Rejection.TIME_BACKWARDS, Rejection.LATE)
            if isinstance(event, PacketRejected) and (is_counted or event.channel == "insole/frame"):
                return  # packets of an earlier time are counted, and fragments forgotten (link/decoder.py)
        if self.session.pack() != before:
            raise Broken(f"{events[0]} changed the state")
