"""Touchdown signs of both feet, and the feet that are down by their signs or, if a sign fails, by their strides."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from ...events import Event, FootFlat, Limitation, StrideTaken
from ...foot.pressure.insole import HIGHEST_DECAY
from ...foot.view import FootView, PressedCells
from ...types import SITE_OF_FOOT, Foot, Phase
from ...types.attrs import define, field
from ...types.vector import GRAVITY, rotate
from .evidence import SignEvidence
from .touchdown import AnyTouchdown, Flags, FootState, Height, NetAcceleration, PressureTouchdown

UNKNOWN_STATE = FootState()
"""State of a foot without samples."""


@define
class Signs:
    """Collects the signs of both feet: add views and pressures before `down_flags`."""

    method: AnyTouchdown
    """Method that turns the states of both feet into touchdown flags."""
    states: dict[Foot, FootState] = field(factory=dict, init=False)
    """State by foot, for feet with samples."""
    evidence: dict[Foot, SignEvidence] = field(init=False)
    """Check of each foot's sign."""

    def __attrs_post_init__(self) -> None:
        self.evidence = {foot: SignEvidence() for foot in Foot}

    def add_view(self, view: FootView, events: Sequence[object], height: float) -> None:
        """Add a sample of a foot and its events; `height` is that of the foot's own track, m."""
        state, evidence = self.states.get(view.foot), self.evidence[view.foot]
        if state is None:
            state = self.states[view.foot] = FootState()
        state.in_swing = view.phase is Phase.SWING
        for event in events:
            if isinstance(event, StrideTaken):
                evidence.add_stride()
            elif isinstance(event, FootFlat):
                state.flat_height = height
        if isinstance(self.method, NetAcceleration) and view.levelled and view.sample.acc is not None:
            x, y, z = rotate(view.attitude, view.sample.acc)
            state.acceleration = hypot(x, y, z - GRAVITY)
        evidence.add_sample(view.t, view.pressed is not None or not isinstance(self.method, PressureTouchdown))

    def add_pressure(self, foot: Foot, cells: PressedCells) -> FootState:
        """Add the cells of the foot's newest sample, and return its state."""
        state = self.states[foot]
        state.pressure = max(cells.values)
        recent = (state.highest_pressure or 0.0) * HIGHEST_DECAY
        state.highest_pressure = None if cells.in_newtons else max(recent, state.pressure)
        return state

    def down_flags(self, t: float, alone: Foot | None, known_at: float, events: list[Event]) -> Flags:
        """Return the flags TD_L and TD_R by the method or, if a foot's sign fails, by that foot's strides.

        The use of strides is reported once. `alone` is the only foot with samples, None if both have samples."""
        left, right = self.states.get(Foot.LEFT, UNKNOWN_STATE), self.states.get(Foot.RIGHT, UNKNOWN_STATE)
        flags = self.method.update(t, left, right)
        has_no_sign = alone is not None and isinstance(self.method, Height)  # it compares two feet
        down = []
        for foot, state, flag in ((Foot.LEFT, left, flags[0]), (Foot.RIGHT, right, flags[1])):
            evidence = self.evidence[foot]
            down.append(evidence.is_down(flag, state.in_swing, has_no_sign) and (alone is None or alone is foot))
            if evidence.uses_strides and not evidence.reported and state is not UNKNOWN_STATE:
                evidence.reported = True
                sign = "insole" if isinstance(self.method, PressureTouchdown) else "foot's motion"
                what = f"the {foot.value} {sign} does not tell when it is down: its own steps stand for touchdowns"
                events.append(Limitation(t=t, known_at=known_at, site=SITE_OF_FOOT[foot], what=what))
        return down[0], down[1]
