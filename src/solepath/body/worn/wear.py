"""How the feet's sensors are worn, whatever the recipe: a foot that falls silent, and left and right exchanged."""

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
"""Looked up once: a word of an enum costs as much as five multiplications."""


@define
class Hearing:
    """When one foot was last heard."""

    t: float | None = None
    """Its newest sample, s; None before any."""
    missing: int = 0
    """Steps of the other foot since then."""
    said: bool = False
    """That it is silent."""


@frozen
class WearSettings:
    """What `Wear` is set to."""

    steps: int = 3
    """A foot is silent when the other has taken so many steps since its last sample."""
    seconds: float = 3.0
    """No foot is silent that was heard less than this ago, s."""


@define
class Wear(Part):
    """Hears every sample of both feet.

    A foot that was heard before is silent when the other has taken `steps` steps and `seconds` since its last sample:
    FootSilent, and FootResumed with the sample that ends it. While nobody walks nothing is said, and nothing of a foot
    that was never heard: a recording may be of one foot. Recipes of two feet go on with the one that is left.
    FeetSwapped is said once, as `Sides` sees it.
    """

    needs_samples: ClassVar[bool] = True

    settings: WearSettings = WearSettings()
    sides: Sides = field(factory=Sides, init=False)
    left: Hearing = field(factory=Hearing, init=False)
    right: Hearing = field(factory=Hearing, init=False)
    swapped: bool = field(default=False, init=False)
    """That has been said."""

    def receive(self, event: PartInput) -> Sequence[PartOutput]:
        """The device on a foot may have said where its cells are."""
        if isinstance(event, LayoutReported) and event.site.foot is not None:
            self.sides.told(event.site.foot, event.layout)
        return ()

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        """A foot was heard."""
        t, events = view.t, view.events
        is_left = view.foot is LEFT
        this, other = (self.left, self.right) if is_left else (self.right, self.left)
        if not (events or this.said or other.missing):
            this.t, this.missing = t, 0
            if not self.swapped:
                self.sides.keep(self.sides.left if is_left else self.sides.right, view)
            return ()
        found: list[PartOutput] = []
        if this.said:
            this.said = False
            silence = 0.0 if this.t is None else max(0.0, t - this.t)
            found.append(FootResumed(t=t, known_at=view.known_at, foot=view.foot, silent_for=silence))
        this.t = t
        this.missing = 0
        if view.after.covariance is not None:  # there was a stride
            other.missing += 1
        if other.missing and other.t is not None and not other.said:
            if t < other.t:
                other.missing = 0  # this foot lags behind the other on the way here, or its times began anew
            elif other.missing >= self.settings.steps and t - other.t >= self.settings.seconds:
                other.said = True
                silent = Foot.RIGHT if is_left else LEFT
                found.append(FootSilent(t=t, known_at=view.known_at, foot=silent, silent_for=t - other.t))
        if not self.swapped and self.sides.swapped(view):
            self.swapped = True
            self.sides.forget()
            found.append(FeetSwapped(t=t, known_at=view.known_at))
        return found
