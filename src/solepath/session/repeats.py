"""Small troubles of links that repeat: short gaps, and rejected packets and samples, which are reported together.

The first trouble of a kind is reported at once, and so is a long gap, an absence, and a trouble after a calm time.
Those of the same kind that follow within REPORTED_TOGETHER are reported as one event, with their counts and times added
up. Time is that of packets and samples, and only those that were used let it pass, so that a rejected one changes
nothing but counts."""

from __future__ import annotations

from ..events import ClockReset, Disconnected, Event, PacketRejected, SampleGap, SampleRejected, StreamStale
from ..events.link import is_harmless_loss
from ..types import Packet, Sample
from ..types.attrs import define, evolve, field
from ..types.plain import number

REPORTED_TOGETHER = 10.0
"""Time after a trouble was reported within which those of its kind are reported together, s.

Of the events of the walk of `solepath demo` 9 % are then about the link; with 5 s 14 %, with 20 s 7 %, with 60 s 5 %.
It is also the time over which the health of a link is counted."""
MAX_KINDS = 32
"""Largest number of kinds of trouble that are reported together: each has a site, a channel and a reason. Seven sites
with their usual troubles have fewer; those of any further kind are reported one by one. Chosen by hand."""
MAX_TEXT = 200
"""Largest number of characters of a channel, or of words, that is kept; troubles with more are reported one by one.

Words about two devices to which a system gives 36 characters each have 130."""

Trouble = SampleGap | PacketRejected | SampleRejected
TROUBLES = (SampleGap, PacketRejected, SampleRejected)
REJECTIONS = (PacketRejected, SampleRejected)
ENDS = (ClockReset, Disconnected, StreamStale)
"""Events of a site before which its troubles are reported, because what follows is another connection or clock."""


@define
class Repeated:
    """One kind of trouble of a site that was reported, and what came of it since."""

    reported: Trouble
    """Newest event that was reported."""
    held: Trouble | None = None
    """Troubles since then, which are reported together; None without any."""

    def is_recent(self, t: float) -> bool:
        """Return whether `t`, s, is near the time at which this kind was reported."""
        return abs(t - self.reported.known_at) < REPORTED_TOGETHER

    def take_held(self, now: float | None) -> list[Event]:
        """Return what is held, which is reported and known at `now`, s; None before the first time that is known."""
        held, self.held = self.held, None
        if held is None:
            return []
        self.reported = held if now is None or now <= held.known_at else evolve(held, known_at=now)
        return [self.reported]


@define
class Repeats:
    """What was reported of the small troubles of all sites, and what is held."""

    kinds: list[Repeated] = field(factory=list)
    """Kinds of trouble in the order in which they were first reported, at most MAX_KINDS."""
    due: float = 0.0
    """First time at which one of these is reported or forgotten, s."""

    def gather(self, item: Packet | Sample | None, events: list[Event]) -> list[Event]:
        """Return what an app gets after an item, whose events these are; None as the item means that time passed."""
        now = None if item is None else _time(item)
        if not events and now is not None and now < self.due:  # nearly always
            return events
        reported: list[Event] = []
        for event in events:
            if isinstance(event, TROUBLES):
                reported += self._add(event)
            else:
                if isinstance(event, ENDS):
                    of_site = [one for one in self.kinds if one.reported.site is event.site]
                    reported += self._end(of_site, event.known_at)
                reported.append(event)
        if item is not None and now is not None and not any([isinstance(event, REJECTIONS) for event in events]):
            for one in [one for one in self.kinds if one.reported.site is item.site and not one.is_recent(now)]:
                if one.held is None:
                    self.kinds.remove(one)
                reported += one.take_held(now)
        self.due = min([one.reported.known_at for one in self.kinds], default=0.0) + REPORTED_TOGETHER
        return reported

    def end(self, events: list[Event], now: float | None) -> list[Event]:
        """Return what an app gets at `now`, s, the end or when the clock is set, whose events these are."""
        return self.gather(None, events) + self._end(self.kinds, now)

    def _add(self, event: Trouble) -> list[Event]:
        """Hold a trouble, or return it to be reported."""
        known = next((one for one in self.kinds if _kind(one.reported) == _kind(event)), None)
        if known is None or not _can_be_kept(event):
            if known is None and _can_be_kept(event) and len(self.kinds) < MAX_KINDS:
                self.kinds.append(Repeated(event))
            return [event]
        is_recent = known.is_recent(event.known_at)
        if (isinstance(event, SampleGap) and not is_harmless_loss(event)) or (known.held is None and not is_recent):
            reported = known.take_held(event.known_at)
            known.reported = event
            return [*reported, event]
        known.held = event if known.held is None else _joined(known.held, event)
        return [] if is_recent else known.take_held(event.known_at)

    def _end(self, kinds: list[Repeated], now: float | None) -> list[Event]:
        """Forget these kinds; return what was held of them, which is reported at `now`, s."""
        self.kinds = [one for one in self.kinds if all([one is not ended for ended in kinds])]
        return [event for one in kinds for event in one.take_held(now)]


def _time(item: Packet | Sample) -> float:
    """Return when an item came, s; its numbers are as the app gave them."""
    t = number("t", item.t)
    return t if isinstance(item, Packet) or item.known_at is None else max(t, number("known_at", item.known_at))


def _kind(event: Trouble) -> tuple[object, ...]:
    """Return what troubles that are reported together have in common."""
    match event:
        case SampleGap():
            return SampleGap, event.site
        case PacketRejected():
            return PacketRejected, event.site, event.channel, event.reason
        case _:
            return SampleRejected, event.site, event.reason, event.defect


def _can_be_kept(event: Trouble) -> bool:
    """Return whether the texts of a trouble can be kept: a packet may have any text as its channel."""
    texts = [getattr(event, name, "") for name in ("channel", "detail")]
    return all([len(text) <= MAX_TEXT and text.isprintable() for text in texts])


def _joined(held: Trouble, event: Trouble) -> Trouble:
    """Return the event that reports two troubles of a kind."""
    known_at, count = max(held.known_at, event.known_at), held.count + event.count
    if isinstance(held, SampleGap) and isinstance(event, SampleGap):
        return evolve(
            held,
            known_at=known_at,
            count=count,
            duration=held.duration + event.duration,
            gaps=held.gaps + event.gaps,
            longest=max(held.longest, event.longest),
        )
    return evolve(held, known_at=known_at, count=count)
