"""The rules of feedback that come with solepath.

Latencies are from the cause to the event that shows it, at 100 Hz, without radio and host; docs/app.md has them
measured with both. No rule gives a signal before the first stride of a bout is known, which is with the second one."""

from __future__ import annotations

from math import fsum
from typing import ClassVar

from ..events import FootFlat, FootMoved, GaitCycleMeasured, HeelOff, HeelStrike, ToeOff
from ..events.happening import BaseEvent
from ..types import OTHER, Foot
from ..types.attrs import field, frozen, limited, limits
from .rule import Rule, Value, WalkNow

IN_A_ROW = 3
"""Number of the newest steady cycles of both feet that are all beyond a limit of a cycle.

One is no trend, and the two that end with the half steps before a stop are shorter."""
LATE_CYCLE = 1.0
"""Time within which a signal about the last cycles must be given, s: about one stride."""


@frozen
class EveryHeelStrike(Rule):
    """A signal at each contact of a foot: its heel-strike, or its foot-flat if it lands flat.

    Latency: one sample with pressure cells; without them 10 to 20 ms from a session with `impacts=True`, else 50 ms; if
    no impact shows, until the foot is still, often too late for the deadline, 0.2 s. It needs one sensor, on this
    foot."""

    reads: ClassVar[tuple[type[BaseEvent], ...]] = (HeelStrike, FootFlat)

    foot: Foot

    def measure(self, event: HeelStrike | FootFlat, walk: WalkNow) -> Value | None:
        """Return the contact, which is no quantity."""
        if isinstance(event, HeelStrike) and event.revises is not None:
            return None
        is_contact = event.foot is self.foot and walk.feet[self.foot].contact == event.t
        return Value(event.t, self.foot, 0.0) if is_contact else None


@frozen
class StanceLonger(Rule):
    """A signal while the foot stays on the ground for longer than `limit` s after its contact.

    Latency: the next sample after the limit, in the same stance; the cause is the moment at which the limit passes. It
    needs `Session(poses=True)`; without that it comes at the toe-off, if that is within 0.2 s. Who stands on both feet
    with the heel down stands, and gets no signal: a stance is one of walking once the heel is lifted or the other foot
    swings. It needs one sensor, on this foot; the other one makes it sooner where the heel stays down."""

    reads: ClassVar[tuple[type[BaseEvent], ...]] = (FootMoved, ToeOff, HeelOff)

    foot: Foot
    limit: float = field(metadata=limits(0.05, 10.0, "s"))

    def measure(self, event: FootMoved | ToeOff | HeelOff, walk: WalkNow) -> Value | None:
        """Return the time on the ground so far once it is beyond the limit, or at its end."""
        now = walk.feet[self.foot]
        if event.foot is not self.foot or now.contact is None:
            return None
        if now.toe_off is not None:
            stance = now.stance if isinstance(event, ToeOff) else None
            return None if stance is None else Value(min(now.contact + self.limit, event.t), self.foot, stance)
        so_far = event.t - now.contact
        if so_far <= self.limit or not (now.is_lifted or walk.feet[OTHER[self.foot]].in_air):
            return None
        return Value(now.contact + self.limit, self.foot, so_far)


@frozen
class StanceShorter(Rule):
    """A signal at the toe-off that ends a stance shorter than `limit` s.

    Latency: one sample after the toe-off. It needs one sensor, on this foot."""

    reads: ClassVar[tuple[type[BaseEvent], ...]] = (ToeOff,)
    above: ClassVar[bool] = False

    foot: Foot
    limit: float = field(metadata=limits(0.05, 10.0, "s"))

    def measure(self, event: ToeOff, walk: WalkNow) -> Value | None:
        """Return the time on the ground."""
        stance = walk.feet[self.foot].stance if event.foot is self.foot else None
        return None if stance is None else Value(event.t, self.foot, stance)


@frozen(kw_only=True)
class CycleRule(Rule):
    """The base of the rules about the last steady cycles of both feet, which walk straight on.

    Latency: that of GaitCycleMeasured, 0.1 to 0.2 s after the contact that ends the last cycle, and three cycles of
    both feet, 1.5 strides, after the gait has changed; three strides with a sensor on one foot, which is enough."""

    reads: ClassVar[tuple[type[BaseEvent], ...]] = (GaitCycleMeasured,)

    remind: float | None = limited(10.0, 0.1, 1e6, "s")
    within: float = limited(LATE_CYCLE, 0.0, 60.0, "s")

    def measure(self, event: GaitCycleMeasured, walk: WalkNow) -> Value | None:
        """Return the value of the last cycles that is nearest to being inside the limit."""
        if not event.steady:
            return None
        known = [value for one in walk.cycles if (value := self.of_cycle(one)) is not None]
        if len(known) < IN_A_ROW:
            return None
        newest = known[-IN_A_ROW:]
        return Value(event.t, None, min(newest) if self.above else max(newest))

    def of_cycle(self, cycle: GaitCycleMeasured) -> float | None:
        """Return the value of one cycle; None where it has none."""
        return None


@frozen
class StrideShorter(CycleRule):
    """A signal when the last three steady strides of both feet are each shorter than `limit` m. Latency: CycleRule."""

    above: ClassVar[bool] = False

    limit: float = field(metadata=limits(0.0, 4.0, "m"))

    def of_cycle(self, cycle: GaitCycleMeasured) -> float | None:
        """Return the stride length, m."""
        return cycle.stride_length


@frozen
class StrideLonger(CycleRule):
    """A signal when the last three steady strides of both feet are each longer than `limit` m. Latency: CycleRule."""

    limit: float = field(metadata=limits(0.0, 4.0, "m"))

    def of_cycle(self, cycle: GaitCycleMeasured) -> float | None:
        """Return the stride length, m."""
        return cycle.stride_length


@frozen
class CadenceBelow(CycleRule):
    """A signal when the last three steady cycles each have fewer than `limit` steps a minute. Latency: CycleRule."""

    above: ClassVar[bool] = False

    limit: float = field(metadata=limits(1.0, 400.0, "steps a minute"))

    def of_cycle(self, cycle: GaitCycleMeasured) -> float | None:
        """Return the cadence, steps of both feet a minute."""
        return cycle.cadence


@frozen
class CadenceAbove(CycleRule):
    """A signal when the last three steady cycles each have more than `limit` steps a minute. Latency: CycleRule."""

    limit: float = field(metadata=limits(1.0, 400.0, "steps a minute"))

    def of_cycle(self, cycle: GaitCycleMeasured) -> float | None:
        """Return the cadence, steps of both feet a minute."""
        return cycle.cadence


@frozen
class StanceUneven(CycleRule):
    """A signal when the stances of the two feet differ by more than `limit` of their mean, 0.1 for 10 %.

    It compares the newest two steady cycles of each foot; the foot of the signal is the one that stands longer.
    Latency: CycleRule, and two strides of each foot. It needs a sensor on each foot."""

    limit: float = field(metadata=limits(0.0, 2.0))

    def measure(self, event: GaitCycleMeasured, walk: WalkNow) -> Value | None:
        """Return the difference as a share of the mean."""
        newest = {foot: [one.stance_time for one in walk.cycles if one.foot is foot][-2:] for foot in Foot}
        if not event.steady or min(map(len, newest.values())) < 2:
            return None
        left, right = (0.5 * fsum(times) for times in newest.values())
        foot = Foot.LEFT if left > right else Foot.RIGHT
        return Value(event.t, foot, 2.0 * abs(left - right) / (left + right))
