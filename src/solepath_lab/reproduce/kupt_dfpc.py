"""Chen et al. 2019: 20 walks of 20 m, and 91 m through a building, with two smart insoles at 30 Hz.

The shoes are worn ones: they bend elsewhere than in the postures, land softly and slide (emulate/wearers/soles/). Our
additions to the printed method are rows of the table, one after the other, for both feet together; ZUPT has rows with
the same additions, so that the difference is what the known velocity is worth. A block of rows changes one thing at a
time about shoe and sensors (`SETTINGS`). The law by which the load moves in bends is changed in the corridor, because
straight walks have no bends.

Each walk has another pair of insoles, for which the shoe is measured in five postures, three times each (section
III-C). A recording has 20 s of walking to measure the pressure noise (section III-B), a halt, and then the 20 m. The
sessions receive only the samples after the halt. Distances are the sums of stride lengths, as in section IV-B. In the
corridor the drift is the error of that sum, as in section IV-C. The paper does not give the corridor's shape; here it
goes once around the inner block of a floor (solepath_lab/emulated/laps.py)."""

from __future__ import annotations

import numpy as np
from attrs import frozen

from solepath.emulate.wearers.truth import Truth
from solepath.events import Event, StrideFused
from solepath.papers.kupt_dfpc.recipe import KUPT, KUPT_DFPC, KUPT_DFPC_PRINTED, ZUPT
from solepath.recipes import Recipe
from solepath.types import Foot
from solepath.validate.alignment import Floats

from .contour.runs import sign_test
from .kupt.figures import coverage, panels, watch
from .kupt.walks import (
    ABLATIONS,
    BY_ERROR_INDEX,
    CORRIDOR_LENGTH,
    OTHER_LAW,
    RATE,
    SAME_ADDITIONS,
    SETTINGS,
    STANDARD,
    WALK_LENGTH,
    PreparedWalk,
    Setting,
    prepare,
)  # fmt: skip
from .published import PUBLISHED, rows_of
from .runner import Runner
from .tables import (
    BoxPlots,
    DrawStyle,
    FigureRow,
    PictureTrack,
    Plot,
    Reproduction,
    Values,
    WalkResults,
    pooled,
    row_of,
)
from .walks import align_track, final_strides, run_session, thin_out

NAME = KUPT_DFPC.name
WALKS = 20
WALKS_PER_CORRIDOR = 4
"""Number of walks of 20 m for each corridor walk. The paper has a single corridor walk, too few for a mean."""
FOOT_LETTERS = {Foot.LEFT: "L", Foot.RIGHT: "R"}
TRUE = {foot: f"true {letter}" for foot, letter in FOOT_LETTERS.items()}
"""Names of the true distances."""
PAPER, PAPER_ROWS = PUBLISHED[NAME], rows_of(NAME)
TABLE_I = ("ZUPT-L", "ZUPT-R", "KUPT-L", "KUPT-R", "KUPT+DFPC")
"""Rows of table I and of fig. 12."""
PRINTED_ROWS = ("KUPT-L, printed", "KUPT-R, printed", "KUPT+DFPC, printed")
SAME_ROW, SAME_FUSED_ROW = "ZUPT (+ bias)", "ZUPT+DFPC, same additions"
"""Rows of ZUPT with all our additions to KUPT, of both feet and of their fusion."""
COVERAGE_ROWS = ("known by ZUPT %", "known by KUPT %")


@frozen
class KuptJob:
    """One walk to emulate."""

    seed: int
    corridor: bool = False
    """True for a walk of CORRIDOR_LENGTH, False for one of WALK_LENGTH."""
    setting: Setting = STANDARD
    """Shoe and sensors."""
    drawn: bool = False
    """True for the walk of figs. 11 and 14."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` walks of 20 m, and of one corridor walk for every WALKS_PER_CORRIDOR of them."""
    count = WALKS if walks is None else walks
    corridors = max(1, count // WALKS_PER_CORRIDOR)
    laws = (STANDARD, OTHER_LAW)
    jobs = [KuptJob(1000 * seed + 500 + k, corridor=True, setting=law) for law in laws for k in range(corridors)]
    jobs += [KuptJob(1000 * seed + k, drawn=k == 1) for k in range(1, count + 1)]
    jobs += [KuptJob(1000 * seed + k, setting=setting) for setting in SETTINGS for k in range(1, count + 1)]
    results = runner.run(walk, jobs, _describe)
    corridor_walks, results = results[: len(laws) * corridors], results[len(laws) * corridors :]
    short_walks = results[:count]
    rows = []
    for number, start in enumerate(["", *(f"{setting.name}: " for setting in SETTINGS)]):
        walks_of_setting = results[number * count :][:count]
        for name in walks_of_setting[0].values:
            if name not in TRUE.values():
                digits = 1 if name in COVERAGE_ROWS else 2
                rows.append(row_of(PAPER_ROWS, start + name, pooled(walks_of_setting, name), digits))
    return Reproduction(
        name=NAME,
        paper_title=PAPER["title"],
        emulation=f"{count} walks of {WALK_LENGTH:g} m at {RATE:g} Hz, another pair of insoles each time",
        unit="m",
        rows=tuple(rows),
        panels=(
            BoxPlots(f"distance of {count} walks of {WALK_LENGTH:g} m (fig. 12)", TABLE_I, "m", WALK_LENGTH),
            *corridor_walks[0].panels,
            *short_walks[0].panels,
        ),
        notes=(
            *_notes(rows, short_walks),
            *_corridor_notes("", corridor_walks[:corridors]),
            *_corridor_notes(f" with {OTHER_LAW.name}", corridor_walks[corridors:]),
            f"The paper contradicts itself: the mean of KUPT-L is {PAPER_ROWS['KUPT-L'].mean} m in table I "
            f"and {PAPER['KUPT-L-in-text']} m in the text below it.",
        ),
    )


def _describe(one: WalkResults) -> str:
    return ", ".join(f"{name} {one.values[name][0]:.2f}" for name in TABLE_I) + " m"


def _notes(rows: list[FigureRow], short_walks: list[WalkResults]) -> list[str]:
    off = {row.name: np.array(row.values) - WALK_LENGTH for row in rows if row.name not in COVERAGE_ROWS}
    squares = {name: float(np.sqrt(np.mean(of**2))) for name, of in off.items()}
    own = [f"{name} {of:.2f}" for name, of in squares.items() if ": " not in name]
    lines = [f"Root mean square of the error of {len(short_walks)} walks, m: {', '.join(own)}."]
    for setting in SETTINGS:
        start = f"{setting.name}: "
        of_setting = {name.removeprefix(start): of for name, of in squares.items() if name.startswith(start)}
        zero, known = (sum([of_setting[f"{one}-{letter}"] ** 2 for letter in "LR"]) ** 0.5 for one in ("ZUPT", "KUPT"))
        found = ", ".join([f"{name} {of:.2f}" for name, of in of_setting.items()])
        lines.append(f"With {setting.name}: {found}; KUPT over ZUPT, both feet: {known / zero:.2f}.")
    lines.append(f"The feet really went {np.mean(pooled(short_walks, *TRUE.values())):.2f} m on average.")
    test = sign_test(np.abs(off["KUPT (+ bias)"]), np.abs(off[SAME_ROW]))
    lines.append(
        f"The known velocity alone: KUPT errs less than ZUPT with the same additions in {test.smaller} of {test.pairs} "
        f"walks of a foot (sign test, p = {test.probability:.2g})."
    )
    return lines


def _corridor_notes(condition: str, walks: list[WalkResults]) -> list[str]:
    lines = []
    for name, drift in PAPER["corridor"].items():
        feet = [true for foot, true in TRUE.items() if name.endswith(f"-{FOOT_LETTERS[foot]}")] or list(TRUE.values())
        off = np.array([one.values[name][0] - np.mean(pooled([one], *feet)) for one in walks])
        shares = 100.0 * np.abs(off) / CORRIDOR_LENGTH
        lines.append(
            f"{CORRIDOR_LENGTH:g} m of corridors{condition}, {name}: distance off by "
            f"{', '.join(f'{one:+.2f}' for one in off)} m, {shares.mean():.2f} % of it on average, "
            f"{shares.max():.2f} % at worst, end {np.mean(pooled(walks, f'end: {name}')):.2f} m from the start of this "
            f"closed way; paper {drift:.2f} m, {100.0 * drift / CORRIDOR_LENGTH:.2f} %."
        )
    return lines


def walk(job: KuptJob) -> WalkResults:
    """Emulate one walk, calibrate on its first part and run each recipe on the second.

    Values are measured distances by row, m, of both feet in a row of both, and true ones (`TRUE`). A corridor walk,
    which is a closed loop, has distances from the start to the end of tracks, "end: ROW", m."""
    prepared = prepare(job.seed, job.setting, job.corridor)
    zupt, known = _run(ZUPT, prepared), _run(KUPT_DFPC, prepared)
    distances: Values = {
        f"{name}-{letter}": (distance,)
        for name, events in (("ZUPT", zupt), ("KUPT", known))
        for letter, distance in zip("LR", _distances(events), strict=True)
    }
    distances["KUPT+DFPC"] = (_fused_distance(known),)
    distances |= {name: (prepared.true_distance(foot),) for foot, name in TRUE.items()}
    if job.corridor:
        tracks, ends = _tracks(prepared.walk.truth, prepared.t_halt, zupt, known)
        title = f"{CORRIDOR_LENGTH:g} m of corridors (fig. 13)"
        return WalkResults(distances | ends, (Plot(title, tracks, marks=(("start", 0.0, 0.0),)),))
    same = _run(SAME_ADDITIONS, prepared)
    distances[SAME_ROW] = _distances(same)
    distances[SAME_FUSED_ROW] = (_fused_distance(same),)
    if not job.setting.with_additions:
        return WalkResults(distances)
    printed = _run(KUPT_DFPC_PRINTED, prepared)
    for name, distance in zip(PRINTED_ROWS, (*_distances(printed), _fused_distance(printed)), strict=True):
        distances[name] = (distance,)
    for name, recipe in ABLATIONS.items():
        distances[name] = _distances(known if recipe is KUPT else _run(recipe, prepared))
    by_index = _run(BY_ERROR_INDEX, prepared)
    distances[BY_ERROR_INDEX.name] = (_fused_distance(by_index),)
    if job.setting != STANDARD:
        return WalkResults(distances)
    seen = watch(prepared.parts.after, prepared.calibration)
    for name, shares in zip(COVERAGE_ROWS, zip(*[coverage(seen[foot]) for foot in Foot], strict=True), strict=True):
        distances[name] = shares
    drawn = panels(seen, {"ZUPT": zupt, "KUPT+DFPC": known}, by_index) if job.drawn else ()
    return WalkResults(distances, drawn)


def _run(recipe: Recipe, prepared: PreparedWalk) -> list[Event]:
    return run_session(recipe, prepared.parts.after, prepared.calibration)


def _distances(events: list[Event]) -> tuple[float, ...]:
    """Return the sums of the stride lengths of both feet, m."""
    return tuple([sum([stride.length for stride in final_strides(events, foot)]) for foot in Foot])


def _fused_distance(events: list[Event]) -> float:
    return next((event.distance for event in reversed(events) if isinstance(event, StrideFused)), 0.0)


def _tracks(truth: Truth, t_halt: float, zupt: list[Event], known: list[Event]) -> tuple[list[PictureTrack], Values]:
    """Return tracks of stride ends, aligned with the truth over two metres, and distances from start to end, m."""
    ends = {
        f"ZUPT-{letter}": [(stride.t_end, foot, stride.position) for stride in final_strides(zupt, foot)]
        for foot, letter in FOOT_LETTERS.items()
    }
    # after each stride the position is the end of the chosen foot's path, which changes only at that foot's strides
    ends["KUPT+DFPC"] = [
        (one.t, one.foot, one.position) for one in known if isinstance(one, StrideFused) and one.foot is one.chosen
    ]
    path = _true_path(truth, t_halt)
    start = path[0].copy()
    tracks, distances = [PictureTrack("true path", thin_out(path - start), DrawStyle.TRUTH)], Values()
    for name, places in ends.items():
        if len(places) < 2:
            continue
        track = np.array([(0.0, 0.0), *((x, y) for _, _, (x, y, _) in places)])
        true = np.array(
            [_true_places(truth, foot, t)[0] for t, foot in [(t_halt, places[0][1]), *(p[:2] for p in places)]]
        )
        tracks.append(PictureTrack(name, thin_out(align_track(track, true) - start), DrawStyle.DOTS))
        distances[f"end: {name}"] = (float(np.linalg.norm(track[-1] - track[0])),)
    return tracks, distances


def _true_places(truth: Truth, foot: Foot, t: float | Floats) -> Floats:
    """Return the true positions (x, y) of the foot's sensor on the floor at `t` s, (n, 2), m."""
    places: Floats = truth.pose(foot, t).position[:, :2] + truth.feet[foot].origin[:2]
    return places


def _true_path(truth: Truth, t_halt: float) -> Floats:
    """Return the true path midway between the feet from `t_halt` on, (n, 2), m."""
    t = np.arange(t_halt, truth.duration, 0.2)
    left, right = (_true_places(truth, foot, t) for foot in Foot)
    middle: Floats = 0.5 * (left + right)
    return middle
