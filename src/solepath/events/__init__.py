"""Everything that a session can say.

Every event is frozen, compares with == and carries the same three times of truth: `t`, when it happened (s, sample
clock); `known_at`, when that was known (s, arrival of the packet that settled it); `final`, whether anything may still
revise it. Final events never change, however much data follows.
"""

from __future__ import annotations

from .activity import ActivityChanged, FlightClimbed, LiftRidden, TurnMade
from .body import StrideFused, TouchedDown, WalkingModeChanged
from .foot import FootFlat, HeelOff, HeelStrike, StrideFeatures, StrideTaken, ToeOff
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
    PacketsLost,
    Rejection,
    SampleGap,
    SampleRejected,
    ScaleSuspect,
    StreamRestarted,
    StreamResumed,
    StreamStale,
)
from .live import FootMoved, FootPressed, WearerMoved
from .place import Candidate, Placed, PlaceLost
from .wear import CellFault, CellsFailed, FeetSwapped, FootResumed, FootSilent, InsoleNeverUnloads

__all__ = [
    "ActivityChanged", "ActivityEvent", "BatteryLevel", "BodyEvent", "Candidate", "CellFault", "CellsFailed",
    "ClockReset", "Connected", "Disconnected", "Event", "FeetSwapped", "FlightClimbed", "FootFlat", "FootResumed",
    "FootMoved", "FootPressed", "FootSilent", "GaitEvent", "HeelOff", "HeelStrike", "InsoleNeverUnloads",
    "KeysChanged", "LayoutKnown", "LiftRidden", "Limitation", "LinkEvent", "LinkTrouble", "LiveEvent",
    "PacketRejected", "PacketsDropped", "PacketsLost", "PlaceEvent", "PlaceLost", "Placed", "Rejection",
    "SampleGap", "SampleRejected", "ScaleSuspect", "StrideFeatures", "StrideTaken", "StreamRestarted",
    "StreamResumed", "StreamStale", "StrideFused", "GaitCycleMeasured", "ToeOff", "TouchedDown", "TurnMade",
    "WalkingModeChanged", "WearEvent", "WearerMoved",
]  # fmt: skip

GaitEvent = HeelStrike | FootFlat | HeelOff | ToeOff | StrideTaken
LinkEvent = (
    PacketRejected
    | SampleRejected
    | PacketsLost
    | SampleGap
    | ClockReset
    | StreamStale
    | StreamResumed
    | Connected
    | Disconnected
    | PacketsDropped
    | StreamRestarted
    | LinkTrouble
    | ScaleSuspect
    | LayoutKnown
    | BatteryLevel
    | KeysChanged
    | Limitation
)
BodyEvent = GaitCycleMeasured | StrideFused | TouchedDown | WalkingModeChanged
ActivityEvent = ActivityChanged | LiftRidden | FlightClimbed | TurnMade
PlaceEvent = Placed | PlaceLost
WearEvent = CellsFailed | InsoleNeverUnloads | FeetSwapped | FootSilent | FootResumed
LiveEvent = FootMoved | FootPressed | WearerMoved
"""Only for those who ask, at every sample or step: what is drawn, and not kept."""
Event = GaitEvent | LinkEvent | BodyEvent | ActivityEvent | PlaceEvent | WearEvent | LiveEvent
"""All of them."""
