"""Drift from laps of a square with marked steps, section V-B of "Personal navigation via high-resolution gait-corrected
inertial measurement units" (IEEE Trans. Instrum. Meas. 59, 2010).

The wearer walks four to six laps of a square on whose edges every step of one foot is marked (40 marks on 4 times 11.7
m in the paper) and steps on the same marks in every lap. A foot that comes back to its mark is where it was, so a line
through the positions of one mark over time (least squares) has the slope of the drift. The mean slope of all marks is
taken off later positions.

The paper finds a drift towards a fixed direction. What wanders about is not that: extrapolated from five minutes to a
half hour it does more harm than it removes. A fixed drift moves all marks by the same amount from every lap to the
next; so the slope is kept when it is larger than the laps' disagreement explains, by the test that is exact for
independent movements of two components: with n movements of standard error s an axis, k = n - 1 and a chance of
CHANCE, slope^2 / (2 s^2) > k (CHANCE^(-1/k) - 1), the F distribution with 2 and 2 k degrees of freedom.
"""

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
"""The paper's marks."""
FEWEST_LAPS = 3
"""Two points lie on any line."""
CHANCE = 0.01
"""Of keeping a slope where nothing drifts."""
LARGEST = 0.05
"""A foot whose velocity is reset at every step does not drift faster, m/s: 5 cm a step."""
CLOSES = 0.25
"""From one visit of a mark to the next it may seem to move by this share of the square's diagonal, beside a drift: the
laps of a square of 11.7 m then end within 4 m, 9 % of their way."""
NEAR = 1.0
"""A step ends at a mark when it ends within this of the time that the marks' file says, s."""


@frozen
class CornerMark:
    """The foot stood on mark `name` at `t`, s."""

    name: str
    t: float


@frozen
class SquareDrift:
    """What the laps tell. `slope`: mean of the marks' slopes, m/s (x, y), in the frame of `Calibration.drift`;
    `scatter`: its standard error by the laps' disagreement, m/s an axis; `agreed`: it is more than that explains."""

    foot: Foot
    slope: tuple[float, float]
    scatter: float
    agreed: bool
    marks: int
    visits: int
    """Of all marks together."""

    @property
    def kept(self) -> tuple[float, float]:
        """What a calibration takes of it: all or nothing, m/s."""
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
    """Run the laps through a session and fit the lines. With `marks` every visit is the step that ends nearest to its
    time; without, every `steps_per_lap`-th step is on the same mark. `foot`: whose; the right one's where both were
    recorded. CalibrationError when there are too few laps, or they are none (`check`), or a recipe that cannot use a
    drift."""
    if not isinstance(recipe.corrector, BiasZupt):
        raise CalibrationError(f"recipe {recipe.name} takes no drift off")
    known = Calibration() if calibration is None else calibration
    session = Session(recipe, calibration=evolve(known, drift={}))
    steps: dict[Foot, list[StrideTaken]] = {one: [] for one in Foot}
    for event in [*session.feed(items), *session.finish()]:
        if isinstance(event, StrideTaken):
            steps[event.foot].append(event)
    chosen = foot or (Foot.RIGHT if steps[Foot.RIGHT] else Foot.LEFT)
    if not steps[chosen]:
        raise CalibrationError(f"no step of the {chosen.value} foot in the recording")
    visits = _counted(steps[chosen], steps_per_lap) if marks is None else _marked(steps[chosen], marks)
    tracker = session.feet[chosen]
    # Steps are in the world frame, whose first heading is the walk's; a drift is in that of the sensor, or the device.
    corrector = tracker.corrector
    turned = corrector.turned if isinstance(corrector, BiasZupt) else None
    north = tracker.gait.world.north or (1.0, 0.0)
    back = -atan2(north[1], north[0]) - (turned or 0.0)
    found = fitted(chosen, visits, back)
    check(found, visits)
    return found


def read_marks(path: Path | str) -> tuple[CornerMark, ...]:
    """Marks from a .csv with the columns `mark` and `t`, one row for every visit. CalibrationError when it is not."""
    rows = read_rows(path, ("mark", "t"))
    if not rows:
        raise CalibrationError(f"{path}: no visits of marks")
    return tuple([CornerMark(row.word("mark"), row.number("t")) for row in rows])


Visits = dict[str, list[tuple[float, Vec3]]]
"""By mark: when it was stood on and where that seemed to be, world frame, m."""


def _counted(steps: Sequence[StrideTaken], steps_per_lap: int) -> Visits:
    if steps_per_lap < 4:
        raise CalibrationError(f"{steps_per_lap} marks are no square")
    if len(steps) < FEWEST_LAPS * steps_per_lap:
        raise CalibrationError(f"{len(steps)} steps are less than {FEWEST_LAPS} laps of {steps_per_lap} marks")
    visits: Visits = {}
    for number, step in enumerate(steps):
        visits.setdefault(str(number % steps_per_lap), []).append((step.t, step.position))
    return visits


def _marked(steps: Sequence[StrideTaken], marks: Sequence[CornerMark]) -> Visits:
    visits: Visits = {}
    ends = np.array([step.t for step in steps])
    for mark in marks:
        nearest = int(np.argmin(np.abs(ends - mark.t)))
        if abs(ends[nearest] - mark.t) > NEAR:
            raise CalibrationError(f"no step ends at mark {mark.name} near {mark.t:.2f} s")
        visits.setdefault(mark.name, []).append((steps[nearest].t, steps[nearest].position))
    return visits


def fitted(foot: Foot, visits: Mapping[str, list[tuple[float, Vec3]]], back: float) -> SquareDrift:
    """One line for each mark that was visited often enough; `back` turns from the world's frame to the drift's, rad."""
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
    sx, sy, _ = rotate(from_yaw(back), (x, y, 0.0))
    return SquareDrift(foot, (sx, sy), scatter, agreed, len(slopes), used)


def check(found: SquareDrift, visits: Mapping[str, list[tuple[float, Vec3]]]) -> None:
    """CalibrationError when what was walked is no laps of a square: when from one lap to the next the marks, in the
    mean, lie farther apart than `LARGEST` and `CLOSES` allow, or the drift is larger than `LARGEST`."""
    marks = [np.array([(t, x, y) for t, (x, y, _) in places]) for places in visits.values() if len(places) > 1]
    middles = np.array([mark[:, 1:].mean(axis=0) for mark in marks])
    diagonal = float(np.linalg.norm(np.ptp(middles, axis=0)))
    moves: dict[int, list[tuple[float, float]]] = {}
    for mark in marks:
        for number, (lasted, dx, dy) in enumerate(np.diff(mark, axis=0)):
            moves.setdefault(number, []).append((float(lasted), hypot(dx, dy)))
    for lap in moves.values():
        lasted, moved = np.mean(lap, axis=0)
        if moved > LARGEST * lasted + CLOSES * diagonal:
            raise CalibrationError(
                f"the laps do not close: a mark lies {moved:.1f} m from where it lay a lap before, "
                f"the diagonal of all marks is {diagonal:.1f} m; is the number of steps a lap right?"
            )
    speed = hypot(*found.slope)
    if speed > LARGEST:
        raise CalibrationError(
            f"a drift of {100.0 * speed:.1f} cm/s: more than {100.0 * LARGEST:.0f} cm/s are no drift of steps"
        )
