"""Check of a foot's touchdown sign against its own strides, which replace a sign that fails (walking-modes).

The methods of Gong et al. 2023 find touchdowns by one sign. An insole that sends no more values, or one that never
unloads, has lost that sign, while the foot's inertial sensor still finds its strides."""

from __future__ import annotations

from ...types.attrs import define, field

SILENT_AFTER = 0.5
"""Time without the sign after which a foot has lost it, s."""
UNSEEN_STRIDES = 2
"""Number of strides without a change of the sign after which a foot has lost it."""


@define
class SignEvidence:
    """The sign of one foot, compared with its own strides."""

    shown_at: float | None = field(default=None, init=False)
    """Time of the last sample with the sign in it, s."""
    silent: bool = field(default=False, init=False)
    """Flag: the foot has been without the sign for too long."""
    last_flag: bool = field(default=False, init=False)
    """Last value of the sign."""
    strides_since_change: int = field(default=0, init=False)
    """Number of own strides since the sign changed."""
    stride_count: int = field(default=0, init=False)
    """Number of own strides in all."""
    uses_strides: bool = field(default=False, init=False)
    """Flag: the foot's own strides replace its sign."""
    reported: bool = field(default=False, init=False)
    """Flag: the replacement was reported."""

    def add_sample(self, t: float, shows: bool) -> None:
        """Add one sample of the foot, with the sign in it (`shows`) or not."""
        if shows or self.shown_at is None or t < self.shown_at:
            self.shown_at = t
        self.silent = t - self.shown_at > SILENT_AFTER

    def add_stride(self) -> None:
        """Add one stride of the foot."""
        self.strides_since_change += 1
        self.stride_count += 1

    def is_down(self, flag: bool, swings: bool, none: bool = False) -> bool:
        """Return whether the foot is down.

        `flag`: down by the sign; `swings`: in swing by its own phase; `none`: there is no sign."""
        if flag is not self.last_flag:
            self.last_flag, self.strides_since_change = flag, 0
        uses_strides = none or self.silent or self.strides_since_change >= UNSEEN_STRIDES
        if uses_strides is not self.uses_strides and flag is not swings:  # both agree: no touchdown
            self.uses_strides = uses_strides
        return not swings if self.uses_strides else flag
