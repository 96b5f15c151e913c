"""The events of a session as rows of events.tsv, which events.json describes."""

from __future__ import annotations

from math import isfinite

from ...events import ActivityChanged, Event, FootFlat, HeelOff, HeelStrike, StrideTaken, ToeOff
from .names import TSV_MISSING

EVENT_COLUMNS = (
    "onset", "duration", "trial_type", "foot", "stride_length", "heading_change", "height_change", "degraded",
)  # fmt: skip
GAIT_EVENTS = {HeelStrike: "heel_strike", FootFlat: "foot_flat", HeelOff: "heel_off", ToeOff: "toe_off"}


def event_row(event: Event) -> tuple[float, dict[str, str]] | None:
    """Return the start of an event, s, on the recording's clock, and its row without `onset`; None if it has none."""
    if not event.final:
        return None
    if isinstance(event, StrideTaken):
        changes = event.heading_change, event.height_change
        length, heading, height = (
            f"{value:.6f}" if isfinite(value) else TSV_MISSING for value in (event.length, *changes)
        )
        return event.t_start, {
            "duration": f"{event.t_end - event.t_start:.6f}",
            "trial_type": "stride",
            "foot": event.foot.value,
            "stride_length": length,
            "heading_change": heading,
            "height_change": height,
            "degraded": str(int(event.degraded)),
        }
    if isinstance(event, ActivityChanged):
        return event.t, {"trial_type": event.activity.value.lower()}
    if isinstance(event, HeelStrike | FootFlat | HeelOff | ToeOff):
        return event.t, {"duration": "0", "trial_type": GAIT_EVENTS[type(event)], "foot": event.foot.value}
    return None
