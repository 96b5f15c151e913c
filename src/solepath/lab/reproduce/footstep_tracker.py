"""Liu et al. 2015: wearers with a 20 Hz SensorTag in each insole, in a building of 56 m by 63 m, without any anchor.

The experiments of the paper are repeated here (footstep_walks.py): the 63 m corridor by one foot, by the common method
and by two feet (fig. 13 b), steps (c), activities (a), turns (d, e), and the place on the floor plan (f to h). Most
figures of the paper are drawn, not printed; their rows have no figure of the paper's."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from math import degrees

from ...emulate.routes.building import BUILDING
from ...papers.footstep_tracker.recipe import FOOTSTEP_TRACKER
from ...types import Activity, Turn
from ..measures.confusion import ActivityScore
from ..processes import Progress, run_jobs
from . import footstep_walks, published
from .footstep_walks import CORRIDOR, FootstepWalked, walked
from .tables import Drawn, Floor, PictureTrack, Reproduction, row_of

NAME = FOOTSTEP_TRACKER.name
FIRST = 100_000
"""First seed of the wearers; nothing was learnt from this one or later ones (lab/train/emulated.py)."""
WEARERS = 8
"""Number of wearers; section V-E: "we invited eight different users"."""


def reproduce(
    walks: int | None = None, seed: int = 1, *, processes: int = 1, progress: Progress | None = None
) -> Reproduction:
    """Return the results of `walks` wearers, each of whom walks every experiment."""
    count = WEARERS if walks is None else walks
    seeds = [FIRST + 1000 * seed + k for k in range(count)]
    done = list(run_jobs(walked, seeds, processes=processes, progress=progress))
    places = [place for one in done for place in one.places]
    rows = [
        _row("corridor, one foot %", [100.0 * one.one_foot / CORRIDOR for one in done]),
        _row("corridor, by height %", [100.0 * one.by_height / CORRIDOR for one in done]),
        _row("corridor, two feet %", [100.0 * one.two_feet / CORRIDOR for one in done]),
        _row("step, one foot m", [abs(off) for one in done for off in one.step_one]),
        _row("step, two feet m", [abs(off) for one in done for off in one.step_two]),
        _row("activities %", [100.0 * (one.windows.accuracy or 0.0) for one in done]),
        _row("turn angle deg", [off for one in done for off in one.turned.values()], digits=1),
        _row("turn classes %", [_share(one.classes.values()) for one in done]),
        _row("place m", [sum(place.off) / len(place.off) for place in places if place.off]),
        _row("steps until decided", [float(place.decided) for place in places if place.decided is not None], digits=0),
    ]
    return Reproduction(
        name=NAME,
        paper_title=published.FOOTSTEP_TRACKER_TITLE,
        walked=f"{count} wearers with a CC2541 at 20 Hz in each insole, two floors of 56 m by 63 m",
        unit="as named",
        rows=tuple(rows),
        panels=tuple(_floor(one) for one in done[:1]),
        notes=_notes(done),
    )


_row = partial(row_of, published.FOOTSTEP_TRACKER)


def _share(counts: Iterable[tuple[int, int]]) -> float:
    """Return the percentage right of (right, all) pairs."""
    pairs = list(counts)
    return 100.0 * sum([right for right, _ in pairs]) / max(1, sum([of for _, of in pairs]))


def _floor(one: FootstepWalked) -> Floor:
    place = one.places[0]
    walls = tuple(PictureTrack("", (wall.start, wall.end), Drawn.TRUTH) for wall in BUILDING.levels[0].walls)
    candidates = PictureTrack("candidates", place.before, Drawn.DOTS)
    tracks = (*walls, candidates, PictureTrack("true path", place.path), PictureTrack("place", place.track))
    return Floor("the way of fig. 15", tracks)


def _notes(done: list[FootstepWalked]) -> tuple[str, ...]:
    lines = []
    windows = sum([one.windows for one in done], ActivityScore())
    for activity in Activity:
        reported = windows.reported_for(activity)
        if reported:
            share = 100.0 * reported.get(activity, 0) / sum(reported.values())
            lines.append(f"{activity.value}: {share:.1f} % of {sum(reported.values())} windows right.")
    for turn in Turn:
        pairs = [one.classes[turn] for one in done]
        lines.append(f"Turn {turn.value}: {_share(pairs):.1f} % right.")
    angles = [round(degrees(angle)) for angle in footstep_walks.INCREMENTS]
    by_angle = [(angle, [one.turned[angle] for one in done]) for angle in angles]
    lines.append(
        "Mean error of the turn angle, degrees: " + ", ".join(f"{a}: {sum(v) / len(v):.1f}" for a, v in by_angle) + "."
    )
    places = [place for one in done for place in one.places]
    missing, alone = sum([one.dropped > 0 for one in places]), sum([one.wrong > 0 for one in places])
    never = sum([place.decided is None for place in places])
    lines.append(
        f"Of {len(places)} walks on the plan, half along the way of the figure, the others along ways of their own: "
        f"the true candidate was missing at some step in {missing}, a wrong one was alone at some step in {alone}, and "
        f"in {never} it never came down to the true one."
    )
    lines.append("After how many steps it is decided is a matter of the building: six in the paper's, for one user.")
    return tuple(lines)
