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
    SAME,
    SETTINGS,
    STANDARD,
    VARIANTS,
    WALK_LENGTH,
    PreparedWalk,
    Setting,
    prepare,
)  # fmt: skip
from .runner import Runner
from .tables import BoxPlots, DrawStyle, PictureTrack, Plot, Reproduction, Values, WalkResults, gathered
from .walks import final_strides, run_session, thin_out

NAME = KUPT_DFPC.name
WALKS = 20
WALKS_PER_CORRIDOR = 4
"""Number of walks of 20 m for each corridor walk. The paper has a single corridor walk, too few for a mean."""
TABLE_I = ("ZUPT-L", "ZUPT-R", "KUPT-L", "KUPT-R", "KUPT+DFPC")
"""Rows of table I and of fig. 12."""
CORRIDOR = "91 m of corridors: "
"""What stands before the rows of the corridor walks."""
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
    seeds = range(1000 * seed + 1, 1000 * seed + count + 1)
    jobs = {
        CORRIDOR: [KuptJob(1000 * seed + 500 + k, corridor=True) for k in range(max(1, count // WALKS_PER_CORRIDOR))],
        "": [KuptJob(one, drawn=one == seeds[0]) for one in seeds],
        **{f"{setting.name}: ": [KuptJob(one, setting=setting) for one in seeds] for setting in SETTINGS},
    }
    found = runner.run_blocks(walk, jobs, _describe)
    corridors = found.pop(CORRIDOR)
    title = f"distance of {count} walks of {WALK_LENGTH:g} m (fig. 12)"
    return Reproduction(
        name=NAME,
        emulation=f"{count} walks of {WALK_LENGTH:g} m at {RATE:g} Hz, another pair of insoles each time",
        unit="m",
        results=gathered({**found, CORRIDOR: corridors}),
        panels=(BoxPlots(title, TABLE_I, "m", WALK_LENGTH), *corridors[0].panels, *found[""][0].panels),
    )


def _describe(one: WalkResults) -> str:
    return ", ".join(f"{name} {one.values[name][0]:.2f}" for name in TABLE_I) + " m"


def walk(job: KuptJob) -> WalkResults:
    """Emulate one walk, calibrate on its first part and run each recipe on the second.

    Values are measured distances by row, m, of both feet in a row of both, and the sizes of their errors against what
    the feet really went, "(off) ROW", m. A corridor walk has these as rows, "drift, ROW", and, since it is a closed
    loop, distances from the start to the end of tracks, "end, ROW", m."""
    prepared = prepare(job.seed, job.setting, job.corridor)
    zupt, known = _run(ZUPT, prepared), _run(KUPT_DFPC, prepared)
    distances = _by_foot("ZUPT", zupt) | _with_fusion("KUPT", "", known)
    true = np.array([prepared.true_distance(foot) for foot in Foot])
    if job.corridor:
        tracks, ends = _tracks(prepared.walk.truth, prepared.t_halt, zupt, known)
        title = f"{CORRIDOR_LENGTH:g} m of corridors (fig. 13)"
        plot = Plot(title, tracks, marks=(("start", 0.0, 0.0),))
        return WalkResults(distances | _errors("drift, ", distances, true) | ends, (plot,))
    seen, printed = watch(prepared.parts.after, prepared.calibration)
    distances |= _with_fusion("KUPT", ", printed", printed)
    for name in VARIANTS if job.setting == STANDARD else (SAME,):
        distances[name] = _distances(_run(VARIANTS[name], prepared))
    values = distances | _errors("(off) ", distances, true)
    if job.setting == STANDARD:
        shares = zip(*[coverage(seen[foot]) for foot in Foot], strict=True)
        values |= dict(zip(COVERAGE_ROWS, shares, strict=True))
    return WalkResults(values, panels(seen, printed, zupt, known) if job.drawn else ())


def _run(recipe: Recipe, prepared: PreparedWalk) -> list[Event]:
    return run_session(recipe, prepared.parts.after, prepared.calibration)


def _distances(events: list[Event]) -> tuple[float, ...]:
    """Return the sums of the stride lengths of both feet, m."""
    return tuple([sum([stride.length for stride in final_strides(events, foot)]) for foot in Foot])


def _errors(start: str, distances: Values, true: np.ndarray) -> Values:
    """Return the sizes of the errors of distances; one of a single foot, or of both together, is against the mean."""
    return {
        f"{start}{name}": tuple(np.abs(np.subtract(of, true if len(of) > 1 else true.mean())).tolist())
        for name, of in distances.items()
    }


def _by_foot(name: str, events: list[Event], end: str = "") -> Values:
    return {f"{name}-{letter}{end}": (distance,) for letter, distance in zip("LR", _distances(events), strict=True)}


def _with_fusion(name: str, end: str, events: list[Event]) -> Values:
    """Return the distances of a recipe by each foot, by the fusion of both and by their mean, m."""
    fused = next((event.distance for event in reversed(events) if isinstance(event, StrideFused)), 0.0)
    mean = float(np.mean(_distances(events)))
    return _by_foot(name, events, end) | {f"{name}+DFPC{end}": (fused,), f"{name}{end}, mean of the feet": (mean,)}


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
    return tracks, {f"end, {name}": (hypot(*of[-1][:2]) if of else 0.0,) for name, of in ends.items()}
