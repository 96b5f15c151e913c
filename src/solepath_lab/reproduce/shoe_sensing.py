"""Li et al. 2016: walking, jogging, stairs, a rectangle and five minutes in a building with an MPU-6050 on one shoe.

Ten wearers go 19.2 m there and back at a walk and at a jog, and a flight up and down, twice each: twenty rounds in all.
They go around a rectangle, over ramps, and for five minutes through a building (shoe/walks.py). Two methods are
compared everywhere: the printed one and ours. On a short walk each of our additions is left out once, and windows of
other lengths are tried; other rates, shoes and sensors walk it too (shoe/variants.py). The values of a row are the
single strides of all wearers, unless stated otherwise. The paper calls strides steps, and so do the rows. It draws
figures 21 and 22 and does not print their values."""

from __future__ import annotations

from solepath.papers.shoe_sensing.recipe import SHOE_SENSING

from .runner import Runner
from .shoe.variants import SETUPS
from .shoe.walks import TITLES, ShoeJob, walk
from .tables import Reproduction, WalkResults, gathered, mean

NAME = SHOE_SENSING.name
WALKS = 10
"""Number of wearers, each with two rounds; section 4.2.1: "20 rounds each (i.e., back and forth)"."""
LONG_WALKS = ("walking", "jogging", "stairs", "rectangle", "ramps", "five minutes", "short")
DESCRIBED = 3
"""Number of values of a walk in the line about it."""


def reproduce(walks: int | None, seed: int, runner: Runner) -> Reproduction:
    """Return the results of `walks` wearers, each of whom walks every experiment, and of a short walk of each setup."""
    count = WALKS if walks is None else walks
    jobs = {
        f"{name}: ": [ShoeJob(1000 * seed + 10 * k + number, name, drawn=k == 0) for k in range(count)]
        for number, name in enumerate(LONG_WALKS)
    }
    jobs |= {f"with {setup.name}: ": [ShoeJob(1000 * seed + 900, "setup", setup)] for setup in SETUPS}
    found = runner.run_blocks(walk, jobs, _describe)
    return Reproduction(
        name=NAME,
        emulation=f"{count} wearers with an MPU-6050 on one worn shoe at 100 Hz, another sensor for each walk",
        unit="as named",
        results=gathered(found),
        panels=tuple([panel for name in ("short", *TITLES) for panel in found[f"{name}: "][0].panels]),
    )


def _describe(one: WalkResults) -> str:
    return "; ".join([f"{name} {mean(of):.2f}" for name, of in [*one.values.items()][:DESCRIBED]])
