"""The seven segments of a body: chains of constant lengths, sensors that move with them, and skin that gives way."""

from __future__ import annotations

from math import pi, radians

import numpy as np
import pytest

from solepath.emulate import Route, emulate
from solepath.emulate.radio import Radio
from solepath.emulate.sensors.parts import CRE_CC02
from solepath.emulate.sensors.suit import limb_mounting, suit
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.limbs import MAX_SLIP, ankle_place
from solepath.emulate.wearers.shoe import Mounting
from solepath.emulate.wearers.turning import matrices, multiply_quaternions
from solepath.emulate.wearers.walker import Walker
from solepath.link.decoder import Decoder
from solepath.types import Foot, Quat, Sample, Site
from solepath.types.vector import GRAVITY
from solepath_lab.emulated.limb_samples import limb_samples

ROUTE = Route().stand(2.0).walk(5.0, 1.3).turn(pi, 2.0, 1.1).walk(2.0).turn(pi / 2).walk(2.0).stop(2.0)
ABOVE = [site for site in Site if site.foot is None]


@pytest.fixture(scope="module")
def walker() -> Walker:
    return Walker(ROUTE, seed=3)


@pytest.mark.parametrize("foot", Foot)
def test_the_chain_from_the_pelvis_down_ends_at_the_ankle_in_the_shoe(walker: Walker, foot: Foot) -> None:
    """Equation (7) of Gong et al. 2023: products of rotations and constant lengths alone."""
    t, limbs, body = np.arange(0.0, walker.duration, 0.01), walker.wearer.limbs, walker.body
    side = 1.0 if foot is Foot.LEFT else -1.0
    thigh, shank = (Site.LEFT_THIGH, Site.LEFT_SHANK) if foot is Foot.LEFT else (Site.RIGHT_THIGH, Site.RIGHT_SHANK)
    at, pelvis = body.segment(Site.PELVIS, t)
    down = np.array([0.0, 0.0, -1.0])
    ankle = at + pelvis @ (0.0, 0.5 * side * limbs.hip_width, 0.0)
    ankle = ankle + body.segment(thigh, t)[1] @ (limbs.thigh * down) + body.segment(shank, t)[1] @ (limbs.shank * down)
    shoe = walker.kinematics(foot, t, Mounting(ankle_place(walker.wearer.shoe, limbs))).position
    loose = np.linalg.norm(ankle - shoe, axis=1)
    assert loose.max() < np.hypot(*MAX_SLIP) + 1e-9
    assert loose == pytest.approx(np.linalg.norm(body.slip(foot, t), axis=1), abs=1e-9)
    leg = body.leg(foot, t)
    assert np.linalg.norm(leg.hip - leg.knee, axis=1) == pytest.approx(limbs.thigh)
    assert np.linalg.norm(leg.knee - leg.ankle, axis=1) == pytest.approx(limbs.shank)


@pytest.mark.parametrize("site", ABOVE)
def test_rates_and_forces_of_body_sensors_are_those_of_their_motion(walker: Walker, site: Site) -> None:
    mounting = limb_mounting(site, walker.wearer.limbs, 4)
    assert mounting == limb_mounting(site, walker.wearer.limbs, 4) != limb_mounting(site, walker.wearer.limbs, 5)
    t = np.arange(3.0, 6.0, 0.001)
    found = walker.body.at(site, t, mounting)
    assert np.abs(np.diff(found.position, axis=0)).max() < 6e-3 and np.abs(found.rate).max() < 15.0
    turned = multiply_quaternions(found.attitude[:-1] * (1.0, -1.0, -1.0, -1.0), found.attitude[1:])
    middle = 0.5 * (found.rate[1:] + found.rate[:-1])
    assert 2.0 * turned[:, 1:] / 0.001 == pytest.approx(middle, abs=0.03)  # differences of 1 ms
    moved = found.position[-1] - found.position[0]
    assert np.trapezoid(found.velocity, t, axis=0) == pytest.approx(moved, abs=1e-4)
    acceleration = np.einsum("nij,nj->ni", matrices(found.attitude), found.force) - (0.0, 0.0, GRAVITY)
    assert np.trapezoid(acceleration, t, axis=0) == pytest.approx(found.velocity[-1] - found.velocity[0], abs=0.02)


def test_seven_sites_are_sampled_together_with_the_attitude_errors_of_the_paper_s_sensor(walker: Walker) -> None:
    exact, read, again = (
        limb_samples(walker, 10.0, seed=7, attitude=part, tissue=0.0, limb_attitudes_only=True)
        for part in (None, CRE_CC02, CRE_CC02)
    )
    assert read == again != exact
    off = [angle_between(one.quat, two.quat) for one, two in zip(exact, read, strict=True)]
    assert np.sqrt(np.mean(np.square(off))) == pytest.approx(radians(0.81) * np.sqrt(3.0), rel=0.5)
    for site in Site:
        own = [sample.t for sample in read if sample.site is site]
        assert own == pytest.approx([k / 10.0 for k in range(len(own))]) and len(own) > 100


def test_seven_devices_feed_their_decoders_with_attitudes_of_the_segments() -> None:
    worn = suit(Wearer().limbs, seed=3)
    route = Route().stand(1.5).walk(4.0, 1.2).stop(1.0)
    walk = emulate(route, devices=worn, radio=Radio(latency=0.0, jitter=0.0), seed=3)
    for site in Site:
        decoder = Decoder(site)
        outputs = [item for packet in walk.packets if packet.site is site for item in decoder.feed(packet)]
        samples = [item for item in outputs + decoder.finish() if isinstance(item, Sample)]
        assert len(samples) == pytest.approx(walk.truth.duration * (60.0 if site.foot is None else 50.0), rel=0.03)
        t = np.array([sample.t for sample in samples]) - 0.002
        true = walk.walker.body.at(site, t, worn[site].mounting).attitude
        off = [angle_between(s.quat, tuple(q)) for s, q in zip(samples, true.tolist(), strict=True)]
        assert max(off) < radians(7.0) and np.median(off) < radians(3.0)


def angle_between(p: Quat | None, q: tuple[float, ...] | None) -> float:
    assert p is not None and q is not None
    return 2.0 * float(np.arccos(min(1.0, abs(sum(a * b for a, b in zip(p, q, strict=True))))))
