"""Liu et al. 2015: wearers with a 20 Hz SensorTag in each insole, in a building of 56 m by 63 m, without radio anchors.

The experiments of fig. 13 are repeated (footstep/): a corridor of 63 m measured by one foot, by the stature and by both
feet (b), stride lengths (c), activities (a), turns (d, e), and the place on the floor plan (f to h). The shoes are worn
ones: they flex and slip. Our additions to the stride length are rows, one after the other; a block of rows changes one
thing at a time about shoe, sensors, radio and air. Most results of the paper are drawn and not printed; our rows of
them have no paper's figure beside them. The paper's "step" is the stride of one foot."""

from __future__ import annotations

from functools import partial

from solepath.papers.footstep_tracker.recipe import FOOTSTEP_TRACKER

from .footstep.activities import score_activities
from .footstep.corridor import score_corridor
from .footstep.figures import panels
from .footstep.places import score_places
from .footstep.turning import score_turns
from .footstep.wearers import SETTINGS, STANDARD, WearerJob
from .runner import Runner
from .tables import Reproduction, WalkResults, gathered, mean

NAME = FOOTSTEP_TRACKER.name
FIRST_SEED = 100_000
"""First seed of the wearers; training uses only smaller seeds (lab/train/emulated.py)."""
WEARERS = 8
"""Number of wearers; section V-E: "we invited eight different users"."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` wearers, each of whom does every experiment."""
    count = WEARERS if walks is None else walks
    seeds = range(FIRST_SEED + 1000 * seed, FIRST_SEED + 1000 * seed + count)
    jobs = {setting.title: [WearerJob(one, setting) for one in seeds] for setting in (STANDARD, *SETTINGS)}
    active = {title: of for title, of in jobs.items() if of[0].setting.activities}
    corridors = runner.run_blocks(score_corridor, jobs, partial(_describe, "corridor, one foot %"))
    activities = runner.run_blocks(score_activities, active, partial(_describe, "activities %"))
    turns = runner.run(score_turns, jobs[""], partial(_describe, "turn angle, ours deg"))
    places = runner.run(score_places, jobs[""], partial(_describe, "place m"))
    parts = [gathered(blocks) for blocks in (corridors, activities, {"": turns}, {"": places})]
    return Reproduction(
        name=NAME,
        emulation=f"{count} wearers with a CC2541 at 20 Hz in each worn insole, two floors of 56 m by 63 m",
        unit="as named",
        results=tuple([{**a, **b, **c, **d} for a, b, c, d in zip(*parts, strict=True)]),
        panels=(*panels(*parts), *corridors[""][0].panels, *places[0].panels),
    )


def _describe(name: str, one: WalkResults) -> str:
    return f"{name} {mean(one.values[name]):.2f}"
