"""Drift from laps of a square with marked strides, section V-B of Bebek et al. 2010.

"Personal navigation via high-resolution gait-corrected inertial measurement units" (IEEE Trans. Instrum. Meas. 59,
2010). The wearer walks four to six laps of a square on whose edges every stride of one foot is marked (40 marks on 4
times 11.7 m in the paper) and steps on the same marks in every lap. On every visit of a mark the true position is the
same. So the slope of a line through the computed positions over time (least squares) is the drift. The mean slope of
all marks is subtracted from later positions as a velocity. That the lines are over time is our reading: fig. 12 plots
Northing against Easting, where a line has a direction and no velocity.

The paper's drift has a fixed direction. The correction of a drift that changes direction would do more harm than good,
if it were extrapolated from five minutes to half an hour. A fixed drift moves all marks from each lap to the next at
the same velocity. So the slope is used only if it is larger than chance explains. The test is exact for n independent
two-dimensional lap velocities whose mean has the standard error s on each axis. With k = n - 1 and a probability p of a
false drift the condition is slope^2 / (2 s^2) > k (p^(-1/k) - 1), from the F distribution with 2 and 2 k degrees of
freedom. Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import atan2, hypot, inf

import numpy as np
from numpy.typing import NDArray

from ...calibration import Calibration, CalibrationError
from ...events import StrideTaken
from ...recipes import Recipe
from ...session import Session
from ...types import Foot, Packet, Sample, Vec2, Vec3
from ...types.attrs import evolve, frozen
from ...types.vector import from_yaw, rotate
from .bias_zupt import BiasZupt
from .recipe import PRESSURE_CONTOUR

STRIDES_PER_LAP = 40
"""Number of marks around the paper's square, one for each stride of one foot."""
FEWEST_LAPS = 3
"""Least number of laps for a drift; a line through two points always fits."""
FALSE_DRIFT_PROBABILITY = 0.01
"""Probability of using a slope if there is no drift."""
LARGEST_DRIFT = 0.05
"""Largest drift of a foot whose velocity is set to zero in every stride, m/s: about 5 cm per stride."""
CLOSURE_SHARE = 0.25
"""Distance by which a mark may move per lap in addition to the drift, as a share of the square's diagonal.

The laps of a square of 11.7 m then end within 4 m, which is 9 % of the distance walked."""


@frozen
class SquareDrift:
    """The drift of one foot by the laps."""

    foot: Foot
    slope: Vec2
    """Mean of the marks' slopes (x, y), m/s, in the frame of `Calibration.drift`."""
    scatter: float
    """Standard error of `slope` on each axis, m/s, from the differences between the laps."""
    agreed: bool
    """Flag: the slope is larger than chance explains."""
    marks: int
    """Number of marks that were visited often enough."""
    visits: int
    """Number of visits of all these marks."""

    @property
    def kept(self) -> Vec2:
        """Slope for a calibration (x, y), m/s: `slope` if `agreed`, otherwise zero. The paper uses every slope."""
        return self.slope if self.agreed else (0.0, 0.0)


def square_drift(
    items: Iterable[Packet | Sample],
    *,
    foot: Foot | None = None,
    steps_per_lap: int = STRIDES_PER_LAP,
    recipe: Recipe = PRESSURE_CONTOUR,
    calibration: Calibration | None = None,
) -> SquareDrift:
    """Run the laps through a session, and fit a line to the positions of each mark.

    Every `steps_per_lap`-th stride is on the same mark. `foot` is the foot to use; None selects the right foot if it
    was recorded. Raises CalibrationError when there are too few laps, when they are not laps of a square
    (`check_laps`), or when the recipe cannot use a drift."""
    if not isinstance(recipe.corrector, BiasZupt):
        raise CalibrationError(f"recipe {recipe.name} takes no drift off")
    known = Calibration() if calibration is None else calibration
    session = Session(recipe, calibration=evolve(known, drift={}))
    taken = [event for event in [*session.feed(items), *session.finish()] if isinstance(event, StrideTaken)]
    chosen = foot or (Foot.RIGHT if any(one.foot is Foot.RIGHT for one in taken) else Foot.LEFT)
    strides = [one for one in taken if one.foot is chosen]
    if not strides:
        raise CalibrationError(f"no stride of the {chosen.value} foot in the recording")
    visits = _visits_by_count(strides, steps_per_lap)
    tracker = session.feet[chosen]
    # strides are in the world frame, but a drift is in the navigation frame or in that of the device
    corrector = tracker.corrector
    heading_offset = corrector.heading_offset if isinstance(corrector, BiasZupt) else None
    north = tracker.gait.world.north or (1.0, 0.0)
    to_drift_frame = -atan2(north[1], north[0]) - (heading_offset or 0.0)
    drift = fit_drift(chosen, visits, to_drift_frame)
    check_laps(drift, visits)
    return drift


Values = NDArray[np.float64]
Visits = dict[str, list[tuple[float, Vec3]]]
"""Visits by mark, each with its time, s, and the computed position, world frame, m."""


def _visits_by_count(strides: Sequence[StrideTaken], steps_per_lap: int) -> Visits:
    if steps_per_lap < 4:
        raise CalibrationError(f"{steps_per_lap} marks are no square")
    if len(strides) < FEWEST_LAPS * steps_per_lap:
        raise CalibrationError(f"{len(strides)} strides are less than {FEWEST_LAPS} laps of {steps_per_lap} marks")
    visits: Visits = {}
    for number, stride in enumerate(strides):
        visits.setdefault(str(number % steps_per_lap), []).append((stride.t, stride.position))
    return visits


def fit_drift(foot: Foot, visits: Visits, to_drift_frame: float) -> SquareDrift:
    """Fit a line to the positions of each mark that was visited often enough, and return the mean drift.

    `to_drift_frame` is the angle, rad, by which vectors are turned from the world frame to that of the drift."""
    marks = [mark for mark in _rows(visits) if len(mark) >= FEWEST_LAPS and np.all(np.diff(mark[:, 0]) > 0.0)]
    if not marks:
        raise CalibrationError(f"no mark was stood on {FEWEST_LAPS} times")
    centred = [mark - mark.mean(axis=0) for mark in marks]
    x, y = np.mean([mark[:, 0] @ mark[:, 1:] / (mark[:, 0] @ mark[:, 0]) for mark in centred], axis=0).tolist()
    laps = np.array([np.mean(moves[:, 1:] / moves[:, :1], axis=0) for moves in _moves(marks)])
    k = len(laps) - 1
    scatter = float(np.sqrt(np.mean(laps.var(axis=0, ddof=1)) / len(laps))) if k > 0 else inf
    agreed = k > 0 and x * x + y * y > 2.0 * scatter * scatter * k * (FALSE_DRIFT_PROBABILITY ** (-1.0 / k) - 1.0)
    sx, sy, _ = rotate(from_yaw(to_drift_frame), (x, y, 0.0))
    return SquareDrift(foot, (sx, sy), scatter, agreed, len(marks), sum(map(len, marks)))


def check_laps(drift: SquareDrift, visits: Visits) -> None:
    """Raise CalibrationError unless the laps are laps of a square.

    The mean distance of the marks from one lap to the next must be at most `LARGEST_DRIFT` times the lap's duration
    plus `CLOSURE_SHARE` times the diagonal, and the drift at most `LARGEST_DRIFT`."""
    marks = [mark for mark in _rows(visits) if len(mark) > 1]
    diagonal = float(np.linalg.norm(np.ptp([mark[:, 1:].mean(axis=0) for mark in marks], axis=0)))
    for moves in _moves(marks):
        distance = float(np.linalg.norm(moves[:, 1:], axis=1).mean())
        if distance > LARGEST_DRIFT * moves[:, 0].mean() + CLOSURE_SHARE * diagonal:
            raise CalibrationError(
                f"the laps do not close: a mark lies {distance:.1f} m from where it lay a lap before, "
                f"the diagonal of all marks is {diagonal:.1f} m; is the number of marks a lap right?"
            )
    speed = hypot(*drift.slope)
    if speed > LARGEST_DRIFT:
        raise CalibrationError(
            f"a drift of {100.0 * speed:.1f} cm/s: more than {100.0 * LARGEST_DRIFT:.0f} cm/s are no drift of strides"
        )


def _rows(visits: Visits) -> list[Values]:
    """Return the visits of each mark, (n, 3): time, s, and place x, y, m."""
    return [np.array([(t, x, y) for t, (x, y, _) in mark]) for mark in visits.values()]


def _moves(marks: list[Values]) -> list[Values]:
    """Return what the marks do from each lap to the next, (n, 3): duration, s, and way x, y, m."""
    laps = max(map(len, marks)) - 1
    return [np.array([mark[k + 1] - mark[k] for mark in marks if len(mark) > k + 1]) for k in range(laps)]
