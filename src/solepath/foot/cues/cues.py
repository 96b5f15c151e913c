"""What cues are asked: from the numbers of one foot to what it was seen to do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol, Self

from ...calibration import Calibration
from ...types import Foot, Layout, Phase, Vec3
from ..phase import Cue
from ..stance.stance import Load, Stance


class SeenCue(NamedTuple):
    """A cue and when it happened."""

    cue: Cue
    t: float
    """s."""


class Cues(Protocol):
    """What sees heel-strike, foot-flat, heel-off and toe-off. An app's own extends this and may stand in a Recipe
    beside ours; testing/promises.py tries whether it keeps what follows, docs/extending.md shows one.

    An attrs class (`@define`) with fields of kinds that can be saved. It says what has happened, never what will. It
    reads no clock and no random numbers, costs the same at every sample, remembers no more the longer it is fed, and
    never raises: samples are finite, but otherwise of any size (up to 500 m/s^2, 100 rad/s) and at any distance in
    time. What follows from a cue is in the table of phase.py, and one that changes no phase is no matter.
    """

    __slots__ = ()

    def update(
        self, t: float, dt: float, acc: Vec3, gyro: Vec3, still: bool, speed: float, phase: Phase,
        load: Load | None, stance: Stance,
    ) -> Sequence[SeenCue]:  # fmt: skip
        """One corrected sample: `acc` in m/s^2, `gyro` in rad/s without bias, `still`: the evidence of zero velocity
        was believed, `speed` in m/s, `phase` before it. What was seen, in order."""

    def alone(self, t: float, dt: float, load: Load, phase: Phase) -> Sequence[SeenCue]:
        """The same for an insole without an inertial sensor."""

    # what cues may know or pay heed to; they need not

    sagittal: float = 0.0
    """Rate about the axis to the wearer's left in the last sample, positive toe down, rad/s; 0 while that axis is not
    known."""
    mark: Cue | None = None
    """CONTACT: of all samples so far the last is most likely that of heel-strike. CLEAR: the one before it is most
    likely that of toe-off (Corrector.mark). None: neither."""

    def cleared(self, t: float) -> SeenCue:
        """The toe left the ground at `t`, in a gap, and the swing was under way when that ended."""
        return SeenCue(Cue.CLEAR, t)

    def reset(self) -> None:
        """There was a gap: what lasts must be seen to last."""
        return

    def restart(self) -> None:
        """Times begin anew: what was learnt stays, what lasted does not."""
        return

    def set_layout(self, layout: Layout) -> None:
        """Where the cells are; told once that is known, and again when it changes."""
        return

    def calibrated(self, foot: Foot, calibration: Calibration) -> Self:
        """The cues to be used for that foot, with what the calibration says of it."""
        return self
