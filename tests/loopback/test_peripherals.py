"""Emulated peripherals obey every write that the protocols know, and serve what the emulator emits."""

from __future__ import annotations

import pytest
from attrs import evolve
from benches import LEFT, RIGHT, Received, error_code, played, set_up, start, walker, worn
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.emulate.devices.peripheral import Peripheral
from solepath.emulate.sensors.device import Device, device_rng
from solepath.emulate.sensors.insole_device import TICK_RATE, Insole
from solepath.emulate.sensors.sensortags import CC2541, CC2650
from solepath.link.devices import cc2541, cc2650, insole
from solepath.link.profile import Profile
from solepath.types import Site
from solepath.wire.insole import InsoleFrame, parse_frame
from solepath.wire.insole_control import Resend, SetInterval, build_control
from solepath.wire.insole_info import parse_info

DEVICES: list[tuple[Device, Profile]] = [
    (Insole(), insole.PROFILE),
    (CC2650(), cc2650.PROFILE),
    (CC2541(), cc2541.PROFILE),
]


def frames(received: Received) -> list[InsoleFrame]:
    return [parse_frame(outgoing.value) for _, outgoing in received if outgoing.channel == "insole/frame"]


# every device


@pytest.mark.parametrize(("device", "profile"), DEVICES)
def test_only_what_is_subscribed_is_sent_and_only_while_connected(device: Device, profile: Profile) -> None:
    tag = worn(device)
    assert tag.next_due() is None
    assert tag.poll(1.0) == []
    set_up(tag, profile, now=1.0)
    stream = profile.streams[0]
    assert played(tag, 3.0, stream)
    tag.subscribe(stream, False, 3.0)
    assert not played(tag, 5.0, stream)
    tag.subscribe(stream, True, 5.0)
    again = played(tag, 7.0, stream)
    assert again[0][0] < 5.0 + 1.5 / profile.nominal_rate
    assert len(again) == pytest.approx(2.0 * profile.nominal_rate, abs=1.5), "what was missed does not come later"
    tag.disconnected(7.0)
    assert tag.next_due() is None
    start(tag, stream, now=7.5)
    assert not played(tag, 9.0, stream), "a new connection starts with everything off"


@pytest.mark.parametrize(("device", "profile"), DEVICES)
@settings(max_examples=20)
@given(st.lists(st.tuples(st.integers(0, 30), st.binary(max_size=4)), max_size=12))
def test_every_write_is_obeyed_or_rejected(device: Device, profile: Profile, writes: list[tuple[int, bytes]]) -> None:
    tag = _lasting(device)
    set_up(tag, profile)
    channels = [c.channel for s in tag.services for c in s.characteristics]
    now = 0.0
    for which, value in writes:
        error_code(tag, channels[which % len(channels)], value, now)
        error_code(tag, channels[which % len(channels)], None, now)
        now += 0.05
        tag.poll(now)
    tag.disconnected(now)


_BENCHES: dict[str, Peripheral] = {}


def _lasting(device: Device) -> Peripheral:
    """Return one device for all examples, so that each signal is computed once."""
    return _BENCHES.setdefault(type(device).__name__, worn(device))


# the insole


@pytest.mark.parametrize(
    ("device", "site"),
    [
        (Insole(), LEFT),
        (Insole(cells=24, rate=30.0, batch=3), RIGHT),
        (Insole(cells=99, mtu=65, quaternion=True), LEFT),
        (Insole(imu=False, ppm=40.0, ticks=2**32 - 50), RIGHT),
    ],
)
def test_frames_are_byte_for_byte_those_that_the_emulator_emits(device: Insole, site: Site) -> None:
    emitted = [n for n in device.emit(walker(), site, device_rng(3, site)) if n.channel == "insole/frame"]
    tag = set_up(worn(device, site), insole.PROFILE, now=-1.0, mtu=device.mtu)
    assert tag.read("insole/info", -1.0) in [n.data for n in device.emit(walker(), site, device_rng(3, site))]
    received = played(tag, walker().duration + 1.0, "insole/frame")
    walked = [(t, outgoing.value) for t, outgoing in received if emitted[0].t - 1e-6 <= t <= emitted[-1].t + 1e-6]
    assert [value for _, value in walked] == [n.data for n in emitted]
    assert [t for t, _ in walked] == pytest.approx([n.t for n in emitted], abs=1e-9)


@pytest.mark.parametrize("interval", [164, 656, 1000, 3277])
def test_an_interval_set_while_it_runs_goes_on_in_sequence_and_on_the_same_clock(interval: int) -> None:
    tag = set_up(worn(Insole(ppm=0.0)), insole.PROFILE)
    before = played(tag, 4.0)
    tag.write("insole/control", build_control(SetInterval(interval)), 4.0)
    after = played(tag, 8.0)
    (t_old, *_), (t_new, *_) = (before[-1], after[0])
    old, new = frames(before)[-1], frames(after)[0]
    assert new.sequence == (old.sequence + 1) % 2**16
    assert (new.ticks - old.ticks) % 2**32 / TICK_RATE == pytest.approx(t_new - t_old, abs=1.0 / TICK_RATE)
    assert {frame.interval for frame in frames(after)} == {interval}
    assert len(after) == pytest.approx(4.0 * TICK_RATE / interval, abs=1.0)
    assert parse_info(tag.read("insole/info", 8.0) or b"").interval == interval


def test_frames_are_sent_again_flagged_and_otherwise_the_same() -> None:
    tag = set_up(worn(Insole()), insole.PROFILE)
    first = frames(played(tag, 3.0))
    requested = first[-20:-10]
    tag.write("insole/control", build_control(Resend(requested[0].sequence, 10)), 3.0)
    after = frames(played(tag, 3.5))
    assert [evolve(f, retransmitted=False) for f in after if f.retransmitted] == requested
    fresh = [f.sequence for f in after if not f.retransmitted]
    assert fresh[0] == (first[-1].sequence + 1) % 2**16
