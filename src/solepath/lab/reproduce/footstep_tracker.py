"""Liu et al. 2015: wearers with a 20 Hz SensorTag in each insole, in a building of 56 m by 63 m, without radio anchors.

The experiments of fig. 13 are repeated (footstep_walks.py): activities (a), a corridor of 63 m measured by one foot, by
the wearer's stature and by both feet (b), stride lengths (c), turns (d, e), and the place on the floor plan (f to h).
Most results of the paper are drawn and not printed; our rows of them have no paper's figure beside them. The paper's
"step" is the stride of one foot."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from math import degrees

from ...emulate.routes.building import BUILDING
from ...papers.footstep_tracker.recipe import FOOTSTEP_TRACKER
from ...types import Activity, Turn
from ..measures.confusion import ActivityScore
from . import footstep_walks, published
from .footstep_walks import CORRIDOR_LENGTH, FootstepResults, score_wearer
from .runner import Runner
from .tables import DrawStyle, FloorPanel, PictureTrack, Reproduction, row_of

NAME = FOOTSTEP_TRACKER.name
FIRST_SEED = 100_000
"""First seed of the wearers; training uses only smaller seeds (lab/train/emulated.py)."""
WEARERS = 8
"""Number of wearers; section V-E: "we invited eight different users"."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` wearers, each of whom does every experiment."""
    count = WEARERS if walks is None else walks
    seeds = [FIRST_SEED + 1000 * seed + k for k in range(count)]
    results = runner.run(score_wearer, seeds, _describe)
    places = [place for one in results for place in one.places]
    rows = [
        _row("corridor, one foot %", [100.0 * one.one_foot_error / CORRIDOR_LENGTH for one in results]),
        _row("corridor, by height %", [100.0 * one.stature_error / CORRIDOR_LENGTH for one in results]),
        _row("corridor, two feet %", [100.0 * one.two_feet_error / CORRIDOR_LENGTH for one in results]),
        _row("step, one foot m", [abs(off) for one in results for off in one.one_foot_stride_errors]),
        _row("step, two feet m", [abs(off) for one in results for off in one.two_feet_stride_errors]),
        _row("activities %", [100.0 * (one.windows.accuracy or 0.0) for one in results]),
        _row("activities, as printed %", [100.0 * (one.printed_windows.accuracy or 0.0) for one in results]),
        _row("turn angle deg", [off for one in results for off in one.turn_errors.values()], digits=1),
        _row("turn classes %", [_share(one.classes.values()) for one in results]),
        _row("place m", [sum(place.off) / len(place.off) for place in places if place.off]),
        _row("steps until decided", [float(place.decided) for place in places if place.decided is not None], digits=0),
    ]
    return Reproduction(
        name=NAME,
        paper_title=published.FOOTSTEP_TRACKER_TITLE,
        emulation=f"{count} wearers with a CC2541 at 20 Hz in each insole, two floors of 56 m by 63 m",
        unit="as named",
        rows=tuple(rows),
        panels=tuple(_floor(one) for one in results[:1]),
        notes=_notes(results),
    )


def _describe(one: FootstepResults) -> str:
    places = [sum(place.off) / len(place.off) for place in one.places if place.off]
    return (
        f"corridor off by {one.two_feet_error:+.2f} m with two feet, {100.0 * (one.windows.accuracy or 0.0):.1f} % of "
        f"activities, places off by {', '.join(f'{place:.2f}' for place in places)} m"
    )


_row = partial(row_of, published.FOOTSTEP_TRACKER)


def _share(counts: Iterable[tuple[int, int]]) -> float:
    """Return the percentage of right answers in pairs of (number right, number of all)."""
    pairs = list(counts)
    return 100.0 * sum([n_right for n_right, _ in pairs]) / max(1, sum([of for _, of in pairs]))


def _floor(one: FootstepResults) -> FloorPanel:
    place = one.places[0]
    walls = tuple(PictureTrack("", (wall.start, wall.end), DrawStyle.TRUTH) for wall in BUILDING.levels[0].walls)
    candidates = PictureTrack("candidates", place.before, DrawStyle.DOTS)
    tracks = (*walls, candidates, PictureTrack("true path", place.path), PictureTrack("place", place.track))
    return FloorPanel("the way of fig. 15", tracks)


def _notes(results: list[FootstepResults]) -> tuple[str, ...]:
    lines = []
    windows = sum([one.windows for one in results], ActivityScore())
    printed = sum([one.printed_windows for one in results], ActivityScore())
    for activity in Activity:
        count = sum(windows.reported_for(activity).values())
        if count:
            ours, as_printed = [
                100.0 * one.reported_for(activity).get(activity, 0) / count for one in (windows, printed)
            ]
            lines.append(f"{activity.value}: {ours:.1f} % of {count} windows right; as printed {as_printed:.1f} %.")
    for turn in Turn:
        pairs = [one.classes[turn] for one in results]
        lines.append(f"Turn {turn.value}: {_share(pairs):.1f} % right.")
    angles = [round(degrees(angle)) for angle in footstep_walks.TURN_ANGLES]
    by_angle = [(angle, [one.turn_errors[angle] for one in results]) for angle in angles]
    lines.append(
        "Mean error of the turn angle, degrees: " + ", ".join(f"{a}: {sum(v) / len(v):.1f}" for a, v in by_angle) + "."
    )
    places = [place for one in results for place in one.places]
    n_missing, n_wrong = sum([one.dropped > 0 for one in places]), sum([one.wrong > 0 for one in places])
    n_undecided = sum([place.decided is None for place in places])
    lines.append(
        f"Of {len(places)} walks on the plan, half along the way of the figure, the others along ways of their own: "
        f"the true candidate was missing at some step in {n_missing}, a wrong one was alone at some step in {n_wrong}, "
        f"and in {n_undecided} it never came down to the true one."
    )
    lines.append("After how many steps it is decided is a matter of the building: six in the paper's, for one user.")
    return tuple(lines)
