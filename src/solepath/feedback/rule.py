"""The contract of a rule of feedback, and what a rule may know of the walk."""

from __future__ import annotations

from abc import abstractmethod
from collections import deque
from math import isfinite
from typing import Any, ClassVar

from ..body.gait.cycles import MAX_PHASE_TIME, MIN_CYCLE_TIME
from ..events import (
    ClockReset,
    DefectFound,
    Disconnected,
    FootFlat,
    FootMoved,
    FootSilent,
    GaitCycleMeasured,
    HeelOff,
    HeelStrike,
    SampleGap,
    StreamStale,
    StrideTaken,
    ToeOff,
)
from ..events.foot import Flaw
from ..events.happening import BaseEvent
from ..events.link import is_harmless_loss
from ..types import Foot, PerFoot, per_foot
from ..types.attrs import define, field, frozen, limited

KEPT_CYCLES = 8
"""Number of the newest steady cycles of both feet that rules may read."""
OLDEST_CYCLE = 2.0 * MAX_PHASE_TIME
"""Greatest age of a kept cycle when the next one is added, s: the longest gait cycle."""


@frozen
class Value:
    """What a rule has measured."""

    t: float
    """Time at which it happened, s; the deadline of a signal counts from it."""
    foot: Foot | None
    """Foot that it is about; None for both."""
    value: float
    """Value in the unit of the rule's limit."""


@define
class FootNow:
    """What the events report of one foot up to now; a rule must not change it."""

    contact: float | None = None
    """Contact that started the newest stance, s; None while it is not known, as after a gap."""
    toe_off: float | None = None
    """Toe-off that ended the newest stance, s; None while it lasts, and while it is not known."""
    is_lifted: bool = False
    """Flag: the heel has left the ground since the contact."""
    in_air: bool = False
    """Flag: the foot swings."""

    @property
    def stance(self) -> float | None:
        """Duration of the newest stance, s; None while it lasts, is not known, or is none of a gait cycle (2 s)."""
        if self.contact is None or self.toe_off is None:
            return None
        time = self.toe_off - self.contact
        return time if 0.0 < time <= MAX_PHASE_TIME else None


@define
class WalkNow:
    """What the events report of the walk up to now; a rule must not change it."""

    feet: PerFoot[FootNow] = field(factory=lambda: per_foot(FootNow))
    cycles: deque[GaitCycleMeasured] = field(factory=lambda: deque(maxlen=KEPT_CYCLES))
    """Newest steady gait cycles of both feet, the oldest first; empty after a loss, a reset, and while nobody walks."""

    def add(self, event: BaseEvent) -> None:
        """Add an event."""
        match event:
            case FootMoved():  # nearly always
                pass
            case HeelStrike(foot=foot) | FootFlat(foot=foot):
                self._add_contact(self.feet[foot], event)
            case HeelOff(foot=foot):
                self.feet[foot].is_lifted = True
            case ToeOff(foot=foot):
                now = self.feet[foot]
                now.in_air, now.toe_off = True, event.t
                now.contact = None if event.inferred else now.contact
            case GaitCycleMeasured(steady=True):
                while self.cycles and event.t - self.cycles[0].t > OLDEST_CYCLE:
                    self.cycles.popleft()
                self.cycles.append(event)
            case SampleGap() if not is_harmless_loss(event):
                self.forget(event.site.foot)
            case StreamStale() | Disconnected() | ClockReset() | DefectFound(spoils=True):
                self.forget(event.site.foot)
            case FootSilent():
                self.forget(event.foot)

    @staticmethod
    def _add_contact(now: FootNow, event: HeelStrike | FootFlat) -> None:
        """Start a stance, or correct its start; a foot-flat is a contact when no heel-strike came before it.

        Otherwise it lowers the heel, which may have been lifted by somebody who stands."""
        now.is_lifted = False
        if isinstance(event, HeelStrike) or now.in_air:
            now.contact = None if event.inferred else event.t
            now.toe_off, now.in_air = None, False

    def forget(self, foot: Foot | None) -> None:
        """Forget the stance of a foot, None for no foot, and the cycles: samples are missing, or wrong."""
        if foot is not None:
            self.feet[foot] = FootNow()
            self.cycles.clear()


HYSTERESIS = 0.05
"""Share of the limit by which a value must be better than it before the next excursion gives a signal; the stance and
the stride of a healthy walker vary by 2 to 3 % (Hollman et al. 2011, Gait & Posture 34). Chosen by hand."""
WITHIN = 0.2
"""Time within which a signal about one moment of a stride must be given, s. A step takes 0.5 s: later, a person takes
the signal for one about the other foot. Chosen by hand."""
REMINDER = 5.0
"""Time after which a signal is repeated while the value stays beyond the limit, s; chosen by hand."""


@frozen(kw_only=True)
class Rule:
    """A rule: what is measured, and when the wearer gets a signal for it. It is plain data without state.

    For a rule of your own derive a frozen attrs class with a `limit`, name in `reads` the events from which it
    measures, and override `measure`. Its value gives a signal when it is beyond the limit: above it, or below it if
    `above` is False; always if there is no limit. Feedback does the rest: who walks, hysteresis, refractory time,
    deadline."""

    reads: ClassVar[tuple[type[BaseEvent], ...]] = ()
    """Classes of the events for which `measure` is called; FootMoved is in every sample of `Session(poses=True)`."""
    above: ClassVar[bool] = True
    """True if values above the limit give a signal, False if those below."""

    limit: float | None = None
    """Limit; None: every value gives a signal."""
    rearm: float | None = None
    """Value to which it must return after a signal before the next excursion gives one; None: 5 % inside the limit."""
    remind: float | None = limited(REMINDER, 0.1, 1e6, "s")
    """Time after which the signal is repeated while the value stays beyond the limit, s; None: it is not repeated."""
    pause: float = limited(MIN_CYCLE_TIME, 0.0, 1e6, "s")
    """Refractory time: least time from the cause of one signal to that of the next, s."""
    within: float = limited(WITHIN, 0.0, 60.0, "s")
    """Time from the cause within which the signal must be given, s; later it is dropped."""

    @abstractmethod
    def measure(self, event: Any, walk: WalkNow) -> Value | None:
        """Return what the event shows; None for nothing. `walk` has the events up to this one, with it.

        It is called only while somebody walks. It must not raise, keep anything or change `walk`."""

    def contradiction(self) -> str | None:
        """Return what is wrong with values that are each possible, as words after the rule's name; None if nothing."""
        if not all([isfinite(one) for one in (self.limit, self.rearm) if one is not None]):
            return " has a limit that is no finite number"
        if self.limit is None or self.rearm is None or not self.is_beyond(self.rearm):
            return None
        return f" has rearm {self.rearm:g} on the wrong side of its limit {self.limit:g}"

    def is_beyond(self, value: float) -> bool:
        """Return whether a value gives a signal."""
        return self.limit is None or (value > self.limit if self.above else value < self.limit)

    def is_rearmed(self, value: float) -> bool:
        """Return whether the next value beyond the limit gives a signal again after this one."""
        if self.limit is None:
            return True
        inside = -HYSTERESIS if self.above else HYSTERESIS
        rearm = self.limit + inside * abs(self.limit) if self.rearm is None else self.rearm
        return value <= rearm if self.above else value >= rearm


MISSING = frozenset((Flaw.GAP, Flaw.RANGE))
"""Flaws of the length of a stride that was walked all the same."""


def is_sound(stride: StrideTaken) -> bool:
    """Return whether a stride shows that its foot walks and that its data are right, though samples may be missing."""
    return MISSING.issuperset(stride.flaws)
