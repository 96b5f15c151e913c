"""Compensation of a wearer's own touchdowns, from walks over marks on the floor.

After Gong et al. 2023 (Sensors 23, 5417), section 3.3: the wearer steps on marked points, straight ahead and along
bends of 4 m and 2 m. The compensation of a foot in a mode is the mean of (marked point - measured point). Marked points
are taken relative to the other foot's mark, and measured ones relative to its touchdown, so errors do not accumulate
over steps. A mark is the point of the ground below the ankle.

The paper's floor is surveyed, and its sensors have a common north. So errors may also turn every step to the same side,
as those of a wearer do whose skin rolls over the muscles. They are kept if the heading of the wearer at the start is
given; x of the marks is then that heading. Otherwise the marks may be in any frame. The angle to it is fitted to all
steps of a walk, which takes off what they err to one side on average."""

from __future__ import annotations

from cmath import rect
from collections.abc import Iterable
from itertools import pairwise
from math import atan2, fsum, inf
from operator import attrgetter
from pathlib import Path

from ...calibration import Calibration, CalibrationError
from ...events import TouchedDown
from ...foot.navigate.error_state import ErrorStateFilter
from ...foot.stance.cycle import Cycle
from ...recipes import Recipe, usual_parts
from ...recording.decoded import DecodedRecording
from ...recording.text_table import read_rows
from ...session import Session
from ...types import Foot, Vec2, WalkingMode
from ...types.attrs import evolve, frozen
from ...types.vector import wrap_angle
from .modes import Modes
from .settings import ModesSettings
from .touchdown import PressureTouchdown

MARK_TOLERANCE = 0.3
"""Longest time between a touchdown and the time in its mark, s; chosen by hand."""
MODES = tuple(mode for mode in WalkingMode if mode is not WalkingMode.STANDING)
"""Walking modes that have a compensation."""


@frozen
class ModeMark:
    """A marked point on the floor on which a foot stepped."""

    where: str
    """File and line of the mark, for messages."""
    foot: Foot
    x: float
    """Position along the first axis of the marks' frame, m."""
    y: float
    """Position along the second axis of the marks' frame, m."""
    mode: WalkingMode
    """Walking mode of the step that ended on the mark."""
    t: float | None = None
    """Approximate time of the touchdown, s; None if `step` is given."""
    step: int | None = None
    """Number of the touchdown among those of this foot, from 1; None if `t` is given."""


@frozen
class StepError:
    """The marked minus the measured end of one step; the direction of walking is that half a step before this end."""

    foot: Foot
    mode: WalkingMode
    forward: float
    """Error in the direction of walking, m."""
    left: float
    """Error to the left of the direction of walking, m."""


def read_marks(path: Path | str) -> list[ModeMark]:
    """Read the marks of a csv file with the columns foot (left, right), x, y (m), mode, and t (s) or step (from 1).

    Raises CalibrationError, with file and line, when the file does not have that form."""
    marks = []
    for row in read_rows(path, ("foot", "x", "y", "mode")):
        foot = Foot(row.one_of("foot", [foot.value for foot in Foot]))
        mode = WalkingMode[row.one_of("mode", [mode.name for mode in MODES])]
        t = row.number("t") if row.has("t") else None
        step = row.number("step") if t is None and row.has("step") else None
        if step is not None and (step != int(step) or step < 1):
            raise CalibrationError(f"{row.where}: step is {step:g}, not a whole number from 1")
        if t is None and step is None:
            raise CalibrationError(f"{row.where}: neither t nor step says which touchdown it is")
        number = None if step is None else int(step)
        marks.append(ModeMark(row.where, foot, row.number("x"), row.number("y"), mode, t, number))
    if not marks:
        raise CalibrationError(f"{path}: no marks")
    return marks


def touchdowns(walk: DecodedRecording, known: Calibration, heading: float | None = None) -> list[TouchedDown]:
    """Return the touchdowns of a walk by method III without compensation, in the order of time.

    `heading` is that of `ModesSettings`, rad."""
    insoles = dict(known.insoles)
    for foot, layout in walk.layouts.items():
        insole = known.insole(foot)
        insoles[foot] = insole if insole.layout is not None else evolve(insole, layout=layout)
    parts = usual_parts(Modes(PressureTouchdown(), ModesSettings(heading=heading)))
    recipe = Recipe("marked walk", Cycle(), ErrorStateFilter(), parts=parts)
    session = Session(recipe, calibration=evolve(known, insoles=insoles))
    events = [*session.feed(walk.samples), *session.finish()]
    return sorted([event for event in events if isinstance(event, TouchedDown)], key=attrgetter("t"))


def step_errors(marks: Iterable[ModeMark], downs: list[TouchedDown], turn: float | None = None) -> list[StepError]:
    """Return the error of every step to the last of four consecutive marked touchdowns of alternate feet.

    The first two touchdowns serve to compute the direction of walking. `turn` is the angle from the session's frame to
    that of the marks, rad; None fits it to the steps, and with it what turns every step of the wearer by the same
    angle. Raises CalibrationError when a mark has no touchdown, or two marks have the same one."""
    mark_of: dict[int, ModeMark] = {}
    for mark in marks:
        k = _touchdown_index(mark, downs)
        if k in mark_of:
            raise CalibrationError(f"{mark.where}: the same touchdown as at {mark_of[k].where}")
        mark_of[k] = mark
    steps = []
    for k in range(3, len(downs)):
        four = [mark_of[j] for j in range(k - 3, k + 1) if j in mark_of]
        if len(four) < 4 or any([one.foot is next_one.foot for one, next_one in pairwise(four)]):
            continue
        earliest, earlier, before, newest = four
        # the line through two touchdowns of one foot is the direction between them: for this foot one step before the
        # end, for the other foot two steps before; extrapolate to half a step before
        direction = atan2(newest.y - earlier.y, newest.x - earlier.x)
        direction += 0.5 * wrap_angle(direction - atan2(before.y - earliest.y, before.x - earliest.x))
        true = complex(newest.x - before.x, newest.y - before.y)
        (x, y, _), (px, py, _) = downs[k].position, downs[k - 1].position
        steps.append((newest, true, complex(x - px, y - py), direction))
    if turn is None:  # by least squares over all steps
        products = [true * measured.conjugate() for _, true, measured, _ in steps]
        turn = atan2(fsum([one.imag for one in products]), fsum([one.real for one in products]))
    errors = []
    for reached, true, measured, direction in steps:
        error = (true - measured * rect(1.0, turn)) * rect(1.0, -direction)
        errors.append(StepError(reached.foot, reached.mode, error.real, error.imag))
    return errors


def mean_errors(errors: Iterable[StepError]) -> dict[Foot, dict[WalkingMode, Vec2]]:
    """Return the mean errors (forward, left), m, by foot and mode."""
    errors_of: dict[Foot, dict[WalkingMode, list[StepError]]] = {}
    for error in errors:
        errors_of.setdefault(error.foot, {}).setdefault(error.mode, []).append(error)
    return {
        foot: {
            mode: (fsum([e.forward for e in of]) / len(of), fsum([e.left for e in of]) / len(of))
            for mode, of in errors_of[foot].items()
        }
        for foot in Foot
        if foot in errors_of
    }


def fit_modes(
    walks: Iterable[tuple[DecodedRecording, Path | str]], known: Calibration | None = None, heading: float | None = None
) -> Calibration:
    """Return a calibration that contains the compensation from marked walks.

    Each walk is a recording and its csv file of marks (`read_marks`). `known` has the wearer's limbs and insoles.
    `heading` is the direction, rad, that the wearer faces at the start of each walk, in the world that the sensors
    share; x of the marks must be that direction. None takes the direction of the first step, which must then be
    straight, and marks in any frame; so do feet without body sensors, whose own tracks know no north. Raises
    CalibrationError when a walk has no four consecutive marks."""
    known = Calibration() if known is None else known
    errors: list[StepError] = []
    for walk, path in walks:
        has_north = heading is not None and any([sample.site.foot is None for sample in walk.samples])
        turn = 0.0 if has_north else None
        walk_errors = step_errors(read_marks(path), touchdowns(walk, known, heading), turn)
        if not walk_errors:
            raise CalibrationError(f"{path}: no four marks one after the other, left and right in turn")
        errors += walk_errors
    return Calibration(modes=mean_errors(errors))


def _touchdown_index(mark: ModeMark, downs: list[TouchedDown]) -> int:
    foot_indices = [k for k, down in enumerate(downs) if down.foot is mark.foot]
    if mark.t is not None:
        away, nearest = min([(abs(downs[k].t - mark.t), k) for k in foot_indices], default=(inf, 0))
        if away > MARK_TOLERANCE:
            raise CalibrationError(f"{mark.where}: the {mark.foot.value} foot did not come down at {mark.t:g} s")
        return nearest
    if mark.step is None or mark.step > len(foot_indices):
        raise CalibrationError(f"{mark.where}: the {mark.foot.value} foot came down {len(foot_indices)} times only")
    return foot_indices[mark.step - 1]
