"""Walking mode during a walk, from contacts of both feet, the body's weight, and table 2 (mode.py).

After Gong et al. 2023 (Sensors 23, 5417), section 3.3. The paper leaves open when the mode is known. A contact shows
its mode when it ends, long after its touchdown. But when a foot comes down the other has borne the whole weight, and
the mode of the step that ends is that of the other's contact up to then; where it shows none, the latest that it
showed. Standing is no mode to walk in: the first step after it is taken for a straight one. So is every step of insoles
whose cells do not show left and right."""

from __future__ import annotations

from ...types import OTHER, Foot, Layout, WalkingMode
from ...types.attrs import define, field
from .mode import LEAST_STEP, LONGEST_CONTACT, STANDING_WEIGHT, Contact, at_pace, decide
from .settings import ModesSettings
from .touchdown import FootState, PressureTouchdown

MEAN_SAMPLES = 2000
"""Number of samples of the mean load of both feet; after that, older samples fade."""


@define
class SoleContacts:
    """The contacts of one foot, and the mode that they showed."""

    step: float = field(default=0.0, init=False)
    """Length of the stride that ended with its last touchdown, m."""
    contact: Contact = field(factory=Contact, init=False)
    pressed: bool = field(default=False, init=False)
    """Flag: its contact lasts."""
    mode: WalkingMode | None = field(default=None, init=False)
    """Latest mode that its contacts showed."""
    in_newtons: bool = field(default=True, init=False)
    """Flag: its samples may be in newtons."""


@define
class Recognition:
    """Recognises the walking mode; takes every sample of cells and every touchdown."""

    settings: ModesSettings = ModesSettings()
    soles: dict[Foot, SoleContacts] = field(init=False)
    contact_detector: PressureTouchdown = field(factory=PressureTouchdown, init=False)
    """Detector that starts and ends the contacts that show a mode."""
    mean_load: float = field(default=0.0, init=False)
    """Mean load of both feet, unit of the samples."""
    load_count: int = field(default=0, init=False)

    def __attrs_post_init__(self) -> None:
        self.soles = {foot: SoleContacts() for foot in Foot}

    def add_pressure(
        self, foot: Foot, state: FootState, cells: tuple[float, ...], layout: Layout | None, t: float, both_feet: bool
    ) -> WalkingMode | None:
        """Add a sample of the cells of `foot` at `t` s, and return the mode if the foot shows another one.

        `state` has the sample's pressure; `layout` as far as it is known; `both_feet`: samples of the other foot have
        come too."""
        sole = self.soles[foot]
        contact = sole.contact
        sole.in_newtons = state.highest_pressure is None
        contact.set_layout(layout)
        total = sum(cells)
        pressed = self.contact_detector.is_down(state, sole.pressed)
        both = total + self.soles[OTHER[foot]].contact.last_load
        contact.last_load = total
        if both_feet:
            self.load_count = min(self.load_count + 1, MEAN_SAMPLES)
            self.mean_load += (both - self.mean_load) / self.load_count
        mode: WalkingMode | None = None
        if pressed:
            if not sole.pressed:
                contact.start(t)
            contact.add(cells, total)
            if contact.duration(t) > LONGEST_CONTACT and not contact.too_long:
                contact.too_long = True
                mode = self._standing(both)
        elif sole.pressed:
            contact.t_end = t
            mode = self._mode_of_ended(foot, both)
        sole.pressed = pressed
        if mode is None or mode is sole.mode:
            return None
        sole.mode = mode
        return mode

    def blind(self, foot: Foot) -> bool:
        """Return whether the foot's cells do not show left and right: they show no mode but standing."""
        return self.soles[foot].contact.blind

    def add_touchdown(self, foot: Foot, step: float) -> None:
        """Add a touchdown of the foot `step` m from where it stood before."""
        self.soles[foot].step = step

    def mode_at_touchdown(self, foot: Foot) -> WalkingMode:
        """Return the mode of the step that ends as `foot` comes down."""
        other = OTHER[foot]
        reference = self.soles[other]
        mode = self._mode_so_far(other) if reference.pressed and not reference.contact.too_long else None
        if mode is None:
            mode = reference.mode
        return WalkingMode.STRAIGHT if mode is None or mode is WalkingMode.STANDING else mode

    def _standing(self, both: float) -> WalkingMode | None:
        """Return STANDING by table 2 if there is no step and the weight is on the feet."""
        weight = self.settings.weight if self.soles[Foot.LEFT].in_newtons else None
        weight = self.mean_load if weight is None else weight
        return WalkingMode.STANDING if both > STANDING_WEIGHT * weight else None

    def _mode_of_ended(self, foot: Foot, both: float) -> WalkingMode | None:
        """Return the mode of a contact that has ended."""
        sole = self.soles[foot]
        contact = sole.contact
        shares = contact.shares()
        if shares is None or contact.too_long:
            return None
        contact.forward = shares["F1"] - shares["F2"]
        return self._standing(both) if sole.step < LEAST_STEP else self._mode_so_far(foot)

    def _mode_so_far(self, foot: Foot) -> WalkingMode | None:
        """Return the mode of a foot's contact so far, by table 2."""
        sole = self.soles[foot]
        contact = sole.contact
        shares = contact.shares()
        if shares is None:
            return None
        forward = shares["F1"] - shares["F2"] + self.soles[OTHER[foot]].contact.forward
        return decide(foot, sole.step, at_pace(shares, contact.speed(sole.step)), forward, self.settings.th)
