"""Emulated devices send real bytes of the true motion, and the radio loses and damages the set shares of them."""

from collections import Counter
from itertools import pairwise
from math import nan

import numpy as np
import pytest

from solepath import Foot, Packet, Phase, Sample, Site
from solepath.emulate import CC2541, CC2650, Insole, Route, emulate, sampled
from solepath.emulate.radio import Radio
from solepath.emulate.sensors.device import SETUP_TIME, Device, Notification
from solepath.emulate.sensors.dot import Dot
from solepath.emulate.sensors.insole_device import ACC_COUNT, GYRO_COUNT, TICK_RATE
from solepath.emulate.sensors.parts import CellErrors, Imu, TriadErrors
from solepath.emulate.wearers.shoe import IN_SOLE, Mounting
from solepath.link.decoder import Decoder
from solepath.link.devices import cc2541, cc2650, insole
from solepath.link.profile import Access, Profile
from solepath.types.vector import from_rotation_vector
from solepath.wire.insole import parse_frame
from solepath.wire.insole_info import parse_info
from solepath_lab.emulated.boot import heel_array

SHORT = Route().stand(1.0).walk(6.0, 1.3).stop(1.0)
IDEAL = TriadErrors(density=0.0, bias=0.0, drift=0.0, scale=0.0, cross=0.0, bandwidth=1e9)
IDEAL_IMU = Imu("ideal", IDEAL, IDEAL)
IDEAL_CELL = CellErrors("ideal", gain=0.0, preload=0.0, noise=0.0, lag=1e-6)
PROMPT = Radio(latency=0.0, jitter=0.0)
LEFT, RIGHT = Site.LEFT_FOOT, Site.RIGHT_FOOT


def test_the_same_seed_gives_the_same_bytes_and_the_gait_does_not_depend_on_device_or_radio() -> None:
    radio = Radio(loss=0.05, duplicate=0.02, corrupt=0.02, truncate=0.02, jitter=0.05)
    one, two, three = (emulate(SHORT, radio=radio, seed=seed) for seed in (5, 5, 6))
    assert one.packets == two.packets != three.packets
    assert emulate(SHORT, devices={LEFT: CC2650()}, seed=5).walker.plan == one.walker.plan


def test_two_insoles_at_100_hz_send_what_they_should() -> None:
    walk = emulate(SHORT, seed=3)
    assert [p.t for p in walk.packets] == sorted(p.t for p in walk.packets)
    for site in (LEFT, RIGHT):
        own = [p for p in walk.packets if p.site is site]
        channels = Counter(p.channel for p in own)
        assert channels["insole/info"] == channels["device/firmware"] == channels["device/battery"] == 1
        sent = [parse_frame(p.data) for p in own if p.channel == "insole/frame"]
        assert len(sent) == pytest.approx((walk.truth.duration - SETUP_TIME) * 100, abs=4)
        info = parse_info(next(p.data for p in own if p.channel == "insole/info"))
        for one, two in pairwise(sent):
            assert two.sequence == (one.sequence + 1) % 2**16
            assert (two.ticks - one.ticks) % 2**32 == one.interval == info.interval
        assert all(frame.foot is site.foot and frame.layout == info.layout == 96 for frame in sent)
        assert len(info.cells) == 96 == len(sent[0].samples[0].cells)


@pytest.mark.parametrize("mounting", [IN_SOLE, Mounting((0.15, 0.01, 0.07), from_rotation_vector((1.0, 2.0, -0.5)))])
def test_an_ideal_insole_reports_the_true_motion_and_load_to_the_count(mounting: Mounting) -> None:
    device = Insole(cells=24, batch=4, mounting=mounting, chip=IDEAL_IMU, cell_part=IDEAL_CELL, ppm=0.0, ticks=1000)
    walk = emulate(SHORT, devices={LEFT: device}, radio=PROMPT, seed=2)
    info = parse_info(next(p.data for p in walk.packets if p.channel == "insole/info"))
    starts, still = [], 0
    for packet in walk.packets:
        if packet.channel != "insole/frame":
            continue
        frame = parse_frame(packet.data)
        t = packet.t - 1e-3 + (np.arange(4) - 3) * frame.interval / TICK_RATE
        starts.append(t[0] - frame.ticks / TICK_RATE)
        loads = [sum(sample.cells) * info.pressure_scale for sample in frame.samples]
        assert loads == pytest.approx(walk.walker.loads.total(Foot.LEFT, t), abs=12 * info.pressure_scale + 1e-6)
        # The device's low pass rounds off and delays what is fast; at rest nothing is lost.
        if set(walk.truth.feet[Foot.LEFT].phases(np.concatenate([t - 0.03, t]))) == {Phase.STATIONARY}:
            still += 1
            true = walk.walker.kinematics(Foot.LEFT, t, mounting)
            counts = np.array([sample.imu for sample in frame.samples], dtype=float)
            assert counts[:, :3] * ACC_COUNT == pytest.approx(true.force, abs=0.03)
            assert counts[:, 3:] * GYRO_COUNT == pytest.approx(true.rate, abs=0.005)
    assert starts == pytest.approx([starts[0]] * len(starts), abs=1e-9)  # its clock runs true
    assert still > 40


def test_broken_cells_of_a_device_have_the_same_count_in_every_frame_and_the_others_their_own() -> None:
    broken, whole = (
        [
            parse_frame(p.data).samples[0]
            for p in emulate(SHORT, devices={LEFT: Insole(cells=24, broken=which)}, radio=PROMPT, seed=2).packets
            if p.channel == "insole/frame"
        ]
        for which in (((2, 0), (9, 300)), ())
    )
    for one, sound in zip(broken, whole, strict=True):
        assert one.imu == sound.imu
        assert one.cells == tuple({2: 0, 9: 300}.get(k, count) for k, count in enumerate(sound.cells))


def test_a_sampled_walk_has_what_a_perfect_link_makes_of_the_packets() -> None:
    insoles = {LEFT: Insole(cells=24, quaternion=True, ppm=0.0), RIGHT: Insole(cells=heel_array(Foot.RIGHT), ppm=0.0)}
    found = sampled(SHORT, insoles=insoles, seed=4)
    packets = emulate(SHORT, devices=insoles, radio=PROMPT, seed=4).packets
    assert [s.t for s in found.samples] == sorted(s.t for s in found.samples)
    for site in insoles:
        decoder = Decoder(site)
        decoded = [item for packet in packets if packet.site is site for item in decoder.feed(packet)]
        decoded = [item for item in decoded + decoder.finish() if isinstance(item, Sample)]
        for one, other in zip([s for s in found.samples if s.site is site], decoded, strict=True):
            assert one.t == pytest.approx(other.t, abs=2e-3)
            assert one.acc == pytest.approx(other.acc) and one.gyro == pytest.approx(other.gyro)
            assert one.pressure == pytest.approx(other.pressure) and one.saturated is other.saturated
            assert one.quat == (None if other.quat is None else pytest.approx(other.quat, abs=1e-4))


@pytest.mark.parametrize(
    ("device", "profile"),
    [
        (Insole(), insole.PROFILE),
        (CC2650(), cc2650.PROFILE),
        (CC2541(), cc2541.PROFILE),
        (CC2541(rate=20.0), cc2541.PROFILE_20HZ),
    ],
    ids=["insole", "cc2650", "cc2541", "cc2541 at 20 Hz"],
)
def test_a_recording_starts_with_all_reads_and_writes(device: Device, profile: Profile) -> None:
    walk = emulate(SHORT, devices={LEFT: device}, seed=2)
    setup = [(p.channel, p.data) for p in walk.packets if p.t < SETUP_TIME]
    expected: list[str] = [*profile.reads]
    for write in profile.setup:
        expected += [write.channel, *write.then_read]
    assert [channel for channel, _ in setup] == expected
    read = {channel.name for channel in profile.channels if channel.access is not Access.WRITE}
    assert [(c, data) for c, data in setup if c not in read] == [(w.channel, w.value) for w in profile.setup]


@pytest.mark.parametrize(
    ("device", "channel", "value"),
    [
        (CC2650(rate=50.0), "cc2650/movement-period", b"\x02"),
        (CC2650(range=16), "cc2650/movement-config", b"\x7f\x03"),
        (CC2541(code=1), "cc2541/accelerometer-config", b"\x01"),
    ],
)
def test_a_device_reports_other_settings(device: Device, channel: str, value: bytes) -> None:
    walk = emulate(Route().stand(1.0), devices={LEFT: device}, seed=2)
    assert next(p.data for p in walk.packets if p.channel == channel) == value


def test_a_dot_ticks_in_microseconds_and_can_be_worn_on_a_foot_too() -> None:
    walk = emulate(Route().stand(2.0), devices={LEFT: Dot(ticks=2**32 - 500_000, ppm=0.0)}, radio=Radio(), seed=2)
    ticks = [int.from_bytes(p.data[:4], "little") for p in walk.packets if p.channel == "dot-orientation/quaternion"]
    assert ticks[0] == 2**32 - 500_000
    assert {(b - a) % 2**32 for a, b in pairwise(ticks)} == {16666, 16667}


def test_a_device_above_the_ankle_is_rejected() -> None:
    with pytest.raises(ValueError):
        emulate(SHORT, devices={Site.PELVIS: CC2650()})


SENT = [Notification(0.01 * k, "insole/frame", bytes([k % 256]) * 20) for k in range(5000)]


def transmitted(radio: Radio) -> list[Packet]:
    return radio.transmit(SENT, LEFT, np.random.default_rng(1))


def test_the_set_shares_are_lost_duplicated_damaged_and_cut() -> None:
    assert [p.data for p in transmitted(Radio())] == [n.data for n in SENT] and transmitted(Radio(loss=1.0)) == []
    assert len(transmitted(Radio(loss=0.05))) / len(SENT) == pytest.approx(0.95, abs=0.006)
    assert len(transmitted(Radio(duplicate=0.04))) / len(SENT) == pytest.approx(1.04, abs=0.006)
    damaged = zip(SENT, transmitted(Radio(corrupt=0.03)), strict=True)
    changed = [(n.data, p.data) for n, p in damaged if n.data != p.data]
    assert len(changed) / len(SENT) == pytest.approx(0.03, abs=0.006)
    for was, now in changed:
        assert 1 <= sum((a ^ b).bit_count() for a, b in zip(was, now, strict=True)) <= 3
    cut = [p for p in transmitted(Radio(truncate=0.02)) if len(p.data) < 20]
    assert len(cut) / len(SENT) == pytest.approx(0.02, abs=0.005)


def test_packets_are_late_by_latency_and_jitter_and_overtake_only_where_they_may() -> None:
    found = transmitted(Radio(latency=0.01, jitter=0.05))
    late = np.array([p.t for p in found]) - np.array([n.t for n in SENT])
    assert 0.01 <= late.min() < 0.013 and 0.059 < late.max() <= 0.0601
    free = transmitted(Radio(jitter=0.05, in_order=False))
    assert all(a.t <= b.t for packets in (found, free) for a, b in pairwise(packets))
    order = [n.data[0] for n in SENT]
    assert [p.data[0] for p in found] == order != [p.data[0] for p in free]
    assert sorted(order) == sorted(p.data[0] for p in free)


def test_read_and_written_values_always_arrive() -> None:
    setup = [Notification(0.01 * k, "insole/info", b"info", acknowledged=True) for k in range(50)]
    found = Radio(loss=1.0, corrupt=1.0, truncate=1.0).transmit(setup, LEFT, np.random.default_rng(1))
    assert [p.data for p in found] == [b"info"] * 50


@pytest.mark.parametrize("bad", [-0.1, 1.1, nan])
def test_an_invalid_share_is_rejected(bad: float) -> None:
    with pytest.raises(ValueError):
        Radio(loss=bad)
