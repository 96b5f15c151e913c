"""Liu et al. 2015: wearers with a 20 Hz SensorTag in each insole, in a building of 56 m by 63 m, without radio anchors.

The experiments of fig. 13 are repeated (footstep/): a corridor of 63 m measured by one foot, by the stature and by both
feet (b), stride lengths (c), activities (a), turns (d, e), and the place on the floor plan (f to h). The shoes
are worn ones: they flex and slip. Our additions to the printed method are rows, one after the other; a block of rows
changes one thing at a time about shoe, sensors and air. Most results of the paper are drawn and not printed; our rows
of them have no paper's figure beside them. The paper's "step" is the stride of one foot."""

from __future__ import annotations

from functools import partial
from math import degrees

from solepath.papers.footstep_tracker.recipe import FOOTSTEP_TRACKER
from solepath.types import Turn

from .footstep.activities import CLASSES, STAIRS, VARIANTS, score_activities, variant_title
from .footstep.corridor import CORRIDOR_LENGTH, score_corridor
from .footstep.figures import mean, mean_series, panels
from .footstep.places import score_places
from .footstep.turning import TURN_ANGLES, score_turns
from .footstep.wearers import IN_WEATHER, LENGTH_RECIPES, SETTINGS, STANDARD, WearerJob
from .published import PUBLISHED, rows_of
from .runner import Runner
from .tables import FigureRow, Reproduction, WalkResults, pooled, row_of

NAME = FOOTSTEP_TRACKER.name
FIRST_SEED = 100_000
"""First seed of the wearers; training uses only smaller seeds (lab/train/emulated.py)."""
TURN_ROWS = (
    "turn angle deg", "turn angle, (7) printed deg", "curve of 360 deg", "curve of 360, filter printed deg"
)  # fmt: skip
WEARERS = 8
"""Number of wearers; section V-E: "we invited eight different users"."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` wearers, each of whom does every experiment."""
    count = WEARERS if walks is None else walks
    seeds = [FIRST_SEED + 1000 * seed + k for k in range(count)]
    jobs = {setting.name: [WearerJob(one, setting) for one in seeds] for setting in (STANDARD, *SETTINGS, IN_WEATHER)}
    standard = jobs[STANDARD.name]
    others = [job for setting in SETTINGS for job in jobs[setting.name]]
    with_activities = [setting.name for setting in (*SETTINGS, IN_WEATHER) if setting.activities]
    activity_jobs = standard + [job for name in with_activities for job in jobs[name]]
    corridors = runner.run(score_corridor, standard + others, _describe_corridor)
    activities = runner.run(score_activities, activity_jobs, _describe_activities)
    turns = runner.run(score_turns, standard, lambda one: f"turns off by {mean(one.values[TURN_ROWS[0]]):.1f} degrees")
    places = runner.run(score_places, standard, _describe_places)
    rows = [
        *_corridor_rows(corridors[:count]),
        *_activity_rows(activities[:count]),
        *[_row(name, pooled(turns, name), 1) for name in TURN_ROWS],
        _row("turn classes %", [mean(pooled([one], *[turn.value for turn in Turn])) for one in turns]),
        *_place_rows(places),
    ]
    for k, setting in enumerate(SETTINGS, 1):
        of_setting = corridors[k * count :][:count]
        rows.append(_row(f"{setting.name}: one foot %", _shares(of_setting, "one foot: ours")))
        rows.append(_row(f"{setting.name}: two feet %", _shares(of_setting, "two feet")))
    for k, name in enumerate(with_activities, 1):
        for row in ("activities %", "STAIRS_DOWN %"):
            rows.append(_row(f"{name}: {row}", pooled(activities[k * count :][:count], row), 1))
    return Reproduction(
        name=NAME,
        paper_title=PUBLISHED[NAME]["title"],
        emulation=f"{count} wearers with a CC2541 at 20 Hz in each worn insole, two floors of 56 m by 63 m",
        unit="as named",
        rows=tuple(rows),
        panels=panels(corridors[:count], activities[:count], turns, places),
        notes=_notes(corridors[:count], turns),
    )


_row = partial(row_of, rows_of(NAME))


def _shares(corridors: list[WalkResults], name: str) -> list[float]:
    """Return the sizes of errors of a length as shares of that of the corridor, %."""
    return [100.0 * abs(off) / CORRIDOR_LENGTH for off in pooled(corridors, name)]


def _corridor_rows(corridors: list[WalkResults]) -> list[FigureRow]:
    shares = {"one foot": "one foot: ours", "by height": "by height", "two feet": "two feet"}
    rows = [_row(f"corridor, {name} %", _shares(corridors, key)) for name, key in shares.items()]
    for name in ("one foot", "one-metre rule", "two feet"):
        rows.append(_row(f"corridor's end, {name} %", _shares(corridors, f"end: {name}")))
    for name in LENGTH_RECIPES:
        rows.append(_row(f"corridor, {name} %", _shares(corridors, f"one foot: {name}")))
        rows.append(_row(f"strides, {name} %", pooled(corridors, f"strides, {name} %"), 1))
    for name in ("one foot", "two feet"):
        rows.append(_row(f"step, {name} m", map(abs, pooled(corridors, f"step: {name}"))))
    names = ("toe-out deg", "toe-out, printed deg", "zones by the loose rule %", "zones within 0, 0, g %")
    return rows + [_row(name, pooled(corridors, name), 1) for name in names]


def _activity_rows(activities: list[WalkResults]) -> list[FigureRow]:
    rows = []
    for variant in VARIANTS:
        title = variant_title(variant)
        rows.append(_row(f"activities{title} %", pooled(activities, f"activities{title} %")))
        for activity in CLASSES if variant in ("ours", "printed") else STAIRS:
            name = f"{activity.value}{title} %"
            rows.append(_row(name, pooled(activities, name), 1))
    return rows


def _place_rows(places: list[WalkResults]) -> list[FigureRow]:
    rows = [_row("place m", pooled(places, "place, case study, two feet m"))]
    names = [name for name in places[0].values if name.startswith(("place, ", "true one kept, "))]
    rows += [_row(name, pooled(places, name), 2 if name.startswith("place") else 1) for name in names]
    return [*rows, _row("steps until decided", pooled(places, "steps until decided"), 0)]


def _describe_corridor(one: WalkResults) -> str:
    left, right = one.values["one foot: ours"]
    return f"corridor off by {left:+.2f} and {right:+.2f} m with one foot, {one.values['two feet'][0]:+.2f} m with two"


def _describe_activities(one: WalkResults) -> str:
    return ", ".join([f"{name} {of[0]:.1f}" for name, of in one.values.items() if name.startswith("activities")])


def _describe_places(one: WalkResults) -> str:
    return ", ".join([f"{name} {of[0]:.2f}" for name, of in one.values.items() if name.startswith("place") and of])


def _notes(corridors: list[WalkResults], turns: list[WalkResults]) -> tuple[str, ...]:
    one_foot, two_feet = pooled(corridors, "one foot: ours"), pooled(corridors, "two feet")
    apart = [0.5 * (left - right) for left, right in (one.values["one foot: ours"] for one in corridors)]
    n_angles, n_printed = (len(pooled(corridors, name)) for name in ("toe-out deg", "toe-out, printed deg"))
    by_angle = zip(TURN_ANGLES, mean_series(turns, TURN_ROWS[0]), strict=True)
    return (
        f"Corridor, two feet over one foot, RMS over {len(corridors)} pairs: {_rms(two_feet) / _rms(one_foot):.2f}. "
        f"The mean of both feet is off by {mean(two_feet):+.2f} m on average; half of their difference is "
        f"{_rms(apart):.2f} m (RMS), which is what the mean takes away; {_rms(two_feet):.2f} m are common to both "
        f"feet, which it does not.",
        f"Toe-out: {n_angles} angles are twice their error or more, {2 * len(corridors) - n_angles} are not; by the "
        f"printed formula {n_printed} feet have an angle at all.",
        *[f"Turn {turn.value}: {mean(pooled(turns, turn.value)):.1f} % right." for turn in Turn],
        "Mean error of the turn angle, degrees: "
        + ", ".join([f"{degrees(angle):.0f}: {error:.1f}" for angle, error in by_angle])
        + ".",
        "After how many steps it is decided is a matter of the building: six in the paper's, for one user.",
    )


def _rms(values: list[float]) -> float:
    return float((sum([value * value for value in values]) / len(values)) ** 0.5)
