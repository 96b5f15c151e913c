"""The place without a start and with a first heading, on the way of a case study and on ways through two buildings.

    solepath-lab emulated places [--walks N] [--seed S]

prints a table as Markdown: the walks that keep the true candidate after each scored stride
(validate/place.py), and the mean error from the second turn on, as the mean over walks. Both have their 95 % intervals,
of a share by Wilson (1927, J. Am. Stat. Assoc. 22), of a mean by Student's t over walks. The heading is given with an
error of 6 degrees. The asymmetric building is the usual one; HALF_TURN is its own image after half a turn, so
that nothing but a heading tells its halves apart: there, the error without one is chance, and is left out."""

from __future__ import annotations

from argparse import Namespace
from math import fsum, sqrt

import numpy as np

from solepath import recipes
from solepath.cli.common.processes import run_jobs
from solepath.emulate.routes.building import FOUR_LOOPS
from solepath.emulate.routes.ways import case_study, wandering
from solepath.emulate.walk import emulate
from solepath.floorplan.index import IndexedPlan
from solepath.floorplan.plan import Start
from solepath.session import Session
from solepath.types import SITE_OF_FOOT, Foot
from solepath.validate.place import PlaceScore, score

from ..reproduce.tables import Claim
from ..tables import markdown
from .buildings import HALF_TURN
from .evidence import HEADING_ERROR
from .reliability import DEVICES, TITLES
from .wearers import random_wearer

LIMIT = 1.96
"""Half the width of the 95 % interval of a normal distribution, in standard deviations."""
ROWS = {
    "case study, no start": False,
    "asymmetric plan, no start": False,
    "asymmetric plan, first heading": True,
    "half-turn plan, no start": False,
    "half-turn plan, first heading": True,
}
"""A flag by the name of a row: the session is given the first heading."""


def share_interval(count: int, total: int) -> tuple[float, float]:
    """Return the 95 % interval of a share that was found in `count` of `total`."""
    share, square = count / total, LIMIT * LIMIT / total
    middle, reach = share + 0.5 * square, sqrt(square * (share * (1.0 - share) + 0.25 * square))
    return (middle - reach) / (1.0 + square), (middle + reach) / (1.0 + square)


def score_way(job: tuple[str, str, int]) -> tuple[str, str, PlaceScore]:
    """Return recipe, row and score of a walk; the rows of a building share the walk of a seed."""
    recipe, row, seed = job
    rng = np.random.default_rng([seed, 60])
    building = HALF_TURN if row.startswith("half") else FOUR_LOOPS
    way = case_study() if row.startswith("case") else wandering(seed, building)
    wearer, _ = random_wearer(rng)
    devices = {SITE_OF_FOOT[foot]: DEVICES[recipe] for foot in Foot}
    walk = emulate(way.route, wearer=wearer, devices=devices, seed=seed)
    heading = (way.start.heading or 0.0) + float(rng.normal(0.0, HEADING_ERROR))
    start = Start(heading=heading) if ROWS[row] else None
    session = Session(recipes.by_name(recipe), floorplan=IndexedPlan(way.building.plan), start=start)
    return recipe, row, score(way, walk.walker, walk.truth, session.feed(walk.packets) + session.finish())


def cell(row: str, scores: list[PlaceScore]) -> str:
    """Return how many walks kept the true candidate, and their mean error, with the intervals."""
    kept = sum([one.strides > 0 and not one.dropped for one in scores])
    low, high = share_interval(kept, len(scores))
    text = f"{kept} of {len(scores)} ({100.0 * low:.0f} to {100.0 * high:.0f} %)"
    off = [fsum(one.off) / len(one.off) for one in scores if one.off]
    if len(off) < 2 or row == "half-turn plan, no start":
        return text
    low, high = Claim("mean error", tuple(off)).interval
    return f"{text}; {fsum(off) / len(off):.2f} m ({low:.2f} to {high:.2f})"


def run(options: Namespace) -> int:
    """Print the table; return the exit status."""
    seeds = range(options.seed, options.seed + options.walks)
    jobs = [(recipe, row, seed) for recipe in DEVICES for row in ROWS for seed in seeds]
    scores: dict[tuple[str, str], list[PlaceScore]] = {}
    for recipe, row, one in run_jobs(score_way, jobs, processes=options.processes):
        scores.setdefault((recipe, row), []).append(one)
    rows = [[row, *[cell(row, scores[recipe, row]) for recipe in DEVICES]] for row in ROWS]
    print("\n".join(markdown.table(["true candidate kept; mean error", *TITLES.values()], rows)))
    return 0
