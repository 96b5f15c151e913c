"""Walking mode during a walk, from strides and contacts of both feet and the body's weight.

After Gong et al. 2023 (Sensors 23, 5417), section 3.3. A contact is the time from a foot's touchdown until its cells
are unloaded. The paper leaves open when the mode is known; the compensation is needed at a touchdown.

By `ModeRule.TURN` (turning.py) the mode of the step that ends is that of the mean curvature of the newest stride of
either foot, and the mode of a contact that of the stride that ended in it and the other foot's newest one. By table 2
(mode.py) the mode of a contact is certain only at its end. At a touchdown the other foot has borne the whole weight, so
the mode of the step that ends is that of the other foot's contact so far or, if this has no mode yet, the latest one of
that foot. The first step after standing is taken for a straight one. So is every step if neither the feet's turns nor
the cells show a mode.

Two readings of table 2: a foot in contact for more than 1.5 s takes no step, so its `Step` counts as less than L_w; and
"no others trigger" is asked of the foot in contact only. Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Sequence
from math import fsum

from ...foot.view import FootView
from ...types import OTHER, Foot, Layout, WalkingMode
from ...types.attrs import define, field
from .mode import LEAST_STEP_LENGTH, LONGEST_CONTACT, STANDING_WEIGHT, Contact, at_reference_speed, decide
from .settings import ModeRule, ModesSettings
from .touchdown import FootState, PressureTouchdown
from .turning import StrideTurn, mode_of_curvature

MEAN_SAMPLES = 2000
"""Number of samples over which the mean load of both feet is a plain mean; later samples have weight 1/2000 each."""


@define
class SoleContacts:
    """The contacts of one foot, and their latest mode."""

    step: float = field(default=0.0, init=False)
    """Length of the stride that ended with the foot's last touchdown, m."""
    contact: Contact = field(factory=Contact, init=False)
    """Present or last contact."""
    pressed: bool = field(default=False, init=False)
    """Flag: the foot is in contact now."""
    mode: WalkingMode | None = field(default=None, init=False)
    """Latest mode of the foot's contacts; None before the first."""
    turn: StrideTurn = field(factory=StrideTurn, init=False)
    """Turn of the foot in its newest stride."""
    curvature: float | None = field(default=None, init=False)
    """Curvature of the path in the foot's newest stride, 1/m, left positive; None if unknown or in standing."""
    in_newtons: bool = field(default=True, init=False)
    """Flag: the foot's samples may be in newtons."""


@define
class Recognition:
    """Recognises the walking mode from all samples of the cells and all touchdowns."""

    settings: ModesSettings = ModesSettings()
    soles: dict[Foot, SoleContacts] = field(init=False)
    """Contacts by foot."""
    contact_detector: PressureTouchdown = field(factory=PressureTouchdown, init=False)
    """Detector of the start and the end of a contact."""
    mean_load: float = field(default=0.0, init=False)
    """Mean of the sum of both feet's loads, unit of the samples."""
    load_count: int = field(default=0, init=False)
    """Number of samples in `mean_load`, at most `MEAN_SAMPLES`."""

    def __attrs_post_init__(self) -> None:
        self.soles = {foot: SoleContacts() for foot in Foot}

    def add_view(self, view: FootView, events: Sequence[object]) -> None:
        """Add a sample of a foot, which may turn, with its events."""
        self.soles[view.foot].turn.add_view(view, events)

    def add_pressure(
        self, foot: Foot, state: FootState, cells: tuple[float, ...], layout: Layout | None, t: float, both_feet: bool
    ) -> WalkingMode | None:
        """Add a sample of the cells of `foot` at `t` s; return the foot's mode if it has changed, otherwise None.

        `state` has the sample's pressure, `layout` is None if it is unknown, and `both_feet` is true if samples of the
        other foot have come, too."""
        sole = self.soles[foot]
        contact = sole.contact
        sole.in_newtons = state.highest_pressure is None
        contact.set_layout(layout)
        total = fsum(cells)
        pressed = self.contact_detector.is_down(state, sole.pressed)
        both_loads = total + self.soles[OTHER[foot]].contact.last_load
        contact.last_load = total
        if both_feet:
            self.load_count = min(self.load_count + 1, MEAN_SAMPLES)
            self.mean_load += (both_loads - self.mean_load) / self.load_count
        mode: WalkingMode | None = None
        if pressed:
            if not sole.pressed:
                contact.start(t)
            contact.add(cells, total)
            if contact.duration(t) > LONGEST_CONTACT and not contact.too_long:
                contact.too_long = True
                mode = self._standing(both_loads)
        elif sole.pressed:
            contact.t_end = t
            mode = self._mode_of_ended(foot, both_loads)
        sole.pressed = pressed
        if mode is None or mode is sole.mode:
            return None
        sole.mode = mode
        return mode

    def reset(self, foot: Foot) -> None:
        """Discard the times of a foot's contacts, because its clock restarts."""
        contact = self.soles[foot].contact
        contact.t_start = contact.t_end = None
        self.soles[foot].turn.reset()

    def is_blind(self, foot: Foot) -> bool:
        """Return whether the mode is asked of cells that do not show left and right: they show only standing."""
        return self.settings.rule is not ModeRule.TURN and self.soles[foot].contact.blind

    def add_touchdown(self, foot: Foot, step: float) -> None:
        """Add a touchdown of the foot at a distance of `step` m from its previous one."""
        sole = self.soles[foot]
        sole.step = step
        turn = sole.turn.turn()
        sole.curvature = None if turn is None or step < LEAST_STEP_LENGTH else turn / step

    def mode_at_touchdown(self, foot: Foot) -> WalkingMode:
        """Return the mode of the step that ends as `foot` comes down."""
        other = OTHER[foot]
        if self.settings.rule is ModeRule.TURN:
            return self._mode_by_turn(foot) or WalkingMode.STRAIGHT
        reference = self.soles[other]
        mode = self._mode_so_far(other) if reference.pressed and not reference.contact.too_long else None
        if mode is None:
            mode = reference.mode
        return WalkingMode.STRAIGHT if mode is None or mode is WalkingMode.STANDING else mode

    def _standing(self, both_loads: float) -> WalkingMode | None:
        """Return STANDING by table 2 if the wearer's weight is on the feet; `both_loads` is the sum of their loads."""
        weight = self.settings.weight if self.soles[Foot.LEFT].in_newtons else None
        weight = self.mean_load if weight is None else weight
        return WalkingMode.STANDING if both_loads > STANDING_WEIGHT * weight else None

    def _mode_of_ended(self, foot: Foot, both_loads: float) -> WalkingMode | None:
        """Return the mode of a contact that has ended, and keep its `forward`."""
        sole = self.soles[foot]
        contact = sole.contact
        if contact.too_long:
            return None
        if sole.step < LEAST_STEP_LENGTH:
            return self._standing(both_loads)
        if self.settings.rule is ModeRule.TURN:
            return self._mode_by_turn(foot)
        shares = contact.shares()
        if shares is None:
            return None
        contact.forward = shares["F1"] - shares["F2"]
        return self._mode_so_far(foot)

    def _mode_by_turn(self, foot: Foot) -> WalkingMode | None:
        """Return the mode by the mean curvature of the newest stride of `foot` and of the other foot, if it walks."""
        curvature, other = self.soles[foot].curvature, self.soles[OTHER[foot]].curvature
        if curvature is None:
            return None
        return mode_of_curvature(curvature if other is None else 0.5 * (curvature + other))

    def _mode_so_far(self, foot: Foot) -> WalkingMode | None:
        """Return the mode of a foot's contact so far, by table 2."""
        sole = self.soles[foot]
        contact = sole.contact
        shares = contact.shares()
        if shares is None:
            return None
        forward = shares["F1"] - shares["F2"] + self.soles[OTHER[foot]].contact.forward
        if self.settings.rule is ModeRule.TABLE_2_AT_SPEED:
            shares = at_reference_speed(shares, contact.speed(sole.step))
        return decide(foot, sole.step, shares, forward, self.settings.th)
