"""Bebek et al. 2010: six half-hour walks that end where they start, a boot with 24 cells and an IMU in its heel.

Each walk is one recording: laps of the calibration square on marked footprints, a halt, and the half hour (fig. 13).
Each recipe is calibrated by its own positions in the laps ("the same ZUPT'ing and calibration techniques are applied").
The sessions receive only the samples after the halt. A loop-closing error is the horizontal distance between the start
and the end of a track.

The lengths of the walks are those of table I. The paper says that the fourth walk was laps of the square and that the
fifth was random. Here walks that fit into half an hour at PACE are laps of the square, and longer ones are random. The
wearer walks at PACE, or faster where the half hour requires it, and stands for the rest of the half hour. The paper
does not give the sampling rate."""

from __future__ import annotations

from math import atan2, cos, sin
from operator import attrgetter

import numpy as np
from attrs import evolve, frozen

from ...calibration import Calibration, merged
from ...emulate.routes.actions import Stand
from ...emulate.routes.laps import field_walk, square
from ...emulate.routes.route import Route
from ...emulate.sensors.insole_device import boot
from ...emulate.walk import EmulatedWalk, emulate
from ...events import StrideTaken
from ...papers.pressure_contour.recipe import GYROSCOPE, PRESSURE_CONTOUR
from ...papers.pressure_contour.square import square_drift
from ...types import SITE_OF_FOOT, Foot
from ..measures.alignment import Floats
from . import published
from .runner import Runner
from .tables import DrawStyle, FloorPanel, PictureTrack, Reproduction, row_of
from .walks import align_track, cut_walk, find_halt, join_routes, run_session, thin_out

NAME = PRESSURE_CONTOUR.name
WALKS = 6
RATE = 50.0
"""Sampling rate, Hz (assumed)."""
HALF_HOUR = 1800.0
"""Duration of the paper's walks, s."""
WALK_DURATION = HALF_HOUR
"""Duration of each emulated walk, s. Tests shorten it; the lengths of LOOPS are scaled with it."""
CALIBRATION_LAPS = 5
"""Number of laps of the calibration square; the paper has "four to six"."""
PACE = 0.8
"""Walking speed, m/s: that of the calibration walks, 235 m in 5 min (section V-D)."""
FOOT = Foot.RIGHT
"""Foot that wears the boot (assumed)."""
RECIPES = {"Gyroscope": GYROSCOPE, "Pressure": PRESSURE_CONTOUR}
FIGURE_TITLES = {3: "square (fig. 14)", 4: "random walk (fig. 16)"}
"""Titles of the walks that the paper draws, by their index in LOOPS. These are walked first."""
LOOP_ORDER = (*FIGURE_TITLES, 0, 1, 2, 5)
"""Indices of LOOPS in the order in which they are walked."""


@frozen
class ContourJob:
    """One half-hour walk to emulate, as long as LOOPS[number]; a shorter `duration`, s, shortens it in proportion."""

    seed: int
    number: int
    duration: float
    laps: int

    @property
    def square(self) -> bool:
        """True for laps of the square, False for a random walk."""
        return published.LOOPS[self.number].distance < PACE * HALF_HOUR


@frozen
class ContourResults:
    """The results of one half-hour walk."""

    number: int
    """Index in LOOPS."""
    distance: float
    """Length of the walk, m."""
    closing_errors: dict[str, float]
    """Loop-closing error by key of RECIPES, m."""
    tracks: tuple[PictureTrack, ...]
    """True path and then the track of each recipe."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` half-hour walks."""
    count = WALKS if walks is None else walks
    numbers = [LOOP_ORDER[k % len(LOOP_ORDER)] for k in range(count)]
    jobs = [ContourJob(1000 * seed + k, number, WALK_DURATION, CALIBRATION_LAPS) for k, number in enumerate(numbers)]
    results = runner.run(walk, jobs, _describe)
    paper = published.PRESSURE_CONTOUR
    rows = [row_of(paper, f"{name} m", [one.closing_errors[name] for one in results]) for name in RECIPES]
    for name in RECIPES:
        shares = [100.0 * one.closing_errors[name] / one.distance for one in results]
        rows.append(row_of(paper, f"{name} %", shares, 3))
    first = results[: len(FIGURE_TITLES)]
    panels = [FloorPanel(FIGURE_TITLES[one.number], one.tracks, (("start", 0, 0),)) for one in first]
    return Reproduction(
        name=NAME,
        paper_title=published.PRESSURE_CONTOUR_TITLE,
        emulation=f"{count} walks of {WALK_DURATION / 60.0:g} min at {RATE:g} Hz, another device each time",
        unit="loop-closing error",
        rows=tuple(rows),
        panels=tuple(panels),
        notes=_notes(results),
    )


def _describe(one: ContourResults) -> str:
    errors = ", ".join(f"{name.lower()} {error:.2f}" for name, error in one.closing_errors.items())
    return f"{one.distance:.0f} m, closing errors {errors} m"


def _notes(results: list[ContourResults]) -> tuple[str, ...]:
    lines = []
    for one in sorted(results, key=attrgetter("number")):
        paper = published.LOOPS[one.number]
        ours = ", ".join(f"{name.lower()} {error:.2f} m" for name, error in one.closing_errors.items())
        lines.append(
            f"Like experiment {one.number + 1}, {one.distance:.0f} m: {ours}; paper, {paper.distance:.0f} m: "
            f"gyroscope {paper.gyroscope:.2f} m, pressure {paper.pressure:.2f} m."
        )
    lines.append(
        "The paper's mean percentages, 0.40 and 0.35, are its mean errors over its mean distance; the table above has "
        "the means of its six percentages."
    )
    return tuple(lines)


def route_of(job: ContourJob) -> tuple[Route, Route]:
    """Return the route of the calibration laps with a halt of half a minute, and the whole route."""
    distance = published.LOOPS[job.number].distance * job.duration / HALF_HOUR
    laps = square(job.laps, speed=PACE).stand(28.0)
    if job.square:
        lap = square(1, speed=PACE)
        count = max(1, round(distance / lap.length))
        pause = max(1.0, job.duration / count - lap.length / PACE)
        whole = laps
        for _ in range(count):
            whole = join_routes(whole, evolve(lap, actions=(*lap.actions[1:-1], Stand(pause))))
        return laps, whole
    after = field_walk(job.duration, distance / job.duration, job.seed)
    heading = after.end.heading
    return laps, join_routes(laps, after.turn(atan2(-sin(heading), cos(heading))).stand(2.0))


def walk(job: ContourJob) -> ContourResults:
    """Emulate one half hour, calibrate each recipe on the laps and run it on the rest."""
    laps, whole = route_of(job)
    walked = emulate(whole, devices={SITE_OF_FOOT[FOOT]: boot(FOOT, RATE)}, seed=job.seed)
    t_halt = find_halt(walked.walker, laps)
    parts = cut_walk(walked, t_halt)
    ends = [one.t_end for one in walked.truth.strides(FOOT) if one.t_end > t_halt]
    path = thin_out(_true_positions(walked, np.array([t_halt, *ends])))
    closing_errors, tracks = {}, [PictureTrack("true path", path, DrawStyle.TRUTH)]
    for name, recipe in RECIPES.items():
        drift = square_drift(parts.before, foot=FOOT, recipe=recipe, calibration=parts.layouts).kept
        events = run_session(recipe, parts.after, merged(parts.layouts, Calibration(drift={FOOT: drift})))
        strides = [event for event in events if isinstance(event, StrideTaken) and event.final]
        track = np.array([(0.0, 0.0), *((x, y) for x, y, _ in (stride.position for stride in strides))])
        true = _true_positions(walked, np.array([t_halt, *(stride.t_end for stride in strides)]))
        closing_errors[name] = float(np.linalg.norm(track[-1] - track[0]))
        tracks.append(PictureTrack(name.lower(), thin_out(align_track(track, true, over=10.0))))
    return ContourResults(job.number, whole.length - laps.length, closing_errors, tuple(tracks))


def _true_positions(walked: EmulatedWalk, t: Floats) -> Floats:
    """Return the true positions (x, y) of the boot's sensor at `t` (n,) s, relative to the first one, (n, 2), m."""
    positions: Floats = walked.truth.pose(FOOT, t).position[:, :2]
    positions -= positions[0].copy()
    return positions
