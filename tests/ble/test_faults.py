"""Every fault of the radio, and the events that an app receives for it; on both tiers."""

from __future__ import annotations

from functools import cache
from typing import TypeVar

import pytest
from airs import TIERS, collect, in_virtual_time
from attrs import evolve
from benches import LEFT
from soak import soaked

from solepath import (
    ClockReset,
    Connected,
    Disconnected,
    Event,
    LinkTrouble,
    PacketRejected,
    Rejection,
    SampleGap,
    Session,
    StreamRestarted,
    StreamResumed,
    StreamStale,
    StrideTaken,
)
from solepath.ble import DeviceConfig, Devices
from solepath.emulate import Route
from solepath.emulate.devices.bench import Bench
from solepath.emulate.devices.faults import parse_faults
from solepath.emulate.sensors.device import Device
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2650 as Tag
from solepath.link.devices.cc2650 import PROFILE as CC2650
from solepath.link.profile import Write
from solepath.types import Packet, Site

E = TypeVar("E")
STAND = Route().stand(9.0)
WALK = Route().stand(3.0).walk(12.0).stop(3.0)
FOOT_ADDRESS = "F0:5E:00:00:00:01"
SMALL_INSOLE = Insole(cells=8, rate=50.0)
both = pytest.mark.parametrize("tier", ["memory", *soaked("bumble")])


@cache
def receive(
    tier: str,
    faults: str,
    seconds: float,
    device: Device = SMALL_INSOLE,
    route: Route = STAND,
    configs: tuple[DeviceConfig, ...] = (DeviceConfig(LEFT, FOOT_ADDRESS),),
    sites: tuple[Site, ...] = (LEFT,),
) -> list[Packet]:
    bench = Bench(route, devices=dict.fromkeys(sites, device), seed=3, faults=parse_faults(faults))

    async def main() -> list[Packet]:
        async with TIERS[tier](bench) as backend, Devices(configs, backend=backend, patience=5.0) as devices:
            return await collect(devices, seconds)

    return in_virtual_time(main)


def events(packets: list[Packet]) -> list[Event]:
    return Session(losses=True).feed(packets)


def of(kind: type[E], found: list[Event]) -> list[E]:
    return [event for event in found if isinstance(event, kind)]


@both
@pytest.mark.parametrize(
    ("faults", "reasons", "rejected", "lost"),
    [
        ("4 * drop 3", set(), 0, 3),
        ("4 * duplicate 2", {Rejection.DUPLICATE}, 2, 0),
        ("4 * truncate 4", {Rejection.TRUNCATED, Rejection.CHECKSUM}, 4, 4),
        ("4 * flip 2; 5 * flip 3", {Rejection.CHECKSUM}, 5, 5),
    ],
    ids=["lost", "twice", "cut short", "turned bits"],
)
def test_spoilt_notifications_are_rejected_with_their_reason_and_those_that_never_came_whole_are_missing(
    tier: str, faults: str, reasons: set[Rejection], rejected: int, lost: int
) -> None:
    found = events(receive(tier, faults, 7.0))
    rejections, losses = of(PacketRejected, found), of(SampleGap, found)
    assert sum(event.count for event in rejections) == rejected and {event.reason for event in rejections} <= reasons
    assert sum(event.count for event in losses) == lost
    assert {event.site for event in losses} <= {LEFT}
    assert not losses or losses[0].t == pytest.approx(4.0, abs=0.1)


@both
def test_a_disconnection_in_mid_stride_is_reported_with_the_gap_and_its_stride_is_degraded(tier: str) -> None:
    found = events(receive(tier, "8.6 * disconnect", 16.0, route=WALK))
    order = of((Connected, Disconnected, SampleGap), found)  # type: ignore[arg-type]
    assert [type(event) for event in order] == [Connected, Disconnected, Connected, SampleGap]
    assert order[1].t == pytest.approx(8.6, abs=0.1)  # type: ignore[attr-defined]
    [gap] = of(SampleGap, found)
    assert 0.05 < gap.duration < 0.6
    [step] = [step for step in of(StrideTaken, found) if step.t_start < gap.t < step.t_end]
    assert step.degraded
    assert len(of(StrideTaken, found)) > 8
    assert not of(PacketRejected, found)
    assert not of(LinkTrouble, found)


@both
def test_a_link_that_is_lost_while_a_frozen_stream_is_set_up_again_is_made_again(tier: str) -> None:
    found = events(receive(tier, "4 * freeze; 4.5 * hang", 12.0))
    order = of((StreamRestarted, Disconnected, Connected, StreamResumed), found)  # type: ignore[arg-type]
    assert [type(e) for e in order] == [Connected, StreamRestarted, Disconnected, Connected, StreamResumed]
    [trouble] = of(LinkTrouble, found)
    assert trouble.what.startswith("the connection was lost: the device is sought again")


def test_a_device_that_restarts_is_a_clock_reset() -> None:
    [reset] = of(ClockReset, events(receive("memory", "4 * restart", 7.0)))
    assert reset.restarted


def test_a_device_that_vanishes_for_a_minute_is_stale_then_searched_for_and_back_within_seconds() -> None:
    found = events(receive("memory", "4 * vanish 60", 75.0))
    order = of((StreamStale, Disconnected, LinkTrouble, Connected, StreamResumed), found)  # type: ignore[arg-type]
    kinds = [type(event) for event in order]
    assert kinds == [Connected, Disconnected, StreamStale, LinkTrouble, Connected, StreamResumed]
    _, disconnected, stale, trouble, back, resumed = order
    assert disconnected.t == pytest.approx(4.0, abs=0.1)  # type: ignore[attr-defined]
    assert stale.t == pytest.approx(5.0, abs=0.1)  # type: ignore[attr-defined]
    assert trouble.what.startswith(f"no device '{FOOT_ADDRESS}' is in range")  # type: ignore[attr-defined]
    assert 64.0 < back.t < resumed.t < 67.0  # type: ignore[attr-defined]


@both
@pytest.mark.parametrize(
    ("device", "control"),
    [(SMALL_INSOLE, "insole/control"), (Tag(), "cc2650/movement-config")],
    ids=["insole", "cc2650"],
)
def test_a_rejected_setup_is_reported_and_repeated(tier: str, device: Device, control: str) -> None:
    found = events(receive(tier, f"0 * refuse {control}", 8.0, device=device))
    [trouble] = of(LinkTrouble, found)
    assert trouble.what.startswith(f"{control} was not set to ")
    assert "the device answered with the ATT error 0x80" in trouble.what
    [restarted] = of(StreamRestarted, found)
    assert restarted.t < 3.0 and len(of(Connected, found)) == 1
    packets = receive(tier, f"0 * refuse {control}", 8.0, device=device)
    assert [packet for packet in packets if packet.channel == restarted.channel and packet.t > 7.5]


@both
@pytest.mark.parametrize("device", [SMALL_INSOLE, Tag()], ids=["insole", "cc2650"])
def test_a_frozen_stream_is_restarted_and_resumes(tier: str, device: Device) -> None:
    found = events(receive(tier, "4 * freeze", 9.0, device=device))
    order = of((StreamStale, StreamRestarted, StreamResumed), found)  # type: ignore[arg-type]
    assert {type(event) for event in order} == {StreamStale, StreamRestarted, StreamResumed}
    assert len(order) == 3 and isinstance(order[-1], StreamResumed)
    assert order[-1].silent_for < 2.5
    assert len(of(Connected, found)) == 1 and not of(LinkTrouble, found)


@both
def test_a_stream_that_stays_frozen_is_connected_again(tier: str) -> None:
    found = events(receive(tier, "4 * freeze; 4.5 * refuse insole/control 2", 12.0))
    order = of((StreamRestarted, Disconnected, Connected, StreamResumed), found)  # type: ignore[arg-type]
    first, *restarted, disconnected, back, resumed = [type(event) for event in order]
    assert restarted == [StreamRestarted] * 3
    assert (first, disconnected, back, resumed) == (Connected, Disconnected, Connected, StreamResumed)


WAKING = evolve(CC2650, setup=(CC2650.setup[0], Write("cc2650/movement-config", b"\xff\x02"), *CC2650.setup[2:]))


def test_a_device_that_wakes_on_motion_may_be_silent() -> None:
    """The tag sends nothing from 24 s on, as if it slept."""
    route = Route().stand(8.0).walk(5.0).stop(25.0)
    configs = (DeviceConfig(LEFT, FOOT_ADDRESS, WAKING),)
    packets = receive("memory", "24 * freeze", 36.0, device=Tag(), route=route, configs=configs)
    found = events(packets)
    moved = [packet.t for packet in packets if packet.channel == "cc2650/movement"]
    assert moved and max(moved) < 30.0, "it did fall asleep"
    assert not of(StreamRestarted, found) and not of(StreamStale, found) and len(of(Connected, found)) == 1
