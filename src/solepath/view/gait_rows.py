"""Which gait parameters are shown, what they are called, and in which unit and with how many digits: the same in every
table, on the page and in the report."""

from __future__ import annotations

from math import degrees

from attrs import frozen

from ..body.gait_means import Figure, GaitParameters
from ..types import Foot

ROWS: tuple[tuple[str, str, str, int, float], ...] = (
    ("stride_time", "stride time", "s", 3, 1.0),
    ("step_time", "step time", "s", 3, 1.0),
    ("stride_length", "stride length", "m", 3, 1.0),
    ("step_length", "step length", "m", 3, 1.0),
    ("step_width", "step width", "m", 3, 1.0),
    ("speed", "speed", "m/s", 2, 1.0),
    ("clearance", "rise of the sensor", "m", 3, 1.0),
    ("toe_off_angle", "toe-off angle", "deg", 1, degrees(1.0)),
    ("heel_strike_angle", "heel-strike angle", "deg", 1, degrees(1.0)),
)
"""Parameter of StrideFigures, what it is called, the unit that it is shown in, digits, and how many of that unit one of
its own is."""
SHARES = (
    ("stance_time", "stance"),
    ("single_support", "single support"),
    ("initial_double_support", "initial double support"),
    ("terminal_double_support", "terminal double support"),
)
"""Times that are shown as a share of the stride time, in percent with one digit."""


@frozen
class GaitRow:
    """One parameter of steady strides. `left`, `right`, `both`, `sd`: in `unit`, None where it cannot be told (a share
    of the stride has no `sd`). `cv`, `asymmetry`: shares (0.05 is 5 %), as in Figure and GaitParameters."""

    name: str
    label: str
    unit: str
    digits: int
    left: float | None
    right: float | None
    both: float
    sd: float | None
    cv: float | None
    asymmetry: float | None


def gait_rows(parameters: GaitParameters) -> list[GaitRow]:
    """A row for each parameter that was measured, in the order in which they are shown."""
    feet = [parameters.feet.get(foot) for foot in Foot]
    rows = []
    for name, label, unit, digits, scale in ROWS:
        figure: Figure | None = getattr(parameters.both, name)
        if figure is not None:
            figures = [None if one is None else getattr(one, name) for one in feet]
            left, right = [None if one is None else scale * one.mean for one in figures]
            sd = None if figure.sd is None else scale * figure.sd
            asymmetry = parameters.asymmetry(name)
            rows.append(
                GaitRow(name, label, unit, digits, left, right, scale * figure.mean, sd, figure.cv, asymmetry)
            )
    for name, label in SHARES:
        share = parameters.both.share(name)
        if share is not None:
            shares = [None if one is None else one.share(name) for one in feet]
            left, right = [None if one is None else 100.0 * one for one in shares]
            asymmetry = parameters.asymmetry(name)
            rows.append(GaitRow(name, label, "%", 1, left, right, 100.0 * share, None, None, asymmetry))
    return rows
