"""Setup of a device without Bluetooth: the requests, one at a time, done by emulated devices or answered at will."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from attrs import evolve
from benches import LEFT, RIGHT, ROUTE
from hypothesis import given
from hypothesis import strategies as st

from solepath import PacketRejected, Session
from solepath.emulate.devices.attributes import AttError
from solepath.emulate.devices.bench import Bench
from solepath.emulate.devices.faults import parse_faults
from solepath.emulate.devices.peripheral import Peripheral
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2650
from solepath.events import Event
from solepath.link.catalogue import PROFILES
from solepath.link.devices.cc2650 import PROFILE as TAG
from solepath.link.devices.insole import PROFILE as INSOLE
from solepath.link.profile import Access, Profile, Write
from solepath.link.setup.config import DeviceConfig
from solepath.link.setup.device_setup import DeviceSetup, GattCharacteristic, Operation, Request, Value
from solepath.link.setup.roster import Roster
from solepath.types import Packet, Site

Done = list[tuple[Request, bytes | str]]
"""Requests with what was read, or the reason of the rejection."""


def characteristics(device: Peripheral) -> frozenset[GattCharacteristic]:
    return frozenset(
        GattCharacteristic(service.uuid, one.uuid, "notify" in one.properties)
        for service in device.services
        for one in service.characteristics
    )


def all_characteristics(profile: Profile) -> frozenset[GattCharacteristic]:
    return frozenset(
        GattCharacteristic(one.service, one.characteristic, one.access is Access.NOTIFY) for one in profile.channels
    )


def setup_of(
    device: Peripheral, profile: Profile, site: Site | None = None, roster: Roster | None = None
) -> DeviceSetup:
    roster = roster or Roster()
    [member] = roster.add([DeviceConfig(site, device.address, profile)])
    return DeviceSetup(roster, member, profile, characteristics(device), device.address, device.name, -60)


def do(device: Peripheral, request: Request, now: float) -> bytes:
    channel = request.channel.name
    match request.operation:
        case Operation.READ:
            return device.read(channel, now) or b""
        case Operation.SUBSCRIBE:
            device.subscribe(channel, True, now)
        case Operation.WRITE:
            device.write(channel, request.value, now)
    return b""


def perform(setup: DeviceSetup, device: Peripheral, now: float, values: list[Value]) -> tuple[list[Value], Done]:
    """Do all requests with an emulated device; return the values, after `values`, and what was done."""
    values, done = [*values], []
    while (request := setup.request) is not None:
        try:
            value = do(device, request, now)
            values += setup.answer(now, value)
            done.append((request, value))
        except AttError as error:
            values += setup.reject(now, str(error))
            done.append((request, str(error)))
    return values, done


def connect(setup: DeviceSetup, device: Peripheral, now: float = 0.0) -> tuple[list[Value], Done]:
    device.connected(now, device.mtu)
    return perform(setup, device, now, setup.start(now))


def feed(session: Session, setup: DeviceSetup, t: float, values: list[Value]) -> Iterator[Event]:
    for channel, data in values:
        yield from session.feed(Packet(t, setup.member.site, channel, data, setup.address))


def operations(done: Done) -> list[tuple[Operation, str]]:
    return [(request.operation, request.channel.name) for request, _ in done]


def test_two_insoles_report_their_feet_and_another_right_one_ends_in_words() -> None:
    bench, roster = Bench(ROUTE, seed=3), Roster()
    members = roster.add([DeviceConfig(None, profile=INSOLE)] * 2)
    for member, site in zip(members, (RIGHT, LEFT), strict=True):
        device = bench[site]
        setup = DeviceSetup(roster, member, INSOLE, characteristics(device), device.address, device.name)
        values, _ = connect(setup, device)
        assert member.site is site and [channel for channel, _ in values][0] == "receiver/connected"
    other = Bench(ROUTE, devices={LEFT: Insole()}, seed=4)[LEFT]
    members[1].address = ""
    setup = DeviceSetup(roster, members[1], INSOLE, characteristics(bench[RIGHT]), other.address, "solepath X")
    values, _ = connect(setup, bench[RIGHT])
    assert setup.end == "solepath X is one more for the right foot"
    assert values == [("receiver/trouble", setup.end.encode())]
    assert setup.disconnect() == []
    assert roster.is_excluded(members[1], other.address, "solepath X", 59.0)
    assert not roster.is_excluded(members[1], other.address, "solepath X", 61.0)


def test_an_insole_of_the_other_foot_and_a_device_of_another_kind_end_in_words() -> None:
    right = Bench(ROUTE, devices={RIGHT: Insole()})[RIGHT]
    setup = setup_of(right, INSOLE, LEFT)
    connect(setup, right)
    assert setup.end == f"{right.name} is a right foot one: expected at the left foot"
    setup = setup_of(right, TAG, LEFT)
    connect(setup, right)
    assert setup.end == f"{right.name} is no cc2650: it has no cc2650/movement"


@pytest.mark.parametrize(
    "faults, ends, words",
    [
        ("0 left_foot refuse insole/info", True, "insole/info cannot be read"),
        ("0 left_foot refuse device/firmware", False, "device/firmware cannot be read"),
        ("0 left_foot refuse insole/control", False, "insole/control was not set to 01"),
    ],
)
def test_a_rejection_ends_the_setup_only_if_nothing_can_be_received_without(
    faults: str, ends: bool, words: str
) -> None:
    device = Bench(ROUTE, devices={LEFT: Insole()}, faults=parse_faults(faults))[LEFT]
    setup = setup_of(device, INSOLE)
    values, done = connect(setup, device)
    assert (setup.end is not None, setup.is_listening) == (ends, not ends)
    rejected = [answer for _, answer in done if isinstance(answer, str)]
    assert [data.decode() for channel, data in values if channel == "receiver/trouble"] == [f"{words}: {rejected[0]}"]


def test_a_frozen_stream_is_set_up_again_twice_and_then_the_connection_ends() -> None:
    device = Bench(ROUTE, devices={LEFT: CC2650()}, seed=3)[LEFT]
    setup = setup_of(device, TAG, LEFT)
    connect(setup, device)
    restarts = []
    while setup.end is None:
        now = setup.next_check_at()
        assert now is not None
        values, done = perform(setup, device, now, setup.check(now))
        restarts.append([channel for channel, _ in values])
    assert restarts == [["receiver/restarted", *(write.channel for write in TAG.setup)]] * 2 + [["receiver/restarted"]]
    assert setup.end == "cc2650/movement is frozen"


@pytest.mark.parametrize("config, checked", [("7f02", True), ("ff02", False)], ids=["always on", "wake on motion"])
def test_a_device_that_waits_for_motion_is_not_checked(config: str, checked: bool) -> None:
    device = Bench(ROUTE, devices={LEFT: CC2650()}, seed=3)[LEFT]
    setup = setup_of(device, evolve(TAG, setup=(Write("cc2650/movement-config", bytes.fromhex(config)),)), LEFT)
    connect(setup, device, 5.0)
    assert setup.next_check_at() == (5.0 + TAG.stale_after if checked else None)


@given(profile=st.sampled_from(PROFILES), data=st.data())
def test_any_answers_lead_to_listening_or_to_an_end(profile: Profile, data: st.DataObject) -> None:
    roster = Roster()
    [member] = roster.add([DeviceConfig(LEFT, "A", profile)])
    present = data.draw(st.sets(st.sampled_from(sorted(all_characteristics(profile), key=repr))))
    setup = DeviceSetup(roster, member, profile, frozenset(present), "A", "a" * 300)
    session, requests, now = Session(), 0, 0.0
    values = setup.start(now)
    for _ in range(200):
        if setup.request is None:
            break
        requests += 1
        now += 0.1
        if data.draw(st.booleans()):
            values += setup.answer(now, data.draw(st.binary(max_size=40)))
        else:
            values += setup.reject(now, data.draw(st.text(max_size=600)) or "?")
    assert setup.request is None and (setup.end is None) is setup.is_listening
    assert requests <= 1 + len(profile.channels) + sum(1 + len(write.then_read) for write in profile.setup)
    values += setup.disconnect()
    events = list(feed(session, setup, now, values))
    assert not [
        event for event in events if isinstance(event, PacketRejected) and event.channel.startswith("receiver/")
    ]
    with pytest.raises(ValueError, match="no request"):
        setup.answer(now)


def test_the_writes_follow_the_subscriptions_except_those_that_are_needed_before() -> None:
    first, *others = TAG.setup
    early = evolve(TAG, setup=(*others, evolve(first, before_subscribing=True)))
    for profile, key in ((TAG, None), (early, (first.channel, first.value))):
        roster = Roster()
        [member] = roster.add([DeviceConfig(LEFT, "X", profile)])
        setup = DeviceSetup(roster, member, profile, all_characteristics(profile), "X", "")
        setup.start(0.0)
        done: list[Request] = []
        while (request := setup.request) is not None:
            done.append(request)
            setup.answer(0.1 * len(done))
        kinds = [one.operation for one in done if one.channel.name not in first.then_read]
        writes = [(one.channel.name, one.value) for one in done if one.operation is Operation.WRITE]
        assert sorted(writes) == sorted((one.channel, one.value) for one in TAG.setup)
        subscribed = [place for place, kind in enumerate(kinds) if kind is Operation.SUBSCRIBE]
        written = [place for place, kind in enumerate(kinds) if kind is Operation.WRITE]
        if key is None:
            assert max(subscribed) < min(written)
        else:
            assert writes[0] == key and written[0] < min(subscribed) < max(subscribed) < written[1]
        assert setup.is_listening
