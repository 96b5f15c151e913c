"""Touchdown signs of both feet, and the feet that are down by their signs or, if a sign fails, by their strides.

Each method of Gong et al. 2023 detects touchdowns by one sign: height, acceleration or pressure. It fails, for
instance, when an insole sends no more values or never unloads. The foot's inertial sensor still detects strides then.
Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from ...events import Event, FootFlat, Limitation, StrideTaken
from ...foot.pressure.insole import HIGHEST_DECAY
from ...foot.view import FootView, PressedCells
from ...types import SITE_OF_FOOT, Foot, PerFoot, Phase, per_foot
from ...types.attrs import field, state, stateful
from ...types.vector import GRAVITY, rotate
from .touchdown import AnyTouchdown, Flags, FootState, Height, NetAcceleration, PressureTouchdown

LONGEST_SILENCE = 0.5
"""Time without values of the sign after which it has failed, s."""
MOST_STRIDES_WITHOUT_SIGN = 2
"""Number of strides without a change of the sign after which it has failed."""


@stateful
class FootSign:
    """The sign of one foot, compared with its own strides."""

    state: FootState = state(factory=FootState)
    """State of the foot, from which the method computes the sign."""
    has_samples: bool = False
    """Flag: samples of the foot have come."""
    in_swing: bool = False
    """Flag: the foot is in swing by its phase (types.Phase)."""
    flat_height: float = 0.0
    """Height of the foot by its own track at its last foot-flat, m."""
    sign_t: float | None = None
    """Time of the last sample with a value of the sign, s."""
    silent: bool = False
    """Flag: the sign has had no value for longer than `LONGEST_SILENCE`."""
    last_flag: bool = False
    """Last touchdown flag by the sign."""
    strides_since_change: int = 0
    """Number of the foot's strides since that flag changed."""
    stride_count: int = 0
    """Number of all strides of the foot."""
    uses_strides: bool = False
    """Flag: the foot's strides replace its sign."""
    reported: bool = False
    """Flag: the replacement was reported."""

    def is_down(self, flag: bool, none: bool) -> bool:
        """Return whether the foot is down; `flag`: it is down by its sign, `none`: there is no sign."""
        if flag is not self.last_flag:
            self.last_flag, self.strides_since_change = flag, 0
        uses_strides = none or self.silent or self.strides_since_change >= MOST_STRIDES_WITHOUT_SIGN
        # change only while both agree, so that the change is no touchdown
        if uses_strides is not self.uses_strides and flag is not self.in_swing:
            self.uses_strides = uses_strides
        return not self.in_swing if self.uses_strides else flag


@stateful
class Signs:
    """Collects the signs of both feet: add views and pressures before `down_flags`."""

    method: AnyTouchdown = field()
    """Method that turns the states of both feet into touchdown flags."""
    feet: PerFoot[FootSign] = state(factory=lambda: per_foot(FootSign))
    """Sign by foot."""

    def add_view(self, view: FootView, events: Sequence[object], height: float) -> None:
        """Add a sample of a foot and its events; `height` is that of the foot's own track, m."""
        sign = self.feet[view.foot]
        sign.has_samples = True
        sign.in_swing = view.phase is Phase.SWING
        for event in events:
            if isinstance(event, StrideTaken):
                sign.stride_count += 1
            elif isinstance(event, FootFlat):
                sign.flat_height = height
        # once a sample, because a bout's first stride comes with its second one
        sign.strides_since_change += any([isinstance(event, StrideTaken) for event in events])
        if isinstance(self.method, NetAcceleration) and view.levelled and view.sample.acc is not None:
            x, y, z = rotate(view.attitude, view.sample.acc)
            sign.state.acceleration = hypot(x, y, z - GRAVITY)
        has_value = view.pressed is not None or not isinstance(self.method, PressureTouchdown)
        if has_value or sign.sign_t is None or view.t < sign.sign_t:
            sign.sign_t = view.t
        sign.silent = view.t - sign.sign_t > LONGEST_SILENCE

    def add_pressure(self, foot: Foot, cells: PressedCells) -> FootState:
        """Add the cells of the foot's newest sample, and return its state."""
        state = self.feet[foot].state
        state.pressure = max(cells.values)
        recent = (state.highest_pressure or 0.0) * HIGHEST_DECAY
        state.highest_pressure = None if cells.in_newtons else max(recent, state.pressure)
        return state

    def down_flags(self, t: float, alone: Foot | None, known_at: float, events: list[Event]) -> Flags:
        """Return the flags TD_L and TD_R by the method or, if a foot's sign fails, by that foot's strides.

        The use of strides is reported once. `alone` is the only foot with samples, None if both have samples."""
        left, right = (sign.state for sign in self.feet.values())
        flags = self.method.update(t, left, right)
        has_no_sign = alone is not None and isinstance(self.method, Height)  # it compares two feet
        down = []
        for (foot, sign), flag in zip(self.feet.items(), flags, strict=True):
            down.append(sign.is_down(flag, has_no_sign) and alone in (None, foot))
            if sign.uses_strides and not sign.reported and sign.has_samples:
                sign.reported = True
                what = "insole" if isinstance(self.method, PressureTouchdown) else "foot's motion"
                what = f"the {foot.value} {what} does not tell when it is down: its own steps stand for touchdowns"
                events.append(Limitation(t=t, known_at=known_at, site=SITE_OF_FOOT[foot], what=what))
        return down[0], down[1]
