"""Worn soles: slip, soft impacts, a pivot elsewhere, and insoles that alias."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest
from attrs import evolve

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.walk import sampled
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.shoe import Mounting, Shoe
from solepath.emulate.wearers.soles.contact import RIGID, WORN, GroundContact
from solepath.emulate.wearers.walker import Walker
from solepath.types import SITE_OF_FOOT, Foot

ROUTE = Route().stand(1.0).walk(8.0, 1.3).stop(1.0)


def walker_of(contact: GroundContact, seed: int = 5) -> Walker:
    return Walker(ROUTE, Wearer(shoe=Shoe(contact=contact)), seed=seed)


@pytest.mark.parametrize("contact", [WORN, evolve(WORN, pivot_shift=-0.02), evolve(WORN, pivot_shift=0.02)])
def test_a_worn_sole_moves_as_smoothly_as_a_rigid_one(contact: GroundContact) -> None:
    walker = walker_of(contact)
    t = np.arange(0.0, walker.duration, 1e-4)
    found = walker.kinematics(Foot.LEFT, t)
    assert np.linalg.norm(np.diff(found.position, axis=0), axis=1).max() < 6.5 * 1e-4
    assert np.linalg.norm(np.diff(found.velocity, axis=0), axis=1).max() < 250.0 * 1e-4
    assert found.position[:, 2].max() < 0.16


def test_the_strides_of_a_worn_sole_are_those_of_a_rigid_one() -> None:
    """Slip and impact move the foot within a stride; where it stands next is planned."""
    worn, rigid = (walker_of(contact).truth().strides(Foot.RIGHT) for contact in (WORN, RIGID))
    assert [a.length for a in worn] == pytest.approx([b.length for b in rigid], abs=1e-9)


def test_the_toe_slides_back_by_the_slip_before_toe_off() -> None:
    slip = 0.02
    walker = walker_of(evolve(RIGID, toe_slip=slip))
    motion, rigid_motion = walker.motions[Foot.LEFT], walker_of(RIGID).motions[Foot.LEFT]
    arc = walker.wearer.shoe.forefoot
    at_centre = Mounting((arc.x, 0.0, arc.radius))
    for stride in walker.plan.strides[Foot.LEFT]:
        t = np.array([stride.toe_off - 1e-6])
        centre, rigid = motion.at(t, at_centre).position[0], rigid_motion.at(t, at_centre).position[0]
        assert np.linalg.norm(centre - rigid) == pytest.approx(slip, rel=1e-3)
        assert centre[0] < rigid[0]


def test_a_soft_heel_slides_longer_and_lands_more_gently() -> None:
    hard, soft = walker_of(RIGID), walker_of(evolve(RIGID, impact_time=0.05))
    stride = hard.plan.strides[Foot.RIGHT][2]
    t = np.linspace(stride.heel_strike, stride.heel_strike + 0.05, 200)
    peaks = [np.abs(walker.kinematics(Foot.RIGHT, t).acceleration[:, 0]).max() for walker in (hard, soft)]
    assert peaks[1] < 0.5 * peaks[0]


def test_a_rigid_sole_draws_nothing_and_a_worn_one_draws_each_stride() -> None:
    rng = np.random.default_rng(1)
    assert len({RIGID.draw(rng) for _ in range(5)}) == 1
    drawn = [WORN.draw(rng) for _ in range(200)]
    assert 0.014 <= min(one.impact_time for one in drawn) < max(one.impact_time for one in drawn) <= 0.05
    assert min(one.toe_slip for one in drawn) == 0.0


def test_without_a_low_pass_the_noise_and_the_impact_of_all_frequencies_are_in_the_samples() -> None:
    def forces(bandwidth: float | None) -> np.ndarray:
        insoles = {SITE_OF_FOOT[Foot.LEFT]: Insole(rate=30.0, bandwidth=bandwidth)}
        walk = sampled(ROUTE, insoles=insoles, seed=3)
        return np.array([sample.acc for sample in walk.samples])

    aliased, filtered = forces(inf), forces(None)
    assert np.array_equal(filtered, forces(15.0))
    standing = slice(0, 25)
    assert aliased[standing].std(axis=0).min() > 2.0 * filtered[standing].std(axis=0).max()
    # an impact of 14 ms, or what is left of it at 15 Hz, in the differences of neighbouring samples
    assert np.abs(np.diff(aliased, axis=0)).max() > 1.1 * np.abs(np.diff(filtered, axis=0)).max()
