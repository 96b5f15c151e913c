"""Chen et al. 2019: 20 walks of 20 m, and 91 m through a building, with two smart insoles at 30 Hz.

Each walk has another pair of insoles, and the shoe is measured again in five postures, three times each (section
III-C). A recording is 20 s of walking for the pressure noise (section III-B), a halt, and then the 20 m; the sessions
receive the samples after the halt. Distances are the sums of stride lengths, as in section IV-B. For the corridor the
drift of that sum counts, as in section IV-C. The paper does not give the corridor's shape; here it is once around the
inner block of a floor (emulate/routes/laps.py)."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from attrs import field, frozen

from ...calibration import Calibration, merged
from ...emulate.routes.laps import corridor, straight
from ...emulate.routes.postures import postures, write_postures
from ...emulate.sensors.insole_device import Insole
from ...emulate.sensors.parts import WORN_RESISTIVE
from ...emulate.walk import emulate
from ...emulate.wearers.truth import Truth
from ...events import Event, StrideFused, StrideTaken
from ...papers.kupt_dfpc.noise import pressure_noise
from ...papers.kupt_dfpc.recipe import KUPT, KUPT_DFPC, ZUPT
from ...papers.kupt_dfpc.shoe import fit_shoe
from ...types import SITE_OF_FOOT, Foot
from ..measures.alignment import Floats
from ..processes import Progress, run_jobs
from . import published
from .tables import Boxes, Drawn, FigureRow, Floor, PictureTrack, Reproduction, row_of, statistics
from .walks import align_track, cut, join_routes, rest_after, run_session, thin_out

NAME = KUPT_DFPC.name
WALKS = 20
RATE = 30.0
"""Sampling rate, Hz (section III-A)."""
SPEED = 1.3
"""Comfortable walking speed, m/s."""
DISTANCE = 20.0
"""Length of a walk, m."""
CORRIDOR = 91.0
"""Length of the corridor walk, m (section IV-C)."""
EVERY = 4
"""Number of walks of 20 m for each corridor walk. The paper has one corridor walk, which is too few."""
NOISE_WALK = straight(20.0 * SPEED, SPEED).stand(4.0)
"""Walk of 20 s for the pressure noise, and a halt."""
FEET = {Foot.LEFT: "L", Foot.RIGHT: "R"}


@frozen
class KuptJob:
    """One walk; `corridor` makes it CORRIDOR m long instead of DISTANCE."""

    seed: int
    corridor: bool = False


@frozen
class KuptWalked:
    """Results of one walk.

    `distances` has the walked distance by row and `true` the real one of each foot, m. Only a corridor walk has
    `tracks`, the positions at which strides ended with the true path first, and `closing`, the distance of each end
    from its start, m."""

    distances: dict[str, float]
    true: dict[Foot, float]
    tracks: tuple[PictureTrack, ...] = ()
    closing: dict[str, float] = field(factory=dict)


def reproduce(
    walks: int | None = None, seed: int = 1, *, processes: int = 1, progress: Progress | None = None
) -> Reproduction:
    """Return the results of `walks` walks of 20 m, with one corridor walk for every EVERY of them, at least one."""
    count = WALKS if walks is None else walks
    corridors = max(1, count // EVERY)
    jobs = [KuptJob(1000 * seed + 500 + k, corridor=True) for k in range(corridors)]
    jobs += [KuptJob(1000 * seed + k) for k in range(1, count + 1)]
    done = list(run_jobs(walk, jobs, processes=processes, progress=progress))
    long, short = done[:corridors], done[corridors:]
    paper = published.KUPT_DFPC
    rows = tuple([row_of(paper, name, [one.distances[name] for one in short]) for name in paper])
    return Reproduction(
        name=NAME,
        paper_title=published.KUPT_DFPC_TITLE,
        walked=f"{count} walks of {DISTANCE:g} m at {RATE:g} Hz, another pair of insoles each time",
        unit="m",
        rows=rows,
        panels=(
            Boxes(f"distance of {count} walks of {DISTANCE:g} m (fig. 12)", tuple(paper), "m", DISTANCE),
            Floor(f"{CORRIDOR:g} m of corridors (fig. 13)", long[0].tracks, marks=(("start", 0.0, 0.0),)),
        ),
        notes=_notes(rows, short, long),
    )


def _notes(rows: tuple[FigureRow, ...], short: list[KuptWalked], long: list[KuptWalked]) -> tuple[str, ...]:
    squares = {row.name: np.mean([(value - DISTANCE) ** 2 for value in row.values]) for row in rows}
    off = ", ".join(f"{name} {float(np.sqrt(square)):.2f}" for name, square in squares.items())
    paths = statistics([one.true[foot] for one in short for foot in Foot])
    lines = [f"Root mean square of the error of {len(short)} walks, m: {off}."]
    lines.append(f"The feet really went {paths.mean:.2f} m on average.")
    for name, drift in published.CORRIDOR_DRIFT.items():
        off_by = [one.distances[name] - _true_distance(one, name) for one in long]
        share = 100.0 * float(np.mean(np.abs(off_by))) / CORRIDOR
        ends = float(np.mean([one.closing[name] for one in long]))
        lines.append(
            f"{CORRIDOR:g} m of corridors, {name}: distance off by {', '.join(f'{off:+.2f}' for off in off_by)} m, "
            f"{share:.2f} % of it on average, end {ends:.2f} m from the start of this closed way; paper "
            f"{drift:.2f} m, {100.0 * drift / CORRIDOR:.2f} %."
        )
    lines.append(
        f"The paper contradicts itself: the mean of KUPT-L is {published.KUPT_DFPC['KUPT-L'].mean} m in table I and "
        f"{published.KUPT_L_MEAN_IN_TEXT} m in the text below it."
    )
    return tuple(lines)


def _true_distance(one: KuptWalked, name: str) -> float:
    """Return the true distance of the foot of this row, m; the mean of both feet for a row of both."""
    feet = [foot for foot, letter in FEET.items() if name.endswith(f"-{letter}")] or list(Foot)
    return float(np.mean([one.true[foot] for foot in feet]))


def walk(job: KuptJob) -> KuptWalked:
    """Emulate one walk, calibrate on its first part and run each recipe on the second."""
    route = corridor(CORRIDOR, SPEED) if job.corridor else straight(DISTANCE, SPEED)
    walked = emulate(
        join_routes(NOISE_WALK, route),
        devices={SITE_OF_FOOT[foot]: Insole(rate=RATE, cell_part=WORN_RESISTIVE) for foot in Foot},
        seed=job.seed,
    )
    halt = rest_after(walked.walker, NOISE_WALK)
    parts = cut(walked, halt)
    known = merged(merged(parts.layouts, measured_shoe(job.seed)), pressure_noise(parts.before))
    events_of = {recipe.name: run_session(recipe, parts.after, known) for recipe in (ZUPT, KUPT, KUPT_DFPC)}
    distances = {
        f"{recipe.upper()}-{letter}": sum(s.length for s in _steps(events_of[recipe], foot))
        for recipe in ("zupt", "kupt")
        for foot, letter in FEET.items()
    }
    fused = [event for event in events_of[NAME] if isinstance(event, StrideFused)]
    distances["KUPT+DFPC"] = fused[-1].distance if fused else 0.0
    true = {foot: sum(step.length for step in walked.truth.steps(foot) if step.t_heel_off > halt) for foot in Foot}
    if not job.corridor:
        return KuptWalked(distances, true)
    tracks, closing = _tracks(walked.truth, halt, events_of["zupt"], fused)
    return KuptWalked(distances, true, tracks, closing)


def measured_shoe(seed: int) -> Calibration:
    """Return the calibration that rulers and static postures give for the shoe."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "postures.csv"
        write_postures(file, postures(seed=seed))
        return fit_shoe(file).calibration


def _steps(events: list[Event], foot: Foot) -> list[StrideTaken]:
    return [event for event in events if isinstance(event, StrideTaken) and event.final and event.foot is foot]


def _tracks(
    truth: Truth, halt: float, zupt: list[Event], fused: list[StrideFused]
) -> tuple[tuple[PictureTrack, ...], dict[str, float]]:
    """Return tracks of stride ends, aligned over their first two metres, and each end's distance from its start, m."""
    ends = {f"ZUPT-{FEET[foot]}": [(step.t_end, foot, step.position) for step in _steps(zupt, foot)] for foot in Foot}
    # the position after a stride is the end of the chosen foot's path, which does not change between its own strides
    ends["KUPT+DFPC"] = [(one.t, one.foot, one.position) for one in fused if one.foot is one.chosen]
    path = _true_path(truth, halt)
    start = path[0].copy()
    tracks, closing = [PictureTrack("true path", thin_out(path - start), Drawn.TRUTH)], {}
    for name, places in ends.items():
        if len(places) < 2:
            continue
        track = np.array([(0.0, 0.0), *((x, y) for _, _, (x, y, _) in places)])
        true = np.array(
            [_true_places(truth, foot, t)[0] for t, foot in [(halt, places[0][1]), *(p[:2] for p in places)]]
        )
        tracks.append(PictureTrack(name, thin_out(align_track(track, true) - start), Drawn.DOTS))
        closing[name] = float(np.linalg.norm(track[-1] - track[0]))
    return tuple(tracks), closing


def _true_places(truth: Truth, foot: Foot, t: float | Floats) -> Floats:
    """Return (x, y) on the floor at each instant, (n, 2), m."""
    places: Floats = truth.pose(foot, t).position[:, :2] + truth.feet[foot].origin[:2]
    return places


def _true_path(truth: Truth, halt: float) -> Floats:
    """Return the path midway between the feet, (n, 2), m."""
    t = np.arange(halt, truth.duration, 0.2)
    left, right = (_true_places(truth, foot, t) for foot in Foot)
    middle: Floats = 0.5 * (left + right)
    return middle
