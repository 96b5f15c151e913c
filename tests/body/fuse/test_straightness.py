"""Straight ways show the drift of the heading, other ways do not, and the covariance says how sure the place is."""

from __future__ import annotations

from cmath import rect
from collections.abc import Callable
from math import cos, hypot, radians, sin

import numpy as np
import pytest
from soak import soaked

from solepath.body.fuse.common_error import DRIFT, FEET, CommonError
from solepath.body.fuse.straight_ways import Straightness
from solepath.saving import codec as machine
from solepath.types import Foot
from solepath_lab.emulated.unsteady import Wander

STEP = 0.65
"""Advance of the body from the stride of one foot to that of the other, m."""
STEP_TIME = 0.5


class Walked:
    """A wearer on a way, with both feet's strides as a gyroscope that drifts has them.

    `heading(s)` is the direction of the way after s m; the wearer wanders about it by 5 cm."""

    def __init__(self, heading: Callable[[float], float], length: float, drift: float, seed: int = 1) -> None:
        rng = np.random.default_rng(seed)
        wander = Wander.drawn(length + 10.0, 0.05, rng)
        self.error, self.straightness, self.found = CommonError(), Straightness(), 0
        self.off, self.turned = 0.0, 0.0
        """Heading error of the track, rad, and turn of the way so far, rad."""
        place = true_place = np.zeros(2)
        for row in FEET.values():  # the bias is known
            self.error.covariance[row + 2][row + 2] = 0.0
        for k in range(int(length / STEP)):
            s = k * STEP
            turn = heading(s + 2.0 * STEP) - heading(s)
            aside = wander.at(s + 2.0 * STEP)[0] - wander.at(s)[0] + 0.01 * float(rng.standard_normal())
            direction = heading(s + STEP)
            step = np.array([2.0 * STEP, aside])
            foot = (Foot.LEFT, Foot.RIGHT)[k % 2]
            self.off += 0.5 * (drift - self.error.turn_of(foot, 1.0, turn, 2.0 * STEP_TIME))
            moved = complex(*step) * rect(1.0, direction - self.off)
            self.error.propagate(foot, 1.0, turn, 2.0 * STEP_TIME, moved, (1e-4, 0.0, 1e-4))
            sigma = self.error.drift_variance(2.0 * STEP_TIME) ** 0.5
            stretch = self.straightness.add_stride(STEP_TIME * k, moved, 0.5, 1.0, turn)
            one = None if stretch is None else self.straightness.drift_of(stretch, sigma)
            place = place + 0.5 * np.array([moved.real, moved.imag])
            true_place = true_place + 0.5 * np.array(
                [
                    cos(direction) * step[0] - sin(direction) * step[1],
                    sin(direction) * step[0] + cos(direction) * step[1],
                ]
            )
            if one is not None:
                self.found += 1
                dx, dy, yaw = self.error.correct_drift(one.drift, one.variance, one.weight, one.stride_time)
                place = place + (dx, dy)
                self.off -= yaw
        self.place, self.true_place = place, true_place


def corridors(length: float, angle: float) -> Callable[[float], float]:
    """Straights of `length` m, between them bends of 2 m by `angle` rad, in turn to the left and to the right."""

    def heading(s: float) -> float:
        number, along = divmod(s, length + 2.0)
        done = angle if int(number) % 2 else 0.0
        return done + (1.0 if int(number) % 2 == 0 else -1.0) * angle * min(1.0, max(0.0, along - length) / 2.0)

    return heading


def bends(radius: float) -> Callable[[float], float]:
    return lambda s: s / radius


def weaves(radius: float, arc: float) -> Callable[[float], float]:
    """Arcs of `arc` m, in turn to the left and to the right."""
    return lambda s: (min(s % (2.0 * arc), 2.0 * arc - s % (2.0 * arc)) - 0.5 * arc) / radius


@pytest.mark.parametrize("drift", [-0.002, 0.0007])
def test_corridors_show_the_drift(drift: float) -> None:
    errors = [Walked(corridors(25.0, 1.0), 500.0, drift, seed).error for seed in range(6)]
    off = [abs(one.drift_with_bias(0.0) - drift) for one in errors]
    sigmas = [one.drift_variance(0.0) ** 0.5 for one in errors]
    assert all(error < 4.0 * sigma for error, sigma in zip(off, sigmas, strict=True))
    assert np.mean(off) < 2.5e-4
    assert all(sigma < 0.4 * DRIFT for sigma in sigmas), "and the filter knows that it has learnt"


@pytest.mark.parametrize("radius", [15.0, *soaked(-60.0, 100.0)])
def test_a_ring_is_not_straightened(radius: float) -> None:
    """Ten times round a ring of 40 m radius, and as far in others; the drift may be learnt by 3 % of the bend."""
    for seed in range(3):
        error = Walked(bends(radius), 2500.0, 0.0, seed).error
        assert abs(error.drift_with_bias(0.0)) < 0.03 * 2.0 * STEP / abs(radius)


@pytest.mark.parametrize(("radius", "arc"), [(60.0, 15.0), (150.0, 40.0)])
def test_a_slow_weave_is_not_straightened(radius: float, arc: float) -> None:
    drifts = [Walked(weaves(radius, arc), 1000.0, 0.0, seed).error.drift_with_bias(0.0) for seed in range(6)]
    assert np.mean(np.abs(drifts)) < 2.5e-4
    assert abs(np.mean(drifts)) < 2.0e-4


def test_a_straight_walk_without_drift_keeps_its_direction() -> None:
    walked = [Walked(lambda s: 0.0, 300.0, 0.0, seed) for seed in range(6)]
    assert all(one.found > 2 for one in walked)
    assert np.mean([abs(one.error.drift_with_bias(0.0)) for one in walked]) < 1.5e-4
    assert all(abs(one.off) < radians(5.0) for one in walked)


def test_what_a_way_has_shown_turns_the_track_back() -> None:
    for seed in range(4):
        learnt, ignored = (Walked(corridors(30.0, 1.0), 600.0, 0.0015, seed) for _ in range(2))
        assert abs(learnt.off) < radians(12.0) < 0.5 * 0.0015 * 600.0 / STEP
        assert hypot(*(learnt.place - learnt.true_place)) < 0.06 * 600.0 < 0.2 * 0.0015 * 600.0 / STEP * 300.0
        assert machine.load(CommonError, machine.save(ignored.error)) == learnt.error
        assert machine.load(Straightness, machine.save(ignored.straightness)) == learnt.straightness
