"""What a session finds of slow walkers: emulated patients who walk at 0.3 to 0.6 m/s, shuffle, limp or use a stick.

    solepath-lab emulated slow-walkers [--wearers N] [--seed S] [--rate HZ] [--only GAIT] [--processes P]

prints a table as Markdown. A wearer walks 12 m, turns about and walks back, with sensors that have the errors of an
LSM6DSOX. Speeds and shares are drawn for each wearer. Slow walkers have 0.3 to 0.6 m/s, a walk ratio of 0.004 to 0.0068
m per step/min (0.0064 in healthy adults, less in multiple sclerosis: Rota et al. 2011, Int. J. Rehabil. Res. 34),
flatter feet at heel-strike and toe-off, and steps that vary by 4 to 8 % (Hausdorff 2005, J. NeuroEng. Rehabil. 2). Who
shuffles makes steps of 10 to 25 cm, lifts the sole by 3 to 8 mm and lands flat. Who limps is on one leg for a shorter
time: steps are 25 to 75 % unequal in time. Who uses a stick limps less, and halts in each double support until the
stick is put.

A limp and halts are the walk of `emulate` with another course of time: each instant of that walk is passed faster or
slower, so that forces and rates are those of the same way at other speeds.

Idealised: steps of both feet are equally long; the stick carries nobody; feet do not drag; a halt slows a foot down and
does not let it sway."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Callable, Sequence
from math import pi
from operator import add

import numpy as np
from attrs import astuple, evolve, field, frozen

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.curves import Array, Rng
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.shoe import IN_SOLE, ON_INSTEP, Mounting
from solepath.emulate.wearers.turning import matrices
from solepath.emulate.wearers.walker import Walker
from solepath.events import HeelStrike, ToeOff
from solepath.session import Session
from solepath.show.tables.table import number, percent
from solepath.types import Activity, Foot, Sample
from solepath.validate.comparison import STRIDE_TOLERANCE, WHOLE_WALK
from solepath.validate.foot_run import FootRun
from solepath.validate.matching import Matching, match, pairs
from solepath.walk.walk import Walk

from ..measures.not_walking import NotWalking
from . import other_motions
from .courses import Course, Key, Pose
from .other_motions import Posed, in_order, print_table
from .unsteady import Wandering
from .wearers import random_wearer

DISTANCE = 12.0
"""Length of each of the two ways, m."""
RATE_OF_TIME = 0.005
"""Interval in which the course of time is inverted, s."""


@frozen
class Gait:
    """A gait: a walker, and the rates of its time."""

    name: str
    wearer: Callable[[Rng, Wearer], Wearer]
    """Function that makes a patient of a healthy wearer."""
    speeds: tuple[float, float] = (0.3, 0.6)
    """Least and largest speed, m/s."""
    limp: tuple[float, float] = (0.0, 0.0)
    """Least and largest share by which time runs faster while the bad leg carries, and slower on the good one."""
    halt: tuple[float, float] = (1.0, 1.0)
    """Least and largest rate of time in double support."""


def _slow(rng: Rng, wearer: Wearer) -> Wearer:
    return evolve(
        wearer,
        walk_ratio=rng.uniform(0.0040, 0.0068),
        strike_pitch=wearer.strike_pitch * rng.uniform(0.4, 1.0),
        toe_off_pitch=wearer.toe_off_pitch * rng.uniform(0.6, 1.0),
        clearance=rng.uniform(0.008, 0.018),
        length_variation=rng.uniform(0.04, 0.08),
        time_variation=rng.uniform(0.03, 0.06),
        width_variation=0.02,
        wander=Wandering(0.05),
    )


def _shuffling(rng: Rng, wearer: Wearer) -> Wearer:
    # a step of l m at v m/s has 60 v / l steps a minute; the middle of the speeds stands for all of them
    step = rng.uniform(0.10, 0.25)
    return evolve(
        _slow(rng, wearer),
        walk_ratio=step**2 / (60.0 * 0.3),
        strike_pitch=rng.uniform(0.0, 0.06),
        toe_off_pitch=rng.uniform(0.2, 0.5),
        clearance=rng.uniform(0.003, 0.008),
    )


GAITS = (
    Gait("slow", _slow),
    Gait("shuffling", _shuffling, speeds=(0.2, 0.4)),
    Gait("limping", _slow, speeds=(0.3, 0.7), limp=(0.12, 0.28)),
    Gait("with a stick", _slow, limp=(0.05, 0.2), halt=(0.3, 0.7)),
)
"""The gaits, in the order of the table."""


class Patient(Posed):
    """A walker of `emulate` whose time runs at another rate, faster or slower, in each part of the gait cycle."""

    def __init__(self, walker: Walker, bad: Foot, limp: float, halt: float) -> None:
        self.walker = walker
        self.course = _course_of_time(walker, bad, limp, halt)
        grid = np.arange(0.0, float(self.course.times[-1]), RATE_OF_TIME)
        self._grid = grid, self.course.at(grid)
        super().__init__(self._pose, float(self.course.times[-1]), walker.seed)

    def _pose(self, foot: Foot, t: Array) -> Pose:
        found = self.walker.kinematics(foot, self.course.at(t), Mounting((0.0, 0.0, 0.0)))
        return found.position, matrices(found.attitude)

    def true_times(self, foot: Foot, event: str) -> list[float]:
        """Return the times of an event of all strides of a foot, s, such as `heel_strike`."""
        t, inner = self._grid
        return np.interp([getattr(one, event) for one in self.walker.plan.strides[foot]], inner, t).tolist()  # type: ignore[no-any-return]


def _course_of_time(walker: Walker, bad: Foot, limp: float, halt: float) -> Course:
    """Return the time in the walk of `emulate`, s, over the time of the patient, s."""
    rates: list[tuple[float, float]] = [(0.0, 1.0)]
    swings = sorted((one.toe_off, one.heel_strike, foot) for foot in Foot for one in walker.plan.strides[foot])
    for number_of, (toe_off, heel_strike, foot) in enumerate(swings):
        # while the bad leg swings, the good one carries
        rates.append((0.5 * (toe_off + heel_strike), 1.0 - limp if foot is bad else 1.0 + limp))
        following = swings[number_of + 1] if number_of + 1 < len(swings) else None
        if halt < 1.0 and following is not None and following[0] > heel_strike:
            rates.append((0.5 * (heel_strike + following[0]), halt))
    rates.append((max(walker.duration, rates[-1][0] + 1.0), 1.0))
    t, keys = 0.0, list[Key]([(0.0, 0.0, 1.0)])
    for (before, slow), (after, fast) in zip(rates, rates[1:], strict=False):
        if after > before:
            t += 2.0 * (after - before) / (slow + fast)
            keys.append((t, after, fast))
    return Course.through(*keys)


def patient(gait: Gait, seed: int) -> Patient:
    """Return the patient of a seed with this gait."""
    rng = np.random.default_rng([seed, 61, GAITS.index(gait)])
    healthy, _ = random_wearer(rng)
    speed = rng.uniform(*gait.speeds)
    side = float(rng.choice((-1.0, 1.0)))
    route = Route(speed=speed).stand(4.0).walk(DISTANCE, speed).turn(side * pi, 0.5).walk(DISTANCE).stop(3.0)
    walker = Walker(route, gait.wearer(rng, healthy), seed)
    bad = list(Foot)[int(rng.integers(2))]
    return Patient(walker, bad, rng.uniform(*gait.limp), rng.uniform(*gait.halt))


def samples_of(gait: Gait, seed: int, rate: float) -> list[Sample]:
    """Return the samples of both feet of a patient at `rate` Hz, in the order of time."""
    one, mounting = patient(gait, seed), (IN_SOLE, ON_INSTEP)[seed % 2]
    return in_order([one.samples(foot, rate, LSM6DSOX, mounting=mounting) for foot in Foot])


@frozen
class Found:
    """What is found of one walk or, added, of several."""

    true: int = 0
    """Number of true strides."""
    found: int = 0
    """Number of those that were found."""
    invented: int = 0
    """Number of strides that match none."""
    flawed: int = 0
    """Number of strides with flaws."""
    walking: float = 0.0
    """Time from the first toe-off to the last foot-flat that is called walking, s."""
    time: float = 0.0
    """That time, s."""
    heel_strike: Matching = field(factory=Matching)
    toe_off: Matching = field(factory=Matching)
    findings: tuple[str, ...] = ()
    """Names of the findings."""

    def __add__(self, other: Found) -> Found:
        return Found(*map(add, astuple(self, recurse=False), astuple(other, recurse=False)))


def score(job: tuple[Gait, int, float]) -> Found:
    """Return what the default recipe finds of a gait, a seed and a rate, Hz."""
    one, session = patient(*job[:2]), Session()
    walk = Walk.of(session.feed(samples_of(*job)) + session.finish())
    total = Found(findings=tuple([found.defect.name.lower() for found in walk.found_defects]))
    for foot in Foot:
        run, ends = FootRun.of(walk, foot), one.true_times(foot, "foot_flat")
        matched = len(pairs(ends, [stride.t_end for stride in run.strides], STRIDE_TOLERANCE))
        total += Found(
            len(ends),
            matched,
            len(run.strides) - matched,
            sum([bool(stride.flaws) for stride in run.strides]),
            heel_strike=match(one.true_times(foot, "heel_strike"), run.times[HeelStrike], windows=WHOLE_WALK),
            toe_off=match(one.true_times(foot, "toe_off"), run.times[ToeOff], windows=WHOLE_WALK),
        )
    start = min([one.true_times(foot, "toe_off")[0] for foot in Foot])
    end = max([one.true_times(foot, "foot_flat")[-1] for foot in Foot])
    return total + Found(walking=NotWalking.of(walk, start, end).times[Activity.WALKING], time=end - start)


OPTIONS = other_motions.OPTIONS
COLUMNS = ("strides found", "invented", "called walking %", "with flaws %", "heel-strike F1", "toe-off F1", "findings")
"""Titles of the columns after the first one."""


def cells(gait: Gait, outcomes: Sequence[Found]) -> list[str]:
    """Return the cells of the row of a gait, of all wearers together."""
    total = sum(outcomes, Found())
    reported = total.found + total.invented
    return [
        gait.name,
        f"{total.found} of {total.true}",
        str(total.invented),
        percent(total.walking / total.time),
        percent(total.flawed / reported if reported else None),
        number(total.heel_strike.f1, 3),
        number(total.toe_off.f1, 3),
        ", ".join([f"{name} {total.findings.count(name)}" for name in dict.fromkeys(total.findings)]) or "-",
    ]


def run(options: Namespace) -> int:
    """Print the table; return the exit status."""
    return print_table(options, GAITS, score, cells, COLUMNS)
