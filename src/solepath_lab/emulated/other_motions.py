"""What a session reports of motions that are not walking: on wheels, on a seat, on the spot, not on feet.

    solepath-lab emulated other-motions [--wearers N] [--seed S] [--rate HZ] [--only MOTION] [--processes P]

prints a table as Markdown. For each motion and seed two sensors on the feet, with the errors of an LSM6DSOX, measure
100 s of it (31 jumps take 50 s). What is drawn, from which source, and what is idealised is said in on_wheels.py,
on_the_spot.py and not_on_feet.py. Nothing there was made or changed in view of what a session finds. Counted is the
time after the first 10 s. Strides and metres are those of both feet; "steady" are gait cycles that count as steady. The
findings are those of all seeds together."""

from __future__ import annotations

from argparse import Namespace
from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
from heapq import merge
from itertools import islice
from operator import attrgetter
from typing import Protocol, TypeVar

import numpy as np
from attrs import frozen

from solepath.cli.common.failure import parse_number
from solepath.cli.common.parser import option
from solepath.cli.common.processes import run_jobs
from solepath.emulate.sensors.magnetic_field import UNDISTURBED
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.curves import Array, Rng
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.limbs import motion_of
from solepath.emulate.wearers.motion import Kinematics
from solepath.emulate.wearers.shoe import IN_SOLE, ON_HEEL, ON_INSTEP, Mounting
from solepath.emulate.wearers.walker import Walker
from solepath.session import Session
from solepath.show.tables.table import number, percent
from solepath.types import Foot, Sample
from solepath.walk.walk import Walk

from ..measures.not_walking import NotWalking
from ..options import PROCESSES, only, seeds
from ..tables import markdown
from . import not_on_feet, on_the_spot, on_wheels
from .on_the_spot import Posing

DURATION = 100.0
"""Time of a motion, s."""
SETTLING = 10.0
"""Time at the start that does not count, s."""


class Posed(Walker):
    """Somebody whose feet have given poses: any device of `emulate` measures them. Cells are not emulated."""

    def __init__(self, posing: Posing, duration: float, seed: int) -> None:
        self.posing, self.seed, self.wearer, self.field = posing, seed, Wearer(), UNDISTURBED
        self._duration = duration

    @property
    def duration(self) -> float:
        """Duration of the motion, s."""
        return self._duration

    def kinematics(self, foot: Foot, t: Array, mounting: Mounting = IN_SOLE) -> Kinematics:
        """Return the motion of the sensor on a foot at increasing times `t`, s."""
        return motion_of(partial(self.posing, foot), t, mounting)


@frozen
class OtherMotion:
    """A motion that is not walking."""

    name: str
    make: Callable[[Rng, float], Posing]
    """Function of random numbers and of the duration, s, that returns the poses of both sensors."""
    duration: float = DURATION
    on_foot: bool = True
    """Flag: the poses are those of shoes, not of sensors."""


MOTIONS = (
    OtherMotion("bicycling", on_wheels.cycling),
    OtherMotion("in a car, legs move", on_wheels.riding_along),
    OtherMotion("driving a car", on_wheels.driving),
    OtherMotion("in a bus, legs move", on_wheels.riding_bus),
    OtherMotion("inline skating", on_wheels.skating),
    OtherMotion("in a wheelchair", on_wheels.wheeling),
    OtherMotion("sitting, legs move", on_the_spot.fidgeting),
    OtherMotion("sitting, legs dangle", on_the_spot.dangling),
    OtherMotion("sitting, feet tap", on_the_spot.tapping),
    OtherMotion("marching on the spot", on_the_spot.marching),
    OtherMotion("jumping", on_the_spot.jumping, duration=50.0),
    OtherMotion("walking, in the hands", not_on_feet.in_hands, on_foot=False),
    OtherMotion("walking, in the pockets", not_on_feet.in_pockets, on_foot=False),
    OtherMotion("walking, on the trunk", not_on_feet.on_trunk, on_foot=False),
    OtherMotion("handled, on a table", not_on_feet.on_a_table, on_foot=False),
    OtherMotion("shaken, in a bag", not_on_feet.in_a_bag, on_foot=False),
)
"""The motions, in the order of the table."""
Outcome = tuple[NotWalking, Counter[str]]
"""What is reported, and the findings that are raised, by name."""


def samples_of(motion: OtherMotion, seed: int, rate: float) -> list[Sample]:
    """Return the samples of both sensors at `rate` Hz, in the order of time; each seed is another wearer."""
    order = [one.name for one in MOTIONS].index(motion.name)
    rng = np.random.default_rng([seed, 60, order])
    mounting = Mounting((0.0, 0.0, 0.0))
    if motion.on_foot:
        mounting = (IN_SOLE, ON_INSTEP, ON_HEEL)[int(rng.integers(3))]
    posed = Posed(motion.make(rng, motion.duration), motion.duration, seed)
    return in_order([posed.samples(foot, rate, LSM6DSOX, mounting=mounting) for foot in Foot])


def in_order(streams: Sequence[Sequence[Sample]]) -> list[Sample]:
    """Return the samples of both feet in the order of time."""
    return list(merge(*streams, key=attrgetter("t")))


def score(job: tuple[OtherMotion, int, float]) -> Outcome:
    """Return what the default recipe reports of a motion, a seed and a rate."""
    motion, _, _ = job
    session = Session()
    walk = Walk.of(session.feed(samples_of(*job)) + session.finish())
    findings = Counter([one.defect.name.lower() for one in walk.found_defects])
    return NotWalking.of(walk, SETTLING, motion.duration), findings


OPTIONS = (
    seeds(2, 1, "wearers"),
    option(
        "--rate",
        metavar="HZ",
        type=partial(parse_number, "a rate from 10 to 400 Hz", 10.0, 400.0),
        default=100.0,
        help="samples a second (default: 100)",
    ),
    only("row"),
    PROCESSES,
)
COLUMNS = (
    "strides /min",
    "m /min",
    "unknown %",
    "standing %",
    "walking %",
    "running %",
    "stairs %",
    "lifts %",
    "steady /min",
    "findings",
)
"""Titles of the columns after the first one."""
SHARES = ("share_unknown", "share_standing", "share_walking", "share_running", "share_stairs", "share_lifts")


def cells(motion: OtherMotion, outcomes: Sequence[Outcome]) -> list[str]:
    """Return the cells of the row of a motion, of all wearers together."""
    total = sum([outcome for outcome, _ in outcomes], NotWalking())
    findings = sum([found for _, found in outcomes], Counter[str]())
    figures = total.figures
    return [
        motion.name,
        number(figures["strides_a_minute"]),
        number(figures["metres_a_minute"]),
        *[percent(figures[name]) for name in SHARES],
        number(60.0 * total.steady / total.duration, 1),
        ", ".join([f"{name} {count}" for name, count in findings.most_common()]) or "-",
    ]


class Named(Protocol):
    """A motion or a gait."""

    @property
    def name(self) -> str:
        """Name in the table."""


Kind = TypeVar("Kind", bound=Named)
KindOutcome = TypeVar("KindOutcome")


def print_table(
    options: Namespace,
    kinds: Sequence[Kind],
    score: Callable[[tuple[Kind, int, float]], KindOutcome],
    cells: Callable[[Kind, Sequence[KindOutcome]], list[str]],
    columns: Sequence[str],
) -> int:
    """Score each kind that the options name with each seed, and print a row of each; return the exit status."""
    kinds = [one for one in kinds if not options.only or one.name in options.only]
    numbers = range(options.seed, options.seed + options.wearers)
    jobs = [(kind, seed, options.rate) for kind in kinds for seed in numbers]
    outcomes = iter(run_jobs(score, jobs, processes=options.processes))
    rows = [cells(kind, list(islice(outcomes, options.wearers))) for kind in kinds]
    print("\n".join(markdown.table([f"{options.wearers} wearers each, {options.rate:g} Hz", *columns], rows)))
    return 0


def run(options: Namespace) -> int:
    """Print the table; return the exit status."""
    return print_table(options, MOTIONS, score, cells, COLUMNS)
