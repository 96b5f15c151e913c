"""A compass in the feet holds the heading where it can, and moves nothing where it cannot."""

from __future__ import annotations

from cmath import rect
from collections.abc import Callable
from functools import cache
from math import cos, degrees, radians, sin

import numpy as np
import pytest
from soak import soaked
from strides import stride

from solepath.body.fuse.common_error import FEET, HEADING, CommonError
from solepath.body.fuse.compass import Compass, H, StanceField
from solepath.types import Foot
from solepath.types.vector import IDENTITY, from_yaw
from solepath_lab.emulated.magnetic_field import DisturbedField

STEP, STRIDE_TIME = 0.7, 1.1
"""Advance of the body from the stride of one foot to that of the other, m, and duration of a stride, s."""
Heading = Callable[[float], float]
Fault = Callable[[np.ndarray, int, float], np.ndarray]


def turning(s: float) -> float:
    """Return the direction of a way with bends to both sides after s m, rad."""
    return 2.0 * sin(s / 25.0) + 1.4 * sin(s / 60.0 + 1.0)


def straight(s: float) -> float:
    """Return the direction of a straight way, rad."""
    return 0.0


@cache
def places(heading: Heading, count: int) -> np.ndarray:
    """Return where the foot of each step stands, m."""
    directions = [heading(STEP * k + STEP) for k in range(count - 1)]
    advances = [(0.0, 0.0), *[(STEP * cos(one), STEP * sin(one)) for one in directions]]
    return np.cumsum(advances, axis=0)


class Walked:
    """A wearer whose track drifts by `drift` rad a stride, with a compass at each foot or without.

    `fault` changes what the magnetometer of a foot measures, uT, sensor frame, after some metres."""

    def __init__(
        self, heading: Heading, length: float, disturbance: float = 20.0, drift: float = 0.002, seed: int = 1,
        fault: Fault | None = None, compass: bool = True,
        lengths: tuple[float, float] = (1.5, 15.0),
    ) -> None:  # fmt: skip
        rng = np.random.default_rng(seed)
        field = DisturbedField(radians(disturbance), seed, lengths=lengths)
        self.error, self.compass, self.faults, self.most_moved = CommonError(), Compass(), list[str](), 0.0
        self.iron = rng.normal(0.0, 8.0, (2, 3))
        for row in FEET.values():  # the bias is known
            self.error.covariance[row + 2][row + 2] = 0.0
        self.off = 0.0
        """Heading error, truth minus track, rad."""
        count = int(length / STEP)
        flux = 1e6 * field.at(places(heading, count)) if compass else np.zeros((count, 3))
        for k in range(count):
            s, number = k * STEP, k % 2
            foot = (Foot.LEFT, Foot.RIGHT)[number]
            event = stride(foot, 0.5 * STRIDE_TIME * k, (2.0 * STEP, 0.0, 0.0))
            self.error.start_stride(foot, False)
            if compass:
                true_yaw = heading(s)
                measured = turned(flux[k], -true_yaw) + self.iron[number] + rng.normal(0.0, 0.3, 3)
                if fault is not None:
                    measured = fault(measured, number, s)
                yaw = true_yaw - self.off
                self.compass.feet[foot] = stance(turned(measured, yaw), yaw)
                (_, _, yaw), sentence = self.compass.add_stride(event, 0.0, self.error)
                self.compass.turned(yaw)
                self.off -= yaw
                self.most_moved = max(self.most_moved, abs(yaw))
                if sentence is not None:
                    self.faults.append(sentence)
            turn = heading(s + 2.0 * STEP) - heading(s)
            self.off += 0.5 * (drift - self.error.turn_of(foot, 1.0, turn, STRIDE_TIME))
            direction = heading(s + STEP)
            moved = rect(2.0 * STEP, direction - self.off)
            self.error.propagate(foot, 1.0, turn, STRIDE_TIME, moved, (1e-4, 0.0, 1e-4))
        self.degrees = abs(degrees(self.off))


def stance(flux: np.ndarray, yaw: float) -> StanceField:
    """Return the field of a foot that stood level, turned by `yaw`, rad, and measured `flux`, uT, world frame."""
    x, y, z = flux.tolist()
    one = StanceField()
    one.count, one.sum, one.attitude, one.first = 1, (x, y, z), from_yaw(yaw), IDENTITY
    return one


def turned(vector: np.ndarray, yaw: float) -> np.ndarray:
    c, s = cos(yaw), sin(yaw)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1], vector[2]])


SEEDS = range(1, 9)
FEW_SEEDS = SEEDS[:3]
"""Seeds where each walk by itself must show the same, and no mean is taken."""


@cache
def usual_walk(seed: int, disturbance: float = 20.0) -> Walked:
    """Return a way of 1500 m with bends, with sound magnetometers."""
    return Walked(turning, 1500.0, disturbance, seed=seed)


@cache
def without_compass() -> Walked:
    """Return the same way without a compass."""
    return Walked(turning, 1500.0, compass=False)


def rms(walks: list[Walked]) -> float:
    return float(np.sqrt(np.mean([walked.degrees**2 for walked in walks])))


@pytest.mark.parametrize("disturbance", [20.0, *soaked(30.0)])
@pytest.mark.soak
def test_a_way_that_turns_keeps_its_heading_by_the_compass_and_the_filter_is_as_uncertain_as_it_is(
    disturbance: float,
) -> None:
    with_compass = [usual_walk(seed, disturbance) for seed in SEEDS]
    assert rms(with_compass) < 0.12 * without_compass().degrees
    assert not any(walked.faults for walked in with_compass)
    squares = [radians(w.degrees) ** 2 / w.error.covariance[HEADING][HEADING] for w in with_compass]
    assert 0.2 < np.mean(squares) < 2.5


@pytest.mark.long
def test_without_any_disturbance_nothing_is_strange_and_no_iron_has_changed() -> None:
    walks = [Walked(turning, 3000.0, 0.0, seed=seed) for seed in SEEDS]
    assert rms(walks) < 3.0
    assert not any(walked.faults for walked in walks)


@pytest.mark.soak
def test_the_iron_of_each_shoe_is_learnt() -> None:
    for seed in SEEDS:
        walked = Walked(turning, 1500.0, 12.0, seed=seed)
        for foot, iron in zip(Foot, walked.iron, strict=True):
            learnt = walked.error.aid(walked.compass.first + H[foot])
            assert abs(learnt - complex(*iron[:2])) < 3.0


def test_on_a_straight_way_nothing_proves_a_compass_so_it_moves_nothing() -> None:
    assert Walked(straight, 800.0).most_moved == 0.0


MIRRORED = np.array([1.0, -1.0, 1.0])


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        (lambda m, foot, s: m * MIRRORED, "mirrored"),
        (lambda m, foot, s: m[[1, 0, 2]], "exchanged"),
        (lambda m, foot, s: 1e6 * m, "give tesla"),
        (lambda m, foot, s: 0.01 * m, "give tesla"),
        (lambda m, foot, s: m + 500.0, "magnet"),
    ],
    ids=["mirrored", "exchanged", "microtesla", "gauss", "magnet in both shoes"],
)
def test_a_magnetometer_that_cannot_be_right_moves_nothing_and_is_reported_once(fault: Fault, words: str) -> None:
    for seed in FEW_SEEDS:
        walked = Walked(turning, 1000.0, seed=seed, fault=fault)
        assert walked.most_moved == 0.0
        sentences = [sentence for sentence in walked.faults if words in sentence]
        assert 1 <= len(sentences) <= 2  # what concerns one foot is reported of both


@pytest.mark.soak
def test_a_magnet_that_comes_to_one_shoe_is_noticed_and_learnt() -> None:
    magnet = np.array([60.0, 30.0, 20.0])
    walks = [
        Walked(turning, 1500.0, seed=seed, fault=lambda m, foot, s: m + magnet * (foot == 0 and s > 500.0))
        for seed in SEEDS
    ]
    assert all("something magnetic" in " ".join(walked.faults) for walked in walks)
    assert rms(walks) < 0.15 * without_compass().degrees


@pytest.mark.soak
def test_a_steel_floor_of_150_m_is_reported_and_its_field_is_not_used() -> None:
    def steel(heading: Heading) -> Fault:
        return lambda m, _, s: m + turned(np.array([-15.0, 35.0, 15.0]), -heading(s)) * (500.0 < s < 650.0)

    walks = [Walked(turning, 900.0, seed=seed, fault=steel(turning)) for seed in SEEDS]
    undisturbed = [Walked(turning, 900.0, seed=seed) for seed in SEEDS]
    assert sum("as over steel" in " ".join(walked.faults) for walked in walks) >= len(SEEDS) - 1
    assert rms(walks) < rms(undisturbed) + 6.0


@pytest.mark.long
def test_the_steel_of_a_lift_does_not_turn_the_track() -> None:
    def lift(measured: np.ndarray, foot: int, s: float) -> np.ndarray:
        return measured + (np.array([-30.0, 25.0, 30.0]) if 700.0 < s < 708.0 else 0.0)

    with_lift = [Walked(turning, 1500.0, seed=seed, fault=lift) for seed in SEEDS]
    assert rms(with_lift) < 1.3 * rms([usual_walk(seed) for seed in SEEDS])
    assert not any(walked.faults for walked in with_lift)
