"""Detection of feet whose sensors have separate clocks, from the gait events of both feet.

In the middle of a foot's swing the other foot is in the middle of its stance. This holds exactly if the two double
supports of a cycle are equally long, also for a walker who limps, whose swings or stances differ between the feet. An
offset between the clocks moves the middles apart: their distance is half the difference of the two double supports. It
is known except for whole cycles, because the next cycle looks the same.

The middles lie 6 ms apart (standard deviation of the medians of 111 walks and runs of 19 people) and 16 ms at most,
both with hand labels and with detected events. They need not for a wearer whose gait is very uneven, so the difference
of the swings raises the standard deviation of the offset. A walk in which each foot's cycles differ from the other's,
or in which the distance scatters, shows nothing about the clocks.

Clocks that are many seconds apart show where one foot walks while the other one stands (lone_strides.py)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from ....events import Defect, DefectFound, FootFlat, GaitEvent, HeelStrike, SampleGap, ToeOff
from ....foot.view import FootView
from ....types import Foot, Site
from ....types.attrs import define, field, frozen
from ...part import ClockUnsettled, Part, PartInput, PartOutput
from .lone_strides import LoneStrides
from .offset import Comparison, Offset, find_offset

MEMORY = 48
"""Number of the newest comparisons that the offset is the median of: two a cycle, so about 25 s of walking."""
MIN_CYCLE, MAX_CYCLE = 0.4, 2.2
"""Shortest and longest cycle that is compared, s: of a sprinter and of a very slow walker."""
MAX_CYCLE_RATIO = 1.25
"""Largest ratio of the cycle times of both feet that are compared; they are equal but for a change of pace."""
MAX_GAP = 0.05
"""Longest gap in the samples of a cycle that is compared, s; a shorter one moves an event by less."""
MAX_KEPT = 3
"""Number of the newest swings of a foot that are kept; clocks up to a cycle apart need two."""


@frozen
class Swing:
    """One swing of a foot, in the cycle that ends with it; times in s."""

    middle: float
    duration: float
    cycle: float
    """Time of the cycle from contact to contact."""


@define
class FootClock:
    """The newest events of one foot; times in s."""

    contact: float | None = None
    """Contact of the cycle under way; None while there is none."""
    toe_off: float | None = None
    """Toe-off of the cycle under way; None before it."""
    swings: list[Swing] = field(factory=list)
    """Newest swings, oldest first."""
    unsettled: float | None = None
    """Time up to which the clock of this foot is not settled; None when it is."""
    spoiled: bool = False
    """Flag: another defect spoils the events of this foot."""

    def discard(self) -> None:
        """Discard the cycle under way, because one of its events is missing or not measured."""
        self.contact = self.toe_off = None

    def add_contact(self, t: float) -> float | None:
        """Add a contact; return the middle of the stance of the cycle that ends there, or None without a cycle."""
        contact, toe_off = self.contact, self.toe_off
        if contact is not None and toe_off is None:
            return None  # the foot never left the ground
        self.contact, self.toe_off = t, None
        if contact is None or toe_off is None or not (contact < toe_off < t and MIN_CYCLE <= t - contact <= MAX_CYCLE):
            return None
        if self.unsettled is not None and contact < self.unsettled:
            return None
        swing = Swing(0.5 * (toe_off + t), t - toe_off, t - contact)
        self.swings = [*self.swings[1 - MAX_KEPT :], swing]
        return 0.5 * (contact + toe_off)


@define
class FootClocks(Part):
    """Detects that the times of the feet are not on one clock, and reports it as DefectFound.

    The offset of the right foot's times is reported when at least `MIN_COMPARISONS` comparisons show it with three
    standard deviations, and again when it has changed by half, as it does when the clocks run at different rates. A
    foot that walks while the other one stands is reported once, without an offset, and no offset after it. A foot
    with another defect that spoils its events is not compared."""

    needs_samples: ClassVar[bool] = True

    idle: bool = field(default=True, init=False)
    """Flag: only samples with events are needed."""
    left: FootClock = field(factory=FootClock, init=False)
    right: FootClock = field(factory=FootClock, init=False)
    comparisons: list[Comparison] = field(factory=list, init=False)
    """Newest comparisons, oldest first."""
    reported: float | None = field(default=None, init=False)
    """Newest offset that was reported, s; None before any."""
    lone: LoneStrides = field(factory=LoneStrides, init=False)
    lone_reported: bool = field(default=False, init=False)
    """Flag: it was reported that one foot walked while the other one stood."""
    lone_sentences: str | None = field(default=None, init=False)
    """Sentences on this for the next sample, because a defect of the same sample may be the reason; None mostly."""

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        """Add events; return DefectFound with the one that shows that the clocks are apart."""
        outputs: Sequence[PartOutput] = ()
        if view is not None:
            self.lone.see(view)
            self.idle = self.lone.requested is None
            outputs = self._report_lone(view.t, view.known_at)
        return [*outputs, *[output for event in events for output in self._receive(event)]] if events else outputs

    def finish(self, now: float) -> Sequence[PartOutput]:
        """Return DefectFound if the newest stride was the last sample."""
        return self._report_lone(now, now)

    def _receive(self, event: PartInput) -> Sequence[PartOutput]:
        if isinstance(event, GaitEvent):
            if self.left.spoiled or self.right.spoiled or self.lone_reported:
                return ()
            self.lone_sentences = self.lone.add(event) or self.lone_sentences
            self.idle = self.idle and self.lone_sentences is None
            foot = self._foot(event.foot)
            if isinstance(event, FootFlat):
                if foot.toe_off is not None:  # the heel-strike was not detected
                    foot.discard()
            elif isinstance(event, ToeOff | HeelStrike):
                if event.inferred:
                    foot.discard()
                elif isinstance(event, ToeOff):
                    foot.toe_off = event.t
                else:
                    middle = foot.add_contact(event.t)
                    if middle is not None and self._compare(event.foot, middle):
                        return self._report_offset(event)
        elif isinstance(event, SampleGap) and event.site.foot is not None:
            self.lone.add_gap(event)
            if event.duration > MAX_GAP:
                self._foot(event.site.foot).discard()
        elif isinstance(event, DefectFound) and event.site.foot is not None and is_spoiling(event):
            self._foot(event.site.foot).spoiled = True
            self._forget()
        elif isinstance(event, ClockUnsettled) and event.site.foot is not None:
            self._foot(event.site.foot).unsettled = event.until
        return ()

    def reset(self, site: Site) -> None:
        """Discard everything when the clock or the device of a foot has changed."""
        if site.foot is not None:
            self._foot(site.foot).spoiled = False
            self._forget()
            self.reported, self.lone_reported = None, False

    def _forget(self) -> None:
        """Discard what was collected from both feet."""
        for foot in (self.left, self.right):
            foot.discard()
            foot.swings = []
        self.comparisons, self.lone, self.lone_sentences = [], LoneStrides(), None

    def _foot(self, foot: Foot) -> FootClock:
        return self.left if foot is Foot.LEFT else self.right

    def _compare(self, foot: Foot, middle: float) -> bool:
        """Compare the newest cycle of a foot, the middle of whose stance is `middle`, s; return whether that worked."""
        is_left = foot is Foot.LEFT
        this, other = (self.left, self.right) if is_left else (self.right, self.left)
        if not other.swings:
            return False
        own = this.swings[-1]
        across = min(other.swings, key=lambda swing: abs(swing.middle - middle))
        late = across.middle - middle if is_left else middle - across.middle
        cycle = 0.5 * (own.cycle + across.cycle)
        is_like = own.cycle < MAX_CYCLE_RATIO * across.cycle and across.cycle < MAX_CYCLE_RATIO * own.cycle
        if abs(late) > cycle or not is_like:
            return False
        phase, uneven = late / cycle, across.duration - own.duration
        comparison = Comparison(phase - round(phase), cycle, uneven if is_left else -uneven)
        self.comparisons = [*self.comparisons[1 - MEMORY :], comparison]
        return True

    def _report_offset(self, event: HeelStrike) -> Sequence[PartOutput]:
        """Return DefectFound if the offset is significant and new."""
        offset = find_offset(self.comparisons)
        if offset is None or not offset.is_significant:
            return ()
        if self.reported is not None and not offset.differs_from(self.reported):
            return ()
        self.reported = offset.value
        return self._report(event.t, event.known_at, offset.sentences, offset)

    def _report_lone(self, t: float, known_at: float) -> Sequence[PartOutput]:
        """Return DefectFound at `t`, s, if one foot has walked while the other one stood."""
        if self.lone_sentences is None:
            return ()
        what, self.lone_sentences, self.lone_reported = self.lone_sentences, None, True
        return self._report(t, max(t, known_at), what)

    @staticmethod
    def _report(t: float, known_at: float, what: str, offset: Offset | None = None) -> Sequence[PartOutput]:
        """Return DefectFound with these sentences."""
        return (
            DefectFound(
                t=t,
                known_at=known_at,
                site=Site.RIGHT_FOOT,
                defect=Defect.CLOCKS,
                what=what,
                spoils=False,
                offset=None if offset is None else offset.value,
                sigma=None if offset is None else offset.sigma,
            ),
        )


def is_spoiling(defect: DefectFound) -> bool:
    """Return whether a defect spoils the times of the gait events; a peak that is cut off (CLIPPED) has its time."""
    return defect.spoils and defect.defect is not Defect.CLIPPED
