"""Liu et al. 2015: wearers with a 20 Hz SensorTag in each insole, in a building of 56 m by 63 m, without radio anchors.

The experiments of fig. 13 are repeated (footstep/): a corridor of 63 m measured by one foot, by the stature and by both
feet (b), stride lengths (c), activities (a), turns (d, e), and the place on the floor plan (f to h). The shoes are worn
ones: they flex and slip. Our additions to the stride length are rows, one after the other; a block of rows changes one
thing at a time about shoe, sensors, radio and air. Most results of the paper are drawn and not printed; our rows of
them have no paper's figure beside them. The paper's "step" is the stride of one foot."""

from __future__ import annotations

from functools import partial
from math import degrees

from solepath.papers.footstep_tracker.recipe import FOOTSTEP_TRACKER
from solepath.types import Turn

from .footstep.activities import score_activities
from .footstep.corridor import score_corridor
from .footstep.figures import mean, mean_series, panels
from .footstep.places import score_places
from .footstep.turning import TURN_ANGLES, score_turns
from .footstep.wearers import SETTINGS, STANDARD, WearerJob
from .published import PUBLISHED, rows_of
from .runner import Runner
from .tables import Claim, Reproduction, Values, WalkResults, claim, pooled, row_of

NAME = FOOTSTEP_TRACKER.name
FIRST_SEED = 100_000
"""First seed of the wearers; training uses only smaller seeds (lab/train/emulated.py)."""
WEARERS = 8
"""Number of wearers; section V-E: "we invited eight different users"."""
OF_SETTING = (
    "corridor, one foot %", "corridor, two feet %", "strides, one foot %", "strides, printed %", "activities %",
    "STAIRS_DOWN %",
)  # fmt: skip
"""Rows that each of SETTINGS has, as far as it is scored."""
NOT_ROWS = ("by stride", "by turn", *[turn.value for turn in Turn])
"""First words of the values that only notes and panels have."""
CLAIMS = (
    ("corridor, one foot: closing at rest errs less than as printed",
     "corridor, printed %", "corridor, closed at rest %", "%"),
    ("corridor, one foot: the offset takes some of it off", "corridor, closed at rest %", "corridor, + offset %", "%"),
    ("corridor, one foot: the clipped angles take some more off", "corridor, + offset %", "corridor, one foot %", "%"),
    ("corridor: two feet err less than one", "corridor, one foot %", "corridor, two feet %", "%"),
    ("corridor: two feet err less than the stature's rule", "corridor, by height %", "corridor, two feet %", "%"),
    ("corridor's end: our two feet err less than the one-metre rule",
     "corridor's end, one-metre rule %", "corridor's end, two feet %", "%"),
    ("a stride: the mean with the other foot's last one errs less", "step, one foot m", "step, two feet m", "m"),
    ("3 % of the packets lost: one foot errs more", "3 % lost: corridor, one foot %", "corridor, one foot %", "%"),
    ("3 % of the packets lost: the printed rule finds fewer strides",
     "strides, printed %", "3 % lost: strides, printed %", "%"),
    ("activities: more windows are right than as printed", "activities %", "activities, printed %", "%"),
    ("turns: the turn about the vertical errs less than (7)", "turn angle, printed deg", "turn angle, ours deg", "deg"),
    ("a circle: ours errs less than (7) and the printed filter", "circle, printed deg", "circle, ours deg", "deg"),
    ("case study: two feet are nearer than one", "place, case study, one foot m", "place, case study, ours m", "m"),
    ("case study: weights keep the true candidate more often than walls that drop",
     "true one kept, case study, ours %", "true one kept, case study, dropped at walls %", "%"),
    ("own ways: weights keep the true candidate more often than walls that drop",
     "true one kept, own ways, ours %", "true one kept, own ways, dropped at walls %", "%"),
    ("half-turn plan: a first heading brings the place nearer",
     "place, half-turn plan, no heading m", "place, half-turn plan, first heading m", "m"),
)  # fmt: skip
"""What docs/papers/footstep-tracker.md claims: a sentence, the row with the larger figures, the other one, the unit."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` wearers, each of whom does every experiment."""
    count = WEARERS if walks is None else walks
    seeds = [FIRST_SEED + 1000 * seed + k for k in range(count)]
    jobs = [WearerJob(one, setting) for setting in (STANDARD, *SETTINGS) for one in seeds]
    active = [job for job in jobs if job.setting.activities]
    corridors = runner.run(score_corridor, jobs, partial(_describe, "corridor, one foot %"))
    activities = runner.run(score_activities, active, partial(_describe, "activities %"))
    turns = runner.run(score_turns, jobs[:count], partial(_describe, "turn angle, ours deg"))
    places = runner.run(score_places, jobs[:count], partial(_describe, "place m"))
    wearers = [Values() for _ in seeds]
    scored = [*zip(jobs, corridors, strict=True), *zip(active, activities, strict=True)]
    for job, one in [*scored, *zip(jobs, turns, strict=False), *zip(jobs, places, strict=False)]:
        title = "" if job.is_standard else f"{job.setting.name}: "
        shown = [name for name in one.values if job.is_standard or name in OF_SETTING]
        wearers[seeds.index(job.seed)] |= {f"{title}{name}": one.values[name] for name in shown}
    results = [WalkResults(values) for values in wearers]
    names = [name for name in wearers[0] if not name.startswith(NOT_ROWS)]
    return Reproduction(
        name=NAME,
        paper_title=PUBLISHED[NAME]["title"],
        emulation=f"{count} wearers with a CC2541 at 20 Hz in each worn insole, two floors of 56 m by 63 m",
        unit="as named",
        rows=tuple([row_of(rows_of(NAME), name, pooled(results, name)) for name in names]),
        panels=panels(corridors[:count], activities[:count], turns, places),
        notes=_notes(results, turns),
        claims=tuple([_claim(wearers, *of) for of in CLAIMS]),
    )


def _describe(name: str, one: WalkResults) -> str:
    return f"{name} {mean(one.values[name]):.2f}"


def _claim(wearers: list[Values], sentence: str, more: str, less: str, unit: str) -> Claim:
    """Return a claim with the difference of the means of two rows of each wearer who has both."""
    both = [(mean(one[more]), mean(one[less])) for one in wearers if one[more] and one[less]]
    return claim(sentence, [a for a, _ in both], [b for _, b in both], unit)


def _notes(results: list[WalkResults], turns: list[WalkResults]) -> tuple[str, ...]:
    by_angle = zip(TURN_ANGLES, mean_series(turns, "turn angle, ours deg"), strict=True)
    return (
        f"By the printed formula {len(pooled(results, 'toe-out, printed deg'))} of {2 * len(results)} feet have a "
        "toe-out at all.",
        *[f"Turn {turn.value}: {mean(pooled(results, turn.value)):.1f} % right." for turn in Turn],
        "Mean error of the turn angle, degrees: "
        + ", ".join([f"{degrees(angle):.0f}: {error:.1f}" for angle, error in by_angle])
        + ".",
        "After how many steps it is decided is a matter of the building: six in the paper's, for one user.",
    )
