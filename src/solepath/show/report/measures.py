"""Measures of a walk that a report shows large and compares: five of a walk, five of a run.

    found = measures(gait.of(False))

Bands of reference are named by `Measure.name`."""

from __future__ import annotations

from math import degrees, hypot

from attrs import frozen

from ...body.gait.means import Figure, GaitParameters
from .running import running_means

SWING_DIFFERENCE = "swing_difference_percent"
PACE = {
    "speed_m_per_s": ("Speed", "m/s", 2, ""),
    "cadence_steps_per_min": ("Cadence", "steps/min", 0, ""),
    "stride_length_m": ("Stride length", "m", 2, "two steps"),
}
SPECIFICATIONS = {
    **PACE,
    "double_support_percent": ("Double support", "%", 1, "both feet on the ground"),
    "stance_percent": ("Stance", "%", 1, "the foot on the ground"),
    SWING_DIFFERENCE: ("Asymmetry", "%", 1, "of swing time"),
    **{f"run_{name}": specification for name, specification in PACE.items()},
    "contact_time_ms": ("Contact time", "ms", 0, "the foot on the ground"),
    "flight_time_ms": ("Flight time", "ms", 0, "no foot on the ground"),
    "strike_angle_deg": ("Strike angle", "deg", 1, "of the foot at contact, toe up"),
    "vertical_oscillation_mm": ("Vertical oscillation", "mm", 0, "estimate"),
}
"""Label, unit, digits after the point and short definition of each measure by its name."""


@frozen
class Measure:
    """One measure of steady strides, in the unit in which it is shown."""

    name: str
    """Name in files of bands, such as "speed_m_per_s"."""
    label: str
    unit: str
    digits: int
    detail: str
    """Definition in a few words, such as "both feet on the ground"."""
    running: bool
    """True for a measure of running."""
    value: float
    spread: float | None
    """Variation from stride to stride as a standard deviation; None if it is not known.

    Of an asymmetry it is half the width of the 95 % interval."""

    @property
    def text(self) -> str:
        """Value with its digits, without the unit."""
        return f"{self.value:z.{self.digits}f}"

    @property
    def size(self) -> float:
        """Value as a band judges it: that of an asymmetry without its sign."""
        return abs(self.value) if self.name == SWING_DIFFERENCE else self.value


Found = tuple[float, float | None] | None
"""Value and spread of a measure; None if it is not known."""


def _found(figure: Figure | None, factor: float = 1.0) -> Found:
    return None if figure is None else (factor * figure.mean, figure.sd and abs(factor) * figure.sd)


def measures(means: GaitParameters, difference: Found = None) -> list[Measure]:
    """Return the measures of walking or of running (running.py) that are known.

    `difference` is that of the swing times of a walk, (right - left) / mean, and half the width of its 95 % interval,
    in percent. Stance is only added where double support or speed is not known."""
    both, run, time = means.both, running_means(means), means.both.stride_time
    # to the first order the cadence varies as the stride time does
    cadence = None if time is None else (120.0 / time.mean, time.cv and 120.0 / time.mean * time.cv)
    prefix, pace = "run_" if means.running else "", (_found(both.speed), cadence, _found(both.stride_length))
    found = {f"{prefix}{name}": one for name, one in zip(PACE, pace, strict=True)}
    if run is not None:
        support = both.terminal_double_support
        found |= {
            "contact_time_ms": _found(both.stance_time, 1000.0),
            "flight_time_ms": None if run.flight_time is None else _found(support, -1000.0),
            "strike_angle_deg": _found(both.heel_strike_angle, degrees(1.0)),
        }
        if run.vertical_oscillation is not None:
            found["vertical_oscillation_mm"] = 1000.0 * run.vertical_oscillation, None
    elif time is not None:
        percent, double = 100.0 / time.mean, both.double_support
        if double is not None and double > 0.0:
            # initial and terminal double support are taken as independent
            supports = (both.initial_double_support, both.terminal_double_support)
            spreads = [percent * figure.sd for figure in supports if figure is not None and figure.sd is not None]
            found["double_support_percent"] = percent * double, hypot(*spreads) if len(spreads) == 2 else None
        if len(found) == len(PACE) or both.speed is None:
            found["stance_percent"] = _found(both.stance_time, percent)
    found[SWING_DIFFERENCE] = difference
    known = [(name, one) for name, one in found.items() if one is not None]
    return [Measure(name, *SPECIFICATIONS[name], means.running, *one) for name, one in known]
