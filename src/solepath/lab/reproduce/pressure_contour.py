"""Bebek et al. 2010: six half-hour walks that end where they start, a boot with 24 cells and an IMU in its heel.

Each walk is one recording: laps of the calibration square on marked steps, a halt, and the half hour (fig. 13). The
calibration comes from the laps, for each recipe from its own positions ("the same ZUPT'ing and calibration techniques
are applied"); the sessions receive the samples after the halt. A loop-closing error is the horizontal distance between
a track's start and its end.

Lengths are those of table I. The paper says that the fourth walk was the square and the fifth random; here walks that
fit into half an hour at PACE are rounds of the square and longer ones random. The wearer's pace is that of the
calibration walks, 235 m in five minutes, or faster where the half hour requires it; in the rest of the half hour the
wearer stands. The rate of the samples is not in the paper."""

from __future__ import annotations

from math import atan2, cos, sin
from operator import attrgetter

import numpy as np
from attrs import evolve, frozen

from ...calibration import Calibration, merged
from ...emulate.routes.laps import field_walk, square
from ...emulate.routes.route import Route, Stand
from ...emulate.sensors.insole_device import boot
from ...emulate.walk import EmulatedWalk, emulate
from ...events import StrideTaken
from ...papers.pressure_contour.recipe import GYROSCOPE, PRESSURE_CONTOUR
from ...papers.pressure_contour.square import square_drift
from ...types import SITE_OF_FOOT, Foot
from ..measures.alignment import Floats
from ..processes import Progress, run_jobs
from . import published
from .tables import Drawn, Floor, PictureTrack, Reproduction, row_of
from .walks import align_track, cut, join_routes, rest_after, run_session, thin_out

NAME = PRESSURE_CONTOUR.name
WALKS = 6
RATE = 50.0
"""Sampling rate, Hz (assumed)."""
HALF_HOUR = 1800.0
"""Duration of the paper's walks, s."""
LASTING = HALF_HOUR
"""Duration of each walk, s; the lengths of LOOPS scale with it."""
LAPS = 5
"""Number of laps of the calibration square; "four to six"."""
PACE = 0.8
"""Walking speed, m/s: 235 m in 5 min (section V-D); faster where the half hour requires it."""
FOOT = Foot.RIGHT
"""Foot that wears the boot (assumed)."""
RECIPES = {"Gyroscope": GYROSCOPE, "Pressure": PRESSURE_CONTOUR}
IN_FIGURES = {3: "square (fig. 14)", 4: "random walk (fig. 16)"}
"""Indices of the LOOPS that the paper draws, with their titles; these are walked first."""
ORDER = (*IN_FIGURES, 0, 1, 2, 5)
"""Indices of LOOPS in the order in which they are walked."""


@frozen
class ContourJob:
    """One half-hour walk, with the length of the entry `number` of LOOPS."""

    seed: int
    number: int
    lasting: float
    laps: int

    @property
    def square(self) -> bool:
        """True for rounds of the square, False for a random walk."""
        return published.LOOPS[self.number].distance < PACE * HALF_HOUR


@frozen
class ContourWalked:
    """Loop-closing errors by row, m, the walked `distance`, m, and the tracks, the true path first."""

    number: int
    distance: float
    closing: dict[str, float]
    tracks: tuple[PictureTrack, ...]


def reproduce(
    walks: int | None = None, seed: int = 1, *, processes: int = 1, progress: Progress | None = None
) -> Reproduction:
    """Return the results of `walks` half-hour walks."""
    count = WALKS if walks is None else walks
    jobs = [ContourJob(1000 * seed + k, ORDER[k % len(ORDER)], LASTING, LAPS) for k in range(count)]
    done = list(run_jobs(walk, jobs, processes=processes, progress=progress))
    paper = published.PRESSURE_CONTOUR
    rows = [row_of(paper, f"{name} m", [one.closing[name] for one in done]) for name in RECIPES]
    rows += [row_of(paper, f"{name} %", [100.0 * w.closing[name] / w.distance for w in done], 3) for name in RECIPES]
    panels = [Floor(IN_FIGURES[one.number], one.tracks, (("start", 0, 0),)) for one in done[: len(IN_FIGURES)]]
    return Reproduction(
        name=NAME,
        paper_title=published.PRESSURE_CONTOUR_TITLE,
        walked=f"{count} walks of {LASTING / 60.0:g} min at {RATE:g} Hz, another device each time",
        unit="loop-closing error",
        rows=tuple(rows),
        panels=tuple(panels),
        notes=_notes(done),
    )


def _notes(done: list[ContourWalked]) -> tuple[str, ...]:
    lines = []
    for one in sorted(done, key=attrgetter("number")):
        paper = published.LOOPS[one.number]
        ours = ", ".join(f"{name.lower()} {error:.2f} m" for name, error in one.closing.items())
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
    """Return the calibration laps with a halt of half a minute, and the whole route."""
    distance = published.LOOPS[job.number].distance * job.lasting / HALF_HOUR
    before = square(job.laps, speed=PACE).stand(28.0)
    if job.square:
        lap = square(1, speed=PACE)
        count = max(1, round(distance / lap.length))
        pause = max(1.0, job.lasting / count - lap.length / PACE)
        whole = before
        for _ in range(count):
            whole = join_routes(whole, evolve(lap, actions=(*lap.actions[1:-1], Stand(pause))))
        return before, whole
    after = field_walk(job.lasting, distance / job.lasting, job.seed)
    turned = after.end.heading
    return before, join_routes(before, after.turn(atan2(-sin(turned), cos(turned))).stand(2.0))


def walk(job: ContourJob) -> ContourWalked:
    """Emulate one half hour, calibrate on its laps and run either recipe on the rest."""
    before, whole = route_of(job)
    walked = emulate(whole, devices={SITE_OF_FOOT[FOOT]: boot(FOOT, RATE)}, seed=job.seed)
    halt = rest_after(walked.walker, before)
    parts = cut(walked, halt)
    ends = [step.t_end for step in walked.truth.steps(FOOT) if step.t_end > halt]
    path = thin_out(_places(walked, np.array([halt, *ends])))
    closing, tracks = {}, [PictureTrack("true path", path, Drawn.TRUTH)]
    for name, recipe in RECIPES.items():
        drift = square_drift(parts.before, foot=FOOT, recipe=recipe, calibration=parts.layouts).kept
        events = run_session(recipe, parts.after, merged(parts.layouts, Calibration(drift={FOOT: drift})))
        steps = [one for one in events if isinstance(one, StrideTaken) and one.final]
        track = np.array([(0.0, 0.0), *((x, y) for x, y, _ in (one.position for one in steps))])
        true = _places(walked, np.array([halt, *(one.t_end for one in steps)]))
        closing[name] = float(np.linalg.norm(track[-1] - track[0]))
        tracks.append(PictureTrack(name.lower(), thin_out(align_track(track, true, over=10.0))))
    return ContourWalked(job.number, whole.length - before.length, closing, tuple(tracks))


def _places(walked: EmulatedWalk, t: Floats) -> Floats:
    """Return (x, y) of the boot's sensor relative to its place at the first of these instants, m."""
    places: Floats = walked.truth.pose(FOOT, t).position[:, :2]
    places -= places[0].copy()
    return places
