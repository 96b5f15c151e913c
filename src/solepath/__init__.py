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
        EscalatorRidden,
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
        LinkEvent,
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
        StrideTaken,
        ToeOff,
        TrackNode,
        TrackRevised,
        TurnMade,
        WearerMoved,
    )
    from .events.frames import to_frame
    from .floorplan.importers.reading import read_floorplan
    from .floorplan.index import IndexedPlan
    from .floorplan.plan import FloorPlan, FloorPlanError, Start
    from .link.catalogue import DEVICES
    from .link.driver import Driver, Measured, Reading
    from .link.health import LinkHealth
    from .link.profile import Access, Channel, Profile, Write
    from .link.setup.device_setup import GattCharacteristic
    from .recipes import Recipe
    from .saving.codec import SnapshotError
    from .saving.files import write_whole
    from .session import Session
    from .session.arguments import ItemError
    from .session.host import Host
    from .session.json_host import JsonHost
    from .types import Activity, Cell, Foot, Layout, Packet, Phase, Quat, Sample, Site, Support, Turn, Vec3
    from .wire.fields import Fields

_MODULES = (
    "types",
    "events",
    "calibration",
    "body.part",
    "body.gait.means",
    "recipes",
    "session",
    "session.arguments",
    "saving.codec",
    "saving.files",
    "calibration.file",
    "events.frames",
    "link.driver",
    "link.health",
    "link.profile",
    "wire.fields",
    "link.setup.device_setup",
    "session.host",
    "link.catalogue",
    "session.json_host",
    "floorplan.plan",
    "floorplan.index",
    "floorplan.importers.reading",
)
"""Modules of the names in `__all__`; those that most apps need come first.

A module is imported when a name is first used, so that `solepath --help` and tools that need few names load little."""
_SUBMODULES = ("calibration", "events", "floorplan", "recipes", "session", "types")
"""Modules and packages that are attributes of `solepath` after `import solepath` alone."""


def __dir__() -> list[str]:
    return sorted({*__all__, *_SUBMODULES})


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
    "Access", "Activity", "ActivityChanged", "BatteryLevel", "Calibration", "CalibrationError", "Candidate", "Cell",
    "CellFault", "CellsFailed", "Channel", "ClockReset", "Connected", "DEVICES", "Defect", "DefectFound",
    "Disconnected", "Driver", "EscalatorRidden", "Event", "FeetSwapped", "Fields", "Figure", "Flaw",
    "FlightClimbed", "FloorPlan", "FloorPlanError", "Foot", "FootFlat", "FootMoved", "FootPressed", "FootResumed",
    "FootSilent", "GaitCycleMeasured", "GaitParameters", "GattCharacteristic", "HeelOff", "HeelStrike", "Host",
    "IndexedPlan", "InsoleNeverUnloads", "ItemError", "JsonHost", "KeysChanged", "Layout", "LayoutKnown",
    "LiftRidden", "Limitation", "LinkEvent", "LinkHealth", "LinkTrouble", "Measured", "Packet", "PacketRejected",
    "PacketsDropped", "Phase", "PlaceLost", "Placed", "PlanContradicted", "Position", "PositionRejected",
    "PositionReported", "Profile", "Quat", "Reading", "Recipe", "Rejection", "Sample", "SampleGap",
    "SampleRejected", "Session", "Site", "SnapshotError", "Start", "StreamRestarted", "StreamResumed",
    "StreamStale", "StrideFeatures", "StrideFigures", "StrideTaken", "Support", "ToeOff", "TrackNode",
    "TrackRevised", "Turn", "TurnMade", "Vec3", "WearerMoved", "Write", "read_calibration", "read_floorplan",
    "recipes", "to_frame", "write_whole",
]  # fmt: skip
