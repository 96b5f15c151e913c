"""The events of a session as rows of events.tsv, and their description."""

from __future__ import annotations

from math import isfinite
from typing import Any

from ...events import ActivityChanged, Event, FootFlat, HeelOff, HeelStrike, StrideTaken, ToeOff
from .names import TSV_MISSING

EVENT_COLUMNS = (
    "onset", "duration", "trial_type", "foot", "stride_length", "heading_change", "height_change", "degraded",
)  # fmt: skip
GAIT_EVENTS: dict[type[Event], str] = {
    HeelStrike: "heel_strike",
    FootFlat: "foot_flat",
    HeelOff: "heel_off",
    ToeOff: "toe_off",
}
EVENT_METADATA: dict[str, Any] = {
    "onset": {"Description": "Start of the event, counted from the start of the recording.", "Units": "s"},
    "duration": {"Description": "Duration of the event; 0 for an instant.", "Units": "s"},
    "trial_type": {
        "Description": "Kind of the event, found by solepath.",
        "Levels": {
            "heel_strike": "The foot touched the ground.",
            "foot_flat": "The whole sole is on the ground and still.",
            "heel_off": "The heel left the ground.",
            "toe_off": "The toe left the ground.",
            "stride": "One foot went from a foot-flat to its next foot-flat.",
            "standing": "Start of standing, or sitting.",
            "walking": "Start of walking.",
            "running": "Start of running.",
            "stairs_up": "Start of climbing stairs.",
            "stairs_down": "Start of going down stairs.",
            "elevator_up": "Start of a ride upwards.",
            "elevator_down": "Start of a ride downwards.",
            "unknown": "Start of an activity that is not known.",
        },
    },
    "foot": {"Description": "Foot of the event.", "Levels": {"left": "Left foot.", "right": "Right foot."}},
    "stride_length": {"Description": "Horizontal length of the stride.", "Units": "m"},
    "heading_change": {"Description": "Turn of the foot over the stride, counter-clockwise positive.", "Units": "rad"},
    "height_change": {"Description": "Height of the stride's end above its start.", "Units": "m"},
    "degraded": {
        "Description": "Whether samples of the stride are missing or cannot be trusted.",
        "Levels": {"0": "No.", "1": "Yes."},
    },
}
"""Content of events.json."""


def event_row(event: Event) -> tuple[float, dict[str, str]] | None:
    """Return the start of an event, s, on the recording's clock, and its row without `onset`; None if it has none."""
    if not event.final:
        return None
    if isinstance(event, StrideTaken):
        numbers = {"stride_length": event.length, "heading_change": event.heading_change}
        numbers["height_change"] = event.height_change
        row = {name: f"{value:.6f}" if isfinite(value) else TSV_MISSING for name, value in numbers.items()}
        row |= {"trial_type": "stride", "foot": event.foot.value, "degraded": str(int(event.degraded))}
        return event.t_start, row | {"duration": f"{event.t_end - event.t_start:.6f}"}
    if isinstance(event, ActivityChanged):
        return event.t, {"duration": TSV_MISSING, "trial_type": event.activity.value.lower()}
    if isinstance(event, HeelStrike | FootFlat | HeelOff | ToeOff):
        return event.t, {"duration": "0", "trial_type": GAIT_EVENTS[type(event)], "foot": event.foot.value}
    return None
