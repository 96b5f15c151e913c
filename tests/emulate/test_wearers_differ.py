"""Wearers differ in how a foot swerves in swing, how they wander about a path and how they sway at rest."""

import numpy as np
import pytest

from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.turning import matrices
from solepath.emulate.wearers.walker import Walker
from solepath.lab.emulated.heading_walks import KINDS, LEAST_SWERVE, MOST_SWERVE, heading_route, wearer_of
from solepath.types import Foot

MINUTE = 60.0


def drift_of_one_per_cent(swerve: float) -> float:
    """Heading that a scale error of 1 % of one axis adds, rms over the axes, degrees a minute of walking.

    With a relative error s of axis i, the heading's error is the integral of s (R e_i)_z w_i."""
    walker = Walker(Route().stand(2.0).walk(60.0, 1.3).stop(2.0), Wearer(swerve=(swerve, swerve)), 5)
    t = np.arange(0.0, walker.duration, 0.005)
    motion = walker.kinematics(Foot.LEFT, t)
    drift = 0.01 * 0.005 * (matrices(motion.attitude)[:, 2, :] * motion.rate).sum(axis=0)
    return float(np.degrees(np.linalg.norm(drift))) * MINUTE / (walker.duration - 4.0)


def test_feet_that_swerve_more_turn_the_heading_more_by_the_same_scale_error() -> None:
    little, usual, much = (drift_of_one_per_cent(swerve) for swerve in (LEAST_SWERVE, 1.0, MOST_SWERVE))
    assert 1.5 < little < 5.0 < usual < 12.0 < much < 20.0


@pytest.mark.parametrize("foot", Foot)
def test_a_foot_that_stands_turns_slowly_to_and_fro(foot: Foot) -> None:
    walker = Walker(Route().stand(60.0).walk(5.0).stop(60.0), Wearer(sway=np.radians(0.1)), 3)
    t = np.arange(0.5, 59.0, 0.01)
    means = np.degrees(walker.kinematics(foot, t).rate[: 50 * (len(t) // 50)].reshape(-1, 50, 3).mean(axis=1)) * MINUTE
    assert np.all((means.std(axis=0) > 3.0) & (means.std(axis=0) < 15.0))
    assert np.all(np.abs(means.mean(axis=0)) < 1.0), "and stays where it is"


def test_a_foot_that_sways_moves_without_a_jump() -> None:
    walker = Walker(Route().stand(5.0).walk(5.0).stop(5.0), Wearer(sway=np.radians(0.1)), 3)
    t = np.arange(0.0, walker.duration, 0.001)
    motion = walker.kinematics(Foot.RIGHT, t)
    assert np.abs(np.diff(motion.position, axis=0) / 0.001 - motion.velocity[1:]).max() < 0.05
    turned = np.diff(motion.attitude, axis=0)
    assert np.abs(turned).max() < 0.02


def test_a_wearer_who_wanders_keeps_to_the_path_on_average_and_ends_on_it() -> None:
    aside: list[float] = []
    for seed in range(8):
        walker = Walker(Route().stand(2.0).walk(60.0).stop(2.0), Wearer(wander=0.06, width_variation=0.0), seed)
        lanes = [
            [stride.end.y - side * 0.07 for stride in walker.plan.strides[foot]]
            for foot, side in ((Foot.LEFT, 1.0), (Foot.RIGHT, -1.0))
        ]
        assert abs(lanes[0][-1]) < 0.02 and abs(lanes[1][-1]) < 0.02
        aside += [value for lane in lanes for value in lane[5:-5]]
    assert 0.03 < np.std(aside) < 0.08
    assert abs(np.mean(aside)) < 0.03


@pytest.mark.parametrize("kind", KINDS)
def test_a_route_of_every_kind_is_as_long_as_it_should_be_and_the_same_for_the_same_seed(kind: str) -> None:
    route = heading_route(kind, 3, lambda length, seconds: length >= 200.0)
    assert route == heading_route(kind, 3, lambda length, seconds: length >= 200.0)
    assert 200.0 <= route.length < (2600.0 if kind == "circle" else 720.0)
    assert wearer_of(3) == wearer_of(3) != wearer_of(4)
