"""Feedback in real time: rules about the walk, and the signals (sounds, vibrations) that follow from events.

    feedback = Feedback([EveryHeelStrike(Foot.RIGHT), StanceLonger(Foot.LEFT, 0.75)])
    session = Session(poses=True)                       # StanceLonger needs the live positions
    for signal in feedback.feed(session.feed(packet)): ...

It opens no device, reads no clock, and can be saved at any moment (docs/app.md)."""

from __future__ import annotations

from .feedback import Feedback, Signal
from .rule import FootNow, Rule, Value, WalkNow
from .rules import (
    CadenceAbove,
    CadenceBelow,
    EveryHeelStrike,
    StanceLonger,
    StanceShorter,
    StanceUneven,
    StrideLonger,
    StrideShorter,
)

__all__ = [
    "CadenceAbove", "CadenceBelow", "EveryHeelStrike", "Feedback", "FootNow", "Rule", "Signal", "StanceLonger",
    "StanceShorter", "StanceUneven", "StrideLonger", "StrideShorter", "Value", "WalkNow",
]  # fmt: skip
