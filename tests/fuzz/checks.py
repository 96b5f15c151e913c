"""What must hold for the events and the state of a session, whatever was fed."""

from __future__ import annotations

import json
from math import isfinite
from random import Random
from typing import Any

from solepath import ActivityChanged, ClockReset, Packet, PacketRejected, Sample, SampleRejected, Session
from solepath.link.devices.insole import InsoleLink
from solepath.link.devices.reassembly import Reassembly
from solepath.recipes import Recipe
from solepath.wire.fragment import is_fragment

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
        self.final = FinalEvents()
        self.twin: Session | None = None
        self.twin_items = 0

    def feed(self, item: Any, *, may_raise: bool = False) -> None:
        """Feed a packet or sample; with `may_raise`, TypeError is an answer, and must change nothing."""
        before = self._pack_lasting(item) if self.random.random() < CHECK_SHARE else None
        if self.twin is None and self.random.random() < RESTORE_SHARE:
            self._restore()
        try:
            events = self.session.feed(item)
        except TypeError:
            if not may_raise:
                raise
            if before is not None and self._pack_lasting(item) != before:
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
            self.final.check(event)

    def _check_unchanged(self, before: bytes, item: Any, events: list[Any]) -> None:
        """Check that an item that was rejected changed nothing but what a rejected one may change."""
        if isinstance(item, Packet):
            own = [event for event in events if isinstance(event, PacketRejected) and not is_of_earlier(event)]
            if not own:
                return  # the packet was used, though its samples or earlier fragments may not have been
            if not all([isinstance(event, PacketRejected) for event in events]):
                raise Broken(f"a rejected packet gives {events}")
        elif not is_sample_rejected(events):
            return
        if self._pack_lasting(item) != before:
            raise Broken(f"{events[-1]} changed the state")

    def _pack_lasting(self, item: Packet | Sample) -> bytes:
        """Return the packed session without what this item may change though it is rejected.

        Packets of an earlier time are counted, and a fragment may end its frame (link/decoder.py)."""
        decoder = self.session._state.decoders.get(item.site) if isinstance(item, Packet) else None
        if decoder is None:
            return self.session.pack()
        link, backward_packets = decoder.link, decoder.backward_packets
        has_fragments = isinstance(link, InsoleLink) and item.channel == "insole/frame" and is_fragment(item.data)
        if decoder.newest_arrival is not None and item.t < decoder.newest_arrival:
            decoder.backward_packets = 0
        if has_fragments:
            kept, link.reassembly = link.reassembly, Reassembly()
        packed = self.session.pack()
        decoder.backward_packets = backward_packets
        if has_fragments:
            link.reassembly = kept
        return packed


class FinalEvents:
    """The events of a session that were final, as far as a later event could contradict them."""

    def __init__(self) -> None:
        self.newest: dict[tuple[type, Any], Any] = {}
        """Newest final event of each class and foot."""
        self.numbers: dict[tuple[type, Any], int] = {}
        """Newest number of each class and foot."""
        self.activities: dict[float, bool] = {}
        """Whether each activity that was not replaced is final, by its time, s."""

    def check(self, event: Any) -> None:
        """Check the next event: final ones of a foot come once and in order, and none replaces a final activity."""
        if isinstance(event, ClockReset):  # times restart, numbers do not
            self.newest.clear()
            self.activities = {t: is_final for t, is_final in self.activities.items() if not is_final}
        elif isinstance(event, ActivityChanged):
            self._check_activity(event)
        elif event.final and hasattr(event, "foot"):
            key = (type(event), event.foot)
            newest = self.newest.get(key)
            if newest is not None and (event.t < newest.t or event == newest):  # phases of no duration have one time
                raise Broken(f"{event} after {newest}")
            self.newest[key] = event
            if hasattr(event, "number"):
                if event.number != self.numbers.get(key, 0) + 1:
                    raise Broken(f"{event} after number {self.numbers.get(key, 0)}")
                self.numbers[key] = event.number

    def _check_activity(self, event: ActivityChanged) -> None:
        if event.revises is not None and event.revises not in self.activities:
            raise Broken(f"{event} revises what was not reported")
        for t in [t for t in self.activities if t > event.t or (event.revises is not None and t >= event.revises)]:
            if self.activities.pop(t):
                raise Broken(f"{event} revises what was final at {t} s")
        self.activities[event.t] = event.final


def is_of_earlier(event: PacketRejected) -> bool:
    """Return whether the event reports earlier fragments, which does not mean that its own packet was rejected."""
    return event.detail.startswith("frame dropped")


def is_sample_rejected(events: list[Any]) -> bool:
    """Return whether a sample was rejected and may change nothing.

    The unit of a foot without usable samples is kept, and the time of a limb far ahead."""
    return all([isinstance(one, SampleRejected) and one.defect is None and one.site.foot is not None for one in events])
