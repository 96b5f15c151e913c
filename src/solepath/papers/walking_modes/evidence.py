"""Whether what a foot shows still tells when it comes down; where it does not, its own steps do (walking-modes).

The methods of Gong et al. 2023 take a foot for down by one sign. An insole that brings no number any more, or one that
never unloads, has that sign no more, while the foot's inertial sensor still tells its steps.
"""

from __future__ import annotations

from ...types.attrs import define, field

SILENT = 0.5
"""A foot that has not shown the sign for so long has it no more, s."""
UNSEEN = 2
"""Nor has one that took so many steps while the sign did not change."""


@define
class SignEvidence:
    """The sign of one foot, held against its own steps."""

    shown_at: float | None = field(default=None, init=False)
    """When a sample last had the sign in it, s."""
    silent: bool = field(default=False, init=False)
    flag: bool = field(default=False, init=False)
    """What the sign last said."""
    steps: int = field(default=0, init=False)
    """Own steps since it changed."""
    taken: int = field(default=0, init=False)
    """Own steps in all."""
    own: bool = field(default=False, init=False)
    """Its own steps stand for touchdowns."""
    said: bool = field(default=False, init=False)
    """That has been said."""

    def heard(self, t: float, shows: bool) -> None:
        """A sample of the foot, with the sign in it or not."""
        if shows or self.shown_at is None or t < self.shown_at:
            self.shown_at = t
        self.silent = t - self.shown_at > SILENT

    def stepped(self) -> None:
        """The foot took a step."""
        self.steps += 1
        self.taken += 1

    def down(self, flag: bool, swings: bool, none: bool = False) -> bool:
        """Whether the foot is down: `flag` by the sign, `swings` by its own phase; `none`: there is no sign."""
        if flag is not self.flag:
            self.flag, self.steps = flag, 0
        own = none or self.silent or self.steps >= UNSEEN
        if own is not self.own and flag is not swings:  # they agree, so that the change is no touchdown
            self.own = own
        return not swings if self.own else flag
