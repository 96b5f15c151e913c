"""Recipes: which parts a session is made of. A part is a machine that was never fed; a session begins with copies."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from copy import deepcopy
from functools import lru_cache
from operator import attrgetter
from typing import Any

from attrs import evolve, field, fields, frozen, has

from .body.activity.activities import Activities
from .body.fuse.both_feet import BothFeet
from .body.fuse.position import MeanOfFeet
from .body.height.altitude import Altitude
from .body.place.particles import Particles
from .foot.cues.cues import Cues
from .foot.cues.gait_cues import GaitCues
from .foot.navigate.corrector import Corrector
from .foot.navigate.dedrift import LinearDedrift
from .foot.navigate.error_state import ErrorStateFilter
from .foot.navigate.level import LevelGround
from .foot.pressure.insole import InsoleLoads
from .foot.stance.cycle import Cycle
from .foot.stance.stance import Detector
from .papers.footstep_tracker.activity.two_second_windows import TwoSecondWindows
from .papers.footstep_tracker.critical_cues import CriticalCues
from .papers.footstep_tracker.footsteps import Footsteps
from .papers.footstep_tracker.projection import Projection
from .papers.footstep_tracker.snake import SnakeGame
from .papers.footstep_tracker.static_zones import StaticZones
from .papers.kupt_dfpc.cop_cues import CopCues
from .papers.kupt_dfpc.fusion import DoubleFoot
from .papers.kupt_dfpc.known_velocity import KnownVelocity
from .papers.kupt_dfpc.swing_dedrift import SwingDedrift
from .papers.pressure_contour.bias_zupt import BiasZupt
from .papers.pressure_contour.contour_stance import ContourVelocity, GyroscopeMagnitude
from .papers.shoe_sensing.gated_tilt import ShoeSensing
from .papers.shoe_sensing.short_time_energy import AccelerationMagnitude, ShortTimeEnergy
from .papers.shoe_sensing.walking_state import AnglePerMetre
from .papers.walking_modes.compensation import TABLE_1
from .papers.walking_modes.modes import Modes
from .papers.walking_modes.touchdown import Height, NetAcceleration, PressureTouchdown

AnyBody = BothFeet | MeanOfFeet | DoubleFoot | Modes | Footsteps
AnyActivity = Activities | AnglePerMetre | TwoSecondWindows
AnyPlace = Particles | SnakeGame


@frozen
class Recipe:
    """One choice of parts.

    `detector`: what says that a foot stands still, or how fast it rolls. `corrector`: what keeps the integration from
    drifting. `cues`: what sees heel-strike, foot-flat, heel-off and toe-off. `insole`: what makes a load of cells.
    `body`: what puts both feet together. `activity`: what says what the wearer does. `place`: what finds the wearer
    on a floor plan. `needs_pressure`: without pressure cells it has nothing to say. `altitude`: what follows lifts and
    the air pressure; None: the feet's own heights.
    """

    name: str
    detector: Detector
    corrector: Corrector
    cues: Cues = field(factory=GaitCues)
    insole: InsoleLoads = field(factory=InsoleLoads)
    body: AnyBody = field(factory=MeanOfFeet)
    activity: AnyActivity = field(factory=Activities)
    place: AnyPlace = field(factory=Particles)
    needs_pressure: bool = False
    altitude: Altitude | None = None


def own(recipe: Recipe) -> Recipe:
    """A copy that nobody changes: sessions make their parts by it. Sessions of recipes that are alike hold one, and it
    takes 20 kB; 0.2 ms, next to nothing for such a copy, and four times that for a recipe that was not seen lately. Any
    thread may ask. TypeError for what is no recipe."""
    global _own
    if not isinstance(recipe, Recipe):
        raise TypeError(f"recipe must be a Recipe, not {type(recipe).__name__}")
    known = _own
    if any([recipe is one for one in known]):
        return recipe
    for one in known:
        if alike(one, recipe):
            return one
    copy = deepcopy(recipe)
    if alike(copy, recipe):  # or it would never be found again
        _own = (copy, *_own[: _OWN - 1])
    return copy


_OWN = 16
_own: tuple[Recipe, ...] = ()
"""The newest. It is another one after a change: threads go on in the one that they have."""


def alike(one: Any, other: Any) -> bool:
    """To the bit, and of the same classes, whatever these say of being equal; False of what is no plain data."""
    if one is other:
        return True
    cls = type(one)
    if cls is not type(other):
        return False
    values = _reader(cls)  # type: ignore[arg-type]
    if values is not None:
        return _all_alike(values(one), values(other))
    if cls in (tuple, list):
        return len(one) == len(other) and _all_alike(one, other)
    if cls is deque:
        return bool(one.maxlen == other.maxlen) and alike(list(one), list(other))
    if cls is dict:
        return alike(list(one.items()), list(other.items()))
    return cls in (float, int, str, bytes) and repr(one) == repr(other)


def _all_alike(some: Iterable[Any], others: Iterable[Any]) -> bool:
    # no further than to the first difference: most recipes have another name
    return all(one is other or alike(one, other) for one, other in zip(some, others, strict=True))


@lru_cache(maxsize=256)
def _reader(cls: type) -> Callable[[Any], Iterable[Any]] | None:
    """What reads all that an attrs object holds; None of another class."""
    if not has(cls):
        return None
    names = [f.name for f in fields(cls)]
    if cls.__dictoffset__:  # it may hold anything beside its fields
        return lambda one: [[*one.__dict__.items()], *[getattr(one, name) for name in names]]
    return attrgetter(*names) if len(names) > 1 else lambda one: [getattr(one, name) for name in names]


DEFAULT = Recipe("default", Cycle(), ErrorStateFilter(), body=BothFeet(), altitude=Altitude())
"""Stance judged within each gait cycle, nine-state error-state filter, both feet in one frame."""

STRAIGHT_CORRIDORS = evolve(DEFAULT, name="straight-corridors", body=BothFeet(straight_corridors=True))
"""The same for a wearer who walks straight corridors: the heading is held to them."""

BOARD = 0.44
"""Where the circuit board parts an insole into two areas, as a share of its length: 12.5 cm of a shoe of 28.5 cm."""

_TWO_AREAS = InsoleLoads(heel_ends=BOARD, forefoot_begins=BOARD)

KUPT_DFPC = Recipe(
    "kupt-dfpc", KnownVelocity(), SwingDedrift(), CopCues(), _TWO_AREAS, DoubleFoot(), needs_pressure=True
)
"""Chen et al. 2019: velocity known from heel-strike to toe-off, and both feet calibrating each other's strides."""

KUPT = Recipe("kupt", KnownVelocity(), SwingDedrift(), CopCues(), _TWO_AREAS, needs_pressure=True)
"""The same without the fusion."""

ZUPT = Recipe("zupt", KnownVelocity(), LinearDedrift(), CopCues(), _TWO_AREAS, needs_pressure=True)
"""The same stationary epochs, velocity known in them only: what Chen et al. compare with."""

PRESSURE_CONTOUR = Recipe("pressure-contour", ContourVelocity(), BiasZupt(), needs_pressure=True)
"""Bebek et al. 2010: zero velocity where the contours of heel pressure stand still, accelerometer bias, square laps."""

GYROSCOPE = Recipe("gyroscope", GyroscopeMagnitude(), BiasZupt())
"""The same with zero velocity where the gyroscope is quiet: what Bebek et al. compare with."""

_OWN_HEIGHTS = ErrorStateFilter(level=LevelGround(gate=False))
"""Method I goes by the height of the feet, so nothing is done about it."""

WALKING_MODES = Recipe(
    "walking-modes",
    Cycle(),
    _OWN_HEIGHTS,
    body=Modes(PressureTouchdown(), TABLE_1),
    needs_pressure=True,
)
"""Gong et al. 2023, method IV: touchdowns by maximum pressure, compensated by walking mode. It ships the paper's table
1, which holds for the paper's wearers: on emulated ones it does worse than what their own marked walks teach
(`solepath calibrate modes`)."""

TOUCHDOWN_HEIGHT = Recipe("touchdown-height", Cycle(), _OWN_HEIGHTS, body=Modes(Height()))
"""Their method I: the lower foot carries."""

TOUCHDOWN_ACCELERATION = Recipe("touchdown-acceleration", Cycle(), _OWN_HEIGHTS, body=Modes(NetAcceleration()))
"""Their method II: the foot with little net acceleration carries."""

TOUCHDOWN_PRESSURE = Recipe(
    "touchdown-pressure", Cycle(), _OWN_HEIGHTS, body=Modes(PressureTouchdown()), needs_pressure=True
)
"""Their method III: touchdowns by maximum pressure."""

SHOE_SENSING = Recipe("shoe-sensing", ShortTimeEnergy(), ShoeSensing(), activity=AnglePerMetre())
"""Li et al. 2016: short-time energy, tilt fed back in stance, height errors of level steps taken out."""

SHOE_MAGNITUDE = Recipe(
    "acceleration-magnitude", AccelerationMagnitude(), ShoeSensing(behind=0.0), activity=AnglePerMetre()
)
"""The same with stance where the acceleration is as large as gravity: what Li et al. compare with."""

FOOTSTEP_TRACKER = Recipe(
    "footstep-tracker",
    StaticZones(),
    Projection(),
    CriticalCues(),
    body=Footsteps(),
    activity=TwoSecondWindows(),
    place=SnakeGame(),
)
"""Liu et al. 2015: steps between static zones, projected onto the ground; turns; candidate traces on a floor plan."""

BY_NAME: dict[str, Recipe] = {
    recipe.name: recipe
    for recipe in (
        DEFAULT,
        STRAIGHT_CORRIDORS,
        KUPT_DFPC,
        KUPT,
        ZUPT,
        PRESSURE_CONTOUR,
        GYROSCOPE,
        WALKING_MODES,
        TOUCHDOWN_HEIGHT,
        TOUCHDOWN_ACCELERATION,
        TOUCHDOWN_PRESSURE,
        FOOTSTEP_TRACKER,
        SHOE_SENSING,
        SHOE_MAGNITUDE,
    )
}
