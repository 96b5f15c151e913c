"""Compensation of a wearer's own touchdowns, from walks over marks on the floor.

After Gong et al. 2023 (Sensors 23, 5417), section 3.3: the wearer steps on a marked point with each footfall, straight
on and along bends of 4 m and 2 m, and the mean of (marked point - measured) is the compensation of that foot in that
mode. Each step counts by itself: its error is measured from the mark of the other foot, so errors do not accumulate.
The marks' frame is any on the floor; its turn to the session's frame is found from all steps together. A mark is the
place of the point of the ground below the ankle."""

from __future__ import annotations

from collections.abc import Iterable
from math import atan2, cos, sin
from operator import attrgetter
from pathlib import Path

from ...calibration import Calibration, CalibrationError
from ...calibration.csv_table import read_rows
from ...events import TouchedDown
from ...foot.navigate.error_state import ErrorStateFilter
from ...foot.stance.cycle import Cycle
from ...recipes import Recipe, usual
from ...recording.decoded import DecodedRecording
from ...session import Session
from ...types import Foot, WalkingMode
from ...types.attrs import evolve, frozen
from .modes import Modes
from .settings import ModesSettings

MARK_TOLERANCE = 0.3
"""Longest time between a mark that names a time and its touchdown, s."""
MODES = tuple(mode for mode in WalkingMode if mode is not WalkingMode.STANDING)
"""Walking modes that have a compensation."""


@frozen
class ModeMark:
    """A point on the floor, m, that a foot stepped on in this mode, at about `t` s or with its `step`-th touchdown."""

    where: str
    foot: Foot
    x: float
    y: float
    mode: WalkingMode
    t: float | None = None
    step: int | None = None


@frozen
class StepError:
    """Marked less measured position of one step, in the direction of walking half a step before it ended, m."""

    foot: Foot
    mode: WalkingMode
    forward: float
    left: float


def read_marks(path: Path | str) -> list[ModeMark]:
    """Read the marks of a csv file with the columns foot (left, right), x, y (m), mode, and t (s) or step (from 1).

    CalibrationError that names file and line."""
    rows = read_rows(path, ("foot", "x", "y", "mode"))
    if not rows:
        raise CalibrationError(f"{path}: no marks")
    marks = []
    for row in rows:
        foot = Foot(row.one_of("foot", [foot.value for foot in Foot]))
        mode = WalkingMode[row.one_of("mode", [mode.name for mode in MODES])]
        mark = ModeMark(row.where, foot, row.number("x"), row.number("y"), mode)
        if row.has("t"):
            mark = evolve(mark, t=row.number("t"))
        elif row.has("step"):
            step = row.number("step")
            if step != int(step) or step < 1:
                raise CalibrationError(f"{row.where}: step is {step:g}, not a whole number from 1")
            mark = evolve(mark, step=int(step))
        else:
            raise CalibrationError(f"{row.where}: neither t nor step says which touchdown it is")
        marks.append(mark)
    return marks


def touchdowns(walk: DecodedRecording, known: Calibration, heading: float | None = None) -> list[TouchedDown]:
    """Return the touchdowns of a walk by method III without compensation, in the order of time.

    `heading`: as in `ModesSettings`."""
    insoles = dict(known.insoles)
    for foot, layout in walk.layouts.items():
        insole = known.insole(foot)
        insoles[foot] = insole if insole.layout is not None else evolve(insole, layout=layout)
    parts = usual(Modes(settings=ModesSettings(heading=heading)))
    recipe = Recipe("marked walk", Cycle(), ErrorStateFilter(), parts=parts)
    session = Session(recipe, calibration=evolve(known, insoles=insoles))
    events = [*session.feed(walk.samples), *session.finish()]
    return sorted([event for event in events if isinstance(event, TouchedDown)], key=attrgetter("t"))


def step_errors(marks: Iterable[ModeMark], downs: list[TouchedDown]) -> list[StepError]:
    """Return the error of every step between marks of both feet; a mark of each foot before them gives the direction.

    CalibrationError for a mark without a touchdown, or two marks of one touchdown."""
    at: dict[int, ModeMark] = {}
    for mark in marks:
        k = _touchdown_index(mark, downs)
        if k in at:
            raise CalibrationError(f"{mark.where}: the same touchdown as at {at[k].where}")
        at[k] = mark
    steps = []
    for k in range(3, len(downs)):
        earliest, earlier, before, newest = (at.get(j) for j in range(k - 3, k + 1))
        if earliest is None or earlier is None or before is None or newest is None:
            continue
        if not downs[k - 1].final:  # reported before the first heading was final: in another frame
            continue
        if not earliest.foot is before.foot is not newest.foot is earlier.foot:
            continue
        (x, y, _), (px, py, _) = downs[k].position, downs[k - 1].position
        # one foot's chord is the tangent a step back, the other's two steps back; this is it half a step back
        ahead = atan2(newest.y - earlier.y, newest.x - earlier.x)
        behind = atan2(before.y - earliest.y, before.x - earliest.x)
        ahead += 0.5 * atan2(sin(ahead - behind), cos(ahead - behind))
        steps.append((newest, (newest.x - before.x, newest.y - before.y), (x - px, y - py), ahead))
    # the turn from the session's frame to the marks', least squares over the steps
    turn = atan2(
        sum([mx * true[1] - my * true[0] for _, true, (mx, my), _ in steps]),
        sum([mx * true[0] + my * true[1] for _, true, (mx, my), _ in steps]),
    )
    c, s = cos(turn), sin(turn)
    found = []
    for reached, (tx, ty), (mx, my), ahead in steps:
        ex, ey = tx - (c * mx - s * my), ty - (s * mx + c * my)
        ca, sa = cos(ahead), sin(ahead)
        found.append(StepError(reached.foot, reached.mode, ca * ex + sa * ey, ca * ey - sa * ex))
    return found


def mean_errors(errors: Iterable[StepError]) -> dict[Foot, dict[WalkingMode, tuple[float, float]]]:
    """Return the mean errors (forward, left), m, by foot and mode, without the part that is an error of heading."""
    gathered: dict[Foot, dict[WalkingMode, list[StepError]]] = {}
    for error in errors:
        gathered.setdefault(error.foot, {}).setdefault(error.mode, []).append(error)
    means = {
        foot: {
            mode: (sum([e.forward for e in some]) / len(some), sum([e.left for e in some]) / len(some))
            for mode, some in gathered[foot].items()
        }
        for foot in Foot
        if foot in gathered
    }
    remove_heading_error(means)
    return means


def remove_heading_error(means: dict[Foot, dict[WalkingMode, tuple[float, float]]]) -> None:
    """Remove, mode by mode, the error to the side that both feet have in common.

    It turns the whole path, as a sensor's heading error does, which differs from walk to walk. Where a touchdown is
    misplaced, the errors of the feet have opposite signs."""
    left, right = means.get(Foot.LEFT, {}), means.get(Foot.RIGHT, {})
    for mode in left.keys() & right.keys():
        aside = 0.5 * (left[mode][1] + right[mode][1])
        left[mode] = (left[mode][0], left[mode][1] - aside)
        right[mode] = (right[mode][0], right[mode][1] - aside)


def fit_modes(
    walks: Iterable[tuple[DecodedRecording, Path | str]], known: Calibration | None = None, heading: float | None = None
) -> Calibration:
    """Return a calibration with the compensation that marked walks show.

    Each walk is a recording and its csv file of marks (`read_marks`). `known`: limbs and insoles of the wearer.
    `heading`: direction that the wearer faces at the start of each walk in the world that the sensors share, rad;
    without it the first step gives the direction, and should not go round a bend. CalibrationError when no step lies
    between two marks."""
    known = Calibration() if known is None else known
    errors: list[StepError] = []
    for walk, path in walks:
        found = step_errors(read_marks(path), touchdowns(walk, known, heading))
        if not found:
            raise CalibrationError(f"{path}: no four marks one after the other, left and right in turn")
        errors += found
    return Calibration(modes=mean_errors(errors))


def _touchdown_index(mark: ModeMark, downs: list[TouchedDown]) -> int:
    """Return the index of a mark's touchdown."""
    of_foot = [k for k, down in enumerate(downs) if down.foot is mark.foot]
    if mark.t is not None:
        near = [(abs(downs[k].t - mark.t), k) for k in of_foot if abs(downs[k].t - mark.t) <= MARK_TOLERANCE]
        if not near:
            raise CalibrationError(f"{mark.where}: the {mark.foot.value} foot did not come down at {mark.t:g} s")
        return min(near)[1]
    if mark.step is None or mark.step > len(of_foot):
        raise CalibrationError(f"{mark.where}: the {mark.foot.value} foot came down {len(of_foot)} times only")
    return of_foot[mark.step - 1]
