"""solepath turns the bytes of foot-worn sensors into gait events, strides and a track."""

from importlib import import_module
from typing import TYPE_CHECKING

from . import recipes
from .body.gait.means import Figure, GaitParameters, StrideFigures
from .body.part import Position
from .calibration import Calibration, CalibrationError
from .events import (
    ActivityChanged,
    BatteryLevel,
    Candidate,
    CellFault,
    CellsFailed,
    ClockReset,
    Connected,
    Defect,
    DefectFound,
    Disconnected,
    Event,
    FeetSwapped,
    FlightClimbed,
    FootFlat,
    FootMoved,
    FootPressed,
    FootResumed,
    FootSilent,
    GaitCycleMeasured,
    HeelOff,
    HeelStrike,
    InsoleNeverUnloads,
    KeysChanged,
    LayoutKnown,
    LiftRidden,
    Limitation,
    LinkTrouble,
    PacketRejected,
    PacketsDropped,
    PacketsLost,
    Placed,
    PlaceLost,
    PlanContradicted,
    PositionRejected,
    PositionReported,
    Rejection,
    SampleGap,
    SampleRejected,
    StreamRestarted,
    StreamResumed,
    StreamStale,
    StrideFeatures,
    StrideFused,
    StrideTaken,
    ToeOff,
    TouchedDown,
    TrackNode,
    TrackRevised,
    TurnMade,
    WalkingModeChanged,
    WearerMoved,
)
from .recipes import Recipe
from .session import Session
from .types import Activity, Cell, Foot, Layout, Packet, Phase, Quat, Sample, Site, Support, Turn, Vec3, WalkingMode

if TYPE_CHECKING:
    from .calibration.file import read_calibration
    from .events.frame import to_frame
    from .floorplan.importers.reading import read_floorplan
    from .floorplan.index import IndexedPlan
    from .floorplan.plan import FloorPlan, FloorPlanError, Start
    from .saving.codec import SnapshotError
    from .session.arguments import ItemError

_LAZY_NAMES = {
    "FloorPlan": "floorplan.plan",
    "FloorPlanError": "floorplan.plan",
    "IndexedPlan": "floorplan.index",
    "ItemError": "session.arguments",
    "SnapshotError": "saving.codec",
    "Start": "floorplan.plan",
    "read_calibration": "calibration.file",
    "read_floorplan": "floorplan.importers.reading",
    "to_frame": "events.frame",
}
"""Names that are imported when they are first used, each with its module: many apps never need them."""


def __getattr__(name: str) -> object:
    if name in _LAZY_NAMES:
        return getattr(import_module(f"{__name__}.{_LAZY_NAMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


__all__ = [
    "Activity",
    "ActivityChanged",
    "BatteryLevel",
    "Calibration",
    "CalibrationError",
    "Candidate",
    "Cell",
    "CellFault",
    "CellsFailed",
    "ClockReset",
    "Connected",
    "Defect",
    "DefectFound",
    "Disconnected",
    "Event",
    "FeetSwapped",
    "Figure",
    "FlightClimbed",
    "FloorPlan",
    "FloorPlanError",
    "Foot",
    "FootFlat",
    "FootMoved",
    "FootPressed",
    "FootResumed",
    "FootSilent",
    "GaitCycleMeasured",
    "GaitParameters",
    "HeelOff",
    "HeelStrike",
    "IndexedPlan",
    "InsoleNeverUnloads",
    "ItemError",
    "KeysChanged",
    "Layout",
    "LayoutKnown",
    "LiftRidden",
    "Limitation",
    "LinkTrouble",
    "Packet",
    "PacketRejected",
    "PacketsDropped",
    "PacketsLost",
    "Phase",
    "PlaceLost",
    "Placed",
    "PlanContradicted",
    "Position",
    "PositionRejected",
    "PositionReported",
    "Quat",
    "Recipe",
    "Rejection",
    "Sample",
    "SampleGap",
    "SampleRejected",
    "Session",
    "Site",
    "SnapshotError",
    "Start",
    "StreamRestarted",
    "StreamResumed",
    "StreamStale",
    "StrideFeatures",
    "StrideFigures",
    "StrideFused",
    "StrideTaken",
    "Support",
    "ToeOff",
    "TouchedDown",
    "TrackNode",
    "TrackRevised",
    "Turn",
    "TurnMade",
    "Vec3",
    "WalkingMode",
    "WalkingModeChanged",
    "WearerMoved",
    "read_calibration",
    "read_floorplan",
    "recipes",
    "to_frame",
]  # fmt: skip
