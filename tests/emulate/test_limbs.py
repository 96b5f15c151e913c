"""Pelvis, thighs and shanks move with the feet: connected at the joints, of constant length, without a jump."""

from math import pi, radians

import numpy as np
import pytest

from solepath.emulate.radio import Radio
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.dot import Dot
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import CRE_CC02, WORN_RESISTIVE
from solepath.emulate.sensors.suit import limb_mounting, limb_samples, suit
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.curves import Array
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.limbs import MAX_SLIP, Body, ankle_place
from solepath.emulate.wearers.shoe import Mounting
from solepath.emulate.wearers.turning import matrices, multiply_quaternions, quaternions
from solepath.emulate.wearers.walker import Walker
from solepath.link.decoder import Decoder
from solepath.types import Foot, Quat, Sample, Site
from solepath.types.vector import GRAVITY

ROUTE = Route().stand(2.0).walk(8.0, 1.3).turn(pi, 2.0, 1.1).walk(4.0).turn(pi / 2).walk(3.0).stop(2.0)
ABOVE = [site for site in Site if site.foot is None]


@pytest.fixture(scope="module")
def walker() -> Walker:
    return Walker(ROUTE, seed=3)


@pytest.fixture(scope="module")
def body(walker: Walker) -> Body:
    return walker.body


def times(walker: Walker, step: float = 0.01) -> Array:
    return np.arange(0.0, walker.duration, step)


@pytest.mark.parametrize("foot", list(Foot))
def test_thigh_and_shank_never_change_their_length(walker: Walker, body: Body, foot: Foot) -> None:
    leg, limbs = body.leg(foot, times(walker)), walker.wearer.limbs
    assert np.linalg.norm(leg.hip - leg.knee, axis=1) == pytest.approx(limbs.thigh)
    assert np.linalg.norm(leg.knee - leg.ankle, axis=1) == pytest.approx(limbs.shank)


@pytest.mark.parametrize("foot", list(Foot))
def test_the_chain_from_the_pelvis_down_ends_at_the_ankle_in_the_shoe(walker: Walker, body: Body, foot: Foot) -> None:
    """Equation (7) of Gong et al. 2023: products of rotations and constant lengths alone."""
    t, limbs = times(walker), walker.wearer.limbs
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


@pytest.mark.parametrize("site", list(Site))
def test_no_segment_jumps_or_spins(walker: Walker, body: Body, site: Site) -> None:
    t = times(walker, 0.002)
    at, turn = body.segment(site, t)
    assert np.abs(np.diff(at, axis=0)).max() < 0.002 * 6.0
    q = quaternions(turn)
    assert (np.sum(q[1:] * q[:-1], axis=1) > np.cos(0.5 * 0.002 * 15.0)).all()  # under 15 rad/s
    if site.foot is None:
        rate = body.at(site, t, Mounting((0.0, 0.0, 0.0))).rate
        assert np.abs(np.diff(rate, axis=0)).max() < 1.0  # the heel stops within 14 ms when it strikes


@pytest.mark.parametrize("site", ABOVE)
def test_rates_and_forces_of_body_sensors_are_those_of_their_motion(walker: Walker, body: Body, site: Site) -> None:
    mounting = limb_mounting(site, walker.wearer.limbs, 4)
    t = np.arange(3.0, 6.0, 0.001)
    found = body.at(site, t, mounting)
    half = found.attitude[:-1]
    turned = multiply_quaternions(half * (1.0, -1.0, -1.0, -1.0), found.attitude[1:])
    middle = 0.5 * (found.rate[1:] + found.rate[:-1])
    assert 2.0 * turned[:, 1:] / 0.001 == pytest.approx(middle, abs=0.03)  # differences of 1 ms
    moved = found.position[-1] - found.position[0]
    assert np.trapezoid(found.velocity, t, axis=0) == pytest.approx(moved, abs=1e-4)
    acceleration = np.einsum("nij,nj->ni", matrices(found.attitude), found.force) - (0.0, 0.0, GRAVITY)
    assert np.trapezoid(acceleration, t, axis=0) == pytest.approx(found.velocity[-1] - found.velocity[0], abs=0.02)


def by_site(samples: list[Sample]) -> dict[Site, list[Sample]]:
    return {site: [sample for sample in samples if sample.site is site] for site in Site}


def test_seven_sites_are_sampled_together_and_the_same_seed_gives_the_same() -> None:
    walker = Walker(Route().stand(1.0).walk(4.0, 1.2).stop(1.0), seed=5)
    layouts = {Site.LEFT_FOOT: layout(99, Foot.LEFT), Site.RIGHT_FOOT: layout(99, Foot.RIGHT)}
    samples = limb_samples(walker, 50.0, seed=1, layouts=layouts, cell_part=WORN_RESISTIVE)
    assert samples == limb_samples(walker, 50.0, seed=1, layouts=layouts, cell_part=WORN_RESISTIVE)
    assert [sample.t for sample in samples] == sorted(sample.t for sample in samples)
    for site, own in by_site(samples).items():
        assert [sample.t for sample in own] == pytest.approx([k / 50.0 for k in range(len(own))])
        assert all((sample.pressure is not None) is (site.foot is not None) for sample in own)
        assert all(sample.quat and sample.acc and sample.gyro for sample in own)
    assert samples != limb_samples(walker, 50.0, seed=2, layouts=layouts, cell_part=WORN_RESISTIVE)


def test_attitudes_are_off_by_the_paper_s_sensor_and_mountings_stay(walker: Walker) -> None:
    exact = by_site(limb_samples(walker, 10.0, seed=7, attitude=None, errors=None, tissue=0.0))
    read = by_site(limb_samples(walker, 10.0, seed=7, attitude=CRE_CC02, errors=None, tissue=0.0))
    off = [angle_between_quats(a.quat, b.quat) for site in Site for a, b in zip(exact[site], read[site], strict=True)]
    assert np.sqrt(np.mean(np.square(off))) == pytest.approx(radians(0.81) * np.sqrt(3.0), rel=0.5)
    for site in ABOVE:
        mounting = limb_mounting(site, walker.wearer.limbs, 7)
        assert mounting == limb_mounting(site, walker.wearer.limbs, 7) != limb_mounting(site, walker.wearer.limbs, 8)
        t = np.array([sample.t for sample in exact[site]])
        turn = walker.body.segment(site, t)[1]
        expected = multiply_quaternions(quaternions(turn), np.array([mounting.attitude]))
        same = np.abs(np.sum(expected * np.array([sample.quat for sample in exact[site]]), axis=1))
        assert same == pytest.approx(1.0, abs=1e-9)


def test_seven_devices_feed_their_decoders_with_attitudes_of_the_segments() -> None:
    route = Route().stand(1.5).walk(4.0, 1.2).stop(1.0)
    worn = suit(Wearer().limbs, seed=3)
    walk = emulate(route, devices=worn, radio=Radio(latency=0.0, jitter=0.0), seed=3)
    assert {packet.site for packet in walk.packets} == set(Site)
    for site in Site:
        decoder = Decoder(site)
        outputs = [item for packet in walk.packets if packet.site is site for item in decoder.feed(packet)]
        samples = [item for item in outputs + decoder.finish() if isinstance(item, Sample)]
        assert len(samples) == pytest.approx(walk.truth.duration * (60.0 if site.foot is None else 50.0), rel=0.03)
        t = np.array([sample.t for sample in samples]) - 0.002
        true = walk.walker.body.at(site, t, worn[site].mounting).attitude
        off = [angle_between_quats(s.quat, tuple(q)) for s, q in zip(samples, true.tolist(), strict=True)]
        assert max(off) < radians(7.0) and np.median(off) < radians(3.0)


def test_a_dot_ticks_in_microseconds_and_can_be_worn_on_a_foot_too() -> None:
    walk = emulate(
        Route().stand(2.0), devices={Site.LEFT_FOOT: Dot(ticks=2**32 - 500_000, ppm=0.0)}, radio=Radio(), seed=2
    )
    ticks = [int.from_bytes(p.data[:4], "little") for p in walk.packets if p.channel == "dot-orientation/quaternion"]
    assert ticks[0] == 2**32 - 500_000
    assert {(b - a) % 2**32 for a, b in zip(ticks, ticks[1:], strict=False)} == {16666, 16667}


def angle_between_quats(p: Quat | None, q: tuple[float, ...]) -> float:
    assert p is not None
    return 2.0 * float(np.arccos(min(1.0, abs(sum(a * b for a, b in zip(p, q, strict=True))))))
