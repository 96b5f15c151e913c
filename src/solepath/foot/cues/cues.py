"""Interface of cues, which detect gait events in the samples of one foot."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol, Self

from ...calibration import Calibration
from ...types import Foot, Layout, Phase, Vec3
from ..phase import Cue
from ..stance.stance import Load, Stance


class SeenCue(NamedTuple):
    """A cue and its time."""

    cue: Cue
    t: float
    """Time of the cue, s."""


class Cues(Protocol):
    """The interface of a detector of heel-strike, foot-flat, heel-off and toe-off.

    An app's own class extends this class and can be used in a Recipe. testing/promises.py checks the rules below,
    docs/extending.md shows an example.

    Cues are an attrs class (`@define`) with fields that can be saved. They report the past, never the future. They read
    no clock and no random numbers, have a constant cost for each sample, use bounded memory, and never raise. Samples
    are finite, but otherwise have any size (up to 500 m/s^2, 100 rad/s) and any distance in time. The table in phase.py
    gives the phase that follows from a cue; a cue that changes no phase has no effect."""

    __slots__ = ()

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, still: bool, speed: float, phase: Phase,
        load: Load | None, stance: Stance,
    ) -> Sequence[SeenCue]:  # fmt: skip
        """Return the cues of one corrected sample, in order.

        `acc` is in m/s^2, `gyro` in rad/s without bias. `still`: the zero velocity evidence was accepted. `speed` is in
        m/s, `phase` is the phase before this sample."""

    def alone(self, t: float, dt: float, load: Load, phase: Phase) -> Sequence[SeenCue]:
        """Return the cues of one sample of an insole without inertial sensor, in order."""

    # optional: the default does nothing

    sagittal: float = 0.0
    """Rate of the last sample about the axis to the wearer's left, positive toe down, rad/s. It is 0 while that axis is
    unknown."""
    mark: Cue | None = None
    """Most likely sample of an event so far (Corrector.mark); None for neither. CONTACT: the last sample is most likely
    the one of heel-strike. CLEAR: the one before it is most likely the one of toe-off."""

    def cleared(self, t: float) -> SeenCue:
        """Return a toe-off at `t`, which a gap has hidden; the swing was not over at the end of the gap."""
        return SeenCue(Cue.CLEAR, t)

    def reset(self) -> None:
        """Discard what depends on unbroken samples, after a gap."""
        return

    def restart(self) -> None:
        """Discard what depends on times, because times restart; what was learnt stays."""
        return

    def set_layout(self, layout: Layout) -> None:
        """Set the layout of the pressure cells; called once it is known, and when it changes."""
        return

    def calibrated(self, foot: Foot, calibration: Calibration) -> Self:
        """Return the cues for that foot, with what the calibration contains for it."""
        return self
