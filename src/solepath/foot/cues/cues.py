"""Interface of cues, which detect gait events in the samples of one foot."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, NamedTuple, Protocol, Self

from ...calibration import Calibration
from ...types import Foot, Layout, Phase, Vec3
from ..phase import Cue
from ..stance.stance import Load, Stance

MOST_SINGLE_CELLS = 16
"""Largest number of cells of an insole whose cells are judged one by one (touch.py)."""


class TimedCue(NamedTuple):
    """A cue and its time."""

    cue: Cue
    t: float
    """Time of the cue, s."""


class Cues(Protocol):
    """The interface of a detector of heel-strike, foot-flat, heel-off and toe-off.

    An app's own class extends this class and can be used in a Recipe. testing/promises.py checks the rules below,
    examples/own_parts.py shows an example.

    Cues are an attrs class (`@define`) with fields that can be saved. They report the past, never the future. They read
    no clock and no random numbers, have a constant cost for each sample, use bounded memory, and never raise. Samples
    are finite, at most 500 m/s^2 and 100 rad/s, and come at any interval. The table in phase.py gives the phase that
    follows from a cue; a cue that changes no phase has no effect."""

    __slots__ = ()

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, still: bool, speed: float, phase: Phase,
        load: Load | None, stance: Stance,
    ) -> Sequence[TimedCue]:  # fmt: skip
        """Return the cues of one corrected sample, in order.

        `acc` is in m/s^2, `gyro` in rad/s without bias, both in the sensor frame. `still` is True when zero-velocity
        evidence was accepted. `speed` is in m/s, `phase` is the phase before this sample."""

    def alone(self, t: float, dt: float, load: Load, phase: Phase) -> Sequence[TimedCue]:
        """Return the cues of one sample of an insole without inertial sensor, in order."""

    # what follows is optional: the default does nothing

    uses_centre: ClassVar[bool] = False
    """Flag: `load` has the centre of pressure in every sample; it is computed only for those who need it."""
    sagittal: float = 0.0
    """Rate of the last sample about the axis to the wearer's left, positive toe down, rad/s. It is 0 while that axis is
    unknown."""
    mark: Cue | None = None
    """CONTACT or CLEAR when an event most likely happened just now (`Corrector.mark`), otherwise None.

    CONTACT: the last sample is the most likely one of heel-strike so far. CLEAR: the sample before it is the most
    likely one of toe-off so far."""

    @property
    def impact_at(self) -> float | None:
        """Time of a heel-strike that this swing has shown, but whose CONTACT is not certain yet, s; None otherwise."""
        return None

    def make_hidden_toe_off(self, t: float) -> TimedCue:
        """Return a toe-off at `t`, s, which a gap has hidden; the swing may go on after the gap."""
        return TimedCue(Cue.CLEAR, t)

    def reset(self) -> None:
        """Discard what depends on unbroken samples, after a gap."""
        return

    def restart(self) -> None:
        """Discard what depends on times, because times restart; what was learnt stays."""
        return

    def set_layout(self, layout: Layout) -> None:
        """Set the layout of the pressure cells; called once it is known, when it changes, and after a reset."""
        return

    def calibrated(self, foot: Foot, calibration: Calibration) -> Self:
        """Return the cues with the calibration of `foot`."""
        return self
