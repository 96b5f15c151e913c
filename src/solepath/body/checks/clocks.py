"""Detection of feet whose sensors have separate clocks, from the gait events of both feet.

In the middle of a foot's swing the other foot is in the middle of its stance. This holds exactly if the two double
supports of a cycle are equally long, also for a walker who limps, whose swings or stances differ between the feet. An
offset between the clocks moves the middles apart: their distance is half the difference of the two double supports. It
is known except for whole cycles, because the next cycle looks the same.

The middles lie 6 ms apart (standard deviation of the medians of 111 walks and runs of 19 people) and 16 ms at most,
both with hand labels and with detected events. They need not for a wearer whose gait is very uneven, so the difference
of the swings raises the standard deviation of the offset. A walk in which each foot's cycles differ from the other's,
or in which the distance scatters, shows nothing about the clocks."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, pi, sin, sqrt

from ...events import Defect, DefectFound, FootFlat, HeelStrike, SampleGap, ToeOff
from ...types import Foot, Site
from ...types.attrs import define, field, frozen
from ..part import ClockUnsettled, Part, PartInput, PartOutput

MEMORY = 48
"""Number of the newest comparisons that the offset is the median of: two a cycle, so about 25 s of walking."""
MIN_COMPARISONS = 16
"""Least number of comparisons for an offset, about 9 s of walking.

With 12 to 20 no recording of feet on one clock is reported, with 10 one of 119 is, for a few uneven steps."""
GAIT_SIGMA = 0.010
"""Standard deviation of the distance of the middles, s: 6 ms in even walkers, and an allowance for others."""
EVEN_SWINGS = 0.040
"""Largest difference of the mean swing times of the feet of an even walker, s; 95 % of 111 walks have less."""
UNEVEN_SHARE = 0.25
"""Standard deviation of the distance of the middles of an uneven walker, as a share of the swing times' difference
above `EVEN_SWINGS`; chosen by hand: the double supports differ by half as much as the swings."""
SIGNIFICANT = 3.0
"""Number of standard deviations from which an offset is reported."""
CHANGED = 0.5
"""Relative change of a reported offset that is reported again."""
MAX_SCATTER = 0.08
"""Largest standard deviation of the single distances, as a share of the cycle; walks have 0.01, and 0.03 on stairs."""
MIN_CYCLE, MAX_CYCLE = 0.4, 2.2
"""Shortest and longest cycle that is compared, s: of a sprinter and of a very slow walker."""
AMBIGUOUS_PHASE = 0.25
"""Phase from which the right foot may also be late instead of early, or early instead of late, by the rest of the
cycle."""
MAX_CYCLE_RATIO = 1.25
"""Largest ratio of the cycle times of both feet that are compared; they are equal but for a change of pace."""
MAX_GAP = 0.05
"""Longest gap in the samples of a cycle that is compared, s; a shorter one moves an event by less."""
MAX_KEPT = 3
"""Number of the newest swings of a foot that are kept; clocks up to a cycle apart need two."""
SCALE_OF_MAD = 1.4826
"""Standard deviation of a normal distribution relative to its median absolute deviation."""
EFFICIENCY_OF_MEDIAN = 1.2533
"""Standard deviation of the median relative to that of the mean of normal values: sqrt(pi / 2)."""


@frozen
class Swing:
    """One swing of a foot, in the cycle that ends with it; times in s."""

    middle: float
    duration: float
    cycle: float
    """Time of the cycle from contact to contact."""


@frozen
class Comparison:
    """A stance of one foot compared with the swing of the other foot that is nearest in time."""

    phase: float
    """Lateness of the right foot relative to the left one, as a share of the cycle, from -0.5 to 0.5."""
    cycle: float
    """Mean cycle time of both feet, s."""
    uneven: float
    """Swing time of the right foot minus that of the left one, s."""


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


@frozen
class Offset:
    """An estimate of the offset between the clocks."""

    value: float
    """Time to add to the times of the right foot, s; it may be wrong by whole cycles."""
    sigma: float
    """Standard deviation of `value`, s."""
    cycle: float
    """Time of a cycle, s."""

    def differs_from(self, other: float) -> bool:
        """Return whether another offset, s, differs from this one by more than `CHANGED`, but for whole cycles."""
        difference = self.value - other
        difference -= self.cycle * round(difference / self.cycle)
        return abs(difference) > max(SIGNIFICANT * self.sigma, CHANGED * abs(other))


@define
class FootClocks(Part):
    """Detects that the times of the feet are not on one clock, and reports it as DefectFound.

    The offset of the right foot's times is reported when at least `MIN_COMPARISONS` comparisons show it with three
    standard deviations, and again when it has changed by half, as it does when the clocks run at different rates."""

    left: FootClock = field(factory=FootClock, init=False)
    right: FootClock = field(factory=FootClock, init=False)
    comparisons: list[Comparison] = field(factory=list, init=False)
    """Newest comparisons, oldest first."""
    reported: float | None = field(default=None, init=False)
    """Newest offset that was reported, s; None before any."""

    def receive(self, event: PartInput) -> Sequence[PartOutput]:
        """Receive an event or a notice; return DefectFound with the contact that shows that the clocks are apart."""
        if isinstance(event, HeelStrike | ToeOff | FootFlat):
            foot = self.left if event.foot is Foot.LEFT else self.right
            if isinstance(event, FootFlat):
                if foot.toe_off is not None:  # the heel-strike was not detected
                    foot.discard()
            elif event.inferred:
                foot.discard()
            elif isinstance(event, ToeOff):
                foot.toe_off = event.t
            else:
                middle = foot.add_contact(event.t)
                if middle is not None and self._compare(event.foot, middle):
                    return self._report(event)
        elif isinstance(event, SampleGap) and event.site.foot is not None and event.duration > MAX_GAP:
            (self.left if event.site.foot is Foot.LEFT else self.right).discard()
        elif isinstance(event, ClockUnsettled) and event.site.foot is not None:
            (self.left if event.site.foot is Foot.LEFT else self.right).unsettled = event.until
        return ()

    def reset(self, site: Site) -> None:
        """Discard everything when the clock or the device of a foot has changed."""
        if site.foot is not None:
            unsettled = (self.left.unsettled, self.right.unsettled)
            self.left, self.right = (FootClock(unsettled=until) for until in unsettled)
            self.comparisons, self.reported = [], None

    @property
    def offset(self) -> Offset | None:
        """Offset of the right foot's times now; None while it is not known."""
        comparisons = self.comparisons
        if len(comparisons) < MIN_COMPARISONS:
            return None
        angles = [2.0 * pi * one.phase for one in comparisons]
        turn = atan2(_total([sin(angle) for angle in angles]), _total([cos(angle) for angle in angles])) / (2.0 * pi)
        cycle = _median([one.cycle for one in comparisons])
        phases = [one.phase - round(one.phase - turn) for one in comparisons]
        delay, scatter = _spread([phase * one.cycle for phase, one in zip(phases, comparisons, strict=True)])
        if abs(turn) > AMBIGUOUS_PHASE:
            # a wearer who changes the pace shows the whole cycles: the offset is constant in s and not in phase
            whole = 1.0 if turn < 0.0 else -1.0
            other = _spread([(phase + whole) * one.cycle for phase, one in zip(phases, comparisons, strict=True)])
            if other[1] < scatter:
                delay, scatter = other
        if scatter > MAX_SCATTER * cycle:
            return None
        uneven = UNEVEN_SHARE * max(0.0, abs(_median([one.uneven for one in comparisons])) - EVEN_SWINGS)
        error = EFFICIENCY_OF_MEDIAN * scatter / sqrt(len(comparisons))
        return Offset(-delay, sqrt(GAIT_SIGMA * GAIT_SIGMA + uneven * uneven + error * error), cycle)

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

    def _report(self, event: HeelStrike) -> Sequence[PartOutput]:
        """Return DefectFound if the offset is significant and new."""
        offset = self.offset
        if offset is None or abs(offset.value) <= SIGNIFICANT * offset.sigma:
            return ()
        if self.reported is not None and not offset.differs_from(self.reported):
            return ()
        self.reported = offset.value
        return (
            DefectFound(
                t=event.t,
                known_at=event.known_at,
                site=Site.RIGHT_FOOT,
                defect=Defect.CLOCKS,
                what=_sentences(offset),
                spoils=False,
                offset=offset.value,
                sigma=offset.sigma,
            ),
        )


def _sentences(offset: Offset) -> str:
    """Return the sentences of the report for the person who records."""
    late, size = offset.value < 0.0, 1000.0 * abs(offset.value)
    other = f" (or {1000.0 * offset.cycle - size:.0f} ms {'early' if late else 'late'})" if size > 250.0 else ""
    return (
        f"its times are about {size:.0f} ms {'late' if late else 'early'}{other} against the left foot's, so step time "
        "and double support are left out: record both feet with one clock, or undo the offset"
    )


def _spread(delays: list[float]) -> tuple[float, float]:
    """Return median and robust standard deviation of the delays."""
    median = _median(delays)
    return median, SCALE_OF_MAD * _median([abs(one - median) for one in delays])


def _total(values: list[float]) -> float:
    """Return the sum of the values, added one after the other, because `sum` rounds as the Python version does."""
    total = 0.0
    for value in values:
        total += value
    return total


def _median(values: list[float]) -> float:
    """Return the median of at least one value."""
    ordered, half = sorted(values), len(values) // 2
    return ordered[half] if len(values) % 2 else 0.5 * (ordered[half - 1] + ordered[half])
