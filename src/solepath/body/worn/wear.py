"""Faults of wearing, for any recipe: a silent foot (no samples during a walk), and exchanged feet."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Final

from ...events import FeetSwapped, FootResumed, FootSilent
from ...foot.view import FootView
from ...types import Foot
from ...types.attrs import define, field, frozen
from ..part import LayoutReported, Part, PartInput, PartOutput
from .sides import Sides

LEFT: Final = Foot.LEFT
"""The left foot, looked up once: access to an enum member costs as much as five multiplications."""


@define
class FootSilence:
    """The time without samples of one foot."""

    t: float | None = None
    """Time of the newest sample, s; None before any."""
    strides_since: int = 0
    """Number of strides that the other foot has taken since `t`."""
    silent: bool = False
    """Flag: the silence of this foot was reported."""


@frozen
class WearSettings:
    """The settings of `Wear`."""

    strides: int = 3
    """Number of strides of the other foot, since the last sample of a foot, from which that foot is silent."""
    seconds: float = 3.0
    """Least time since the last sample of a foot before that foot is silent, s."""


@define
class Wear(Part):
    """Detects a silent foot and exchanged feet from the samples of both feet.

    A foot that had samples is silent when, since its last sample, the other foot has taken `strides` strides and
    `seconds` have passed. FootSilent reports the silence; FootResumed comes with the foot's next sample. Nothing is
    reported while the wearer stands, or for a foot that never had a sample, because a recording may be of one foot.
    Recipes of two feet continue with the other foot. FeetSwapped is reported once, when `Sides` detects exchanged
    feet."""

    needs_samples: ClassVar[bool] = True

    settings: WearSettings = WearSettings()
    sides: Sides = field(factory=Sides, init=False)
    left: FootSilence = field(factory=FootSilence, init=False)
    right: FootSilence = field(factory=FootSilence, init=False)
    swapped: bool = field(default=False, init=False)
    """Flag: exchanged feet were reported."""

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> Sequence[PartOutput]:
        """Add one sample of a foot; return events of a silent foot, a resumed foot or exchanged feet."""
        for event in events:
            if isinstance(event, LayoutReported) and event.site.foot is not None:
                self.sides.set_layout(event.site.foot, event.layout)
        if view is None:
            return ()
        t, is_left = view.t, view.foot is LEFT
        this, other = (self.left, self.right) if is_left else (self.right, self.left)
        if not (events or this.silent or other.strides_since):
            this.t, this.strides_since = t, 0
            if not self.swapped:
                self.sides.add_sample(self.sides.left if is_left else self.sides.right, view)
            return ()
        outputs: list[PartOutput] = []
        if this.silent:
            this.silent = False
            silence = 0.0 if this.t is None else max(0.0, t - this.t)
            outputs.append(FootResumed(t=t, known_at=view.known_at, foot=view.foot, silent_for=silence))
        this.t = t
        this.strides_since = 0
        if view.after is not None and view.after.covariance is not None:  # a stride has ended
            other.strides_since += 1
        if other.strides_since and other.t is not None and not other.silent:
            if t < other.t:
                other.strides_since = 0  # this foot's samples are late, or its clock has restarted
            elif other.strides_since >= self.settings.strides and t - other.t >= self.settings.seconds:
                other.silent = True
                silent_foot = Foot.RIGHT if is_left else LEFT
                outputs.append(FootSilent(t=t, known_at=view.known_at, foot=silent_foot, silent_for=t - other.t))
        if not self.swapped and self.sides.update(view, events):
            self.swapped = True
            self.sides.reset()
            outputs.append(FeetSwapped(t=t, known_at=view.known_at))
        return outputs
