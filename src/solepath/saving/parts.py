"""Which classes of solepath stand for a Protocol in a state: the parts of a foot, by name."""

from __future__ import annotations

from ..foot.cues.cues import Cues
from ..foot.cues.gait_cues import GaitCues
from ..foot.navigate.corrector import Corrector
from ..foot.navigate.dedrift import LinearDedrift
from ..foot.navigate.error_state import ErrorStateFilter
from ..foot.stance.classic import AngularRate, Graph, MovingVariance, ShoeDetector
from ..foot.stance.cycle import Cycle
from ..foot.stance.pressure import MaximumPressure, TwoArea
from ..foot.stance.stance import Detector
from ..papers.footstep_tracker.critical_cues import CriticalCues
from ..papers.footstep_tracker.projection import Projection
from ..papers.footstep_tracker.static_zones import StaticZones
from ..papers.kupt_dfpc.cop_cues import CopCues
from ..papers.kupt_dfpc.known_velocity import KnownVelocity
from ..papers.kupt_dfpc.swing_dedrift import SwingDedrift
from ..papers.pressure_contour.bias_zupt import BiasZupt
from ..papers.pressure_contour.contour_stance import ContourVelocity, GyroscopeMagnitude
from ..papers.shoe_sensing.gated_tilt import ShoeSensing
from ..papers.shoe_sensing.short_time_energy import AccelerationMagnitude, ShortTimeEnergy
from .codec import PARTS

PARTS[Detector] = (
    Cycle,
    ShoeDetector,
    AngularRate,
    MovingVariance,
    Graph,
    TwoArea,
    MaximumPressure,
    ContourVelocity,
    GyroscopeMagnitude,
    KnownVelocity,
    StaticZones,
    ShortTimeEnergy,
    AccelerationMagnitude,
)
PARTS[Corrector] = (ErrorStateFilter, LinearDedrift, SwingDedrift, BiasZupt, ShoeSensing, Projection)
PARTS[Cues] = (GaitCues, CopCues, CriticalCues)
