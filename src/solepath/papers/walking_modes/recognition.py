"""The walking mode as a walk goes on: contacts of both feet, the body's weight, and table 2 (mode.py) when it can tell.

After Gong et al. 2023 (Sensors 23, 5417), section 3.3. What the paper leaves open, and what is taken here:

- When the mode is known. A contact tells its mode when it ends, long after the touchdown that it began with. But when
  a foot comes down the other has borne the whole weight, and what that contact has shown up to then is the mode of the
  step that ends; where it shows none, the latest that it told. Standing is no mode to walk in: the first step after
  it is taken for a straight one. So is every step of insoles whose cells do not tell left from right.
"""

from __future__ import annotations

from ...types import OTHER, Foot, Layout, WalkingMode
from ...types.attrs import define, field
from .mode import LEAST_STEP, LINGERS, STANDING_WEIGHT, Contact, at_pace, decide
from .settings import ModesSettings
from .touchdown import FootState, PressureTouchdown

LONG_ENOUGH = 2000
"""Samples that the mean of what both feet bear is taken over, from then on as a decaying one."""


@define
class SoleContacts:
    """What the contacts of one foot are told from, and what they told."""

    step: float = field(default=0.0, init=False)
    """Length of the stride that ended with its last touchdown, m."""
    contact: Contact = field(factory=Contact, init=False)
    pressed: bool = field(default=False, init=False)
    """Its contact lasts."""
    mode: WalkingMode | None = field(default=None, init=False)
    """The latest that its contacts told."""
    in_newtons: bool = field(default=True, init=False)
    """Nothing has shown yet that its samples are not."""


@define
class Recognition:
    """Feed it `pressed` with every sample of cells and `stepped` with every touchdown."""

    settings: ModesSettings = ModesSettings()
    soles: dict[Foot, SoleContacts] = field(init=False)
    pressing: PressureTouchdown = field(factory=PressureTouchdown, init=False)
    """Begins and ends the contacts that tell a mode."""
    borne: float = field(default=0.0, init=False)
    """Mean of what both feet bear, unit of the samples."""
    borne_count: int = field(default=0, init=False)

    def __attrs_post_init__(self) -> None:
        self.soles = {foot: SoleContacts() for foot in Foot}

    def pressed(
        self, foot: Foot, state: FootState, cells: tuple[float, ...], layout: Layout | None, t: float, both_heard: bool
    ) -> WalkingMode | None:
        """A sample of the cells of `foot` at `t` s, of which `state` has the pressure; the layout as far as it is
        known; `both_heard`: samples of the other foot have come too. Returns the mode if the foot tells another one."""
        sole = self.soles[foot]
        contact = sole.contact
        sole.in_newtons = state.full is None
        contact.set_layout(layout)
        total = sum(cells)
        pressed = self.pressing.one(state, sole.pressed)
        both = total + self.soles[OTHER[foot]].contact.newest
        contact.newest = total
        if both_heard:
            self.borne_count = min(self.borne_count + 1, LONG_ENOUGH)
            self.borne += (both - self.borne) / self.borne_count
        mode: WalkingMode | None = None
        if pressed:
            if not sole.pressed:
                contact.begin(t)
            contact.add(cells, total)
            if contact.lasted(t) > LINGERS and not contact.lingers:
                contact.lingers = True
                mode = self._standing(both)
        elif sole.pressed:
            contact.ended = t
            mode = self._told(foot, both)
        sole.pressed = pressed
        if mode is None or mode is sole.mode:
            return None
        sole.mode = mode
        return mode

    def blind(self, foot: Foot) -> bool:
        """The cells of the foot do not tell left from right: no mode but standing comes of them."""
        return self.soles[foot].contact.blind

    def stepped(self, foot: Foot, step: float) -> None:
        """The foot came down `step` m from where it stood before."""
        self.soles[foot].step = step

    def walks(self, foot: Foot) -> WalkingMode:
        """The mode of the step that ends as `foot` comes down."""
        other = OTHER[foot]
        carrying = self.soles[other]
        mode = self._shown(other) if carrying.pressed and not carrying.contact.lingers else None
        if mode is None:
            mode = carrying.mode
        return WalkingMode.STRAIGHT if mode is None or mode is WalkingMode.STANDING else mode

    def _standing(self, both: float) -> WalkingMode | None:
        """Standing still by table 2: no step, and the weight is on the feet."""
        weight = self.settings.weight if self.soles[Foot.LEFT].in_newtons else None
        weight = self.borne if weight is None else weight
        return WalkingMode.STANDING if both > STANDING_WEIGHT * weight else None

    def _told(self, foot: Foot, both: float) -> WalkingMode | None:
        """What a contact tells that has ended."""
        sole = self.soles[foot]
        contact = sole.contact
        shares = contact.shares()
        if shares is None or contact.lingers:
            return None
        contact.forward = shares["F1"] - shares["F2"]
        return self._standing(both) if sole.step < LEAST_STEP else self._shown(foot)

    def _shown(self, foot: Foot) -> WalkingMode | None:
        """What the contact of a foot has shown so far, by table 2."""
        sole = self.soles[foot]
        contact = sole.contact
        shares = contact.shares()
        if shares is None:
            return None
        forward = shares["F1"] - shares["F2"] + self.soles[OTHER[foot]].contact.forward
        return decide(foot, sole.step, at_pace(shares, contact.speed(sole.step)), forward, self.settings.th)
