"""Recipes: which parts a session is made of. A part is a machine that was never fed; a session begins with copies."""

from __future__ import annotations

from attrs import frozen

from .foot.cycle import Cycle
from .foot.eskf import ErrorStateFilter
from .foot.tracker import AnyCorrector, AnyDetector


@frozen
class Recipe:
    """One choice of parts.

    `detector`: what says that a foot stands still. `corrector`: what keeps the integration from drifting.
    """

    name: str
    detector: AnyDetector
    corrector: AnyCorrector


DEFAULT = Recipe("default", Cycle(), ErrorStateFilter())
"""Stance judged within each gait cycle, nine-state error-state filter."""

BY_NAME: dict[str, Recipe] = {recipe.name: recipe for recipe in (DEFAULT,)}
