"""Emulated peripherals obey every write that the protocols know, and serve what the emulator emits."""

from __future__ import annotations

import pytest
from attrs import evolve
from benches import LEFT, RIGHT, ROUTE, Heard, begin, played, refusal, set_up, walker, worn
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.emulate.devices.bench import Bench
from solepath.emulate.devices.peripheral import Peripheral
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.device import Device, device_numbers
from solepath.emulate.sensors.insole_device import TICK_RATE, Insole
from solepath.emulate.sensors.sensortags import CC2541, CC2650
from solepath.link import profile
from solepath.link.decoder import Decoder
from solepath.link.profile import Access, Profile
from solepath.types import Packet, Sample, Site
from solepath.wire import cc2541, cc2650
from solepath.wire.insole import InsoleFrame, parse_frame
from solepath.wire.insole_control import Resend, SetInterval, build_control
from solepath.wire.insole_info import parse_info

START, STOP = b"\x01", b"\x02"
DEVICES: list[tuple[Device, Profile]] = [
    (Insole(), profile.INSOLE),
    (CC2650(), profile.CC2650),
    (CC2541(), profile.CC2541),
]


def frames(heard: Heard) -> list[InsoleFrame]:
    return [parse_frame(outgoing.value) for _, outgoing in heard if outgoing.channel == "insole/frame"]


# every device


@pytest.mark.parametrize(("device", "known"), DEVICES)
def test_a_device_has_the_attributes_of_its_profile_and_what_else_it_has(device: Device, known: Profile) -> None:
    table = {(s.uuid, c.uuid): c for s in worn(device).services for c in s.characteristics}
    for channel in known.channels:
        served = table[channel.service, channel.characteristic]
        assert served.channel == channel.name
        assert ("write" if channel.how is Access.WRITE else channel.how.value) in served.properties
    assert any(c.channel == "device/manufacturer" for c in table.values())
    assert len({c.channel for c in table.values()}) == len(table)


@pytest.mark.parametrize(("device", "known"), DEVICES)
def test_what_was_set_up_decodes_to_samples_and_nothing_else_odd(device: Device, known: Profile) -> None:
    tag, decoder, out = worn(device), Decoder(site=LEFT), []
    begin(tag, *(c.name for c in known.channels if c.how is Access.NOTIFY))
    said = [(name, tag.read(name, 0.0)) for name in known.reads]
    for write in known.setup:
        tag.write(write.channel, write.value, 0.0)
        said += [(write.channel, write.value), *((name, tag.read(name, 0.0)) for name in write.then_read)]
    for name, value in said:
        out += decoder.feed(Packet(0.0, LEFT, name, value or b""))
    for t, outgoing in played(tag, walker().duration):
        out += decoder.feed(Packet(t, LEFT, outgoing.channel, outgoing.value))
    samples = [one for one in out if isinstance(one, Sample)]
    assert len(samples) == pytest.approx(walker().duration * known.nominal_rate, rel=0.05)
    assert {type(one).__name__ for one in out} <= {"Sample", "LayoutKnown", "BatteryLevel"}


@pytest.mark.parametrize(("device", "known"), DEVICES)
def test_only_what_is_subscribed_is_sent_and_only_while_connected(device: Device, known: Profile) -> None:
    tag = worn(device)
    assert tag.next_due() is None
    assert tag.poll(1.0) == []
    set_up(tag, known, now=1.0)
    stream = known.streams[0]
    assert played(tag, 3.0, stream)
    tag.subscribe(stream, False, 3.0)
    assert not played(tag, 5.0, stream)
    tag.subscribe(stream, True, 5.0)
    again = played(tag, 7.0, stream)
    assert again[0][0] < 5.0 + 1.5 / known.nominal_rate
    assert len(again) == pytest.approx(2.0 * known.nominal_rate, abs=1.5), "what was missed does not come later"
    tag.disconnected(7.0)
    assert tag.next_due() is None
    begin(tag, stream, now=7.5)
    assert not played(tag, 9.0, stream), "a new connection begins with everything off"


@pytest.mark.parametrize(("device", "known"), DEVICES)
def test_attributes_refuse_what_they_are_not_made_for(device: Device, known: Profile) -> None:
    tag = begin(worn(device))
    assert refusal(tag, "device/firmware", b"x") == 0x03
    assert refusal(tag, "no such channel") == 0x02
    with pytest.raises(Exception, match="0x06"):
        tag.subscribe("device/firmware", True, 0.0)
    keys = f"{known.name}/keys"
    assert refusal(tag, "insole/frame" if known is profile.INSOLE else keys) == 0x02


@pytest.mark.parametrize(("device", "known"), DEVICES)
def test_the_streams_never_dry_up_before_and_after_the_walk(device: Device, known: Profile) -> None:
    tag = set_up(worn(device, began=1000.0), known, now=900.0)
    stream = known.streams[0]
    assert len(played(tag, 910.0, stream)) == pytest.approx(10.0 * known.nominal_rate, rel=0.02)
    tag.disconnected(910.0)
    set_up(tag, known, now=5000.0)
    heard = played(tag, 5010.0, stream)
    assert len(heard) == pytest.approx(10.0 * known.nominal_rate, rel=0.02)
    assert all(5000.0 <= t <= 5010.0 for t, _ in heard)


@pytest.mark.parametrize(("device", "known"), DEVICES)
@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 30), st.binary(max_size=4)), max_size=12))
def test_whatever_is_written_is_obeyed_or_refused(
    device: Device, known: Profile, writes: list[tuple[int, bytes]]
) -> None:
    tag = _lasting(device)
    set_up(tag, known)
    channels = [c.channel for s in tag.services for c in s.characteristics]
    now = 0.0
    for which, value in writes:
        refusal(tag, channels[which % len(channels)], value, now)
        refusal(tag, channels[which % len(channels)], None, now)
        now += 0.05
        tag.poll(now)
    tag.disconnected(now)


_BENCHES: dict[str, Peripheral] = {}


def _lasting(device: Device) -> Peripheral:
    """One device for all examples, so that each signal is worked out once."""
    return _BENCHES.setdefault(type(device).__name__, worn(device))


def test_a_walk_may_be_begun_when_the_devices_run_already() -> None:
    tag = set_up(worn(Insole(), began=1e6), profile.INSOLE)
    still = frames(played(tag, 3.0))
    tag.began = 3.0
    walk = frames(played(tag, 3.0 + walker().duration))
    assert len({frame.samples for frame in still}) == 1
    assert len({frame.samples for frame in walk}) > 0.9 * len(walk)


def test_a_name_that_an_advertisement_cannot_hold_is_the_callers_mistake() -> None:
    with pytest.raises(ValueError, match="31 fit"):
        worn(Insole(), faults='0 * name "a name that is far too long"')


def test_a_bench_tells_its_devices_apart_by_address_and_names_insoles_by_side() -> None:
    bench = Bench(ROUTE)
    assert [p.name for p in bench.peripherals] == ["solepath L", "solepath R"]
    tags = Bench(ROUTE, devices={RIGHT: CC2650(), LEFT: CC2650()})
    assert [p.site for p in tags.peripherals] == [LEFT, RIGHT]
    assert {p.name for p in tags.peripherals} == {"CC2650 SensorTag"}
    assert len({p.address for p in tags.peripherals}) == 2
    with pytest.raises(ValueError, match="only feet"):
        Bench(ROUTE, devices={Site.PELVIS: Insole()})


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
    emitted = [n for n in device.emit(walker(), site, device_numbers(3, site)) if n.channel == "insole/frame"]
    tag = set_up(worn(device, site), profile.INSOLE, now=-1.0, mtu=device.mtu)
    assert tag.read("insole/info", -1.0) in [n.data for n in device.emit(walker(), site, device_numbers(3, site))]
    heard = played(tag, walker().duration + 1.0, "insole/frame")
    walked = [(t, outgoing.value) for t, outgoing in heard if emitted[0].t - 1e-6 <= t <= emitted[-1].t + 1e-6]
    assert [value for _, value in walked] == [n.data for n in emitted]
    assert [t for t, _ in walked] == pytest.approx([n.t for n in emitted], abs=1e-9)


def test_sequence_and_ticks_count_through_before_during_and_after_the_walk() -> None:
    found = frames(played(set_up(worn(Insole()), profile.INSOLE, now=-5.0), walker().duration + 5.0))
    for one, following in zip(found, found[1:], strict=False):
        assert following.sequence == (one.sequence + 1) % 2**16
        assert following.ticks == (one.ticks + one.interval) % 2**32


@pytest.mark.parametrize("asked", [164, 656, 1000, 3277])
def test_an_interval_set_while_it_runs_goes_on_in_sequence_and_on_the_same_clock(asked: int) -> None:
    tag = set_up(worn(Insole(ppm=0.0)), profile.INSOLE)
    before = played(tag, 4.0)
    tag.write("insole/control", build_control(SetInterval(asked)), 4.0)
    after = played(tag, 8.0)
    (t_old, *_), (t_new, *_) = (before[-1], after[0])
    old, new = frames(before)[-1], frames(after)[0]
    assert new.sequence == (old.sequence + 1) % 2**16
    assert (new.ticks - old.ticks) % 2**32 / TICK_RATE == pytest.approx(t_new - t_old, abs=1.0 / TICK_RATE)
    assert {frame.interval for frame in frames(after)} == {asked}
    assert len(after) == pytest.approx(4.0 * TICK_RATE / asked, abs=1.0)
    assert parse_info(tag.read("insole/info", 8.0) or b"").interval == asked


def test_an_interval_that_is_too_short_becomes_the_shortest_and_info_says_so() -> None:
    tag = begin(worn(Insole(cells=24)))
    tag.write("insole/control", build_control(SetInterval(1)), 0.0)
    assert parse_info(tag.read("insole/info", 0.0) or b"").interval == 82


def test_frames_are_sent_again_flagged_and_otherwise_the_same() -> None:
    tag = set_up(worn(Insole()), profile.INSOLE)
    first = frames(played(tag, 3.0))
    wanted = first[-20:-10]
    tag.write("insole/control", build_control(Resend(wanted[0].sequence, 10)), 3.0)
    after = frames(played(tag, 3.5))
    assert [evolve(f, retransmitted=False) for f in after if f.retransmitted] == wanted
    fresh = [f.sequence for f in after if not f.retransmitted]
    assert fresh[0] == (first[-1].sequence + 1) % 2**16


def test_frames_older_than_twenty_seconds_are_gone() -> None:
    tag = set_up(worn(Insole(cells=24)), profile.INSOLE)
    first = frames(played(tag, 25.0))
    tag.write("insole/control", build_control(Resend(first[0].sequence, 255)), 25.0)
    tag.write("insole/control", build_control(Resend((first[-1].sequence + 100) % 2**16, 5)), 25.0)
    assert not [f for f in frames(played(tag, 26.0)) if f.retransmitted]


def test_with_a_small_mtu_frames_go_in_fragments_and_large_batches_shrink() -> None:
    tag = set_up(worn(Insole(batch=8)), profile.INSOLE, mtu=23)
    heard = played(tag, 1.0, "insole/frame")
    assert max(len(outgoing.value) for _, outgoing in heard) == 20
    decoder, samples = Decoder(site=LEFT), []
    for t, outgoing in heard:
        samples += [o for o in decoder.feed(Packet(t, LEFT, outgoing.channel, outgoing.value)) if isinstance(o, Sample)]
    assert len(samples) > 90


# the CC2650


def movements(tag: Peripheral, until: float) -> list[tuple[float, cc2650.Movement]]:
    return [(t, cc2650.parse_movement(o.value)) for t, o in played(tag, until, "cc2650/movement")]


def configured(config: bytes, device: CC2650 | None = None, route: Route = ROUTE) -> Peripheral:
    tag = begin(worn(device or CC2650(), route=route), "cc2650/movement")
    tag.write("cc2650/movement-period", b"\x0a", 0.0)
    tag.write("cc2650/movement-config", config, 0.0)
    return tag


@pytest.mark.parametrize(("bit", "sensor", "axis"), [
    (0, "gyro", 2), (1, "gyro", 1), (2, "gyro", 0), (3, "acc", 2), (4, "acc", 1), (5, "acc", 0),
])  # fmt: skip
def test_an_axis_that_is_off_reads_zero(bit: int, sensor: str, axis: int) -> None:
    for _, movement in movements(configured((0x027F & ~(1 << bit)).to_bytes(2, "little")), 8.0):
        assert getattr(movement, sensor)[axis] == 0
    alone = movements(configured((0x0200 | 1 << bit).to_bytes(2, "little")), 8.0)
    assert any(getattr(movement, sensor)[axis] for _, movement in alone)
    assert not any(movement.mag != (0, 0, 0) for _, movement in alone)


def test_the_magnetometer_is_switched_as_a_whole() -> None:
    assert all(m.mag == (0, 0, 0) for _, m in movements(configured(b"\x3f\x02"), 4.0))
    assert all(0 not in m.mag and m.acc == (0, 0, 0) for _, m in movements(configured(b"\x40\x02"), 4.0))


@pytest.mark.parametrize("config", [b"\x00\x00", b"\x00\x02", b"\x00\x7f", b"\x80\x02"])
def test_without_any_axis_the_tag_is_silent(config: bytes) -> None:
    tag = configured(config)
    assert tag.next_due() is None
    assert tag.read("cc2650/movement", 1.0) == bytes(18)
    assert tag.read("cc2650/movement-config", 1.0) == config


@pytest.mark.parametrize(
    ("rate", "written", "taken"),
    [(10.0, 0x0A, 10), (10.0, 0x05, 10), (10.0, 0x00, 10), (10.0, 0x64, 100), (10.0, 0xFF, 255), (50.0, 0x02, 2)],
)
def test_a_period_is_kept_and_one_below_the_firmwares_is_raised(rate: float, written: int, taken: int) -> None:
    tag = configured(b"\x7f\x02", CC2650(rate=rate, ppm=0.0))
    tag.write("cc2650/movement-period", bytes([written]), 0.0)
    assert tag.read("cc2650/movement-period", 0.0) == bytes([taken])
    times = [t for t, _ in movements(tag, 11.0)]
    for one, following in zip(times, times[1:], strict=False):
        assert following - one == pytest.approx(0.01 * taken)
    assert len(times) == pytest.approx(1100 / taken, abs=1.0)


def test_with_wake_on_motion_the_tag_is_silent_until_it_moves_and_ten_seconds_after() -> None:
    tag = configured(b"\xff\x02", route=Route().stand(8.0).walk(8.0, 1.2).stop(30.0))
    times = [t for t, _ in movements(tag, 60.0)]
    assert 7.5 < times[0] < 9.5
    assert 24.0 < times[-1] < 28.5
    assert all(b - a < 0.11 for a, b in zip(times, times[1:], strict=False))


REFUSED: dict[Device, list[tuple[str, bytes, int]]] = {
    Insole(): [
        ("insole/control", b"", 0x81),
        ("insole/control", b"\x00", 0x80),
        ("insole/control", b"\x01\x00", 0x81),
        ("insole/control", b"\x03\x00\x00", 0x81),
        ("insole/control", b"\x04\x01\x00\x05", 0x82),
    ],
    CC2650(): [
        ("cc2650/movement-config", b"\x7f", 0x0D),
        ("cc2650/movement-period", b"\x0a\x00", 0x0D),
        ("cc2650/barometer-config", b"\x02", 0x80),
    ],
    CC2541(): [
        ("cc2541/accelerometer-config", b"\x04", 0x80),
        ("cc2541/gyroscope-config", b"\x08", 0x80),
        ("cc2541/barometer-config", b"", 0x0D),
        ("cc2541/gyroscope-period", b"\x0a\x0a", 0x0D),
        ("cc2541/barometer-calibration", b"\x00", 0x03),
    ],
}


@pytest.mark.parametrize("device", REFUSED, ids=lambda device: type(device).__name__)
def test_values_of_wrong_length_or_meaning_are_refused_with_the_codes_of_the_device(device: Device) -> None:
    tag = begin(worn(device))
    for channel, value, code in REFUSED[device]:
        assert refusal(tag, channel, value) == code, (channel, value)


def test_the_barometer_says_the_air_pressure_at_its_own_period() -> None:
    tag = begin(worn(CC2650()), "cc2650/barometer")
    tag.write("cc2650/barometer-period", b"\x14", 0.0)
    assert tag.next_due() is None
    tag.write("cc2650/barometer-config", b"\x01", 0.0)
    heard = [cc2650.parse_barometer(o.value) for _, o in played(tag, 8.0)]
    assert len(heard) == pytest.approx(40, abs=3)
    assert all(one.pressure == pytest.approx(101325.0, abs=300.0) for one in heard)


def test_keys_are_told_when_they_go_down_and_when_they_come_up() -> None:
    presses = (4.0, 1.0)
    for device, keys, parse in (
        (CC2650(presses=presses), "cc2650/keys", cc2650.parse_keys),
        (CC2541(presses=presses), "cc2541/keys", cc2541.parse_keys),
    ):
        heard = played(begin(worn(device), keys), 10.0)
        expected = [(1.0, True), (1.25, False), (4.0, True), (4.25, False)]
        assert [(round(t, 3), parse(o.value).left) for t, o in heard] == expected
        assert not played(begin(worn(device), keys, now=5.0), 10.0), "what is over is not told later"


@pytest.mark.parametrize(("device", "full"), [(Insole(), 87), (CC2650(), 91)])
def test_a_battery_empties_and_says_so(device: Device, full: int) -> None:
    tag = begin(worn(device), "device/battery")
    assert tag.read("device/battery", 0.0) == bytes([full])
    heard = played(tag, 1900.0)
    assert [(round(t), o.value[0]) for t, o in heard] == [(600, full - 1), (1200, full - 2), (1800, full - 3)]
    assert tag.read("device/battery", 1900.0) == bytes([full - 3])


def test_a_disconnected_tag_forgets_what_was_written() -> None:
    tag = set_up(worn(CC2650()), profile.CC2650)
    tag.disconnected(3.0)
    begin(tag, "cc2650/movement", now=4.0)
    assert tag.read("cc2650/movement-config", 4.0) == b"\x00\x00"
    assert tag.read("cc2650/movement-period", 4.0) == b"\x64"
    assert tag.next_due() is None


# the CC2541


def test_each_sensor_has_a_period_of_its_own() -> None:
    tag = begin(worn(CC2541()), *(c.name for c in profile.CC2541.channels if c.how is Access.NOTIFY))
    tag.write("cc2541/accelerometer-period", b"\x05", 0.0)
    tag.write("cc2541/gyroscope-period", b"\x14", 0.0)
    for sensor, on in (("accelerometer", 3), ("gyroscope", 7), ("magnetometer", 1), ("barometer", 1)):
        tag.write(f"cc2541/{sensor}-config", bytes([on]), 0.0)
    played(tag, 10.0)
    assert tag.sent["cc2541/accelerometer"] == pytest.approx(100, abs=2), "stock firmware takes 100 ms at the least"
    assert tag.sent["cc2541/gyroscope"] == pytest.approx(50, abs=1)
    assert tag.sent["cc2541/magnetometer"] == pytest.approx(5, abs=1)
    assert tag.sent["cc2541/barometer"] == pytest.approx(10, abs=1)


def test_coefficients_can_be_read_after_they_were_fetched_and_not_before() -> None:
    tag = begin(worn(CC2541()), "cc2541/barometer")
    assert refusal(tag, "cc2541/barometer-calibration") == 0x02
    tag.write("cc2541/barometer-config", b"\x02", 0.0)
    assert not played(tag, 3.0), "fetching does not switch it on"
    calibration = cc2541.parse_barometer_calibration(tag.read("cc2541/barometer-calibration", 3.0) or b"")
    tag.write("cc2541/barometer-config", b"\x01", 3.0)
    heard = [calibration.pascal(cc2541.parse_barometer(o.value)) for _, o in played(tag, 8.0)]
    assert len(heard) in (4, 5, 6)
    assert heard == pytest.approx([101325.0] * len(heard), abs=300.0)
    tag.disconnected(8.0)
    tag.connected(9.0, 23)
    assert refusal(tag, "cc2541/barometer-calibration", now=9.0) == 0x02
