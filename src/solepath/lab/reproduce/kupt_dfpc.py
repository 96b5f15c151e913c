"""Chen et al. 2019: 20 walks of 20 m, and 91 m through a building, with two smart insoles at 30 Hz.

Each walk has another pair of insoles, for which the shoe is measured in five postures, three times each (section
III-C). A recording has 20 s of walking to measure the pressure noise (section III-B), a halt, and then the 20 m. The
sessions receive only the samples after the halt. Distances are the sums of stride lengths, as in section IV-B. In the
corridor the drift is the error of that sum, as in section IV-C. The paper does not give the corridor's shape; here it
goes once around the inner block of a floor (emulate/routes/laps.py)."""

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
from . import published
from .runner import Runner
from .tables import BoxPlots, DrawStyle, FigureRow, FloorPanel, PictureTrack, Reproduction, row_of, statistics
from .walks import align_track, cut_walk, find_halt, join_routes, run_session, thin_out

NAME = KUPT_DFPC.name
WALKS = 20
RATE = 30.0
"""Sampling rate, Hz (section III-A)."""
SPEED = 1.3
"""Comfortable walking speed, m/s."""
WALK_LENGTH = 20.0
"""Length of a walk, m."""
CORRIDOR_LENGTH = 91.0
"""Length of the corridor walk, m (section IV-C)."""
WALKS_PER_CORRIDOR = 4
"""Number of walks of 20 m for each corridor walk. The paper has a single corridor walk, too few for a mean."""
NOISE_WALK = straight(20.0 * SPEED, SPEED).stand(4.0)
"""Route of 20 s of walking to measure the pressure noise, and a halt."""
FOOT_LETTERS = {Foot.LEFT: "L", Foot.RIGHT: "R"}


@frozen
class KuptJob:
    """One walk to emulate."""

    seed: int
    corridor: bool = False
    """True for a walk of CORRIDOR_LENGTH, False for one of WALK_LENGTH."""


@frozen
class KuptResults:
    """The results of one walk."""

    distances: dict[str, float]
    """Measured distance by row of the table, m."""
    true: dict[Foot, float]
    """True distance of each foot, m."""
    tracks: tuple[PictureTrack, ...] = ()
    """True path and then the stride ends by each method; only of a corridor walk."""
    end_distances: dict[str, float] = field(factory=dict)
    """Distance from the start to the end of each track, m; only of a corridor walk, which is a closed loop."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` walks of 20 m, and of one corridor walk for every WALKS_PER_CORRIDOR of them."""
    count = WALKS if walks is None else walks
    corridors = max(1, count // WALKS_PER_CORRIDOR)
    jobs = [KuptJob(1000 * seed + 500 + k, corridor=True) for k in range(corridors)]
    jobs += [KuptJob(1000 * seed + k) for k in range(1, count + 1)]
    results = runner.run(walk, jobs, _describe)
    corridor_walks, short_walks = results[:corridors], results[corridors:]
    paper = published.KUPT_DFPC
    rows = tuple([row_of(paper, name, [one.distances[name] for one in short_walks]) for name in paper])
    return Reproduction(
        name=NAME,
        paper_title=published.KUPT_DFPC_TITLE,
        emulation=f"{count} walks of {WALK_LENGTH:g} m at {RATE:g} Hz, another pair of insoles each time",
        unit="m",
        rows=rows,
        panels=(
            BoxPlots(f"distance of {count} walks of {WALK_LENGTH:g} m (fig. 12)", tuple(paper), "m", WALK_LENGTH),
            FloorPanel(
                f"{CORRIDOR_LENGTH:g} m of corridors (fig. 13)", corridor_walks[0].tracks, (("start", 0.0, 0.0),)
            ),
        ),
        notes=_notes(rows, short_walks, corridor_walks),
    )


def _describe(one: KuptResults) -> str:
    return ", ".join(f"{name} {distance:.2f}" for name, distance in one.distances.items()) + " m"


def _notes(
    rows: tuple[FigureRow, ...], short_walks: list[KuptResults], corridor_walks: list[KuptResults]
) -> tuple[str, ...]:
    squares = {row.name: np.mean([(value - WALK_LENGTH) ** 2 for value in row.values]) for row in rows}
    off = ", ".join(f"{name} {float(np.sqrt(square)):.2f}" for name, square in squares.items())
    paths = statistics([one.true[foot] for one in short_walks for foot in Foot])
    lines = [f"Root mean square of the error of {len(short_walks)} walks, m: {off}."]
    lines.append(f"The feet really went {paths.mean:.2f} m on average.")
    for name, drift in published.CORRIDOR_DRIFT.items():
        off_by = [one.distances[name] - _true_distance(one, name) for one in corridor_walks]
        share = 100.0 * float(np.mean(np.abs(off_by))) / CORRIDOR_LENGTH
        ends = float(np.mean([one.end_distances[name] for one in corridor_walks]))
        lines.append(
            f"{CORRIDOR_LENGTH:g} m of corridors, {name}: distance off by "
            f"{', '.join(f'{off:+.2f}' for off in off_by)} m, {share:.2f} % of it on average, end {ends:.2f} m from "
            f"the start of this closed way; paper {drift:.2f} m, {100.0 * drift / CORRIDOR_LENGTH:.2f} %."
        )
    lines.append(
        f"The paper contradicts itself: the mean of KUPT-L is {published.KUPT_DFPC['KUPT-L'].mean} m in table I and "
        f"{published.KUPT_L_MEAN_IN_TEXT} m in the text below it."
    )
    return tuple(lines)


def _true_distance(one: KuptResults, name: str) -> float:
    """Return the true distance, m, of the foot in the row's name; the mean of both feet when it names none."""
    feet = [foot for foot, letter in FOOT_LETTERS.items() if name.endswith(f"-{letter}")] or list(Foot)
    return float(np.mean([one.true[foot] for foot in feet]))


def walk(job: KuptJob) -> KuptResults:
    """Emulate one walk, calibrate on its first part and run each recipe on the second."""
    route = corridor(CORRIDOR_LENGTH, SPEED) if job.corridor else straight(WALK_LENGTH, SPEED)
    walked = emulate(
        join_routes(NOISE_WALK, route),
        devices={SITE_OF_FOOT[foot]: Insole(rate=RATE, cell_part=WORN_RESISTIVE) for foot in Foot},
        seed=job.seed,
    )
    t_halt = find_halt(walked.walker, NOISE_WALK)
    parts = cut_walk(walked, t_halt)
    calibration = merged(merged(parts.layouts, measured_shoe(job.seed)), pressure_noise(parts.before))
    events_of = {recipe.name: run_session(recipe, parts.after, calibration) for recipe in (ZUPT, KUPT, KUPT_DFPC)}
    distances = {
        f"{recipe.upper()}-{letter}": sum(s.length for s in _final_strides(events_of[recipe], foot))
        for recipe in ("zupt", "kupt")
        for foot, letter in FOOT_LETTERS.items()
    }
    fused = [event for event in events_of[NAME] if isinstance(event, StrideFused)]
    distances["KUPT+DFPC"] = fused[-1].distance if fused else 0.0
    true = {foot: sum(one.length for one in walked.truth.strides(foot) if one.t_heel_off > t_halt) for foot in Foot}
    if not job.corridor:
        return KuptResults(distances, true)
    tracks, end_distances = _tracks(walked.truth, t_halt, events_of["zupt"], fused)
    return KuptResults(distances, true, tracks, end_distances)


def measured_shoe(seed: int) -> Calibration:
    """Return the calibration that rulers and static postures give for the shoe."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "postures.csv"
        write_postures(file, postures(seed=seed))
        return fit_shoe(file).calibration


def _final_strides(events: list[Event], foot: Foot) -> list[StrideTaken]:
    return [event for event in events if isinstance(event, StrideTaken) and event.final and event.foot is foot]


def _tracks(
    truth: Truth, t_halt: float, zupt: list[Event], fused: list[StrideFused]
) -> tuple[tuple[PictureTrack, ...], dict[str, float]]:
    """Return tracks of stride ends, aligned with the truth over two metres, and distances from start to end, m."""
    ends = {
        f"ZUPT-{letter}": [(stride.t_end, foot, stride.position) for stride in _final_strides(zupt, foot)]
        for foot, letter in FOOT_LETTERS.items()
    }
    # after each stride the position is the end of the chosen foot's path, which changes only at that foot's strides
    ends["KUPT+DFPC"] = [(one.t, one.foot, one.position) for one in fused if one.foot is one.chosen]
    path = _true_path(truth, t_halt)
    start = path[0].copy()
    tracks, end_distances = [PictureTrack("true path", thin_out(path - start), DrawStyle.TRUTH)], {}
    for name, places in ends.items():
        if len(places) < 2:
            continue
        track = np.array([(0.0, 0.0), *((x, y) for _, _, (x, y, _) in places)])
        true = np.array(
            [_true_places(truth, foot, t)[0] for t, foot in [(t_halt, places[0][1]), *(p[:2] for p in places)]]
        )
        tracks.append(PictureTrack(name, thin_out(align_track(track, true) - start), DrawStyle.DOTS))
        end_distances[name] = float(np.linalg.norm(track[-1] - track[0]))
    return tuple(tracks), end_distances


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
