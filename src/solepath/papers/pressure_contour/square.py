"""Drift from laps of a square with marked strides, section V-B of Bebek et al. 2010.

"Personal navigation via high-resolution gait-corrected inertial measurement units" (IEEE Trans. Instrum. Meas. 59,
2010). The wearer walks four to six laps of a square on whose edges every stride of one foot is marked (40 marks on 4
times 11.7 m in the paper) and stands on the same marks in every lap. A foot that comes back to its mark is where it
was, so a line through the positions of one mark over time (least squares) has the slope of the drift. The mean slope of
all marks is subtracted from later positions.

The paper finds a drift in a fixed direction. A drift that changes direction is different: extrapolated from five
minutes to half an hour its correction does more harm than good. A fixed drift moves all marks by the same amount from
every lap to the next; so the slope is kept when it is larger than the laps' disagreement explains, by the test that is
exact for independent movements of two components: with n movements of standard error s an axis, k = n - 1 and a chance
of CHANCE, slope^2 / (2 s^2) > k (CHANCE^(-1/k) - 1), the F distribution with 2 and 2 k degrees of freedom."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import atan2, hypot, inf
from pathlib import Path

import numpy as np

from ...calibration import Calibration, CalibrationError
from ...calibration.csv_table import read_rows
from ...events import StrideTaken
from ...recipes import Recipe
from ...session import Session
from ...types import Foot, Packet, Sample, Vec3
from ...types.attrs import evolve, frozen
from ...types.vector import from_yaw, rotate
from .bias_zupt import BiasZupt
from .recipe import PRESSURE_CONTOUR

STEPS_PER_LAP = 40
"""Number of the paper's marks."""
FEWEST_LAPS = 3
"""Fewest laps that show a drift: two points lie on any line."""
CHANCE = 0.01
"""Probability of keeping a slope where nothing drifts."""
LARGEST_DRIFT = 0.05
"""Largest drift of a foot whose velocity is reset at every stride, m/s: 5 cm a stride."""
CLOSURE_SHARE = 0.25
"""Share of the square's diagonal by which a mark may move from one lap to the next, beside a drift.

The laps of a square of 11.7 m then end within 4 m, 9 % of their way."""
MARK_TOLERANCE = 1.0
"""Longest time between the end of a stride and a mark's time in the file, s."""


@frozen
class CornerMark:
    """A visit of mark `name` by the foot at `t`, s."""

    name: str
    t: float


@frozen
class SquareDrift:
    """Drift that the laps show.

    `slope`: mean of the marks' slopes, m/s (x, y), in the frame of `Calibration.drift`; `scatter`: its standard error
    by the laps' disagreement, m/s an axis; `agreed`: the slope is larger than that explains."""

    foot: Foot
    slope: tuple[float, float]
    scatter: float
    agreed: bool
    marks: int
    visits: int
    """Number of visits of all marks together."""

    @property
    def kept(self) -> tuple[float, float]:
        """Slope that a calibration takes, m/s: `slope` if `agreed`, otherwise zero."""
        return self.slope if self.agreed else (0.0, 0.0)


def square_drift(
    items: Iterable[Packet | Sample],
    *,
    foot: Foot | None = None,
    marks: Sequence[CornerMark] | None = None,
    steps_per_lap: int = STEPS_PER_LAP,
    recipe: Recipe = PRESSURE_CONTOUR,
    calibration: Calibration | None = None,
) -> SquareDrift:
    """Run the laps through a session and fit a line for each mark.

    With `marks` every visit is the stride that ends nearest to its time; without, every `steps_per_lap`-th stride is on
    the same mark. `foot`: the foot to use; the right one where both were recorded. CalibrationError when there are too
    few laps, when they are no laps (`check_laps`), or when the recipe cannot use a drift."""
    if not isinstance(recipe.corrector, BiasZupt):
        raise CalibrationError(f"recipe {recipe.name} takes no drift off")
    known = Calibration() if calibration is None else calibration
    session = Session(recipe, calibration=evolve(known, drift={}))
    strides: dict[Foot, list[StrideTaken]] = {one: [] for one in Foot}
    for event in [*session.feed(items), *session.finish()]:
        if isinstance(event, StrideTaken):
            strides[event.foot].append(event)
    chosen = foot or (Foot.RIGHT if strides[Foot.RIGHT] else Foot.LEFT)
    if not strides[chosen]:
        raise CalibrationError(f"no step of the {chosen.value} foot in the recording")
    visits = (
        _visits_by_count(strides[chosen], steps_per_lap) if marks is None else _visits_by_marks(strides[chosen], marks)
    )
    tracker = session.feet[chosen]
    # Strides are in the world frame, along the first heading; a drift is in the sensor's or the device's frame.
    corrector = tracker.corrector
    heading_offset = corrector.heading_offset if isinstance(corrector, BiasZupt) else None
    north = tracker.gait.world.north or (1.0, 0.0)
    to_drift_frame = -atan2(north[1], north[0]) - (heading_offset or 0.0)
    found = fit_drift(chosen, visits, to_drift_frame)
    check_laps(found, visits)
    return found


def read_marks(path: Path | str) -> tuple[CornerMark, ...]:
    """Read marks from a .csv with the columns `mark` and `t`, one row for every visit.

    CalibrationError when the file is not of that form."""
    rows = read_rows(path, ("mark", "t"))
    if not rows:
        raise CalibrationError(f"{path}: no visits of marks")
    return tuple([CornerMark(row.word("mark"), row.number("t")) for row in rows])


Visits = dict[str, list[tuple[float, Vec3]]]
"""Visits by mark, each with its time, s, and the position found for it, world frame, m."""


def _visits_by_count(strides: Sequence[StrideTaken], steps_per_lap: int) -> Visits:
    if steps_per_lap < 4:
        raise CalibrationError(f"{steps_per_lap} marks are no square")
    if len(strides) < FEWEST_LAPS * steps_per_lap:
        raise CalibrationError(f"{len(strides)} steps are less than {FEWEST_LAPS} laps of {steps_per_lap} marks")
    visits: Visits = {}
    for number, stride in enumerate(strides):
        visits.setdefault(str(number % steps_per_lap), []).append((stride.t, stride.position))
    return visits


def _visits_by_marks(strides: Sequence[StrideTaken], marks: Sequence[CornerMark]) -> Visits:
    visits: Visits = {}
    ends = np.array([stride.t for stride in strides])
    for mark in marks:
        nearest = int(np.argmin(np.abs(ends - mark.t)))
        if abs(ends[nearest] - mark.t) > MARK_TOLERANCE:
            raise CalibrationError(f"no step ends at mark {mark.name} near {mark.t:.2f} s")
        visits.setdefault(mark.name, []).append((strides[nearest].t, strides[nearest].position))
    return visits


def fit_drift(foot: Foot, visits: Mapping[str, list[tuple[float, Vec3]]], to_drift_frame: float) -> SquareDrift:
    """Fit one line for each mark that was visited often enough.

    `to_drift_frame` turns from the world frame to the drift's, rad."""
    slopes: list[tuple[float, float]] = []
    moves: dict[int, list[tuple[float, float]]] = {}
    used = 0
    for places in visits.values():
        t = np.array([at for at, _ in places])
        if len(places) < FEWEST_LAPS or not np.all(np.diff(t) > 0.0):
            continue
        at = np.array([(x, y) for _, (x, y, _) in places])
        late = t - t.mean()
        sx, sy = (late @ (at - at.mean(axis=0))) / (late @ late)
        slopes.append((float(sx), float(sy)))
        used += len(places)
        for lap, (dx, dy) in enumerate(np.diff(at, axis=0) / np.diff(t)[:, None]):
            moves.setdefault(lap, []).append((float(dx), float(dy)))
    if not slopes:
        raise CalibrationError(f"no mark was stood on {FEWEST_LAPS} times")
    x, y = (float(value) for value in np.mean(slopes, axis=0))
    laps = np.array([np.mean(lap, axis=0) for lap in moves.values()])
    scatter = float(np.sqrt(np.mean(laps.var(axis=0, ddof=1)) / len(laps))) if len(laps) > 1 else inf
    k = len(laps) - 1
    agreed = k > 0 and x * x + y * y > 2.0 * scatter * scatter * k * (CHANCE ** (-1.0 / k) - 1.0)
    sx, sy, _ = rotate(from_yaw(to_drift_frame), (x, y, 0.0))
    return SquareDrift(foot, (sx, sy), scatter, agreed, len(slopes), used)


def check_laps(found: SquareDrift, visits: Mapping[str, list[tuple[float, Vec3]]]) -> None:
    """Check that the laps are laps of a square.

    CalibrationError when from one lap to the next the marks, in the mean, lie farther apart than `LARGEST_DRIFT` and
    `CLOSURE_SHARE` allow, or the drift is larger than `LARGEST_DRIFT`."""
    marks = [np.array([(t, x, y) for t, (x, y, _) in places]) for places in visits.values() if len(places) > 1]
    middles = np.array([mark[:, 1:].mean(axis=0) for mark in marks])
    diagonal = float(np.linalg.norm(np.ptp(middles, axis=0)))
    moves: dict[int, list[tuple[float, float]]] = {}
    for mark in marks:
        for number, (duration, dx, dy) in enumerate(np.diff(mark, axis=0)):
            moves.setdefault(number, []).append((float(duration), hypot(dx, dy)))
    for lap in moves.values():
        duration, moved = np.mean(lap, axis=0)
        if moved > LARGEST_DRIFT * duration + CLOSURE_SHARE * diagonal:
            raise CalibrationError(
                f"the laps do not close: a mark lies {moved:.1f} m from where it lay a lap before, "
                f"the diagonal of all marks is {diagonal:.1f} m; is the number of steps a lap right?"
            )
    speed = hypot(*found.slope)
    if speed > LARGEST_DRIFT:
        raise CalibrationError(
            f"a drift of {100.0 * speed:.1f} cm/s: more than {100.0 * LARGEST_DRIFT:.0f} cm/s are no drift of steps"
        )
