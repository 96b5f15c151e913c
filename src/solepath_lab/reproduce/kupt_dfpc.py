"""Chen et al. 2019: 20 walks of 20 m, and 91 m through a building, with two smart insoles at 30 Hz.

The shoes are worn ones: they bend elsewhere than in the postures, land softly and slide (emulated/soles.py). Ours
without one addition, and ZUPT with all of them, have rows of their own, so that the difference is what the known
velocity is worth. A block of rows changes one thing at a time about shoe and sensors (`SETTINGS`).

Each walk has another pair of insoles, for which the shoe is measured in five postures, three times each (section
III-C). A recording has 20 s of walking to measure the pressure noise (section III-B), a halt, and then the 20 m. The
sessions receive only the samples after the halt. Distances are the sums of stride lengths, as in section IV-B. In the
corridor the drift is the error of that sum, as in section IV-C. The paper does not give the corridor's shape; here it
goes once around the inner block of a floor (solepath_lab/emulated/laps.py)."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

import numpy as np
from attrs import frozen

from solepath.emulate.wearers.truth import Truth
from solepath.events import Event, StrideFused
from solepath.papers.kupt_dfpc.recipe import KUPT_DFPC, ZUPT
from solepath.recipes import Recipe
from solepath.types import Foot
from solepath.types.vector import ZERO

from .kupt.figures import coverage, panels, watch
from .kupt.walks import (
    CORRIDOR_LENGTH,
    RATE,
    SETTINGS,
    STANDARD,
    VARIANTS,
    WALK_LENGTH,
    PreparedWalk,
    Setting,
    prepare,
)  # fmt: skip
from .published import PUBLISHED, rows_of
from .runner import Runner
from .tables import (
    BoxPlots,
    Claim,
    DrawStyle,
    PictureTrack,
    Plot,
    Reproduction,
    Values,
    WalkResults,
    claim,
    pooled,
    row_of,
)
from .walks import final_strides, run_session, thin_out

NAME = KUPT_DFPC.name
WALKS = 20
WALKS_PER_CORRIDOR = 4
"""Number of walks of 20 m for each corridor walk. The paper has a single corridor walk, too few for a mean."""
PAPER, PAPER_ROWS = PUBLISHED[NAME], rows_of(NAME)
TABLE_I = ("ZUPT-L", "ZUPT-R", "KUPT-L", "KUPT-R", "KUPT+DFPC")
"""Rows of table I and of fig. 12."""
TRUE = "true"
"""Name of the true distances of both feet."""
MEAN, SAME = "KUPT, mean of the feet", "ZUPT, same additions"
PRINTED, PRINTED_MEAN = "KUPT+DFPC, printed", "KUPT, printed, mean of the feet"
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
    """True for the walk of figs. 10, 11 and 14."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` walks of 20 m, and of one corridor walk for every WALKS_PER_CORRIDOR of them."""
    count = WALKS if walks is None else walks
    jobs = [KuptJob(1000 * seed + 500 + k, corridor=True) for k in range(max(1, count // WALKS_PER_CORRIDOR))]
    corridors = len(jobs)
    jobs += [
        KuptJob(1000 * seed + k, setting=setting, drawn=k == 1 and setting is STANDARD)
        for setting in (STANDARD, *SETTINGS)
        for k in range(1, count + 1)
    ]
    results = runner.run(walk, jobs, _describe)
    corridor_walks, results = results[:corridors], results[corridors:]
    of_setting = {
        f"{setting.name}: " if number else "": results[number * count :][:count]
        for number, setting in enumerate((STANDARD, *SETTINGS))
    }
    short_walks = of_setting[""]
    rows = [
        row_of(PAPER_ROWS, start + name, pooled(of, name), 1 if name in COVERAGE_ROWS else 2)
        for start, of in of_setting.items()
        for name in of[0].values
        if name != TRUE
    ]
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
        claims=(
            *[one for start, of in of_setting.items() for one in _claims(start, of)],
            *_addition_claims(short_walks),
            *_corridor_claims(corridor_walks),
        ),
        notes=(
            f"A claim compares magnitudes of errors, of a walk of {WALK_LENGTH:g} m where nothing else is said.",
            *_corridor_notes(corridor_walks),
            f"The paper contradicts itself: the mean of KUPT-L is {PAPER_ROWS['KUPT-L'].mean} m in table I "
            f"and {PAPER['KUPT-L-in-text']} m in the text below it.",
        ),
    )


def _describe(one: WalkResults) -> str:
    return ", ".join(f"{name} {one.values[name][0]:.2f}" for name in TABLE_I) + " m"


def _off(walks: Sequence[WalkResults], *names: str) -> list[float]:
    """Return the mean magnitude of the error of these rows in each walk, m, against what the feet really went."""
    off = []
    for one in walks:
        true = np.array(one.values[TRUE])
        pairs = [(one.values[name], true if len(one.values[name]) > 1 else true.mean()) for name in names]
        off.append(float(np.mean([np.abs(np.subtract(*pair)).mean() for pair in pairs])))
    return off


def _claims(start: str, walks: Sequence[WalkResults]) -> list[Claim]:
    """Return the comparisons that are made with every shoe and sensor."""
    zupt, kupt = _off(walks, "ZUPT-L", "ZUPT-R"), _off(walks, "KUPT-L", "KUPT-R")
    return [
        claim(f"{start}KUPT errs less than ZUPT", zupt, kupt),
        claim(f"{start}KUPT errs less than ZUPT with the same additions", _off(walks, SAME), kupt),
        claim(f"{start}KUPT as printed errs less than ZUPT", zupt, _off(walks, "KUPT-L, printed", "KUPT-R, printed")),
    ]


def _addition_claims(walks: Sequence[WalkResults]) -> list[Claim]:
    """Return what each addition and the fusion are worth on worn soles."""
    kupt = _off(walks, "KUPT-L", "KUPT-R")
    claims = [claim(f"KUPT errs less than {name}", _off(walks, name), kupt) for name in VARIANTS if name != SAME]
    for as_printed, fused, mean in (("", "KUPT+DFPC", MEAN), (" as printed", PRINTED, PRINTED_MEAN)):
        one_foot = _off(walks, *(f"KUPT-{letter}{', printed' if as_printed else ''}" for letter in "LR"))
        claims += [
            claim(f"KUPT+DFPC{as_printed} errs less than one foot", one_foot, _off(walks, fused)),
            claim(f"the mean of both feet{as_printed} errs less than one foot", one_foot, _off(walks, mean)),
            claim(f"KUPT+DFPC{as_printed} errs less than the mean of both feet", _off(walks, mean), _off(walks, fused)),
        ]
    return claims


def _corridor_claims(walks: Sequence[WalkResults]) -> list[Claim]:
    zupt, fused = _off(walks, "ZUPT-L", "ZUPT-R"), _off(walks, "KUPT+DFPC")
    mean = _off(walks, MEAN)
    name = f"{CORRIDOR_LENGTH:g} m of corridors: "
    return [
        claim(f"{name}KUPT+DFPC errs less than ZUPT", zupt, fused),
        claim(f"{name}KUPT+DFPC errs less than the mean of both feet", mean, fused),
    ]


def _corridor_notes(walks: Sequence[WalkResults]) -> list[str]:
    lines = []
    for name, drift in PAPER["corridor"].items():
        off = np.array(_off(walks, name))
        lines.append(
            f"{CORRIDOR_LENGTH:g} m of corridors, {name}: on average the distance is off by {off.mean():.2f} m, "
            f"{100.0 * off.mean() / CORRIDOR_LENGTH:.2f} %, at worst {100.0 * off.max() / CORRIDOR_LENGTH:.2f} %, "
            f"end {np.mean(pooled(walks, f'end: {name}')):.2f} m from the start of this closed way; paper "
            f"{drift:.2f} m, {100.0 * drift / CORRIDOR_LENGTH:.2f} %."
        )
    return lines


def walk(job: KuptJob) -> WalkResults:
    """Emulate one walk, calibrate on its first part and run each recipe on the second.

    Values are measured distances by row, m, of both feet in a row of both, and the true ones (`TRUE`). A corridor walk,
    which is a closed loop, has distances from the start to the end of tracks, "end: ROW", m."""
    prepared = prepare(job.seed, job.setting, job.corridor)
    zupt, known = _run(ZUPT, prepared), _run(KUPT_DFPC, prepared)
    distances: Values = {**_by_foot("ZUPT-{}", zupt), **_by_foot("KUPT-{}", known)}
    distances["KUPT+DFPC"] = (_fused_distance(known),)
    distances[MEAN] = (float(np.mean(_distances(known))),)
    distances[TRUE] = tuple([prepared.true_distance(foot) for foot in Foot])
    if job.corridor:
        tracks, ends = _tracks(prepared.walk.truth, prepared.t_halt, zupt, known)
        title = f"{CORRIDOR_LENGTH:g} m of corridors (fig. 13)"
        return WalkResults(distances | ends, (Plot(title, tracks, marks=(("start", 0.0, 0.0),)),))
    seen, printed = watch(prepared.parts.after, prepared.calibration)
    distances |= {**_by_foot("KUPT-{}, printed", printed), PRINTED: (_fused_distance(printed),)}
    distances[PRINTED_MEAN] = (float(np.mean(_distances(printed))),)
    for name in VARIANTS if job.setting == STANDARD else (SAME,):
        distances[name] = _distances(_run(VARIANTS[name], prepared))
    if job.setting == STANDARD:
        shares = zip(*[coverage(seen[foot]) for foot in Foot], strict=True)
        distances |= dict(zip(COVERAGE_ROWS, shares, strict=True))
    return WalkResults(distances, panels(seen, printed, zupt, known) if job.drawn else ())


def _run(recipe: Recipe, prepared: PreparedWalk) -> list[Event]:
    return run_session(recipe, prepared.parts.after, prepared.calibration)


def _distances(events: list[Event]) -> tuple[float, ...]:
    """Return the sums of the stride lengths of both feet, m."""
    return tuple([sum([stride.length for stride in final_strides(events, foot)]) for foot in Foot])


def _by_foot(name: str, events: list[Event]) -> Values:
    return {name.format(letter): (distance,) for letter, distance in zip("LR", _distances(events), strict=True)}


def _fused_distance(events: list[Event]) -> float:
    return next((event.distance for event in reversed(events) if isinstance(event, StrideFused)), 0.0)


def _tracks(truth: Truth, t_halt: float, zupt: list[Event], known: list[Event]) -> tuple[list[PictureTrack], Values]:
    """Return tracks of stride ends, which begin along the true way, and their distances from start to end, m."""
    ends = {
        f"ZUPT-{letter}": [stride.position for stride in final_strides(zupt, foot)]
        for letter, foot in zip("LR", Foot, strict=True)
    }
    # after each stride the position is the end of the chosen foot's path, which changes only at that foot's strides
    ends["KUPT+DFPC"] = [one.position for one in known if isinstance(one, StrideFused) and one.foot is one.chosen]
    t = np.arange(t_halt, truth.duration, 0.2)
    path = np.mean([truth.pose(foot, t).position + truth.feet[foot].origin for foot in Foot], axis=0)
    tracks = [PictureTrack("true path", thin_out(path - path[0]), DrawStyle.TRUTH)]
    tracks += [PictureTrack(name, thin_out([ZERO, *of]), DrawStyle.DOTS) for name, of in ends.items()]
    return tracks, {f"end: {name}": (hypot(*of[-1][:2]) if of else 0.0,) for name, of in ends.items()}
