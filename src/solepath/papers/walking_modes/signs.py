"""Touchdown signs of both feet, and which foot is down by them or, where a sign fails, by its strides."""

from __future__ import annotations

from math import hypot

from ...events import Event, FootFlat, Limitation, StrideTaken
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
    shown: dict[Foot, FootState] = field(factory=dict, init=False)
    """State by foot, for feet with samples."""
    evidence: dict[Foot, SignEvidence] = field(init=False)

    def __attrs_post_init__(self) -> None:
        self.evidence = {foot: SignEvidence() for foot in Foot}

    def add_view(self, view: FootView, height: float) -> None:
        """Add a sample of a foot and its events; `height` of its own track, m."""
        state, evidence = self.shown.get(view.foot), self.evidence[view.foot]
        if state is None:
            state = self.shown[view.foot] = FootState()
        state.in_swing = view.phase is Phase.SWING
        for event in view.events:
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
        state = self.shown[foot]
        state.pressure = max(cells.values)
        state.highest_pressure = None if cells.in_newtons else cells.highest
        return state

    def down_flags(self, t: float, alone: Foot | None, known_at: float, events: list[Event]) -> Flags:
        """Return TD_L and TD_R, by the method or, where that fails, by the foot's own strides, which is reported once.

        `alone`: the only foot with samples."""
        left, right = self.shown.get(Foot.LEFT, UNKNOWN_STATE), self.shown.get(Foot.RIGHT, UNKNOWN_STATE)
        flags = self.method.update(t, left, right)
        none = alone is not None and isinstance(self.method, Height)  # one foot is lower than no other
        down = []
        for foot, state, flag in ((Foot.LEFT, left, flags[0]), (Foot.RIGHT, right, flags[1])):
            evidence = self.evidence[foot]
            down.append(evidence.is_down(flag, state.in_swing, none) and (alone is None or alone is foot))
            if evidence.uses_strides and not evidence.reported and state is not UNKNOWN_STATE:
                evidence.reported = True
                sign = "insole" if isinstance(self.method, PressureTouchdown) else "foot's motion"
                what = f"the {foot.value} {sign} does not tell when it is down: its own steps stand for touchdowns"
                events.append(Limitation(t=t, known_at=known_at, site=SITE_OF_FOOT[foot], what=what))
        return down[0], down[1]
