"""Evidence for and against a compass in the feet: the field must keep still while the feet turn.

When a foot turns by theta, a compass that is right sees the same direction of the field in the world, apart from the
iron of the shoe. One whose axes are mirrored sees it turn by 2 theta, and a strong magnet in the shoe by theta. For
each turn of a foot, the logarithm of the likelihood ratio of "right" to "mirrored" grows by

    log (OUTLIERS + f(a)) - log (OUTLIERS + f(a - 2 theta)),    f(x) = exp(kappa (cos x - 1)),

where a is the turn of the measured field in the world without the iron, with errors of a von Mises distribution of
concentration kappa, and with outliers; a magnet adds 0. Besides, the strength must be possible."""

from __future__ import annotations

from math import cos, exp, log, pi, sqrt

from ...types import Vec3
from ...types.attrs import define, field
from .stance_field import ABSURD_FLUX

MOST_KAPPA = 4.0
"""Largest concentration of the turn of the field by disturbances, no unit: 30 degrees."""
OUTLIERS = 0.2
"""Likelihood of any turn of the field, where that of the likeliest one is 1: a turn changes the ratio by 6 at most."""
LEAST_TURN = 0.8
"""Least turn of a foot that is evaluated, rad: theta of 46 degrees."""
PROOF, DISPROOF, MOST = 6.0, -9.0, 12.0
"""Log-likelihood ratios that prove a compass (400 to 1: four turns) or disprove it (1 to 8000), and the largest."""
LEAST_FLUX, MOST_FLUX = 12.0, 200.0
"""Range of the flux density near floors, uT: the field of the earth has 22 to 67 (IGRF), which steel weakens or adds
to."""
WEAKEST = 1.0
"""Flux density below which the unit is wrong, uT: gauss instead of tesla give 0.2 to 0.7."""
TOO_STRONG = 10
"""Number of stances in a row outside the range after which the foot is reported."""


@define
class FootTurns:
    """The turns of one foot and the strength of the field there."""

    reference: tuple[float, float] | None = None
    """Direction of the field and angle of the foot before the next turn, common frame, rad; None before any stance."""
    outside: int = 0
    """Number of stances in a row in which the strength was out of range."""


@define
class CompassTrust:
    """The evidence from the stances of both feet, and the faults that were reported."""

    feet: tuple[FootTurns, FootTurns] = field(factory=lambda: (FootTurns(), FootTurns()), init=False)
    evidence: float = field(default=0.0, init=False)
    """Log-likelihood ratio of right to mirrored axes."""
    reported: list[str] = field(factory=list, init=False)
    """Faults that were reported; those that concern one foot have its number."""
    pending: str | None = field(default=None, init=False)
    """Fault to be reported next; None usually."""

    def add_strength(self, foot: int, flux: Vec3) -> bool:
        """Add the flux density of a stance of foot 0 (left) or 1, uT; return whether its strength is possible."""
        one, (x, y, z) = self.feet[foot], flux
        possible = LEAST_FLUX < sqrt(x * x + y * y + z * z) < MOST_FLUX
        one.outside = 0 if possible else one.outside + 1
        return possible

    def add_direction(self, foot: int, direction: float, yaw: float, kappa: float) -> None:
        """Add the direction of the field without the iron at a stance of foot 0 (left) or 1, common frame, rad.

        `yaw` is the angle of the foot, common frame, rad, and `kappa` the concentration of the direction's turn."""
        one = self.feet[foot]
        turn = 0.0 if one.reference is None else (yaw - one.reference[1] + pi) % (2.0 * pi) - pi
        if one.reference is not None and abs(turn) < LEAST_TURN:
            return
        if one.reference is not None:
            seen = direction - one.reference[0]
            more = _log_likelihood(seen, kappa) - _log_likelihood(seen - 2.0 * turn, kappa)
            self.evidence = max(-MOST, min(MOST, self.evidence + more))
        one.reference = (direction, yaw)

    @property
    def is_proven(self) -> bool:
        """Flag: the compass may correct headings."""
        return self.evidence >= PROOF

    def note(self, foot: int, fault: str) -> None:
        """Queue a fault of foot 0 (left) or 1, a key of `SENTENCES`, unless it was reported before."""
        name = fault if fault in OF_BOTH else f"{fault} {foot}"
        if name not in self.reported:
            self.reported.append(name)
            self.pending = fault

    def fault(self, foot: int, flux: Vec3) -> str | None:
        """Return a sentence on a new fault of the magnetometer of foot 0 (left) or 1; None usually.

        `flux` is the newest flux density, uT."""
        outside = self.feet[foot].outside >= TOO_STRONG
        if not outside and self.evidence > DISPROOF and self.pending is None:
            return None
        size = sqrt(flux[0] ** 2 + flux[1] ** 2 + flux[2] ** 2)
        if outside:
            self.note(foot, "unit" if size >= 0.5 * ABSURD_FLUX or size < WEAKEST else "strength")
        elif self.evidence <= DISPROOF:
            self.note(foot, "axes")
        fault, self.pending = self.pending, None
        return None if fault is None else SENTENCES[fault].format(size)

    def reset(self, foot: int) -> None:
        """Forget what depends on the device of a foot."""
        self.feet[foot].reference, self.feet[foot].outside = None, 0
        self.reported = [one for one in self.reported if one not in OF_BOTH and not one.endswith(str(foot))]
        self.evidence = 0.0


def _log_likelihood(angle: float, kappa: float) -> float:
    return log(OUTLIERS + exp(min(kappa, MOST_KAPPA) * (cos(angle) - 1.0)))


SENTENCES = {
    "unit": "the magnetometer's field is {:.3g} uT, where the earth's has 22 to 67: give tesla. It is not used",
    "changed": "something magnetic has come to this foot or has left it: its compass learns the iron of the shoe again",
    "strange": "for 100 m, the magnetic field has been another one than before, as over steel: the compass is not used "
    "there",
    "strength": "the magnetic field at the foot is {:.0f} uT, where the earth's has 22 to 67: a magnet or steel is "
    "close to the sensor, in the shoe or below it. The compass of this foot is not used while it lasts",
    "axes": "the magnetic field turns with the foot, twice as far: the axes of the magnetometer are mirrored or "
    "exchanged against those of the accelerometer. The compass is not used",
}
"""Faults of a magnetometer by their kind, for people."""
OF_BOTH = ("axes", "strange")
"""Faults that are reported once for both feet."""
