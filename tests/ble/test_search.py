"""Choice of the device for each config."""

from __future__ import annotations

import pytest
from airs import collect, received, troubles
from belts import STRAP, address, logged_radio, strap
from benches import LEFT, RIGHT, ROUTE
from memory_radio import MemoryRadio
from virtual import now, virtually

from solepath.ble import ConnectionState, DeviceConfig, Devices, scan
from solepath.emulate.devices.bench import Bench
from solepath.emulate.devices.faults import parse_faults
from solepath.emulate.devices.peripheral import Peripheral
from solepath.emulate.sensors.device import Device
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2650 as Tag
from solepath.link.devices.cc2650 import PROFILE as CC2650
from solepath.link.devices.insole import PROFILE as INSOLE
from solepath.types import Packet, Site
from solepath.wire.receiver import parse_connected

PELVIS = Site.PELVIS
INSOLE_DEVICE = Insole(cells=8, rate=50.0)


def feet(device: Device, faults: str = "") -> Bench:
    return Bench(ROUTE, devices={LEFT: device, RIGHT: device}, seed=3, faults=parse_faults(faults))


def got(
    peripherals: tuple[Peripheral, ...], configs: list[DeviceConfig], seconds: float = 6.0, **more: float
) -> list[Packet]:
    return received(MemoryRadio(peripherals).backend, *configs, seconds=seconds, **more)


def connected(packets: list[Packet]) -> dict[Site, str]:
    """Return the devices that are connected at the end, by site."""
    return {packet.site: packet.device for packet in packets if packet.channel == "receiver/connected"}


def streams(packets: list[Packet], channel: str = "insole/frame") -> set[Site]:
    return {packet.site for packet in packets if packet.channel == channel}


@pytest.mark.parametrize("which", ["f0:5e:00:00:00:02", "solepath R"])
def test_a_device_is_found_by_its_address_or_by_its_name(which: str) -> None:
    packets = got(feet(INSOLE_DEVICE).peripherals, [DeviceConfig(RIGHT, which)])
    assert connected(packets) == {RIGHT: "F0:5E:00:00:00:02"}
    assert streams(packets) == {RIGHT}
    assert not troubles(packets)
    [connected_packet] = [packet for packet in packets if packet.channel == "receiver/connected"]
    assert parse_connected(connected_packet.data).name == "solepath R"
    assert parse_connected(connected_packet.data).signal == -50


@pytest.mark.parametrize("turned", [False, True])
def test_any_two_insoles_report_their_feet_whichever_advertises_first(turned: bool) -> None:
    bench = feet(INSOLE_DEVICE)
    peripherals = bench.peripherals[::-1] if turned else bench.peripherals
    packets = got(peripherals, [DeviceConfig(None, profile=INSOLE)] * 2)
    assert connected(packets) == {site: bench[site].address for site in (LEFT, RIGHT)}
    assert streams(packets) == {LEFT, RIGHT}
    assert not troubles(packets)


def test_the_insole_of_the_other_foot_is_rejected_with_a_reason() -> None:
    packets = got(feet(INSOLE_DEVICE).peripherals, [DeviceConfig(RIGHT, "F0:5E:00:00:00:01")], seconds=30.0)
    assert not connected(packets)
    assert troubles(packets) == ["solepath L is a left foot one: expected at the right foot"]


def test_two_insoles_of_one_foot_are_not_taken_for_a_pair() -> None:
    bench, spare = feet(INSOLE_DEVICE), Bench(ROUTE, devices={LEFT: INSOLE_DEVICE}, seed=4)[LEFT]
    spare.address = "F0:5E:00:00:00:09"
    packets = got((bench[LEFT], spare), [DeviceConfig(None, profile=INSOLE)] * 2)
    assert len(connected(packets)) == 1
    assert [words.partition(" is ")[2] for words in troubles(packets)] == ["one more for the left foot"]
    packets = got((bench[LEFT], spare, bench[RIGHT]), [DeviceConfig(None, profile=INSOLE)] * 2)
    assert connected(packets).keys() == {LEFT, RIGHT}


def test_a_device_that_does_not_report_its_site_is_not_guessed_to_be_anywhere() -> None:
    packets = got(feet(Tag()).peripherals, [DeviceConfig(None, "F0:5E:00:00:00:01")])
    assert not connected(packets)
    assert troubles(packets) == ["CC2650 SensorTag does not say where it is worn: name a site"]


TAGS = ("F0:5E:00:00:00:01", "F0:5E:00:00:00:02")
AMBIGUOUS = f"2 devices answer to device 'CC2650 SensorTag' ({', '.join(TAGS)}): say which by its address"


def test_when_one_of_the_two_is_named_otherwise_the_other_is_taken() -> None:
    bench = feet(Tag(), faults='8 right_foot name "Tag of the right"')
    packets = got(bench.peripherals, [DeviceConfig(LEFT, "CC2650 SensorTag")], seconds=15.0)
    assert connected(packets) == {LEFT: TAGS[0]}
    assert troubles(packets) == [AMBIGUOUS]
    assert min(packet.t for packet in packets if packet.channel == "receiver/connected") > 8.0


@pytest.mark.parametrize(
    "configs",
    [
        [],
        [DeviceConfig(LEFT, "one"), DeviceConfig(LEFT, "two")],
        [DeviceConfig(LEFT, TAGS[0]), DeviceConfig(RIGHT, TAGS[0].lower())],
        [DeviceConfig(LEFT, profile=CC2650), DeviceConfig(RIGHT, profile=CC2650)],
        [DeviceConfig(None, profile=INSOLE)] * 3,
        [DeviceConfig(LEFT, "one"), *[DeviceConfig(None, profile=INSOLE)] * 2],
    ],
)
def test_indistinguishable_configs_are_an_error_before_anything_is_done(configs: list[DeviceConfig]) -> None:
    with pytest.raises(ValueError):
        Devices(configs)


def test_a_device_of_unknown_kind_is_reported_and_left() -> None:
    packets = got((strap(),), [DeviceConfig(PELVIS, address(1))], seconds=20.0)
    assert not connected(packets)
    assert troubles(packets) == ["strap 1 is of no kind that is known here: say its profile"]


@pytest.mark.parametrize("which", [address(1), "strap 1"])
def test_a_device_of_another_kind_than_configured_is_reported_and_left(which: str) -> None:
    belt = logged_radio(strap())
    packets = received(belt.backend, DeviceConfig(LEFT, which, CC2650), seconds=20.0)
    assert not connected(packets)
    assert troubles(packets) == ["strap 1 is no cc2650: it has no cc2650/movement"]
    assert {what for _, what, _ in belt.log} == {"connect", "disconnect"}


def test_a_device_of_ones_own_kind_is_found_by_name_or_by_what_it_advertises() -> None:
    for configs in (DeviceConfig(PELVIS, "strap 1", STRAP), DeviceConfig(PELVIS, profile=STRAP)):
        packets = got((strap(1),), [configs])
        assert connected(packets) == {PELVIS: address(1)}
        assert streams(packets, "strap/beat") == {PELVIS}


def test_after_its_patience_an_absent_device_is_complained_of_once() -> None:
    packets = got((), [DeviceConfig(LEFT, "solepath L")], seconds=100.0, patience=7.0)
    [words] = troubles(packets)
    assert words.startswith("no device 'solepath L' is in range: switch it on, bring it near")
    [connected_packet] = [packet for packet in packets if packet.channel == "receiver/trouble"]
    assert (connected_packet.site, connected_packet.device) == (LEFT, "")
    assert connected_packet.t == pytest.approx(7.0, abs=0.6)


@virtually
async def test_only_one_scanner_works_at_a_time_and_none_once_all_are_found() -> None:
    belt = logged_radio(*(strap(number, faults=f"{4 + number} * disconnect") for number in range(1, 5)))
    configs = [DeviceConfig(site, address(n), STRAP) for n, site in enumerate(list(Site)[:4], 1)]
    async with Devices(configs, backend=belt.backend) as devices:
        await collect(devices, 3.0)
        assert {one.state for one in devices.connections} == {ConnectionState.LISTENING}
        assert belt.scanning == 0
        await collect(devices, 10.0)
    assert belt.scanning == 0
    assert belt.most == 1


@virtually
async def test_a_scan_lists_known_and_unknown_devices() -> None:
    started_at = now()
    found = await scan(2.0, backend=MemoryRadio((*feet(INSOLE_DEVICE).peripherals, strap())).backend)
    assert now() - started_at == pytest.approx(2.0)
    kinds = {one.address: one.profile.name if one.profile else None for one in found}
    assert kinds == {TAGS[0]: "insole", TAGS[1]: "insole", address(1): None}
