"""Wearing faults of any recipe: a foot that falls silent, and left and right exchanged."""

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
    """The time since the last sample of one foot, and whether its silence was reported."""

    t: float | None = None
    """Time of the newest sample, s; None before any."""
    strides_since: int = 0
    """Number of strides that the other foot has taken since then."""
    silent: bool = False
    """Flag: the silence of this foot was reported."""


@frozen
class WearSettings:
    """The settings of `Wear`."""

    steps: int = 3
    """Number of strides that the other foot takes after the last sample of a foot before that foot is silent."""
    seconds: float = 3.0
    """Least time since the last sample of a foot before that foot is silent, s."""


@define
class Wear(Part):
    """Detects a silent foot and exchanged feet from the samples of both feet.

    A foot that gave samples before is silent when the other one has taken `steps` strides, and `seconds` have passed,
    since its last sample. FootSilent reports that, and FootResumed comes with the sample that ends it. Nothing is
    reported while nobody walks, nor of a foot that never gave a sample: a recording may be of one foot. Recipes of two
    feet continue with the one that is left. FeetSwapped is reported once, when `Sides` detects it."""

    needs_samples: ClassVar[bool] = True

    settings: WearSettings = WearSettings()
    sides: Sides = field(factory=Sides, init=False)
    left: FootSilence = field(factory=FootSilence, init=False)
    right: FootSilence = field(factory=FootSilence, init=False)
    swapped: bool = field(default=False, init=False)
    """Flag: exchanged feet were reported."""

    def receive(self, event: PartInput) -> Sequence[PartOutput]:
        """Receive the layout that the device on a foot may have reported."""
        if isinstance(event, LayoutReported) and event.site.foot is not None:
            self.sides.set_layout(event.site.foot, event.layout)
        return ()

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """Add one sample of a foot and return what it reveals: a silent foot, a resumed one, exchanged feet."""
        t, events = view.t, view.events
        is_left = view.foot is LEFT
        this, other = (self.left, self.right) if is_left else (self.right, self.left)
        if not (events or this.silent or other.strides_since):
            this.t, this.strides_since = t, 0
            if not self.swapped:
                self.sides.add_sample(self.sides.left if is_left else self.sides.right, view)
            return ()
        found: list[PartOutput] = []
        if this.silent:
            this.silent = False
            silence = 0.0 if this.t is None else max(0.0, t - this.t)
            found.append(FootResumed(t=t, known_at=view.known_at, foot=view.foot, silent_for=silence))
        this.t = t
        this.strides_since = 0
        if view.after.covariance is not None:  # there was a stride
            other.strides_since += 1
        if other.strides_since and other.t is not None and not other.silent:
            if t < other.t:
                other.strides_since = 0  # this foot's samples arrive later than the other's, or its clock has restarted
            elif other.strides_since >= self.settings.steps and t - other.t >= self.settings.seconds:
                other.silent = True
                silent_foot = Foot.RIGHT if is_left else LEFT
                found.append(FootSilent(t=t, known_at=view.known_at, foot=silent_foot, silent_for=t - other.t))
        if not self.swapped and self.sides.update(view):
            self.swapped = True
            self.sides.reset()
            found.append(FeetSwapped(t=t, known_at=view.known_at))
        return found
