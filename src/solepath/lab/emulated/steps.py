"""Step width and step length by ranges between the feet, on emulated walks whose widths are known.

    python -m solepath.lab.emulated.steps [--walks N] [--seed S] [--bias M]

prints the table of docs/gait.md as Markdown. The ankles of the wearers walk 5 to 18 cm apart, in equal parts. The true
values are those of the sensors at the foot-flats. The constant guess is the best one in hindsight, the median of all
true widths; no wearer's width is known to the estimate. `--bias` is for sensors whose constant error is another one
than the emulated sensors have."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from math import fsum, pi
from operator import attrgetter

import numpy as np
from attrs import evolve, field, frozen

from ...emulate.routes.route import Route
from ...emulate.sensors.ranging import ULTRA_WIDEBAND, ULTRASOUND, RangeErrors, measure_ranges
from ...emulate.walk import SampledWalk, sampled
from ...emulate.wearers.truth import Truth
from ...events import GaitCycleMeasured
from ...session import Session
from ...types import OTHER, Foot, Sample
from .heading_walks import insoles_of, wearer_of

FIRST_SEED, WALKS = 1, 24
"""First seed and number of walks; the settings were chosen on seeds from 900 on."""
NARROWEST, WIDEST = 0.05, 0.18
"""Least and largest step width of a wearer, between the ankles, m."""
MATCH_TIME = 0.1
"""Largest difference of the time of a contact from the true one, s."""
KINDS: dict[str, RangeErrors | None] = {"no range": None, "ultrasound": ULTRASOUND, "ultra-wideband": ULTRA_WIDEBAND}
"""Range sensors by the name of a row."""


@frozen
class PlacedFoot:
    """A landing of a foot relative to the other foot, along and across the line of its own stride."""

    length: float
    """Step length, m."""
    width: float
    """Step width, m."""


@frozen
class StepScore:
    """The steady gait cycles of a walk against the truth."""

    true_width: float
    """Mean of the true widths of the steady cycles, m."""
    width: float | None
    """Mean of the measured widths, m; None if none was measured."""
    cycles: int
    """Number of steady cycles."""
    errors: tuple[PlacedFoot, ...] = field(repr=False)
    """Errors of each step that was measured, m."""
    sigmas: tuple[PlacedFoot, ...] = field(repr=False)
    """Their standard deviations, m."""


def width_of(number: int, walks: int) -> float:
    """Return the width of the wearer of walk `number` of `walks`, m, evenly spread from the narrowest to the widest."""
    return NARROWEST + (WIDEST - NARROWEST) * number / max(walks - 1, 1)


def walk_of(seed: int, width: float) -> SampledWalk:
    """Return a walk of 50 m with a turn about in its middle, by the wearer of a seed with this step width, m."""
    rng = np.random.default_rng([seed, 31])
    speeds = rng.uniform(0.9, 1.5, 2).tolist()
    route = Route().stand(3.0).walk(25.0, speeds[0]).turn(float(rng.choice((pi, -pi))), 0.8).walk(25.0, speeds[1])
    insoles = {site: evolve(insole, cells=8, reports_saturation=False) for site, insole in insoles_of(seed).items()}
    return sampled(route.stop(2.0), wearer=evolve(wearer_of(seed), step_width=width), insoles=insoles, seed=seed)


def true_placements(truth: Truth) -> dict[tuple[Foot, float], PlacedFoot]:
    """Return the true placements by foot and time of the contact, s."""
    flats = {foot: np.array([0.0, *truth.feet[foot].foot_flats]) for foot in Foot}
    places = {foot: truth.pose(foot, flats[foot]).position + np.array(truth.feet[foot].origin) for foot in Foot}
    found: dict[tuple[Foot, float], PlacedFoot] = {}
    for foot, other in OTHER.items():
        side = 1.0 if foot is Foot.LEFT else -1.0
        for number, stride in enumerate(truth.strides(foot)):
            between = np.flatnonzero((flats[other] > stride.t_start) & (flats[other] < stride.t_end))
            if not len(between) or stride.length < 0.1:
                continue
            x, y, _ = places[foot][number + 1] - places[other][between[-1]]
            ux, uy = (component / stride.length for component in stride.displacement[:2])
            placement = PlacedFoot(float(x * ux + y * uy), float(side * (ux * y - uy * x)))
            found[foot, stride.t_heel_strike] = placement
    return found


def score_steps(walk: SampledWalk, errors: RangeErrors | None) -> StepScore:
    """Return the score of the default recipe on a walk with ranges that have these errors; None: no ranges."""
    ranges: list[Sample] = [] if errors is None else measure_ranges(walk.walker, errors)
    session = Session()
    events = session.feed(sorted([*walk.samples, *ranges], key=attrgetter("t"))) + session.finish()
    truth = true_placements(walk.truth)
    widths: list[float] = []
    measured: list[float] = []
    found: list[PlacedFoot] = []
    sigmas: list[PlacedFoot] = []
    for event in events:
        if not isinstance(event, GaitCycleMeasured) or not event.steady:
            continue
        times = [t for foot, t in truth if foot is event.foot and abs(t - event.t) < MATCH_TIME]
        if not times:
            continue
        true = truth[event.foot, times[0]]
        widths.append(true.width)
        if event.step_length is None or event.step_width is None:
            continue
        assert event.step_length_sigma is not None and event.step_width_sigma is not None
        measured.append(event.step_width)
        found.append(PlacedFoot(event.step_length - true.length, event.step_width - true.width))
        sigmas.append(PlacedFoot(event.step_length_sigma, event.step_width_sigma))
    mean = fsum(measured) / len(measured) if measured else None
    return StepScore(fsum(widths) / len(widths), mean, len(widths), tuple(found), tuple(sigmas))


def mean_error(scores: Sequence[StepScore]) -> float | None:
    """Return the mean of the absolute errors of the mean widths of walks, m; None if no width was measured."""
    errors = [abs(score.width - score.true_width) for score in scores if score.width is not None]
    return fsum(errors) / len(errors) if errors else None


def guess_error(scores: Sequence[StepScore]) -> float:
    """Return the mean absolute error of the best constant guess, m, for the mean widths of walks."""
    guess = float(np.median([score.true_width for score in scores]))
    return fsum([abs(score.true_width - guess) for score in scores]) / len(scores)


def covered(scores: Sequence[StepScore], factor: float, name: str) -> float:
    """Return the share of the errors in `name` (length or width) that are below `factor` standard deviations."""
    inside: list[bool] = [
        abs(getattr(error, name)) < factor * getattr(sigma, name)
        for score in scores
        for error, sigma in zip(score.errors, score.sigmas, strict=True)
    ]
    return inside.count(True) / max(len(inside), 1)


def row(name: str, scores: Sequence[StepScore]) -> str:
    """Return a row of the table."""
    found = [error for score in scores for error in score.errors]
    cycles = sum([score.cycles for score in scores])  # whole numbers
    mean = mean_error(scores)
    if mean is None:
        return f"| {name} | 0 of {cycles} | - | - | - | - | - |"
    per_step, length = (fsum([abs(getattr(one, what)) for one in found]) / len(found) for what in ("width", "length"))
    worst = max([abs(score.width - score.true_width) for score in scores if score.width is not None])
    shares = "/".join([f"{100.0 * covered(scores, factor, 'width'):.0f}" for factor in (1.0, 2.0)])
    return (
        f"| {name} | {len(found)} of {cycles} | {100.0 * mean:.1f} cm | {100.0 * worst:.1f} cm | "
        f"{100.0 * per_step:.1f} cm | {shares} % | {100.0 * length:.1f} cm |"
    )


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(prog="python -m solepath.lab.emulated.steps", description=__doc__)
    parser.add_argument("--walks", metavar="N", type=int, default=WALKS, help="number of walks")
    parser.add_argument("--seed", metavar="S", type=int, default=FIRST_SEED, help="first seed")
    parser.add_argument("--bias", metavar="M", type=float, help="standard deviation of the constant error, m")
    options = parser.parse_args(arguments)
    scores: dict[str, list[StepScore]] = {name: [] for name in KINDS}
    for number in range(options.walks):
        walk = walk_of(options.seed + number, width_of(number, options.walks))
        for name, errors in KINDS.items():
            if errors is not None and options.bias is not None:
                errors = evolve(errors, bias=options.bias)
            scores[name].append(score_steps(walk, errors))
    print("| range sensor | steps known | width of a walk | worst walk | of a step | in 1/2 sigma | length of a step |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    print(f"| constant guess | - | {100.0 * guess_error(scores['no range']):.1f} cm | - | - | - | - |")
    for name, found in scores.items():
        print(row(name, found))


if __name__ == "__main__":
    main()
