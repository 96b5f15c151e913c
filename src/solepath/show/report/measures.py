"""Measures of a walk that a report shows large and compares: five of a walk, five of a run.

    measures = walk_measures(gait.of(False), asymmetry)

Bands of reference are named by `Measure.name`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from math import degrees, hypot

from attrs import frozen

from ...body.gait.means import Figure, GaitParameters
from .running import running_means

Found = tuple[float, float | None] | None
"""Value of a measure and its variation from stride to stride as a standard deviation; None if it is not known."""


@frozen
class Specification:
    """The label, unit, digits after the point and short definition of a measure, and how it follows from the means."""

    label: str
    unit: str
    digits: int
    detail: str
    """Definition in a few words, such as "both feet on the ground"; may be empty."""
    find: Callable[[GaitParameters], Found]


@frozen
class Measure:
    """One measure of steady strides, in the unit in which it is shown."""

    name: str
    """Name in files of bands, such as "speed_m_per_s"."""
    value: float
    spread: float | None
    """Variation from stride to stride as a standard deviation; None if it is not known.

    Of an asymmetry it is half the width of the 95 % interval."""

    @property
    def kind(self) -> Specification:
        """Label, unit and digits."""
        return SPECIFICATIONS[self.name]

    @property
    def is_of_run(self) -> bool:
        """True of a measure of running."""
        return self.name in RUN

    @property
    def text(self) -> str:
        """Value with its digits, without the unit."""
        return f"{self.value:z.{self.kind.digits}f}"

    @property
    def size(self) -> float:
        """Value as a band judges it: that of an asymmetry without its sign."""
        return abs(self.value) if self.name == SWING_DIFFERENCE else self.value


def _scaled(figure: Figure | None, factor: float) -> Found:
    return None if figure is None else (factor * figure.mean, figure.sd and factor * figure.sd)


def _mean_of(name: str, factor: float = 1.0) -> Callable[[GaitParameters], Found]:
    return lambda means: _scaled(getattr(means.both, name), factor)


def _cadence(means: GaitParameters) -> Found:
    """Return the cadence, steps/min; to the first order it varies as the stride time does."""
    time = means.both.stride_time
    return None if time is None else (120.0 / time.mean, time.cv and 120.0 / time.mean * time.cv)


def _double_support(means: GaitParameters) -> Found:
    both = means.both
    time, double, supports = (
        both.stride_time,
        both.double_support,
        (both.initial_double_support, both.terminal_double_support),
    )
    if time is None or double is None or double <= 0.0:
        return None
    # initial and terminal double support are taken as independent
    spreads = [figure.sd for figure in supports if figure is not None and figure.sd is not None]
    return 100.0 * double / time.mean, 100.0 * hypot(*spreads) / time.mean if len(spreads) == 2 else None


def _stance(means: GaitParameters) -> Found:
    time = means.both.stride_time
    return None if time is None else _scaled(means.both.stance_time, 100.0 / time.mean)


def _flight(means: GaitParameters) -> Found:
    run, support = running_means(means), means.both.terminal_double_support
    if run is None or run.flight_time is None or support is None:
        return None
    return 1000.0 * run.flight_time, support.sd and 1000.0 * support.sd


def _oscillation(means: GaitParameters) -> Found:
    run = running_means(means)
    return None if run is None or run.vertical_oscillation is None else (1000.0 * run.vertical_oscillation, None)


SWING_DIFFERENCE = "swing_difference_percent"
SPEED, CADENCE = "speed_m_per_s", "cadence_steps_per_min"
DOUBLE_SUPPORT, STANCE = "double_support_percent", "stance_percent"
PACE = {
    SPEED: Specification("Speed", "m/s", 2, "", _mean_of("speed")),
    CADENCE: Specification("Cadence", "steps/min", 0, "", _cadence),
    "stride_length_m": Specification("Stride length", "m", 2, "two steps", _mean_of("stride_length")),
}
WALK = {
    **PACE,
    DOUBLE_SUPPORT: Specification("Double support", "%", 1, "both feet on the ground", _double_support),
    STANCE: Specification("Stance", "%", 1, "the foot on the ground", _stance),
}
RUN = {
    **{f"run_{name}": kind for name, kind in PACE.items()},
    "contact_time_ms": Specification(
        "Contact time", "ms", 0, "the foot on the ground", _mean_of("stance_time", 1000.0)
    ),
    "flight_time_ms": Specification("Flight time", "ms", 0, "no foot on the ground", _flight),
    "strike_angle_deg": Specification(
        "Strike angle", "deg", 1, "of the foot at contact, toe up", _mean_of("heel_strike_angle", degrees(1.0))
    ),
    "vertical_oscillation_mm": Specification("Vertical oscillation", "mm", 0, "estimate", _oscillation),
}
SPECIFICATIONS = {
    **WALK,
    SWING_DIFFERENCE: Specification("Asymmetry", "%", 1, "of swing time", lambda means: None),
    **RUN,
}
"""All measures by their names."""


def walk_measures(means: GaitParameters, difference: Found) -> list[Measure]:
    """Return speed, cadence, stride length, double support or else stance, and the asymmetry, if known.

    `difference` is that of the swing times, (right - left) / mean, and half the width of its 95 % interval, in percent.
    Without speed and length, stance is added."""
    found = {name: kind.find(means) for name, kind in WALK.items()}
    if found[DOUBLE_SUPPORT] and found[SPEED]:
        del found[STANCE]
    return _known({**found, SWING_DIFFERENCE: difference}.items())


def run_measures(means: GaitParameters) -> list[Measure]:
    """Return speed and cadence and stride length of a run, and its running measures (running.py), if known."""
    return _known([(name, kind.find(means)) for name, kind in RUN.items()])


def _known(found: Iterable[tuple[str, Found]]) -> list[Measure]:
    return [Measure(name, *values) for name, values in found if values is not None]
