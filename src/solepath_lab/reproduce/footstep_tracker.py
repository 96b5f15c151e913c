"""Liu et al. 2015: wearers with a 20 Hz SensorTag in each insole, in a building of 56 m by 63 m, without radio anchors.

The experiments of fig. 13 are repeated (footstep/): a corridor of 63 m measured by one foot, by the stature and by both
feet (b), stride lengths (c), activities (a), turns (d, e), and the place on the floor plan (f to h). The shoes
are worn ones: they flex and slip. Our additions to the printed method are rows, one after the other; a block of rows
changes one thing at a time about shoe, sensors and air. Most results of the paper are drawn and not printed; our rows
of them have no paper's figure beside them. The paper's "step" is the stride of one foot."""

from __future__ import annotations

from functools import partial

from solepath.papers.footstep_tracker.recipe import FOOTSTEP_TRACKER
from solepath.types import Activity, Turn

from .footstep.activities import STAIRS, VARIANTS, ActivityResults, score_activities
from .footstep.corridor import CORRIDOR_LENGTH, CorridorResults, score_corridor
from .footstep.figures import CLASSES, class_shares, panels, share_right
from .footstep.places import PlaceResults, score_places
from .footstep.turning import TurnResults, score_turns
from .footstep.wearers import IN_WEATHER, LENGTH_RECIPES, SETTINGS, STANDARD, WearerJob
from .published import PUBLISHED, rows_of
from .runner import Runner
from .tables import FigureRow, Reproduction, row_of

NAME = FOOTSTEP_TRACKER.name
FIRST_SEED = 100_000
"""First seed of the wearers; training uses only smaller seeds (lab/train/emulated.py)."""
WEARERS = 8
"""Number of wearers; section V-E: "we invited eight different users"."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` wearers, each of whom does every experiment."""
    count = WEARERS if walks is None else walks
    seeds = [FIRST_SEED + 1000 * seed + k for k in range(count)]
    jobs = {setting.name: [WearerJob(one, setting) for one in seeds] for setting in (STANDARD, *SETTINGS, IN_WEATHER)}
    standard = jobs[STANDARD.name]
    others = [job for setting in SETTINGS for job in jobs[setting.name]]
    with_activities = [job for setting in (*SETTINGS, IN_WEATHER) if setting.activities for job in jobs[setting.name]]
    corridors = runner.run(score_corridor, standard + others, _describe_corridor)
    activities = runner.run(score_activities, standard + with_activities, _describe_activities)
    turns = runner.run(score_turns, standard, _describe_turns)
    places = runner.run(score_places, standard, _describe_places)
    rows = [
        *_corridor_rows(corridors[:count]),
        *_activity_rows(activities[:count]),
        *_turn_rows(turns),
        *_place_rows(places),
    ]
    for k, setting in enumerate(SETTINGS, 1):
        of_setting = corridors[k * count :][:count]
        rows.append(_row(f"{setting.name}: one foot %", _one_foot(of_setting, "ours")))
        rows.append(_row(f"{setting.name}: two feet %", _two_feet(of_setting, "ours")))
    for k, name in enumerate([one.name for one in (*SETTINGS, IN_WEATHER) if one.activities], 1):
        scores = [one.scores["ours"] for one in activities[k * count :][:count]]
        rows.append(_row(f"{name}: activities %", [100.0 * (one.accuracy or 0.0) for one in scores], 1))
        rows.append(_row(f"{name}: STAIRS_DOWN %", class_shares(scores, Activity.STAIRS_DOWN), 1))
    return Reproduction(
        name=NAME,
        paper_title=PUBLISHED[NAME]["title"],
        emulation=f"{count} wearers with a CC2541 at 20 Hz in each worn insole, two floors of 56 m by 63 m",
        unit="as named",
        rows=tuple(rows),
        panels=panels(corridors[:count], activities[:count], turns, places),
        notes=_notes(corridors[:count], activities[:count], turns, places),
    )


_row = partial(row_of, rows_of(NAME))


def _one_foot(corridors: list[CorridorResults], variant: str) -> list[float]:
    return [100.0 * abs(off) / CORRIDOR_LENGTH for one in corridors for off in one.one_foot[variant]]


def _two_feet(corridors: list[CorridorResults], variant: str) -> list[float]:
    return [100.0 * abs(one.two_feet[variant]) / CORRIDOR_LENGTH for one in corridors]


def _corridor_rows(corridors: list[CorridorResults]) -> list[FigureRow]:
    rows = [
        _row("corridor, one foot %", _one_foot(corridors, "ours")),
        _row("corridor, by height %", [100.0 * abs(one.stature) / CORRIDOR_LENGTH for one in corridors]),
        _row("corridor, two feet %", _two_feet(corridors, "ours")),
    ]
    for name in ("one foot", "one-metre rule", "two feet"):
        off = [100.0 * abs(off) / CORRIDOR_LENGTH for one in corridors for off in one.ends[name]]
        rows.append(_row(f"corridor's end, {name} %", off))
    for name in LENGTH_RECIPES:
        rows.append(_row(f"corridor, {name} %", _one_foot(corridors, name)))
        rows.append(_row(f"strides, {name} %", [one.strides_found[name] for one in corridors], 1))
    for name in ("one foot", "two feet"):
        rows.append(_row(f"step, {name} m", [abs(off) for one in corridors for off in one.stride_errors[name]]))
    rows += [
        _row("toe-out deg", [off for one in corridors for off in one.toe_outs], 1),
        _row("toe-out, printed deg", [off for one in corridors for off in one.toe_outs_printed], 1),
        _row("zones by the loose rule %", [100.0 * one.zones[0] / max(1, one.zones[1]) for one in corridors], 1),
        _row("zones within 0, 0, g %", [100.0 * one.literal[0] / max(1, one.literal[1]) for one in corridors], 1),
    ]
    return rows


def _activity_rows(activities: list[ActivityResults]) -> list[FigureRow]:
    rows = []
    for variant in VARIANTS:
        scores = [one.scores[variant] for one in activities]
        title = "" if variant == "ours" else f", {variant}"
        rows.append(_row(f"activities{title} %", [100.0 * (one.accuracy or 0.0) for one in scores]))
        for activity in CLASSES if variant in ("ours", "printed") else STAIRS:
            rows.append(_row(f"{activity.value}{title} %", class_shares(scores, activity), 1))
    return rows


def _turn_rows(turns: list[TurnResults]) -> list[FigureRow]:
    return [
        _row("turn angle deg", [off for one in turns for off in one.errors.values()], 1),
        _row("turn angle, (7) printed deg", [off for one in turns for off in one.printed_errors.values()], 1),
        _row("curve of 360 deg", [one.curve for one in turns], 1),
        _row("curve of 360, filter printed deg", [one.printed_curve for one in turns], 1),
        _row("turn classes %", [share_right(list(one.classes.values())) for one in turns]),
    ]


def _place_rows(places: list[PlaceResults]) -> list[FigureRow]:
    rows = []
    for name in places[0].scores:
        scores = [one.scores[name] for one in places]
        rows.append(_row(f"place, {name} m", [sum(one.off) / len(one.off) for one in scores if one.off]))
        kept = [100.0 if one.strides and not one.dropped else 0.0 for one in scores]
        rows.append(_row(f"true one kept, {name} %", kept, 1))
    decided = [one.scores["case study, two feet"].decided for one in places]
    rows.append(_row("steps until decided", [float(one) for one in decided if one is not None], 0))
    means = [one.scores["case study, two feet"].off for one in places]
    return [_row("place m", [sum(off) / len(off) for off in means if off]), *rows]


def _describe_corridor(one: CorridorResults) -> str:
    left, right = one.one_foot["ours"]
    return f"corridor off by {left:+.2f} and {right:+.2f} m with one foot, {one.two_feet['ours']:+.2f} m with two"


def _describe_activities(one: ActivityResults) -> str:
    return ", ".join([f"{100.0 * (of.accuracy or 0.0):.1f} % of activities {name}" for name, of in one.scores.items()])


def _describe_turns(one: TurnResults) -> str:
    return f"turns off by {sum(one.errors.values()) / len(one.errors):.1f} degrees"


def _describe_places(one: PlaceResults) -> str:
    off = {name: sum(of.off) / len(of.off) for name, of in one.scores.items() if of.off}
    return "places off by " + ", ".join([f"{of:.2f} m ({name})" for name, of in off.items()])


def _notes(
    corridors: list[CorridorResults], activities: list[ActivityResults], turns: list[TurnResults],
    places: list[PlaceResults],
) -> tuple[str, ...]:  # fmt: skip
    lines = []
    one_foot, two_feet = _one_foot(corridors, "ours"), _two_feet(corridors, "ours")
    ratio = _rms(two_feet) / _rms(one_foot)
    signed = [sum(one.one_foot["ours"]) / 2.0 for one in corridors]
    apart = [0.5 * (one.one_foot["ours"][0] - one.one_foot["ours"][1]) for one in corridors]
    lines.append(
        f"Corridor, two feet over one foot, RMS over {len(corridors)} pairs: {ratio:.2f}. The mean of both feet is off "
        f"by {sum(signed) / len(signed):+.2f} m on average; half of their difference is {_rms(apart):.2f} m (RMS), "
        f"which is what the mean takes away; {_rms(signed):.2f} m are common to both feet, which it does not."
    )
    n_angles = sum([len(one.toe_outs) for one in corridors])
    lines.append(
        f"Toe-out: {n_angles} angles are twice their error or more, {2 * len(corridors) - n_angles} are not; by the "
        f"printed formula {sum([len(one.toe_outs_printed) for one in corridors])} feet have an angle at all."
    )
    for turn in Turn:
        lines.append(f"Turn {turn.value}: {share_right([one.classes[turn] for one in turns]):.1f} % right.")
    angles = sorted(turns[0].errors)
    by_angle = [(angle, [one.errors[angle] for one in turns]) for angle in angles]
    lines.append(
        "Mean error of the turn angle, degrees: "
        + ", ".join([f"{a:.0f}: {sum(v) / len(v):.1f}" for a, v in by_angle])
        + "."
    )
    for name in places[0].scores:
        scores = [one.scores[name] for one in places]
        n_missing, n_wrong = sum([one.dropped > 0 for one in scores]), sum([one.wrong > 0 for one in scores])
        n_undecided = sum([one.decided is None for one in scores])
        lines.append(
            f"{name}: of {len(scores)} walks the true candidate was missing at some step in {n_missing}, a wrong one "
            f"was alone at some step in {n_wrong}, and in {n_undecided} it never came down to the true one."
        )
    lines.append("After how many steps it is decided is a matter of the building: six in the paper's, for one user.")
    return tuple(lines)


def _rms(values: list[float]) -> float:
    return float((sum([value * value for value in values]) / len(values)) ** 0.5)
