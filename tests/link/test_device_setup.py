"""Setup of a device without Bluetooth: its requests in order, what ends it, and what a frozen stream leads to."""

from __future__ import annotations

from math import inf, nextafter

import pytest
from attrs import evolve
from decoded import info_value

from solepath import Foot, Site
from solepath.link.catalogue import PROFILES
from solepath.link.devices.cc2650 import PROFILE as TAG
from solepath.link.devices.insole import PROFILE as INSOLE
from solepath.link.profile import Access, Profile, Write
from solepath.link.setup.config import DeviceConfig
from solepath.link.setup.device_setup import DeviceSetup, GattCharacteristic, Operation, Value
from solepath.link.setup.roster import Member, Roster

LEFT, RIGHT = Site.LEFT_FOOT, Site.RIGHT_FOOT
READ, SUBSCRIBE, WRITE = Operation.READ, Operation.SUBSCRIBE, Operation.WRITE
NAMED = [pytest.param(profile, id=profile.name) for profile in PROFILES]


def setup_of(
    profile: Profile, without: str = "", member: Member | None = None, roster: Roster | None = None, address: str = "A"
) -> DeviceSetup:
    """Return the setup of a device that has all characteristics of its profile but one."""
    roster = roster or Roster()
    if member is None:
        [member] = roster.add([DeviceConfig(LEFT, "A", profile)])
    present = frozenset(
        GattCharacteristic(one.service, one.characteristic, one.access is Access.NOTIFY)
        for one in profile.channels
        if one.name != without
    )
    return DeviceSetup(roster, member, profile, present, address, "Shoe", -60)


def value_of(channel: str, foot: Foot = Foot.LEFT) -> bytes:
    """Return what a device answers when this channel is read."""
    return info_value(foot=foot) if channel == "insole/info" else b"\x32"


def perform(
    setup: DeviceSetup, rejected: int = -1, foot: Foot = Foot.LEFT
) -> tuple[list[tuple[Operation, str]], list[Value]]:
    """Start, and answer all requests, one every second, but the one of this number; return requests and values."""
    values, done = setup.start(0.0), list[tuple[Operation, str]]()
    while (request := setup.request) is not None and setup.end is None:
        done.append((request.operation, request.channel.name))
        if len(done) - 1 == rejected:
            values += setup.reject("busy", float(len(done)))
        else:
            answer = value_of(request.channel.name, foot) if request.operation is READ else b""
            values += setup.answer(answer, float(len(done)))
    return done, values


def expected_requests(profile: Profile) -> list[tuple[Operation, str]]:
    """Return what protocol/ says: reads, what must be written before, subscriptions, writes and what is read after."""
    early, late = [], []
    for write in profile.setup:
        (early if write.before_subscribing else late).append((WRITE, write.channel))
        late += [(READ, name) for name in write.then_read]
    subscriptions = [(SUBSCRIBE, one.name) for one in profile.channels if one.access is Access.NOTIFY]
    return [*[(READ, name) for name in profile.reads], *early, *subscriptions, *late]


@pytest.mark.parametrize(
    "profile", [*NAMED, evolve(TAG, setup=(*TAG.setup[1:], evolve(TAG.setup[0], before_subscribing=True)))]
)
def test_a_device_is_read_subscribed_and_written_in_order_and_every_value_is_recorded(profile: Profile) -> None:
    setup = setup_of(profile)
    done, values = perform(setup)
    assert done == expected_requests(profile)
    assert setup.is_listening and setup.end is None and setup.member.address == "A"
    assert setup.next_check_at() == len(done) + profile.stale_after
    assert values[0] == ("receiver/connected", b"\xc4Shoe")
    written = {
        write.channel: [one.value for one in profile.setup if one.channel == write.channel] for write in profile.setup
    }
    recorded = [(READ, name, value_of(name)) if name not in written else (WRITE, name, written[name].pop(0))
                for operation, name in done if operation is not SUBSCRIBE]  # fmt: skip
    assert values[1:] == [(name, value) for _, name, value in recorded]
    assert setup.disconnect() == [("receiver/disconnected", b"")] and setup.next_check_at() is None
    with pytest.raises(ValueError, match="no request"):
        setup.answer(b"", 99.0)


@pytest.mark.parametrize("profile", NAMED)
def test_only_a_stream_or_the_record_of_the_foot_that_is_refused_ends_the_setup(profile: Profile) -> None:
    words = {READ: "cannot be read: busy", SUBSCRIBE: "cannot be subscribed: busy", WRITE: "busy"}
    for number, (operation, channel) in enumerate(expected_requests(profile)):
        setup = setup_of(profile)
        done, values = perform(setup, rejected=number)
        needed = channel in profile.streams and operation is SUBSCRIBE or channel == "insole/info"
        assert (setup.end is not None, setup.is_listening) == (needed, not needed)
        (trouble,) = [data.decode() for name, data in values if name == "receiver/trouble"]
        assert trouble.startswith(channel) and trouble.endswith(words[operation])
        read_after = [name for write in profile.setup for name in write.then_read]
        assert needed or {*done, *[(READ, name) for name in read_after]} == {*expected_requests(profile)}


@pytest.mark.parametrize("profile", NAMED)
def test_what_a_device_does_not_have_is_left_out_unless_it_is_a_stream(profile: Profile) -> None:
    for channel in [
        one.name for one in profile.channels if one.name not in ("orphe/info", "orphe/mode", "insole/info")
    ]:
        setup = setup_of(profile, without=channel)
        done, values = perform(setup)
        if channel in profile.streams:
            assert setup.end == f"Shoe is no {profile.name}: it has no {channel}" and done == []
            continue
        read_after = [name for write in profile.setup if write.channel == channel for name in write.then_read]
        assert done == [one for one in expected_requests(profile) if one[1] not in (channel, *read_after)]
        missing = [data.decode() for name, data in values if name == "receiver/trouble"]
        assert missing == [f"{channel} is not there to be set: the device keeps to its own"] * sum(
            write.channel == channel for write in profile.setup
        )


def test_a_frozen_stream_is_set_up_again_twice_and_then_the_connection_ends() -> None:
    setup = setup_of(TAG)
    done, _ = perform(setup)
    ready = float(len(done))
    setup.add_notification("cc2650/movement", ready + 0.5)
    setup.add_notification("cc2650/keys", ready + 2.0)  # another channel does not show that the stream is alive
    due, restarts = ready + 0.5 + TAG.stale_after, 0
    while setup.end is None:
        assert setup.next_check_at() == due and setup.check(nextafter(due, 0.0)) == []
        values = setup.check(due)
        assert values[0] == ("receiver/restarted", b"cc2650/movement")
        while setup.request is not None:
            assert setup.next_check_at() is None
            values += setup.answer(b"", due + 0.25)
        if setup.end is None:
            assert values[1:] == [(write.channel, write.value) for write in TAG.setup]
        restarts += 1
        if restarts == 1:  # it sends again: two more tries are left
            setup.add_notification("cc2650/movement", due + 1.0)
            assert setup.check(due + 1.0) == [] and setup.has_streamed
            due += 1.0
        due += TAG.stale_after
    assert restarts == 4 and setup.end == "cc2650/movement is frozen"


def test_a_clock_that_restarts_gives_streams_their_whole_time_again() -> None:
    setup = setup_of(TAG)
    perform(setup)
    setup.restart_clock(-50.0)
    assert setup.next_check_at() == -50.0 + TAG.stale_after


@pytest.mark.parametrize("config, watched", [("7f02", True), ("ff02", False)], ids=["always on", "wake on motion"])
def test_a_device_that_waits_for_motion_is_not_checked(config: str, watched: bool) -> None:
    setup = setup_of(evolve(TAG, setup=(Write("cc2650/movement-config", bytes.fromhex(config)),)))
    perform(setup)
    assert (setup.next_check_at() is not None) is watched and setup.check(inf if not watched else 0.0) == []


def test_insoles_report_their_feet_and_one_that_is_not_expected_ends_in_words_for_a_minute() -> None:
    roster = Roster()
    members = roster.add([DeviceConfig(None, profile=INSOLE)] * 2)
    for member, site, address in zip(members, (RIGHT, LEFT), "BC", strict=True):
        perform(setup_of(INSOLE, "", member, roster, address), foot=Foot.RIGHT if site is RIGHT else Foot.LEFT)
        assert (member.site, member.address) == (site, address)
    assert [roster.is_excluded(members[0], address, "", 0.0) for address in "BCX"] == [False, True, False]
    members[1].address = ""
    setup = setup_of(INSOLE, "", members[1], roster, "X")
    _, values = perform(setup, foot=Foot.RIGHT)
    assert setup.end == "Shoe is one more for the right foot"
    assert values == [("receiver/trouble", setup.end.encode())] and setup.disconnect() == []
    assert roster.is_excluded(members[1], "X", "Shoe", nextafter(61.0, 0.0))
    assert not roster.is_excluded(members[1], "X", "Shoe", 61.0)
    setup = setup_of(INSOLE)
    perform(setup, foot=Foot.RIGHT)
    assert setup.end == "Shoe is a right foot one: expected at the left foot"
    setup = setup_of(INSOLE)
    setup.start(0.0)
    assert setup.answer(b"?", 1.0)[0][0] == "receiver/trouble" and setup.end is not None
    assert setup.end.startswith("the INFO record of Shoe cannot be read")
    named = Roster()
    first, second = named.add([DeviceConfig(LEFT, "A", TAG), DeviceConfig(RIGHT, "Shoe", TAG)])
    assert named.is_excluded(first, "Z", "Shoe", 0.0) and not named.is_excluded(second, "Z", "Shoe", 0.0)
