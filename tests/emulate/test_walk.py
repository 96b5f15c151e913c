"""Emulated devices send real bytes of the true motion, and the radio loses and damages the set shares of them."""

from collections import Counter
from itertools import pairwise
from math import ceil, radians
from typing import Any

import numpy as np
import pytest

from solepath.emulate.radio import Radio
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.device import SETUP_TIME, Device, Notification
from solepath.emulate.sensors.insole_device import ACC_COUNT, GYRO_COUNT, TICK_RATE, Insole
from solepath.emulate.sensors.insoles import heel_array
from solepath.emulate.sensors.parts import CellErrors, Imu, TriadErrors
from solepath.emulate.sensors.sensors import air_pressure
from solepath.emulate.sensors.sensortags import CC2541, CC2650, T5400_CALIBRATION, raw_barometer_values
from solepath.emulate.sensors.sensortags import GYRO_COUNT as TAG_GYRO_COUNT
from solepath.emulate.walk import emulate, sampled
from solepath.emulate.wearers.shoe import IN_SOLE, Mounting
from solepath.link.decoder import Decoder
from solepath.link.devices import cc2541, cc2650, insole
from solepath.link.profile import Access, Profile
from solepath.types import Foot, Packet, Phase, Sample, Site
from solepath.types.vector import GRAVITY, from_rotation_vector
from solepath.wire.fields import parse_whole
from solepath.wire.fragment import parse_fragment
from solepath.wire.insole import InsoleFrame, parse_frame
from solepath.wire.insole_info import parse_info

SHORT = Route().stand(1.0).walk(6.0, 1.3).stop(1.0)
IDEAL = TriadErrors(density=0.0, bias=0.0, drift=0.0, scale=0.0, cross=0.0, bandwidth=1e9)
IDEAL_IMU = Imu("ideal", IDEAL, IDEAL)
IDEAL_CELL = CellErrors("ideal", gain=0.0, preload=0.0, noise=0.0, lag=1e-6)
PROMPT = Radio(latency=0.0, jitter=0.0)


def parsed(packet: Packet) -> Any:
    return parse_whole({**cc2650.FORMATS, **cc2541.FORMATS}[packet.channel], packet.data)


def frames(packets: tuple[Packet, ...], site: Site) -> list[InsoleFrame]:
    return [parse_frame(p.data) for p in packets if p.site is site and p.channel == "insole/frame"]


def test_the_same_seed_gives_the_same_bytes_and_another_seed_others() -> None:
    radio = Radio(loss=0.05, duplicate=0.02, corrupt=0.02, truncate=0.02, jitter=0.05)
    one, two, three = (emulate(SHORT, radio=radio, seed=seed).packets for seed in (5, 5, 6))
    assert one == two
    assert one != three


def test_the_gait_does_not_depend_on_what_is_worn_or_on_the_radio() -> None:
    one = emulate(SHORT, radio=Radio(loss=0.3), seed=5)
    two = emulate(SHORT, devices={Site.LEFT_FOOT: CC2650()}, seed=5)
    assert one.walker.plan == two.walker.plan


def test_two_insoles_at_100_hz_send_what_they_should() -> None:
    walk = emulate(SHORT, seed=3)
    assert [p.t for p in walk.packets] == sorted(p.t for p in walk.packets)
    for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT):
        channels = Counter(p.channel for p in walk.packets if p.site is site)
        assert channels["insole/info"] == channels["device/firmware"] == channels["device/battery"] == 1
        sent = frames(walk.packets, site)
        assert len(sent) == pytest.approx((walk.truth.duration - SETUP_TIME) * 100, abs=4)
        info = parse_info(next(p.data for p in walk.packets if p.site is site and p.channel == "insole/info"))
        for one, two in pairwise(sent):
            assert two.sequence == (one.sequence + 1) % 2**16
            assert (two.ticks - one.ticks) % 2**32 == one.interval == info.interval
        assert all(frame.foot is site.foot and frame.layout == info.layout == 96 for frame in sent)
        assert len(info.cells) == 96 == len(sent[0].samples[0].cells)


@pytest.mark.parametrize("mounting", [IN_SOLE, Mounting((0.15, 0.01, 0.07), from_rotation_vector((1.0, 2.0, -0.5)))])
def test_an_ideal_insole_reports_the_truth_to_the_count(mounting: Mounting) -> None:
    device = Insole(cells=24, batch=4, mounting=mounting, chip=IDEAL_IMU, cell_part=IDEAL_CELL, ppm=0.0, ticks=1000)
    walk = emulate(SHORT, devices={Site.LEFT_FOOT: device}, radio=PROMPT, seed=2)
    starts, still = [], 0
    for packet in walk.packets:
        if packet.channel != "insole/frame":
            continue
        frame = parse_frame(packet.data)
        t = packet.t - 1e-3 + (np.arange(4) - 3) * frame.interval / TICK_RATE
        starts.append(t[0] - frame.ticks / TICK_RATE)
        # The device's low pass rounds off and delays what is fast; at rest nothing is lost.
        before = np.concatenate([t - 0.03, t])
        if set(walk.truth.feet[Foot.LEFT].phases(before)) == {Phase.STATIONARY}:
            still += 1
            true = walk.walker.kinematics(Foot.LEFT, t, mounting)
            counts = np.array([sample.imu for sample in frame.samples], dtype=float)
            assert counts[:, :3] * ACC_COUNT == pytest.approx(true.force, abs=0.03)
            assert counts[:, 3:] * GYRO_COUNT == pytest.approx(true.rate, abs=0.005)
    assert starts == pytest.approx([starts[0]] * len(starts), abs=1e-9)  # its clock runs true
    assert still > 40


def test_the_counts_of_an_insole_sum_up_to_the_load() -> None:
    device = Insole(cells=99, cell_part=IDEAL_CELL, ppm=0.0)
    walk = emulate(SHORT, devices={Site.RIGHT_FOOT: device}, radio=PROMPT, seed=2)
    info = parse_info(next(p.data for p in walk.packets if p.channel == "insole/info"))
    for packet in walk.packets:
        if packet.channel == "insole/frame":
            load = sum(parse_frame(packet.data).samples[0].cells) * info.pressure_scale
            true = walk.walker.loads.total(Foot.RIGHT, np.array([packet.t - 1e-3]))[0]
            assert load == pytest.approx(true, abs=99 * 0.5 * info.pressure_scale + 1e-6)


def test_a_sampled_walk_has_what_a_perfect_link_makes_of_the_packets() -> None:
    insoles = {
        Site.LEFT_FOOT: Insole(cells=24, quaternion=True, ppm=0.0),
        Site.RIGHT_FOOT: Insole(cells=heel_array(Foot.RIGHT), ppm=0.0),
    }
    found = sampled(SHORT, insoles=insoles, seed=4)
    assert [s.t for s in found.samples] == sorted(s.t for s in found.samples)
    for site in insoles:
        decoder = Decoder(site)
        packets = emulate(SHORT, devices=insoles, radio=PROMPT, seed=4).packets
        decoded = [item for packet in packets if packet.site is site for item in decoder.feed(packet)]
        decoded = [item for item in decoded + decoder.finish() if isinstance(item, Sample)]
        own = [s for s in found.samples if s.site is site]
        assert len(own) == len(decoded)
        for one, other in zip(own, decoded, strict=True):
            assert one.t == pytest.approx(other.t, abs=2e-3)
            assert one.acc == pytest.approx(other.acc) and one.gyro == pytest.approx(other.gyro)
            assert one.pressure == pytest.approx(other.pressure) and one.saturated is other.saturated
            assert (one.quat is None) is (other.quat is None)
            assert one.quat is None or one.quat == pytest.approx(other.quat, abs=1e-4)


def test_frames_too_long_for_the_link_come_in_fragments() -> None:
    walk = emulate(SHORT, devices={Site.LEFT_FOOT: Insole(mtu=65)}, radio=PROMPT, seed=2)
    pieces = [p.data for p in walk.packets if p.channel == "insole/frame"]
    assert max(len(piece) for piece in pieces) == 62
    whole, found = b"", 0
    for piece in pieces:
        fragment = parse_fragment(piece)
        whole = fragment.body if fragment.index == 0 else whole + fragment.body
        if fragment.last:
            assert parse_frame(whole).layout == 96
            found += 1
    assert found == len(pieces) / 3


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
    walk = emulate(SHORT, devices={Site.LEFT_FOOT: device}, seed=2)
    setup = [(p.channel, p.data) for p in walk.packets if p.t < SETUP_TIME]
    expected: list[str] = [*profile.reads]
    for write in profile.setup:
        expected += [write.channel, *write.then_read]
    assert [channel for channel, _ in setup] == expected
    read = {channel.name for channel in profile.channels if channel.access is not Access.WRITE}
    assert [(c, data) for c, data in setup if c not in read] == [(w.channel, w.value) for w in profile.setup]


def test_a_device_reports_other_settings() -> None:
    def value(device: Device, channel: str) -> bytes:
        walk = emulate(SHORT, devices={Site.LEFT_FOOT: device}, seed=2)
        return next(p.data for p in walk.packets if p.channel == channel)

    assert value(CC2650(rate=50.0), "cc2650/movement-period") == b"\x02"
    assert value(CC2650(range=16), "cc2650/movement-config") == b"\x7f\x03"
    assert value(CC2541(code=1), "cc2541/accelerometer-config") == b"\x01"
    assert value(CC2541(rate=20.0), "cc2541/gyroscope-period") == b"\x05"


@pytest.mark.parametrize("rate", [10.0, 20.0])
def test_a_cc2541_sends_each_sensor_at_its_own_time(rate: float) -> None:
    walk = emulate(SHORT, devices={Site.RIGHT_FOOT: CC2541(rate=rate)}, radio=PROMPT, seed=4)
    times = {
        name: [p.t for p in walk.packets if p.channel == f"cc2541/{name}"] for name in ("accelerometer", "gyroscope")
    }
    for found in times.values():
        assert np.diff(found) == pytest.approx(1.0 / rate, rel=1e-3)
    apart = (times["gyroscope"][0] - times["accelerometer"][0]) % (1.0 / rate)
    assert 0.0 < apart < 1.0 / rate
    values = [parsed(p).acc for p in walk.packets if p.channel == "cc2541/accelerometer"]
    rest = np.array(values[: int(0.8 * rate)]) * GRAVITY / 16
    assert np.linalg.norm(rest, axis=1) == pytest.approx(GRAVITY, rel=0.25)
    turns = [parsed(p).gyro for p in walk.packets if p.channel == "cc2541/gyroscope"]
    assert np.abs(turns).max() * TAG_GYRO_COUNT > radians(150)


def test_the_raw_air_of_a_t5400_gives_the_pressure_back() -> None:
    for height in (-20.0, 0.0, 3.0, 400.0):
        pascal = float(air_pressure(np.array([height]))[0])
        raw = raw_barometer_values(pascal)
        assert T5400_CALIBRATION.pascal(**raw) == pytest.approx(pascal, abs=2.0)
        assert T5400_CALIBRATION.celsius(raw["temperature"]) == pytest.approx(24.0, abs=0.1)


def test_a_device_above_the_ankle_is_rejected() -> None:
    with pytest.raises(ValueError):
        emulate(SHORT, devices={Site.PELVIS: CC2650()})


SENT = [Notification(0.01 * k, "insole/frame", bytes([k % 256]) * 20) for k in range(20000)]


def transmitted(radio: Radio, seed: int = 1) -> list[Packet]:
    return radio.transmit(SENT, Site.LEFT_FOOT, np.random.default_rng(seed))


def test_the_set_share_is_lost() -> None:
    assert len(transmitted(Radio(loss=0.05))) / len(SENT) == pytest.approx(0.95, abs=0.006)
    assert transmitted(Radio(loss=1.0)) == []
    assert [p.data for p in transmitted(Radio())] == [n.data for n in SENT]


def test_the_set_shares_are_duplicated_damaged_and_cut() -> None:
    assert len(transmitted(Radio(duplicate=0.04))) / len(SENT) == pytest.approx(1.04, abs=0.006)
    damaged = transmitted(Radio(corrupt=0.03))
    changed = [(n.data, p.data) for n, p in zip(SENT, damaged, strict=True) if n.data != p.data]
    assert len(changed) / len(SENT) == pytest.approx(0.03, abs=0.006)
    for was, now in changed:
        bits = sum((a ^ b).bit_count() for a, b in zip(was, now, strict=True))
        assert len(was) == len(now) and 1 <= bits <= 3
    cut = [p for p in transmitted(Radio(truncate=0.02)) if len(p.data) < 20]
    assert len(cut) / len(SENT) == pytest.approx(0.02, abs=0.005)


def test_packets_are_late_by_latency_and_jitter_and_never_overtake() -> None:
    found = transmitted(Radio(latency=0.01, jitter=0.05))
    late = np.array([p.t for p in found]) - np.array([n.t for n in SENT])
    assert late.min() >= 0.01 and late.max() <= 0.0601
    assert late.min() < 0.013 and late.max() > 0.059
    assert all(a.t <= b.t for a, b in pairwise(found))


def test_without_order_packets_overtake() -> None:
    found = transmitted(Radio(jitter=0.05, in_order=False))
    assert all(a.t <= b.t for a, b in pairwise(found))
    order = [p.data[0] for p in found]
    assert order != [n.data[0] for n in SENT]
    assert sorted(order) == sorted(n.data[0] for n in SENT)


def test_connection_events_deliver_in_bunches() -> None:
    found = transmitted(Radio(interval=0.03, latency=0.0, jitter=0.0))
    moments = sorted({p.t for p in found})
    assert np.diff(moments) == pytest.approx(0.03)
    assert len(moments) == pytest.approx(ceil(len(SENT) / 3), abs=2)


def test_read_and_written_values_always_arrive() -> None:
    setup = [Notification(0.01 * k, "insole/info", b"info", acknowledged=True) for k in range(50)]
    found = Radio(loss=1.0, corrupt=1.0, truncate=1.0).transmit(setup, Site.LEFT_FOOT, np.random.default_rng(1))
    assert [p.data for p in found] == [b"info"] * 50


@pytest.mark.parametrize("bad", [-0.1, 1.1, float("nan")])
def test_an_invalid_share_is_rejected(bad: float) -> None:
    with pytest.raises(ValueError):
        Radio(loss=bad)
