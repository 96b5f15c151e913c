"""Detection of feet whose sensors have separate clocks, from the gait events of both feet.

In the middle of a foot's swing the other foot is in the middle of its stance. This holds exactly if the two double
supports of a cycle are equally long, also for a walker who limps, whose swings or stances differ between the feet. An
offset between the clocks moves the middles apart: their distance is half the difference of the two double supports. It
is known except for whole cycles, because the next cycle looks the same.

The middles lie 6 ms apart (standard deviation of the medians of 111 walks and runs of 19 people) and 16 ms at most,
both with hand labels and with detected events. They need not for a wearer whose gait is very uneven, so the difference
of the swings raises the standard deviation of the offset. A walk in which each foot's cycles differ from the other's,
or in which the distance scatters, shows nothing about the clocks.

Clocks that are many seconds apart show where one foot walks while the other one stands (`LoneStrides`)."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, fsum, hypot, pi, sin, sqrt

from ...events import Defect, DefectFound, FootFlat, GaitEvent, HeelStrike, SampleGap, StrideTaken, ToeOff
from ...foot.view import FootView
from ...types import OTHER, Foot, PerFoot, Phase, Site, per_foot
from ...types.attrs import define, evolve, field, frozen, state, stateful
from ..part import ClockUnsettled, Inputs, Outputs, Part, PartOutput
from .stances import Finding

# The offset between the clocks of the feet, from comparisons of the stances of each foot with the other's swings.

MIN_COMPARISONS = 16
"""Least number of comparisons for an offset, about 9 s of walking.

With 12 to 20 no recording of feet on one clock is reported, with 10 one of 119 is, for a few uneven steps."""
GAIT_SIGMA = 0.010
"""Standard deviation of the distance of the middles, s: 6 ms in even walkers, and an allowance for others."""
CELLS_SIGMA = 0.030
"""The same without an inertial sensor, s: a contact is seen when a cell bears it, which depends on where the cells lie.

In 50 walks of 10 people on soles of two cells, the middles lie up to 82 ms apart."""
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
AMBIGUOUS_PHASE = 0.25
"""Phase from which the right foot may also be late instead of early, or early instead of late, by the rest of the
cycle."""
SCALE_OF_MAD = 1.4826
"""Standard deviation of a normal distribution relative to its median absolute deviation."""
EFFICIENCY_OF_MEDIAN = 1.2533
"""Standard deviation of the median relative to that of the mean of normal values: sqrt(pi / 2)."""


@frozen
class Comparison:
    """A stance of one foot compared with the swing of the other foot that is nearest in time."""

    phase: float
    """Lateness of the right foot relative to the left one, as a share of the cycle, from -0.5 to 0.5."""
    cycle: float
    """Mean cycle time of both feet, s."""
    uneven: float
    """Swing time of the right foot minus that of the left one, s."""


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

    def event(self, known: HeelStrike) -> DefectFound:
        """Return the event by which it is reported, with the contact that made it known."""
        late, size = "late" if self.value < 0.0 else "early", 1000.0 * abs(self.value)
        cycle = 1000.0 * self.cycle
        text = (
            f"its times are about {size:.0f} ms {late}, give or take whole cycles of {cycle:.0f} ms; step time and "
            "double support are left out. Use one clock: an offset wrong by a cycle gives numbers that look right"
        )
        found = Finding(Defect.CLOCKS, text, spoils=False).event(Foot.RIGHT, known.t, known.known_at)
        return evolve(found, offset=self.value, sigma=self.sigma)


def find_offset(comparisons: Sequence[Comparison], gait_sigma: float = GAIT_SIGMA) -> Offset | None:
    """Return the offset of the right foot's times that these comparisons show; None if they do not show any.

    `gait_sigma` is the standard deviation of the distance of the middles of even walkers, s."""
    if len(comparisons) < MIN_COMPARISONS:
        return None
    angles = [2.0 * pi * one.phase for one in comparisons]
    turn = atan2(fsum([sin(angle) for angle in angles]), fsum([cos(angle) for angle in angles])) / (2.0 * pi)
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
    sigma = sqrt(gait_sigma * gait_sigma + uneven * uneven + error * error)
    return Offset(-delay, sigma, cycle) if abs(delay) > SIGNIFICANT * sigma else None


def _spread(delays: list[float]) -> tuple[float, float]:
    """Return median and robust standard deviation of the delays."""
    median = _median(delays)
    return median, SCALE_OF_MAD * _median([abs(one - median) for one in delays])


def _median(values: list[float]) -> float:
    """Return the median of at least one value."""
    ordered, half = sorted(values), len(values) // 2
    return ordered[half] if len(values) % 2 else 0.5 * (ordered[half - 1] + ordered[half])


# Strides of one foot while the other foot stands, which nobody can take.
#
# While one foot stands, the other one can get from a step behind it to a step in front of it, and no further. If it
# goes further in several strides, and the standing foot's samples go on, then the times of the feet may be seconds
# apart, or one of the two sensors is not worn or does not measure. Turns, stairs, steps on the spot and a leg that
# swings stay within reach, because the displacement counts and not the number of strides.

LONGEST_STEP = 1.0
"""Longest step of a walk, m: of legs of 1.15 m that are 52 degrees apart.

In 204 recordings of feet on one clock, no foot gets further than 1.7 m while the other one stands. With steps of 0.8,
1.0, 1.2 and 1.4 m, clocks that are 5 or 10 s apart are found in 93, 92, 86 and 78 % of the walks of ipol_10m_uturn and
marpino_heel_toe, and one recording of feet on one clock is reported with 0.8 m, none with more."""
MIN_STRIDES = 2
"""Least number of strides; a single one that is too long is of a runner, or two that were taken for one."""
LONGEST_LONE_GAP = 0.3
"""Longest gap in which a foot cannot have taken a step, s; the swing of a walker lasts longer."""
MAX_LAG = 0.5
"""Longest time by which the samples of the standing foot may be behind the other foot's, s."""


@define
class LoneFoot:
    """The strides of one foot since the other foot moved."""

    stood_since: float | None = None
    """Time from which on this foot is on the ground, s: of its newest event, or before any of a sample; else None."""
    is_known: bool = False
    """Flag: this foot had an event, or a sample with which it is tracked."""
    strides: int = 0
    """Number of strides since the other foot moved."""
    x: float = 0.0
    """Displacement by these strides along the x axis of the world, m."""
    y: float = 0.0
    """Displacement by these strides along the y axis of the world, m."""

    def restart(self) -> None:
        """Restart the count, because the other foot moved, or may have moved."""
        self.strides, self.x, self.y = 0, 0.0, 0.0


@stateful
class LoneStrides:
    """Detects a foot that walked while the other foot stood; the sentences are those of the right foot."""

    feet: PerFoot[LoneFoot] = state(factory=lambda: per_foot(LoneFoot))
    other_t: float | None = None
    """Time of the newest sample of the foot that did not have the newest event, s; None before any."""
    requested: Foot | None = None
    """Foot of which a sample without events is needed, to know whether it is tracked; None mostly."""

    def see(self, view: FootView) -> None:
        """Take a sample with events, or one of the foot that was requested."""
        this, other = self.feet[view.foot], OTHER[view.foot]
        if not this.is_known and view.levelled and view.moved_at is not None:
            this.is_known = True
            this.stood_since = view.t if view.phase in (Phase.STATIONARY, Phase.LOADING) else None
        if self.requested is view.foot:
            self.requested = None
        if view.after is not None:
            self.other_t = view.after.other_t
            if not self.feet[other].is_known and self.other_t is not None:
                self.requested = other

    def add(self, event: GaitEvent) -> str | None:
        """Add an event of a foot; return sentences for the person if the foot has walked while the other one stood."""
        this, other = self.feet[event.foot], self.feet[OTHER[event.foot]]
        if other.strides:
            other.restart()
        if not isinstance(event, StrideTaken):
            this.is_known = True
            this.stood_since = event.t if isinstance(event, HeelStrike | FootFlat) else None
            return None
        is_lone = other.stood_since is not None and other.stood_since <= event.t_start
        if event.flaws or not is_lone or self.other_t is None or self.other_t < event.t_end - MAX_LAG:
            this.restart()
            return None
        x, y, _ = event.displacement
        this.strides, this.x, this.y = this.strides + 1, this.x + x, this.y + y
        if this.strides < MIN_STRIDES or hypot(this.x, this.y) <= 2.0 * LONGEST_STEP:
            return None
        is_left = event.foot is Foot.LEFT
        contradiction = "stood while the left foot walked" if is_left else "walked while the left foot stood"
        return (
            f"it {contradiction}: the clocks are seconds apart, or one sensor is not worn or does not measure. Step "
            "time and double support are left out. Record both feet with one clock"
        )

    def add_gap(self, gap: SampleGap) -> None:
        """Restart the count after a gap in which a foot may have taken a step."""
        if gap.duration > LONGEST_LONE_GAP:
            for foot in self.feet.values():
                foot.restart()


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
    stride_end: float | None = None
    """End of the newest stride in which this foot carried the wearer; None before any."""
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
        if self.stride_end is None or contact > self.stride_end:
            return None  # a pedal has contacts, too
        if self.unsettled is not None and contact < self.unsettled:
            return None
        swing = Swing(0.5 * (toe_off + t), t - toe_off, t - contact)
        self.swings = [*self.swings[1 - MAX_KEPT :], swing]
        return 0.5 * (contact + toe_off)


@stateful
class FootClocks(Part):
    """Detects that the times of the feet are not on one clock, and reports it as DefectFound.

    The offset of the right foot's times is reported when at least `MIN_COMPARISONS` comparisons show it with three
    standard deviations, and again when it has changed by half, as it does when the clocks run at different rates. A
    foot that walks while the other one stands is reported once, without an offset, and no offset after it. A foot
    with another defect that spoils its events is not compared."""

    needs_samples = True
    notices = (ClockUnsettled,)

    idle: bool = True
    """Flag: only samples with events are needed."""
    feet: PerFoot[FootClock] = state(factory=lambda: per_foot(FootClock))
    comparisons: list[Comparison] = state(factory=list)
    """Newest comparisons, oldest first."""
    by_cells: bool = False
    """Flag: the foot of the last view has no inertial sensor."""
    reported: float | None = None
    """Newest offset that was reported, s; None before any."""
    lone: LoneStrides = state(factory=LoneStrides)
    lone_reported: bool = False
    """Flag: it was reported that one foot walked while the other one stood."""
    lone_sentences: str | None = None
    """Sentences on this for the next sample, because a defect of the same sample may be the reason; None mostly."""

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        """Add events; return DefectFound with the one that shows that the clocks are apart."""
        outputs: list[PartOutput] = []
        if view is not None:
            self.by_cells = view.moved_at is None
            if self.by_cells:  # its load shows that the foot carries
                self.feet[view.foot].stride_end = view.t
            self.lone.see(view)
            self.idle = self.lone.requested is None
            if self.lone_sentences is not None:
                outputs += self._report_lone(view.t, view.known_at)
        for event in events:
            if isinstance(event, GaitEvent):
                left, right = self.feet.values()
                if not (self.lone_reported or left.spoiled or right.spoiled):
                    self.lone_sentences = self.lone.add(event) or self.lone_sentences
                    self.idle = self.idle and self.lone_sentences is None
                    outputs += self._add_event(event, self.feet[event.foot])
            elif isinstance(event, SampleGap | DefectFound | ClockUnsettled) and event.site.foot is not None:
                foot = self.feet[event.site.foot]
                if isinstance(event, ClockUnsettled):
                    foot.unsettled = event.until
                elif isinstance(event, SampleGap):
                    self.lone.add_gap(event)
                    if event.duration > MAX_GAP:
                        foot.discard()
                elif event.spoilt_foot is not None:
                    foot.spoiled = True
                    self._forget()
        return outputs

    def finish(self, now: float) -> Outputs:
        """Return DefectFound if the newest stride was the last sample."""
        return self._report_lone(now, now)

    def _add_event(self, event: GaitEvent, foot: FootClock) -> Outputs:
        """Add an event of a foot; return DefectFound if the offset that it shows is significant and new."""
        if isinstance(event, StrideTaken):
            foot.stride_end = event.t_end
        elif isinstance(event, FootFlat):
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
                    offset = find_offset(self.comparisons, CELLS_SIGMA if self.by_cells else GAIT_SIGMA)
                    if offset is not None and (self.reported is None or offset.differs_from(self.reported)):
                        self.reported = offset.value
                        return [offset.event(event)]
        return ()

    def reset(self, site: Site) -> None:
        """Discard everything when the clock or the device of a foot has changed."""
        if site.foot is not None:
            self.feet[site.foot].spoiled, self.feet[site.foot].stride_end = False, None
            self._forget()
            self.reported, self.lone_reported = None, False

    def _forget(self) -> None:
        """Discard what was collected from both feet."""
        for foot in self.feet.values():
            foot.discard()
            foot.swings = []
        self.comparisons, self.lone, self.lone_sentences = [], LoneStrides(), None

    def _compare(self, foot: Foot, middle: float) -> bool:
        """Compare the newest cycle of a foot, the middle of whose stance is `middle`, s; return whether that worked."""
        is_left, this, other = foot is Foot.LEFT, self.feet[foot], self.feet[OTHER[foot]]
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

    def _report_lone(self, t: float, known_at: float) -> Outputs:
        """Return DefectFound at `t`, s, if one foot has walked while the other one stood."""
        if self.lone_sentences is None:
            return ()
        what, self.lone_sentences, self.lone_reported = self.lone_sentences, None, True
        return [Finding(Defect.CLOCKS, what, spoils=False).event(Foot.RIGHT, t, max(t, known_at))]
