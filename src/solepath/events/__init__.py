"""All events of a session.

Every event is frozen, compares with == and has the same three times: `t`, when it happened (s, sample clock);
`known_at`, when it was known (s, arrival of the packet that settled it); `final`, whether no later event may revise it.
Final events never change, however much data follows."""

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
"""Events of one foot's gait."""
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
"""Events of links and sensors."""
BodyEvent = GaitCycleMeasured | StrideFused | TouchedDown | WalkingModeChanged
"""Events measured from both feet."""
ActivityEvent = ActivityChanged | LiftRidden | FlightClimbed | TurnMade
"""Events of the wearer's activity."""
PlaceEvent = Placed | PlaceLost
"""Events of the wearer's place on a floor plan."""
WearEvent = CellsFailed | InsoleNeverUnloads | FeetSwapped | FootSilent | FootResumed
"""Events of how sensors are worn."""
LiveEvent = FootMoved | FootPressed | WearerMoved
"""Events at every sample or step, for drawing, not for keeping; only on request."""
Event = GaitEvent | LinkEvent | BodyEvent | ActivityEvent | PlaceEvent | WearEvent | LiveEvent
"""Any event of a session."""
