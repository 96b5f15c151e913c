"""Recipes: which parts a session is made of. A part is a machine that was never fed; a session begins with copies."""

from __future__ import annotations

from attrs import field, frozen

from .body.fusion import DoubleFoot
from .body.position import MeanOfFeet
from .foot.bias_zupt import BiasZupt
from .foot.contour_stance import ContourVelocity, GyroscopeMagnitude
from .foot.cycle import Cycle
from .foot.eskf import ErrorStateFilter
from .foot.gait_cues import GaitCues
from .foot.pressure import Insole
from .foot.tracker import AnyCorrector, AnyCues, AnyDetector

AnyBody = MeanOfFeet | DoubleFoot


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

PRESSURE_CONTOUR = Recipe("pressure-contour", ContourVelocity(), BiasZupt(), needs_pressure=True)
"""Bebek et al. 2010: zero velocity where the contours of heel pressure stand still, accelerometer bias, square laps."""

GYROSCOPE = Recipe("gyroscope", GyroscopeMagnitude(), BiasZupt())
"""The same with zero velocity where the gyroscope is quiet: what Bebek et al. compare with."""

BY_NAME: dict[str, Recipe] = {recipe.name: recipe for recipe in (DEFAULT, PRESSURE_CONTOUR, GYROSCOPE)}
