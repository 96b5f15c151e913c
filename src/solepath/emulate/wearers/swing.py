"""The pitch of a foot in swing, as two curves: the reversal after toe-off, and the rest up to heel-strike.

Numbers without a source were chosen by hand for plausible rates of a foot and not swept."""

from __future__ import annotations

import numpy as np

from ..routes.styles import StrideKind
from .curves import Array, EndState, evaluate, join
from .gait import PlannedStride

REVERSAL_SHARE = 0.22
"""Share of the swing, from toe-off on, in which the foot stops raising its heel and starts to raise its toe."""
SWING_RATE_RATIO = 1.1
"""Pitch rate at the end of that reversal, as a ratio to the mean rate from there to heel-strike."""
RUN_SWING_PITCH, RUN_SWING_SHARE = -1.50, 0.34
"""Extreme pitch of a runner's foot in swing, rad, negative because the heel is up, and its share of the swing."""
RUN_SWING_ACCELERATION = 4.0
"""Second derivative of the pitch at that extreme, in units of the pitch change and the time up to heel-strike."""


def walking_swing_pitch(pitch_start: EndState, pitch_end: EndState, duration: float) -> tuple[Array, Array]:
    """Return the pitch of a walker's foot in swing: the reversal after toe-off, then a nearly constant rate.

    The reversal lasts a s and the remaining swing b s. With pitch p and rate p' at toe-off and rate r at the end of the
    reversal, the pitch there is p + a (p' + r) / 2. The rate r is SWING_RATE_RATIO times the mean rate over b; this is
    solved for r."""
    a, b = REVERSAL_SHARE * duration, (1.0 - REVERSAL_SHARE) * duration
    rate = (
        SWING_RATE_RATIO * (pitch_end[0] - pitch_start[0] - 0.5 * a * pitch_start[1]) / (b + 0.5 * SWING_RATE_RATIO * a)
    )
    middle = (pitch_start[0] + 0.5 * a * (pitch_start[1] + rate), rate, 0.0)
    return join(pitch_start, middle, a), join(middle, pitch_end, b)


def running_swing_pitch(pitch_start: EndState, pitch_end: EndState, duration: float) -> tuple[Array, Array]:
    """Return the pitch in a runner's swing: the heel rises to RUN_SWING_PITCH, then the foot swings forward."""
    a, b = RUN_SWING_SHARE * duration, (1.0 - RUN_SWING_SHARE) * duration
    top = (RUN_SWING_PITCH, 0.0, RUN_SWING_ACCELERATION * (pitch_end[0] - RUN_SWING_PITCH) / b**2)
    return join(pitch_start, top, a), join(top, pitch_end, b)


def reversal_share(stride: PlannedStride) -> float:
    """Return the share of the swing at which the first of the two curves ends."""
    return RUN_SWING_SHARE if stride.kind is StrideKind.RUN else REVERSAL_SHARE


def pitch_at(pitches: tuple[Array, Array], s: Array, reversal: float) -> Array:
    """Return the pitch at shares `s` of the swing; the first curve ends at share `reversal`."""
    early, late = (evaluate(pitches[0], s / reversal), evaluate(pitches[1], (s - reversal) / (1.0 - reversal)))
    return np.where(s < reversal, early, late)
