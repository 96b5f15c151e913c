"""solepath turns the bytes of foot-worn sensors into gait events, strides and a track."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from . import recipes
    from .body.gait.means import Figure, GaitParameters, StrideFigures
    from .body.part import Position
    from .calibration import Calibration, CalibrationError
    from .calibration.file import read_calibration
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
        Flaw,
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
    from .events.frames import to_frame
    from .floorplan.importers.reading import read_floorplan
    from .floorplan.index import IndexedPlan
    from .floorplan.plan import FloorPlan, FloorPlanError, Start
    from .recipes import Recipe
    from .saving.codec import SnapshotError
    from .session import Session
    from .session.arguments import ItemError
    from .types import Activity, Cell, Foot, Layout, Packet, Phase, Quat, Sample, Site, Support, Turn, Vec3, WalkingMode

_MODULES = (
    "types",
    "events",
    "calibration",
    "body.part",
    "body.gait.means",
    "recipes",
    "session",
    "floorplan.plan",
    "floorplan.index",
    "floorplan.importers.reading",
    "calibration.file",
    "saving.codec",
    "session.arguments",
    "events.frames",
)
"""Modules of the names in `__all__`; those that most apps need come first.

A module is imported when a name is first used, so that `solepath --help` and tools that need few names load little."""
_SUBMODULES = ("calibration", "events", "floorplan", "recipes", "session", "types")
"""Modules and packages that are attributes of `solepath` after `import solepath` alone."""


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


def __getattr__(name: str) -> object:
    if name in _SUBMODULES:
        return import_module(f"{__name__}.{name}")  # which sets the attribute
    if name in __all__:
        value = _find(name)
        globals()[name] = value
        return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def _find(name: str) -> object:
    for module_name in _MODULES:
        module = import_module(f"{__name__}.{module_name}")
        if hasattr(module, name):
            return getattr(module, name)
    raise AttributeError(f"{name!r} is in no module of {__name__!r}")


__all__ = [
    "Activity", "ActivityChanged", "BatteryLevel", "Calibration", "CalibrationError", "Candidate", "Cell",
    "CellFault", "CellsFailed", "ClockReset", "Connected", "Defect", "DefectFound", "Disconnected", "Event",
    "FeetSwapped", "Figure", "Flaw", "FlightClimbed", "FloorPlan", "FloorPlanError", "Foot", "FootFlat", "FootMoved",
    "FootPressed", "FootResumed", "FootSilent", "GaitCycleMeasured", "GaitParameters", "HeelOff", "HeelStrike",
    "IndexedPlan", "InsoleNeverUnloads", "ItemError", "KeysChanged", "Layout", "LayoutKnown", "LiftRidden",
    "Limitation", "LinkTrouble", "Packet", "PacketRejected", "PacketsDropped", "Phase", "PlaceLost",
    "Placed", "PlanContradicted", "Position", "PositionRejected", "PositionReported", "Quat", "Recipe", "Rejection",
    "Sample", "SampleGap", "SampleRejected", "Session", "Site", "SnapshotError", "Start", "StreamRestarted",
    "StreamResumed", "StreamStale", "StrideFeatures", "StrideFigures", "StrideFused", "StrideTaken", "Support",
    "ToeOff", "TouchedDown", "TrackNode", "TrackRevised", "Turn", "TurnMade", "Vec3", "WalkingMode",
    "WalkingModeChanged", "WearerMoved", "read_calibration", "read_floorplan", "recipes", "to_frame",
]  # fmt: skip
