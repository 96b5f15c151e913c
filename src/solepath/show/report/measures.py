"""Measures of a walk that a report shows large and compares: five of a walk, five of a run.

    measures = walk_measures(gait.of(False), asymmetry)

Bands of reference are named by `Measure.name`."""

from __future__ import annotations

from math import degrees, hypot

from attrs import frozen

from ...body.gait.means import Figure, GaitParameters
from .running import running_means


@frozen(kw_only=True)
class Measure:
    """One measure of steady strides, in the unit in which it is shown."""

    name: str
    """Name in files of bands, such as "speed_m_per_s"."""
    label: str
    unit: str
    digits: int
    """Number of digits after the point that are shown."""
    value: float
    spread: float | None
    """Variation from stride to stride as a standard deviation; None if it is not known.

    Of an asymmetry it is half the width of the 95 % interval."""
    detail: str = ""
    """Definition in a few words, such as "both feet on the ground"."""

    @property
    def text(self) -> str:
        """Value with its digits, without the unit."""
        shown = f"{self.value:.{self.digits}f}"
        return shown.removeprefix("-") if float(shown) == 0.0 else shown


SWING_DIFFERENCE = "swing_difference_percent"
SPECIFICATIONS = {
    "speed_m_per_s": ("Speed", "m/s", 2, ""),
    "cadence_steps_per_min": ("Cadence", "steps/min", 0, ""),
    "stride_length_m": ("Stride length", "m", 2, "two steps"),
    "double_support_percent": ("Double support", "%", 1, "both feet on the ground"),
    "stance_percent": ("Stance", "%", 1, "the foot on the ground"),
    SWING_DIFFERENCE: ("Asymmetry", "%", 1, "of swing time"),
    "run_speed_m_per_s": ("Speed", "m/s", 2, ""),
    "run_cadence_steps_per_min": ("Cadence", "steps/min", 0, ""),
    "run_stride_length_m": ("Stride length", "m", 2, "two steps"),
    "contact_time_ms": ("Contact time", "ms", 0, "the foot on the ground"),
    "flight_time_ms": ("Flight time", "ms", 0, "no foot on the ground"),
    "strike_angle_deg": ("Strike angle", "deg", 1, "of the foot at contact, toe up"),
    "vertical_oscillation_mm": ("Vertical oscillation", "mm", 0, "estimate"),
}
"""Label, unit, digits and short definition of each measure by its name."""


def _measure(name: str, value: float | None, spread: float | None) -> list[Measure]:
    """Return a list of the measure; an empty one if its value is not known."""
    if value is None:
        return []
    label, unit, digits, detail = SPECIFICATIONS[name]
    return [Measure(name=name, label=label, unit=unit, digits=digits, value=value, spread=spread, detail=detail)]


def _of_figure(name: str, figure: Figure | None, factor: float = 1.0) -> list[Measure]:
    if figure is None:
        return []
    return _measure(name, factor * figure.mean, None if figure.sd is None else factor * figure.sd)


def walk_measures(parameters: GaitParameters, difference: tuple[float, float] | None) -> list[Measure]:
    """Return speed, cadence, stride length, double support or else stance, and the asymmetry, if known.

    `difference` is that of the swing times, (right - left) / mean, and half the width of its 95 % interval, shares.
    Without speed and length, stance is added."""
    both = parameters.both
    supports = (both.initial_double_support, both.terminal_double_support)
    time, double = both.stride_time, both.double_support
    measures = _of_figure("speed_m_per_s", both.speed)
    measures += _cadence("cadence_steps_per_min", time)
    measures += _of_figure("stride_length_m", both.stride_length)
    share = None if double is None or time is None or double <= 0.0 else 100.0 * double / time.mean
    if share is not None and time is not None:
        # initial and terminal double support are taken as independent
        spreads = [figure.sd for figure in supports if figure is not None and figure.sd is not None]
        spread = 100.0 * hypot(*spreads) / time.mean if len(spreads) == 2 else None
        measures += _measure("double_support_percent", share, spread)
    if (share is None or both.speed is None) and time is not None and (stance := both.stance_time) is not None:
        spread = None if stance.sd is None else 100.0 * stance.sd / time.mean
        measures += _measure("stance_percent", 100.0 * stance.mean / time.mean, spread)
    if difference is not None:
        measures += _measure(SWING_DIFFERENCE, 100.0 * difference[0], 100.0 * difference[1])
    return measures


def run_measures(parameters: GaitParameters) -> list[Measure]:
    """Return speed, cadence and stride length of a run, and its running measures (running.py), if known."""
    both, run = parameters.both, running_means(parameters)
    measures = _of_figure("run_speed_m_per_s", both.speed)
    measures += _cadence("run_cadence_steps_per_min", both.stride_time)
    measures += _of_figure("run_stride_length_m", both.stride_length)
    if run is None:
        return measures
    measures += _of_figure("contact_time_ms", both.stance_time, 1000.0)
    if run.flight_time is not None:
        spread = both.terminal_double_support
        sd = None if spread is None or spread.sd is None else 1000.0 * spread.sd
        measures += _measure("flight_time_ms", 1000.0 * run.flight_time, sd)
    if run.strike_angle is not None:
        measures += _of_figure("strike_angle_deg", both.heel_strike_angle, degrees(1.0))
    if run.vertical_oscillation is not None:
        measures += _measure("vertical_oscillation_mm", 1000.0 * run.vertical_oscillation, None)
    return measures


def _cadence(name: str, time: Figure | None) -> list[Measure]:
    """Return the cadence, steps/min, of a mean stride time; to the first order it varies as that time does."""
    if time is None:
        return []
    return _measure(name, 120.0 / time.mean, None if time.cv is None else 120.0 / time.mean * time.cv)
