"""Recipes: which parts a session is made of. A part is a machine that was never fed; a session begins with copies."""

from __future__ import annotations

from attrs import field, frozen

from .body.position import MeanOfFeet
from .foot.cycle import Cycle
from .foot.eskf import ErrorStateFilter
from .foot.gait_cues import GaitCues
from .foot.pressure import Insole
from .foot.tracker import AnyCorrector, AnyCues, AnyDetector

AnyBody = MeanOfFeet


@frozen
class Recipe:
    """One choice of parts.

    `detector`: what says that a foot stands still, or how fast it rolls. `corrector`: what keeps the integration from
    drifting. `cues`: what sees heel-strike, foot-flat, heel-off and toe-off. `insole`: what makes a load of cells.
    `body`: what puts both feet together. `needs_pressure`: without pressure cells it has nothing to say.
    """

    name: str
    detector: AnyDetector
    corrector: AnyCorrector
    cues: AnyCues = field(factory=GaitCues)
    insole: Insole = field(factory=Insole)
    body: AnyBody = field(factory=MeanOfFeet)
    needs_pressure: bool = False


DEFAULT = Recipe("default", Cycle(), ErrorStateFilter())
"""Stance judged within each gait cycle, nine-state error-state filter."""

BY_NAME: dict[str, Recipe] = {recipe.name: recipe for recipe in (DEFAULT,)}
