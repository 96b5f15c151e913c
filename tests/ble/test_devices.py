"""What an app gets from devices, how it may take it, and what is left when it goes."""

from __future__ import annotations

import asyncio
from functools import cache
from typing import Any

import pytest
from airs import hear, in_virtual_time, others
from attrs import evolve
from belts import RATE, READ_AFTER, STRAP, Asked, address, asked, strap
from benches import LEFT, RIGHT, ROUTE
from bleak.backends.scanner import BaseBleakScanner
from bleak.exc import BleakDBusError, BleakError
from strap import BATTERY, BEAT, CONTROL, HEART_RATE, LEVEL, Strap

from solepath import BatteryLevel, LayoutKnown, PacketRejected, Session
from solepath.ble import Backend, BluetoothError, ConnectionState, Devices, Wanted
from solepath.emulate import Route
from solepath.emulate.devices.bench import Bench
from solepath.emulate.devices.memory import MemoryRadio
from solepath.emulate.devices.peripheral import Characteristic, Service
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2650 as Tag
from solepath.link.profile import CC2650, INSOLE, Access, Write
from solepath.types import Packet, Site
from solepath.wire.receiver import parse_dropped

PELVIS = Site.PELVIS
ONE = Wanted(PELVIS, address(1), STRAP)


def now() -> float:
    return asyncio.get_running_loop().time()


def got(heard: Asked, *wanted: Wanted, seconds: float = 5.0, **more: Any) -> list[Packet]:
    async def main() -> list[Packet]:
        async with Devices(wanted, backend=heard.backend, **more) as devices:
            return await hear(devices, seconds)

    return in_virtual_time(main)


def channels(packets: list[Packet], *, but: str = "receiver/tick") -> list[str]:
    return [packet.channel for packet in packets if packet.channel != but]


def times(packets: list[Packet], channel: str) -> list[float]:
    return [packet.t for packet in packets if packet.channel == channel]


# --- how a device is set up ---


def test_a_device_is_read_then_subscribed_then_written() -> None:
    bench = Bench(ROUTE, devices={LEFT: Insole(), RIGHT: Tag()}, seed=3)
    heard = asked(*bench.peripherals)
    got(heard, Wanted(LEFT, "F0:5E:00:00:00:01"), Wanted(RIGHT, "F0:5E:00:00:00:02"))
    for device, profile in ((bench[LEFT], INSOLE), (bench[RIGHT], CC2650)):
        did = heard.of(device, "read", "subscribe", "write")
        notify = {channel.name for channel in profile.channels if channel.how is Access.NOTIFY}
        assert {channel for what, channel in did if what == "subscribe"} == notify
        assert [what for what, _ in did] == sorted((what for what, _ in did), key=["read", "subscribe", "write"].index)
        assert [channel for what, channel in did if what == "write"] == [write.channel for write in profile.setup]
        assert [channel for what, channel in did if what == "read"] == list(profile.reads)  # each of them once


@pytest.mark.parametrize("faults", ["", "2 * disconnect", "2 * freeze", "2 * refuse strap/control; 2 * disconnect"])
def test_nothing_is_ever_read_that_is_subscribed(faults: str) -> None:
    device = strap(faults=faults)
    heard = asked(device)
    got(heard, Wanted(PELVIS, address(1), READ_AFTER), seconds=12.0)
    subscribed: set[str] = set()
    for what, channel in heard.of(device, "connect", "read", "subscribe"):
        if what == "connect":
            subscribed.clear()
        elif what == "subscribe":
            subscribed.add(channel)
        else:
            assert channel not in subscribed


def test_what_was_read_and_written_comes_as_packets_before_the_stream() -> None:
    bench = Bench(ROUTE, devices={LEFT: Insole()}, seed=3)
    packets = got(asked(*bench.peripherals), Wanted(LEFT, "F0:5E:00:00:00:01"))
    expected = ["receiver/connected", *INSOLE.reads, "insole/control", "insole/frame"]
    assert channels(packets)[: len(expected)] == expected
    assert next(p.data for p in packets if p.channel == "insole/info") == bench[LEFT].value("insole/info", 0.0)
    assert next(p.data for p in packets if p.channel == "insole/control") == INSOLE.setup[0].value
    events = Session().feed(packets)
    assert [type(e) for e in events if isinstance(e, LayoutKnown | BatteryLevel)] == [LayoutKnown, BatteryLevel]
    assert not [event for event in events if isinstance(event, PacketRejected)]


def test_what_is_to_be_read_after_a_write_comes_right_after_it() -> None:
    packets = got(asked(strap()), Wanted(PELVIS, address(1), READ_AFTER))
    order = [channel for channel in channels(packets) if channel != "strap/beat"]
    assert order[:4] == ["receiver/connected", "device/battery", "strap/control", "strap/page"]


def test_a_battery_that_can_only_be_read_is_read_and_keeps_nobody_from_listening() -> None:
    device = strap()
    heard = asked(device)
    packets = got(heard, ONE)
    assert times(packets, "device/battery") and len(times(packets, "strap/beat")) > 4 * RATE
    assert ("subscribe", "device/battery") not in heard.of(device, "subscribe")
    assert not times(packets, "receiver/trouble")


class Odd(Strap):
    """Its control takes commands only, it has two battery services, and one of its streams refuses."""

    def __init__(self, number: int = 1) -> None:
        super().__init__(f"strap {number}", address(number))
        level = Characteristic(LEVEL, "device/battery", frozenset({"read"}))
        control = Characteristic(CONTROL, "strap/control", frozenset({"write-without-response"}))
        beat = Characteristic(BEAT, "strap/beat", frozenset({"notify"}))
        self.services = (Service(HEART_RATE, (beat, control)), *(Service(BATTERY, (level,)) for _ in range(2)))
        self._properties = {c.channel: c.properties for service in self.services for c in service.characteristics}


def test_a_device_that_takes_only_commands_and_has_a_service_twice_is_listened_to() -> None:
    device = Odd()
    heard = asked(device)
    packets = got(heard, ONE)
    assert len(times(packets, "strap/beat")) > 4 * RATE
    assert ("command", "strap/control") in heard.of(device, "write", "command")
    assert not times(packets, "receiver/trouble")


def test_what_a_device_does_not_have_to_be_set_is_told_and_passed_over() -> None:
    device = strap()
    more = evolve(STRAP.channel("strap/control"), name="strap/nothing", characteristic=BATTERY)
    setup = (Write("strap/nothing", b"\x01"), *STRAP.setup)
    profile = evolve(READ_AFTER, channels=(*READ_AFTER.channels, more), setup=setup)
    packets = got(asked(device), Wanted(PELVIS, address(1), profile))
    [said] = [packet.data.decode() for packet in packets if packet.channel == "receiver/trouble"]
    assert said == "strap/nothing is not there to be set: the device keeps to its own"
    assert len(times(packets, "strap/beat")) > 4 * RATE


# --- packets ---


def test_every_packet_says_when_it_arrived_and_from_which_device() -> None:
    device = strap()
    device.log = []
    packets = got(asked(device), ONE)
    beats = [packet for packet in packets if packet.channel == "strap/beat"]
    assert [packet.data for packet in beats] == [one.value for one in device.log[: len(beats)]]
    for packet in beats:
        assert packet.t == pytest.approx(int.from_bytes(packet.data[:4], "little") / RATE, abs=1e-3)
    assert {(p.site, p.device) for p in packets if p.channel != "receiver/tick"} == {(PELVIS, address(1))}
    assert [packet.t for packet in packets] == sorted(packet.t for packet in packets)


def test_while_nothing_comes_time_is_told_to_pass_five_times_a_second() -> None:
    packets = got(asked(), ONE, seconds=5.0, patience=100.0)
    assert set(channels(packets, but="")) == {"receiver/tick"}
    assert len(packets) in (24, 25)
    steps = [b.t - a.t for a, b in zip(packets, packets[1:], strict=False)]
    assert max(steps) <= 0.2501
    assert not Session().feed(packets)


def test_seven_devices_stream_at_once_each_at_its_site() -> None:
    heard = asked(*(strap(n) for n in range(1, 8)))
    wanted = [Wanted(site, address(n), STRAP) for n, site in enumerate(Site, 1)]
    packets = got(heard, *wanted)
    for n, site in enumerate(Site, 1):
        mine = [packet for packet in packets if packet.site is site and packet.channel == "strap/beat"]
        assert len(mine) > 4 * RATE
        assert {packet.device for packet in mine} == {address(n)}
        counted = [int.from_bytes(packet.data[:4], "little") for packet in mine]
        assert counted == list(range(counted[0], counted[0] + len(mine)))


def test_a_device_that_does_not_answer_never_delays_another() -> None:
    quick = strap(2)
    alone = got(asked(quick), Wanted(LEFT, address(2), STRAP))
    hanging = strap(1, faults="0 * hang; 5 * hang; 9 * hang")
    both = got(asked(hanging, strap(2)), ONE, Wanted(LEFT, address(2), STRAP))
    assert times(both, "receiver/trouble")
    mine = [packet for packet in both if packet.site is LEFT and packet.channel != "receiver/tick"]
    assert mine == [packet for packet in alone if packet.channel != "receiver/tick"]


# --- an app that is slow ---


@cache
def taken_late(capacity: int, wait: float) -> list[Packet]:
    """What an app gets that takes nothing for so long, and then all."""

    async def main() -> list[Packet]:
        bench = Bench(Route().stand(25.0), seed=3)
        wanted = [Wanted(peripheral.site, peripheral.address) for peripheral in bench.peripherals]
        async with Devices(wanted, backend=MemoryRadio(bench.peripherals).backend, capacity=capacity) as devices:
            await asyncio.sleep(wait)
            sent.extend(sum(p.sent.values()) for p in bench.peripherals)
        return [packet async for packet in devices]

    sent: list[int] = []
    packets = in_virtual_time(main)
    for site, count in zip((LEFT, RIGHT), sent, strict=True):
        kept = [p for p in packets if p.site is site and p.channel == "insole/frame"]
        dropped = [parse_dropped(p.data) for p in packets if p.site is site and p.channel == "receiver/dropped"]
        assert len(kept) + sum(dropped) == count
    return packets


def test_what_an_app_is_too_slow_for_goes_from_the_oldest_on_and_is_counted() -> None:
    packets = taken_late(capacity=300, wait=20.0)
    frames = [packet for packet in packets if packet.channel == "insole/frame"]
    assert len(frames) in range(290, 301)
    assert min(packet.t for packet in frames) > 18.0
    for site in (LEFT, RIGHT):
        mine = [packet for packet in packets if packet.site is site]
        assert [packet.t for packet in mine] == sorted(packet.t for packet in mine)
        setup = ["receiver/connected", *INSOLE.reads, "insole/control", "receiver/dropped"]
        assert [packet.channel for packet in mine][: len(setup)] == setup


def test_an_app_that_takes_a_packet_every_now_and_then_gets_them_in_order() -> None:
    device = strap()
    device.log = []

    async def main() -> list[Packet]:
        found = []
        async with Devices([ONE], backend=asked(device).backend, capacity=5) as devices:
            async for packet in devices:
                found.append(packet)
                await asyncio.sleep(0.35)
                if packet.t > 20.0:
                    break
        return found

    packets = in_virtual_time(main)
    assert [packet.t for packet in packets] == sorted(packet.t for packet in packets)
    while packets[-1].channel != "strap/beat":
        packets.pop()  # what was dropped after the last beat
    numbers = [int.from_bytes(p.data[:4], "little") for p in packets if p.channel == "strap/beat"]
    dropped = sum(parse_dropped(p.data) for p in packets if p.channel == "receiver/dropped")
    assert device.log is not None
    assert len(numbers) + dropped == numbers[-1] + 1 - int.from_bytes(device.log[0].value[:4], "little")
    assert dropped > 50 and len(numbers) > 20


# --- taking and leaving ---


def test_to_leave_disconnects_and_leaves_no_task_behind() -> None:
    devices = [strap(n) for n in (1, 2)]

    async def main() -> list[Packet]:
        wanted = [Wanted(LEFT, address(1), STRAP), Wanted(RIGHT, address(2), STRAP), Wanted(PELVIS, "absent", STRAP)]
        async with Devices(wanted, backend=MemoryRadio(devices).backend) as heard:
            await hear(heard, 3.0)
            assert all(device.is_connected for device in devices)
        assert not any(device.is_connected for device in devices)
        assert not others()
        rest = [packet async for packet in heard]
        assert [packet async for packet in heard] == []
        await asyncio.sleep(0.0)
        assert {one.state for one in heard.connections} == {ConnectionState.SEEKING}
        return rest

    rest = in_virtual_time(main)
    assert {packet.site for packet in rest if packet.channel == "receiver/disconnected"} == {LEFT, RIGHT}


@pytest.mark.parametrize("moment", [0.001, 0.02, 0.05, 0.08, 0.12, 0.5])
def test_to_leave_at_any_moment_leaves_nothing_behind(moment: float) -> None:
    device = strap()
    heard = asked(device)

    async def main() -> None:
        async with Devices([ONE], backend=heard.backend):
            await asyncio.sleep(moment)
        assert not others() and not device.is_connected and heard.scanning == 0

    in_virtual_time(main)


def test_devices_that_were_left_can_be_entered_again_but_not_twice_at_once() -> None:
    async def main() -> None:
        devices = Devices([ONE], backend=MemoryRadio([strap()]).backend)
        for _ in range(2):
            async with devices:
                packets = await hear(devices, 2.0)
                with pytest.raises(RuntimeError, match="in use"):
                    await devices.__aenter__()
            assert times(packets, "strap/beat")
        assert not others()

    in_virtual_time(main)


def test_two_who_wait_for_the_next_packet_at_once_are_told_that_only_one_may() -> None:
    async def main() -> None:
        async with Devices([ONE], backend=asked().backend) as devices:
            first = asyncio.create_task(anext(devices))
            await asyncio.sleep(0.1)
            with pytest.raises(RuntimeError, match="somebody else"):
                await anext(devices)
            assert (await first).channel == "receiver/tick"

    in_virtual_time(main)


def test_who_gives_up_waiting_loses_no_packet() -> None:
    async def main() -> list[Packet]:
        found = []
        async with Devices([ONE], backend=asked(strap()).backend) as devices:
            while now() < 10.0:
                try:
                    async with asyncio.timeout(0.013):
                        found.append(await anext(devices))
                except TimeoutError:
                    pass
        return found

    beats = [p for p in in_virtual_time(main) if p.channel == "strap/beat"]
    numbers = [int.from_bytes(packet.data[:4], "little") for packet in beats]
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers))) and len(numbers) > 90


def test_a_fault_of_the_program_itself_is_raised_to_whoever_takes_packets() -> None:
    class Faulty(Wanted):
        def fits(self, *given: Any) -> bool:
            return True

        def is_address(self, address: str) -> bool:
            raise ZeroDivisionError("a fault")

    async def main() -> None:
        async with Devices([Faulty(LEFT, address(2), STRAP)], backend=asked(strap(2)).backend) as devices:
            with pytest.raises(ZeroDivisionError, match="a fault"):
                await hear(devices, 5.0)
            with pytest.raises(ZeroDivisionError, match="a fault"):
                await anext(devices)
        assert not others()

    in_virtual_time(main)


def test_devices_that_were_never_entered_do_not_end_silently() -> None:
    async def main() -> None:
        with pytest.raises(RuntimeError, match="entered"):
            await anext(Devices([ONE], backend=asked().backend))

    in_virtual_time(main)


def test_of_two_who_enter_at_once_one_is_told_that_they_are_in_use() -> None:
    """Also while the first is still waiting for Bluetooth; and an entry that failed is none."""
    device = strap()
    heard = asked(device)

    async def main() -> None:
        devices = Devices([ONE], backend=slowly(heard.backend))
        first, second = await asyncio.gather(devices.__aenter__(), devices.__aenter__(), return_exceptions=True)
        assert first is devices and isinstance(second, RuntimeError)
        await hear(devices, 3.0)
        await devices.__aexit__(None, None, None)
        assert not others() and heard.scanning == 0 and not device.is_connected
        broken = Devices([ONE], backend=failing(heard.backend, [BleakError("odd")]))
        with pytest.raises(BluetoothError):
            await broken.__aenter__()
        async with broken:
            assert times(await hear(broken, 3.0), "strap/beat")

    in_virtual_time(main)


def slowly(beneath: Backend) -> Backend:
    """A Bluetooth whose scans take their time to begin."""
    scanner: Any = beneath.scanner

    class Scanner(scanner):
        async def start(self) -> None:
            await asyncio.sleep(0.05)
            await super().start()

    return Backend(beneath.client, Scanner)


# --- scanning that fails ---


def failing(beneath: Backend, errors: list[Exception | None]) -> Backend:
    """A Bluetooth whose scans begin with these, in turn."""
    scanner: Any = beneath.scanner

    class Scanner(scanner):
        async def start(self) -> None:
            error = errors.pop(0) if errors else None
            if error is not None:
                raise error
            await super().start()

    kind: type[BaseBleakScanner] = Scanner
    return Backend(beneath.client, kind)


def test_a_scan_that_fails_later_is_told_where_something_is_sought_and_is_begun_anew() -> None:
    errors: list[Exception | None] = [None, None, BleakDBusError("org.bluez.Error.NotReady", []), BleakError("odd")]
    backend = failing(MemoryRadio([strap(1, faults="3 * disconnect"), strap(2)]).backend, errors)

    async def main() -> list[Packet]:
        async with Devices([ONE, Wanted(LEFT, address(2), STRAP)], backend=backend) as devices:
            return await hear(devices, 12.0)

    packets = in_virtual_time(main)
    assert [(packet.site, packet.data.decode()) for packet in packets if packet.channel == "receiver/trouble"] == [
        (PELVIS, "cannot look for devices: Bluetooth is off: turn it on"),
        (PELVIS, "cannot look for devices: odd"),
    ]
    assert len([p for p in packets if p.channel == "receiver/connected" and p.site is PELVIS]) == 2
    assert times(packets, "strap/beat")[-1] > 11.0


def test_a_scan_that_hears_nothing_any_more_is_begun_anew() -> None:
    """As after Bluetooth was switched off and on, on systems that do not tell."""
    device = strap(faults="5 * disconnect")
    beneath = MemoryRadio([device]).backend
    scanner: Any = beneath.scanner

    class Scanner(scanner):
        began = 0.0

        async def start(self) -> None:
            self.began = now()
            await super().start()

        def call_detection_callbacks(self, *given: Any) -> None:
            if now() < 5.0 or self.began > 20.0:
                super().call_detection_callbacks(*given)

    async def main() -> list[Packet]:
        async with Devices([ONE], backend=Backend(beneath.client, Scanner)) as devices:
            return await hear(devices, 90.0)

    packets = in_virtual_time(main)
    back = times(packets, "receiver/connected")
    assert len(back) == 2 and back[1] < 75.0
    assert device.sent["strap/beat"] > 10 * RATE


def test_a_signal_that_no_radio_measures_and_a_name_that_is_no_text_are_no_fault() -> None:
    beneath = MemoryRadio([strap()]).backend
    scanner: Any = beneath.scanner

    class Scanner(scanner):
        def call_detection_callbacks(self, device: Any, said: Any) -> None:
            super().call_detection_callbacks(device, said._replace(rssi=127, local_name="str\ud800p"))

    async def main() -> list[Packet]:
        async with Devices([ONE], backend=Backend(beneath.client, Scanner)) as devices:
            return await hear(devices, 3.0)

    packets = in_virtual_time(main)
    assert times(packets, "strap/beat")
    [event] = Session().feed([packet for packet in packets if packet.channel == "receiver/connected"])
    assert (event.name, event.signal) == ("str?p", None)  # type: ignore[attr-defined]
