"""Recipes, which are the parts that a session is made of, by their names.

    Session(recipes.DEFAULT)        Session(recipes.by_name("kupt-dfpc"))

A part in a recipe has never received a sample, because a session uses copies. The published systems (papers/) are
imported when their recipe is requested (types/registry.py)."""

from __future__ import annotations

from functools import cached_property
from math import pi
from typing import Any

from .body.activity.activities import Activities
from .body.altitude import Altitude
from .body.checks.air_pressure import AirPressure
from .body.checks.foot_clocks import FootClocks
from .body.checks.looseness import Looseness
from .body.checks.motion import PossibleMotion
from .body.checks.sensors import SensorChecks
from .body.fuse.both_feet import BothFeet
from .body.fuse.position import MeanOfFeet
from .body.gait.cycles import GaitCycles
from .body.gait.turns import Turns
from .body.part import ActivityPart, Part, TrackPart
from .body.wear import Wear
from .foot.cues.cues import Cues
from .foot.cues.gait_cues import GaitCues
from .foot.navigate.corrector import Corrector
from .foot.navigate.error_state import ErrorStateFilter
from .foot.settings import InsoleSettings
from .foot.stance.cycle import Cycle
from .foot.stance.stance import Detector
from .types.attrs import evolve, field, frozen
from .types.plain import plain_copy
from .types.registry import TABLE, load


def usual_parts(
    track: TrackPart | None = None, activity: ActivityPart | None = None, altitude: Altitude | None = None
) -> tuple[Part, ...]:
    """Return the parts of the body in the order that most recipes use.

    They are: SensorChecks, PossibleMotion, Looseness, Wear, the position of the wearer (`track`; MeanOfFeet when it is
    None), AirPressure if there is an `altitude`, the activity (`activity`; Activities when it is None), Turns, the
    height from elevators and air pressure (`altitude`; when it is None, heights are those of the feet), FootClocks, and
    GaitCycles."""
    track, activity = track or MeanOfFeet(), activity or Activities()
    checks = (SensorChecks(), PossibleMotion(), Looseness())
    pressure = None if altitude is None else AirPressure()
    parts = (*checks, Wear(), track, pressure, activity, Turns(), altitude, FootClocks(), GaitCycles())
    return tuple([part for part in parts if part is not None])


@frozen(repr=False)
class Recipe:
    """Detector, corrector, cues and body parts that work together."""

    name: str
    detector: Detector
    """Stance detector, which estimates the velocity that a sensor should have now."""
    corrector: Corrector
    """Corrector, which navigates one foot and limits the drift by stance evidence."""
    cues: Cues = field(factory=GaitCues)
    """Cues, which detect the signs of heel-strike, foot-flat, heel-off and toe-off."""
    insole: InsoleSettings = InsoleSettings()
    """Settings of what converts the readings of pressure cells to load."""
    parts: tuple[Part, ...] = field(factory=usual_parts)
    """Parts of the body, in the order in which they receive events (body/part.py)."""
    place: Part | None = None
    """Part that finds the wearer on a floor plan, the last part of a session that has a plan.

    None stands for Particles, which is imported for such a session only."""
    needs_pressure: bool = False
    """True for a recipe that reports nothing without pressure cells."""
    every_stride: bool = False
    """True for a recipe that takes a foot on a pedal for one that walks, as published systems do."""

    def replace_part(self, kind: type, by: Part | None, name: str | None = None) -> Recipe:
        """Return the recipe with its part of this kind replaced by `by`, or removed if `by` is None.

        `name` is the name of the new recipe. LookupError is raised when the recipe has no part of this kind."""
        if not any([isinstance(part, kind) for part in self.parts]):
            raise LookupError(f"recipe {self.name} has no {kind.__name__}")
        replaced = [by if isinstance(part, kind) else part for part in self.parts]
        parts = tuple([part for part in replaced if part is not None])
        return evolve(self, name=self.name if name is None else name, parts=parts)

    def with_heading(self, heading: float) -> Recipe:
        """Return the recipe for a wearer who starts with this heading, rad, left positive, in the world of all sensors.

        LookupError is raised when no part has a use for it, TypeError or ValueError for a heading that is no angle."""
        heading = float(heading)
        if not abs(heading) <= 2.0 * pi:
            raise ValueError(f"a heading is an angle from -2 pi to 2 pi, not {heading:g} rad")
        found = [part.with_heading(heading) for part in self.parts]
        if all([part is None for part in found]):
            raise LookupError(f"recipe {self.name} finds the first heading by itself and takes none")
        parts = [part if new is None else new for part, new in zip(self.parts, found, strict=True)]
        return evolve(self, parts=tuple(parts))

    def order(self) -> str:
        """Return the names of the parts of the body, a line for each, in the order in which they receive events."""
        place = "Particles" if self.place is None else type(self.place).__name__
        names = [type(part).__name__ for part in self.parts]
        return "\n".join([*names, f"{place} (with a floor plan)"])

    def __repr__(self) -> str:
        return f"<Recipe {self.name}>"


DEFAULT = Recipe("default", Cycle(), ErrorStateFilter(), parts=usual_parts(BothFeet(), altitude=Altitude()))
"""Recipe with a stance threshold from each gait cycle, a nine-state error-state filter, and both feet in one frame."""

NAMES = tuple(TABLE["recipe"])
"""Names of all recipes, the default first."""


def by_name(name: str) -> Recipe:
    """Return the recipe of this name. Raise ValueError, which lists NAMES, for any other name."""
    if name not in NAMES:
        raise ValueError(f"there is no recipe {name!r}; there are: {', '.join(NAMES)}")
    recipe: Recipe = load("recipe", name)
    return recipe


def part_class(name: str) -> type[Any]:
    """Return the class of a part, an aid or a link. Raise SnapshotError for any other name."""
    for kind in ("part", "aid", "link"):
        if name in TABLE[kind]:
            cls: type[Any] = load(kind, name)
            return cls
    from .saving.codec import SnapshotError

    raise SnapshotError(f"a snapshot of a part {name!r:.80} that is not known here")


def shared_copy(recipe: Recipe) -> Recipe:
    """Return a copy of the recipe that nobody changes, from which sessions copy their parts.

    Sessions whose recipes are equal bit for bit share this copy. The function is thread-safe. TypeError is raised when
    `recipe` is not a Recipe."""
    global _copies
    if not isinstance(recipe, Recipe):
        raise TypeError(f"recipe must be a Recipe, not {type(recipe).__name__}: recipes.by_name has them by name")
    copies = _copies
    if any([recipe is copy.recipe for copy in copies]):
        return recipe
    parts = (recipe.detector, recipe.corrector, recipe.cues)
    extra_state = repr([vars(part) for part in parts if hasattr(part, "__dict__")])
    if copies:
        copies = tuple([copy for copy in copies if copy.text is not None])
        text = _Copy(recipe, extra_state).text
        if text is None:
            return plain_copy(recipe)
        for copy in copies:
            if copy.text == text:
                return copy.recipe
    new_copy = _Copy(plain_copy(recipe), extra_state)
    _copies = (new_copy, *copies[: _MAX_COPIES - 1])
    return new_copy.recipe


class _Copy:
    """A copy of a recipe, with the text by which it is compared with other recipes.

    `extra_state` holds the attributes of its parts that are not fields. The text is created at the first comparison,
    because this takes longer than creating a session. It is None when the recipe cannot be saved; such a recipe equals
    no other one."""

    def __init__(self, recipe: Recipe, extra_state: str) -> None:
        self.recipe, self.extra_state = recipe, extra_state

    @cached_property
    def text(self) -> tuple[str, str] | None:
        from .saving.codec import save

        try:
            return repr(save(self.recipe)), self.extra_state
        except (TypeError, ValueError):
            return None


_MAX_COPIES = 16
_copies: tuple[_Copy, ...] = ()
"""The newest copies; a change replaces the whole tuple, so that other threads can continue with the old one."""
