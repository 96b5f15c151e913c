"""Check of a foot's touchdown sign against its own strides, which replace a sign that fails (walking-modes).

Each method of Gong et al. 2023 detects touchdowns by one sign: height, acceleration or pressure. It fails, for
instance, when an insole sends no more values or never unloads. The foot's inertial sensor still detects strides then.
Numbers without a source were chosen by hand."""

from __future__ import annotations

from ...types.attrs import define, field

LONGEST_SILENCE = 0.5
"""Time without values of the sign after which it has failed, s."""
MOST_STRIDES_WITHOUT_SIGN = 2
"""Number of strides without a change of the sign after which it has failed."""


@define
class SignEvidence:
    """The sign of one foot, compared with its own strides."""

    sign_t: float | None = field(default=None, init=False)
    """Time of the last sample with a value of the sign, s."""
    silent: bool = field(default=False, init=False)
    """Flag: the sign has had no value for longer than `LONGEST_SILENCE`."""
    last_flag: bool = field(default=False, init=False)
    """Last touchdown flag by the sign."""
    strides_since_change: int = field(default=0, init=False)
    """Number of the foot's strides since that flag changed."""
    stride_count: int = field(default=0, init=False)
    """Number of all strides of the foot."""
    uses_strides: bool = field(default=False, init=False)
    """Flag: the foot's strides replace its sign."""
    reported: bool = field(default=False, init=False)
    """Flag: the replacement was reported."""

    def add_sample(self, t: float, shows: bool) -> None:
        """Add one sample of the foot; `shows` is true if it has a value of the sign."""
        if shows or self.sign_t is None or t < self.sign_t:
            self.sign_t = t
        self.silent = t - self.sign_t > LONGEST_SILENCE

    def add_stride(self) -> None:
        """Add one stride of the foot."""
        self.strides_since_change += 1
        self.stride_count += 1

    def is_down(self, flag: bool, swings: bool, none: bool = False) -> bool:
        """Return whether the foot is down.

        `flag`: the foot is down by its sign. `swings`: it is in swing by its phase. `none`: there is no sign."""
        if flag is not self.last_flag:
            self.last_flag, self.strides_since_change = flag, 0
        uses_strides = none or self.silent or self.strides_since_change >= MOST_STRIDES_WITHOUT_SIGN
        if uses_strides is not self.uses_strides and flag is not swings:  # both agree, so the change is no touchdown
            self.uses_strides = uses_strides
        return not swings if self.uses_strides else flag
