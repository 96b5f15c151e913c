"""Recipes: which parts a session is made of, and where parts and recipes are found by their names.

    Session(recipes.DEFAULT)        Session(recipes.by_name("kupt-dfpc"))

A part in a recipe was never fed; a session begins with copies. The published systems (papers/) are loaded when their
recipe is asked for. A name, in a state or from a command line, is looked up in the tables here and nowhere else.
"""

from __future__ import annotations

from copy import deepcopy
from functools import cached_property
from importlib import import_module
from typing import Any

from .body.activity.activities import Activities
from .body.fuse.both_feet import BothFeet, BothFeetSettings
from .body.fuse.position import MeanOfFeet
from .body.gait.cycles import GaitCycles
from .body.gait.turns import Turns
from .body.height.altitude import Altitude
from .body.part import ActivityPart, Part, TrackPart
from .body.worn.wear import Wear
from .foot.cues.cues import Cues
from .foot.cues.gait_cues import GaitCues
from .foot.navigate.corrector import Corrector
from .foot.navigate.error_state import ErrorStateFilter
from .foot.pressure.insole import InsoleLoads
from .foot.stance.cycle import Cycle
from .foot.stance.stance import Detector
from .types.attrs import evolve, field, frozen


def usual(
    track: TrackPart | None = None, activity: ActivityPart | None = None, altitude: Altitude | None = None
) -> tuple[Part, ...]:
    """The body's parts in the order that most recipes have: how the sensors are worn, where the wearer is (`track`;
    MeanOfFeet where it is None), what the wearer does (`activity`; Activities), turns, lifts and the air pressure
    (`altitude`; heights are the feet's own where it is None), gait cycles."""
    known = (Wear(), track or MeanOfFeet(), activity or Activities(), Turns(), altitude, GaitCycles())
    return tuple([part for part in known if part is not None])


@frozen(repr=False)
class Recipe:
    """One choice of parts."""

    name: str
    detector: Detector
    """What says that a foot stands still, or how fast it rolls."""
    corrector: Corrector
    """What keeps the integration from drifting."""
    cues: Cues = field(factory=GaitCues)
    """What sees heel-strike, foot-flat, heel-off and toe-off."""
    insole: InsoleLoads = field(factory=InsoleLoads)
    """What makes a load of cells."""
    parts: tuple[Part, ...] = field(factory=usual)
    """The body's, in the order in which they hear of what is said (body/part.py)."""
    place: Part | None = None
    """What finds the wearer on a floor plan, the last of the parts of a session that has one; Particles where it is
    None, loaded for such a session only."""
    needs_pressure: bool = False
    """Without pressure cells it has nothing to say."""

    def exchanged(self, kind: type, by: Part | None, name: str | None = None) -> Recipe:
        """The same with another part in the place of the one of this kind, or without it; by another name if one is
        given. LookupError where there is none of this kind."""
        if not any([isinstance(part, kind) for part in self.parts]):
            raise LookupError(f"recipe {self.name} has no {kind.__name__}")
        known = [by if isinstance(part, kind) else part for part in self.parts]
        parts = tuple([part for part in known if part is not None])
        return evolve(self, name=self.name if name is None else name, parts=parts)

    def order(self) -> str:
        """The parts of the body, a line each, in the order in which they hear of what is said."""
        place = "Particles" if self.place is None else type(self.place).__name__
        names = [type(part).__name__ for part in self.parts]
        return "\n".join([*names, f"{place} (with a floor plan)"])

    def __repr__(self) -> str:
        return f"<Recipe {self.name}>"


DEFAULT = Recipe("default", Cycle(), ErrorStateFilter(), parts=usual(BothFeet(), altitude=Altitude()))
"""Stance judged within each gait cycle, nine-state error-state filter, both feet in one frame."""

STRAIGHT_CORRIDORS = DEFAULT.exchanged(
    TrackPart, BothFeet(BothFeetSettings(straight_corridors=True)), "straight-corridors"
)
"""The same for a wearer who walks straight corridors: the heading is held to them."""

RECIPES: dict[str, str] = {
    "default": "recipes:DEFAULT",
    "straight-corridors": "recipes:STRAIGHT_CORRIDORS",
    "kupt-dfpc": "papers.kupt_dfpc.recipe:KUPT_DFPC",
    "kupt": "papers.kupt_dfpc.recipe:KUPT",
    "zupt": "papers.kupt_dfpc.recipe:ZUPT",
    "pressure-contour": "papers.pressure_contour.recipe:PRESSURE_CONTOUR",
    "gyroscope": "papers.pressure_contour.recipe:GYROSCOPE",
    "walking-modes": "papers.walking_modes.recipe:WALKING_MODES",
    "touchdown-height": "papers.walking_modes.recipe:TOUCHDOWN_HEIGHT",
    "touchdown-acceleration": "papers.walking_modes.recipe:TOUCHDOWN_ACCELERATION",
    "touchdown-pressure": "papers.walking_modes.recipe:TOUCHDOWN_PRESSURE",
    "footstep-tracker": "papers.footstep_tracker.recipe:FOOTSTEP_TRACKER",
    "shoe-sensing": "papers.shoe_sensing.recipe:SHOE_SENSING",
    "acceleration-magnitude": "papers.shoe_sensing.recipe:SHOE_MAGNITUDE",
}
"""Recipe by name -> the module below solepath that has it, and what it is called there."""

NAMES = tuple(RECIPES)
"""Of all recipes, the default first."""

_FOOT, _BODY, _KUPT = "foot.", "body.", "papers.kupt_dfpc."
_CONTOUR, _MODES, _STEPS = "papers.pressure_contour.", "papers.walking_modes.", "papers.footstep_tracker."
_SHOE = "papers.shoe_sensing."

LINKS: dict[str, str] = {
    "InsoleLink": "link.devices.insole",
    "Cc2541Link": "link.devices.cc2541",
    "StreamLink": "link.stream",
}
"""Class of a device's link by name -> the module below solepath that has it."""

PARTS: dict[str, str] = {
    "Cycle": _FOOT + "stance.cycle",
    "ShoeDetector": _FOOT + "stance.shoe",
    "AngularRate": _FOOT + "stance.classic",
    "MovingVariance": _FOOT + "stance.classic",
    "Graph": _FOOT + "stance.classic",
    "TwoArea": _FOOT + "stance.pressure",
    "MaximumPressure": _FOOT + "stance.pressure",
    "ErrorStateFilter": _FOOT + "navigate.error_state",
    "LinearDedrift": _FOOT + "navigate.dedrift",
    "GaitCues": _FOOT + "cues.gait_cues",
    "Wear": _BODY + "worn.wear",
    "MeanOfFeet": _BODY + "fuse.position",
    "BothFeet": _BODY + "fuse.both_feet",
    "Activities": _BODY + "activity.activities",
    "Turns": _BODY + "gait.turns",
    "Altitude": _BODY + "height.altitude",
    "GaitCycles": _BODY + "gait.cycles",
    "Particles": _BODY + "place.particles",
    "KnownVelocity": _KUPT + "known_velocity",
    "SwingDedrift": _KUPT + "swing_dedrift",
    "CopCues": _KUPT + "cop_cues",
    "DoubleFoot": _KUPT + "fusion",
    "ContourVelocity": _CONTOUR + "contour_stance",
    "GyroscopeMagnitude": _CONTOUR + "contour_stance",
    "BiasZupt": _CONTOUR + "bias_zupt",
    "Modes": _MODES + "modes",
    "StaticZones": _STEPS + "static_zones",
    "Projection": _STEPS + "projection",
    "CriticalCues": _STEPS + "critical_cues",
    "Footsteps": _STEPS + "footsteps",
    "TwoSecondWindows": _STEPS + "activity.two_second_windows",
    "SnakeGame": _STEPS + "snake",
    "ShortTimeEnergy": _SHOE + "short_time_energy",
    "AccelerationMagnitude": _SHOE + "short_time_energy",
    "ShoeSensing": _SHOE + "gated_tilt",
    "AnglePerMetre": _SHOE + "walking_state",
}
"""Class of a part by name -> the module below solepath that has it. A state names no other but an app's own."""


def by_name(name: str) -> Recipe:
    """The recipe of this name, one of NAMES. ValueError, which names them, for another."""
    where = RECIPES.get(name)
    if where is None:
        raise ValueError(f"there is no recipe {name!r}; there are: {', '.join(NAMES)}")
    module, _, constant = where.partition(":")
    recipe: Recipe = getattr(import_module(f"{__package__}.{module}"), constant)
    return recipe


def part_class(name: str) -> type[Any]:
    """The class of the part or link of this name, one of PARTS or LINKS. SnapshotError for another."""
    module = PARTS.get(name) or LINKS.get(name)
    if module is None:
        from .saving.codec import SnapshotError

        raise SnapshotError(f"a snapshot of a part {name!r:.80} that is not known here")
    found: type[Any] = getattr(import_module(f"{__package__}.{module}"), name)
    return found


def own(recipe: Recipe) -> Recipe:
    """A copy that nobody changes: sessions make their parts by it, and sessions of recipes that are alike to the bit
    hold one. Any thread may ask. TypeError for what is no recipe."""
    global _own
    if not isinstance(recipe, Recipe):
        raise TypeError(f"recipe must be a Recipe, not {type(recipe).__name__}")
    known = _own
    if any([recipe is one.recipe for one in known]):
        return recipe
    parts = (recipe.detector, recipe.corrector, recipe.cues)
    beside = repr([vars(part) for part in parts if hasattr(part, "__dict__")])
    if known:
        known = tuple([one for one in known if one.text is not None])
        given = _Copy(recipe, beside).text
        if given is None:
            return deepcopy(recipe)
        for one in known:
            if one.text == given:
                return one.recipe
    copy = _Copy(deepcopy(recipe), beside)
    _own = (copy, *known[: _OWN - 1])
    return copy.recipe


class _Copy:
    """A recipe, what its parts hold `beside` their fields, and all of it as text, which is made when it is first
    compared: it takes longer than a session. None where it cannot be saved, and is like no other."""

    def __init__(self, recipe: Recipe, beside: str) -> None:
        self.recipe, self.beside = recipe, beside

    @cached_property
    def text(self) -> tuple[str, str] | None:
        from .saving.codec import save

        try:
            return repr(save(self.recipe)), self.beside
        except (TypeError, ValueError):
            return None


_OWN = 16
_own: tuple[_Copy, ...] = ()
"""The newest. It is another one after a change: threads go on in the one that they have."""
