"""What both feet show, and which of them is down by it: a method's sign (touchdown.py) as far as it can be believed."""

from __future__ import annotations

from math import hypot

from ...events import Event, FootFlat, Limitation, StrideTaken
from ...foot.view import FootView, PressedCells
from ...types import SITE_OF_FOOT, Foot, Phase
from ...types.attrs import define, field
from ...types.vector import GRAVITY, rotate
from .evidence import SignEvidence
from .touchdown import AnyTouchdown, Flags, FootState, Height, NetAcceleration, PressureTouchdown

NOBODY = FootState()
"""What a foot shows that was never heard."""


@define
class Signs:
    """Feed it `moved`, and `pressed` for cells that can be used, before `down`."""

    method: AnyTouchdown
    shown: dict[Foot, FootState] = field(factory=dict, init=False)
    """What each foot shows; of those heard so far."""
    evidence: dict[Foot, SignEvidence] = field(init=False)

    def __attrs_post_init__(self) -> None:
        self.evidence = {foot: SignEvidence() for foot in Foot}

    def moved(self, view: FootView, height: float) -> None:
        """A sample of a foot, and what came of it; `height` of its own track, m."""
        state, evidence = self.shown.get(view.foot), self.evidence[view.foot]
        if state is None:
            state = self.shown[view.foot] = FootState()
        state.swings = view.phase is Phase.SWING
        for event in view.events:
            if isinstance(event, StrideTaken):
                evidence.stepped()
            elif isinstance(event, FootFlat):
                state.floor = height
        if isinstance(self.method, NetAcceleration) and view.levelled and view.sample.acc is not None:
            x, y, z = rotate(view.attitude, view.sample.acc)
            state.acceleration = hypot(x, y, z - GRAVITY)
        evidence.heard(view.t, view.pressed is not None or not isinstance(self.method, PressureTouchdown))

    def pressed(self, foot: Foot, cells: PressedCells) -> FootState:
        """The foot's newest sample has cells. Returns what it shows."""
        state = self.shown[foot]
        state.pressure = max(cells.values)
        state.full = None if cells.in_newtons else cells.highest
        return state

    def down(self, t: float, alone: Foot | None, known_at: float, events: list[Event]) -> Flags:
        """TD_L and TD_R, by the method or, where that cannot tell, by the foot's own steps, which is said once.
        `alone`: the only foot that is heard."""
        left, right = self.shown.get(Foot.LEFT, NOBODY), self.shown.get(Foot.RIGHT, NOBODY)
        flags = self.method.update(t, left, right)
        none = alone is not None and isinstance(self.method, Height)  # one foot is lower than no other
        down = []
        for foot, state, flag in ((Foot.LEFT, left, flags[0]), (Foot.RIGHT, right, flags[1])):
            evidence = self.evidence[foot]
            down.append(evidence.down(flag, state.swings, none) and (alone is None or alone is foot))
            if evidence.own and not evidence.said and state is not NOBODY:
                evidence.said = True
                sign = "insole" if isinstance(self.method, PressureTouchdown) else "foot's motion"
                what = f"the {foot.value} {sign} does not tell when it is down: its own steps stand for touchdowns"
                events.append(Limitation(t=t, known_at=known_at, site=SITE_OF_FOOT[foot], what=what))
        return down[0], down[1]
