"""All events of a session.

Every event is frozen and compares with ==. `t` is the time at which it happened (s, sample clock). `known_at` is the
time at which it was reported (s, arrival of the packet that showed it). `final` is True if no later event revises it.
Latency is `known_at` minus `t`; the docstring of each event states it."""

from __future__ import annotations

from .activity import ActivityChanged, EscalatorRidden, FlightClimbed, LiftRidden, Ride, TurnMade
from .body import PositionRejected, StrideFused, TouchedDown, TrackNode, TrackRevised, WalkingModeChanged
from .defect import (
    CellFault,
    CellsFailed,
    Defect,
    DefectFound,
    FeetSwapped,
    FootResumed,
    FootSilent,
    InsoleNeverUnloads,
)
from .foot import Flaw, FootFlat, HeelOff, HeelStrike, StrideFeatures, StrideTaken, ToeOff
from .gait_cycle import GaitCycleMeasured
from .link import (
    BatteryLevel,
    ClockReset,
    Connected,
    Disconnected,
    KeysChanged,
    LayoutKnown,
    Limitation,
    LinkTrouble,
    PacketRejected,
    PacketsDropped,
    PositionReported,
    Rejection,
    SampleGap,
    SampleRejected,
    StreamRestarted,
    StreamResumed,
    StreamStale,
)
from .live import FootMoved, FootPressed, WearerMoved
from .place import Candidate, Placed, PlaceLost, PlanContradicted

__all__ = [
    "ActivityChanged", "ActivityEvent", "BatteryLevel", "BodyEvent", "Candidate", "CellFault", "CellsFailed",
    "ClockReset", "Connected", "Defect", "DefectFound", "Disconnected", "EscalatorRidden", "Event", "FeetSwapped",
    "Flaw", "FlightClimbed",
    "FootFlat", "FootResumed", "FootMoved", "FootPressed", "FootSilent", "GaitEvent", "HeelOff", "HeelStrike",
    "InsoleNeverUnloads", "KeysChanged", "LayoutKnown", "LiftRidden", "Limitation", "LinkEvent", "LinkTrouble",
    "LiveEvent", "PacketRejected", "PacketsDropped", "PlaceEvent", "PlaceLost", "Placed",
    "PlanContradicted", "PositionRejected", "PositionReported", "Rejection", "TrackNode", "TrackRevised",
    "SampleGap", "SampleRejected", "StrideFeatures", "StrideTaken", "StreamRestarted", "StreamResumed",
    "StreamStale", "StrideFused", "GaitCycleMeasured", "ToeOff", "TouchedDown", "TurnMade", "WalkingModeChanged",
    "WearEvent", "WearerMoved",
]  # fmt: skip

GaitEvent = HeelStrike | FootFlat | HeelOff | ToeOff | StrideTaken
"""Gait events and strides of one foot."""
LinkEvent = (
    PacketRejected | SampleRejected | SampleGap | ClockReset | StreamStale | StreamResumed | Connected
    | Disconnected | PacketsDropped | StreamRestarted | LinkTrouble | LayoutKnown | PositionReported | BatteryLevel
    | KeysChanged | Limitation
)  # fmt: skip
"""Events of links and sensors."""
BodyEvent = GaitCycleMeasured | PositionRejected | StrideFused | TouchedDown | TrackRevised | WalkingModeChanged
"""Events measured from both feet."""
ActivityEvent = ActivityChanged | Ride | FlightClimbed | TurnMade
"""Events of the wearer's activity."""
PlaceEvent = Placed | PlaceLost | PlanContradicted
"""Events of the wearer's place on a floor plan."""
WearEvent = DefectFound | CellsFailed | InsoleNeverUnloads | FeetSwapped | FootSilent | FootResumed
"""Events of defects of the data, and of faults in how sensors are worn."""
LiveEvent = FootMoved | FootPressed | WearerMoved
"""Events of every sample or stride for live display, which are emitted only on request."""
Event = GaitEvent | LinkEvent | BodyEvent | ActivityEvent | PlaceEvent | WearEvent | LiveEvent
"""Any event of a session."""
