"""Which of the devices in range is the configured one, which configs contradict each other, and what is said once."""

from __future__ import annotations

from math import nextafter

import pytest

from solepath.ble.candidates import Advertisement, Candidates
from solepath.link.devices.cc2541 import PROFILE as OLD_TAG
from solepath.link.devices.cc2650 import PROFILE as TAG
from solepath.link.devices.insole import PROFILE as INSOLE
from solepath.link.setup.config import DeviceConfig, check_configs, identify
from solepath.link.setup.device_setup import GattCharacteristic, RecentTroubles, find_profile, shorten, trouble
from solepath.session.host import Host
from solepath.session.json_host import filters
from solepath.session.session import Session
from solepath.types import Site

LEFT, RIGHT = Site.LEFT_FOOT, Site.RIGHT_FOOT


def tag(address: str, t: float, name: str = "SensorTag 2.0") -> Advertisement:
    return Advertisement(address, name, (), -60, t)


def candidates(config: DeviceConfig, address: str = "") -> Candidates:
    return Candidates(config, address, lambda found: found.address == "WRONG", 10.0)


def test_a_device_is_chosen_when_none_like_it_was_heard_for_a_second_and_while_it_is_near() -> None:
    choice = candidates(DeviceConfig(LEFT, profile=TAG))
    first = tag("A", 0.5)
    assert choice.add(first) and not choice.add(tag("B", 0.5, "Toaster")) and choice.add(tag("WRONG", 0.5))
    assert [choice.choose(now) for now in (0.5, nextafter(1.5, 0.0))] == [(None, "")] * 2
    assert choice.choose(1.5) == (first, "")
    assert choice.choose(3.5) == (None, "") and choice.choose(29.0) == (None, ""), "it was near 3 s ago"
    assert (
        choice.add(tag("B", 30.0))
        and "2 devices answer" in choice.choose(30.0)[1]
        and choice.choose(30.4) == (None, "")
    )
    assert [choice.choose(now)[0] for now in (31.0, 31.5)] == [tag("B", 30.0)] * 2, "the other was heard 30 s ago"
    assert not choice.add(tag("B", 31.6, "Toaster")) and choice.choose(32.0) == (None, "")


def test_a_device_of_a_known_address_and_any_insole_are_chosen_at_once() -> None:
    for choice in (candidates(DeviceConfig(LEFT, "a", TAG)), candidates(DeviceConfig(LEFT, "SensorTag 2.0"), "A")):
        assert choice.add(tag("A", 0.0)) and choice.add(tag("C", 0.0)) is False
        assert choice.choose(0.0) == (tag("A", 0.0), "")
    insole = Advertisement("I", "", INSOLE.services, -60, 0.0)
    choice = candidates(DeviceConfig(None, profile=INSOLE))
    assert choice.add(insole) and choice.choose(0.0) == (insole, "")
    nothing = candidates(DeviceConfig(LEFT, profile=TAG))
    assert nothing.choose(nextafter(10.0, 0.0)) == (None, "")
    assert nothing.choose(10.0)[1].startswith("no cc2650 is in range") and nothing.choose(11.0) == (None, "")


@pytest.mark.parametrize("configs", [
    [], [DeviceConfig(LEFT, "A"), DeviceConfig(LEFT, "B")], [DeviceConfig(None, profile=INSOLE)] * 3,
    [DeviceConfig(LEFT, "A"), DeviceConfig(RIGHT, "a")], [DeviceConfig(s, profile=TAG) for s in (LEFT, RIGHT)],
    [DeviceConfig(LEFT, "A"), *[DeviceConfig(None, profile=INSOLE)] * 2],
])  # fmt: skip
def test_configs_that_may_mean_one_device_or_one_site_are_rejected(configs: list[DeviceConfig]) -> None:
    with pytest.raises(ValueError):
        check_configs(configs)
    check_configs([*[DeviceConfig(None, profile=INSOLE)] * 2, DeviceConfig(Site.PELVIS, "A")])
    for wrong in ({}, {"profile": TAG}):
        with pytest.raises(ValueError):
            DeviceConfig(None, **wrong)  # type: ignore[arg-type]


def test_a_device_is_identified_by_its_name_or_its_service_and_found_by_the_filters() -> None:
    assert (
        tag("A", 0.0).profile is identify("SensorTag 2.0", ()) is TAG
        and identify("", INSOLE.services) is INSOLE
        and identify("", ()) is None
    )
    names = [getattr(identify(name, ()), "name", None) for name in ("INS0123", "Thingy", "Thingy 2", "")]
    assert names == ["orphe", "thingy", None, None]
    found = {tuple(one.values()) for one in filters()["filters"]}
    assert found >= {("", "", INSOLE.services[0]), ("", "", TAG.services[0]), *[(name, "", "") for name in TAG.names]}


def test_a_trouble_is_said_again_after_a_minute_and_cut_to_whole_letters() -> None:
    recent, said = RecentTroubles(), [trouble("a"), ("device/battery", b"1"), trouble("b")]
    assert recent.leave_out(said, 0.0) == said and recent.leave_out(said, nextafter(60.0, 0.0)) == [said[1]]
    assert recent.leave_out(said, 60.0) == said
    many = [trouble(str(k)) for k in range(200)]
    assert recent.leave_out(many, 61.0) == many and recent.leave_out(many, 62.0) == many[98:]
    assert shorten("aé", 2) == "a" and shorten("aé", 3) == "aé" and len(trouble("é" * 999)[1]) == 500


IDENTIFIER = "8C1F6F6E-2B1D-4D0A-9E50-4B7A1C2D3E4F"
"""Identifier of a device on macOS."""


@pytest.mark.parametrize("which", ["f0:f1:f2:f3:f4:f5", "F0-F1-F2-F3-F4-F5", "f0f1f2f3f4f5", " F0.F1.F2.F3.F4.F5 "])
def test_an_address_is_the_same_in_any_spelling(which: str) -> None:
    assert DeviceConfig(LEFT, which).matches("F0:F1:F2:F3:F4:F5", "", ())
    assert not DeviceConfig(LEFT, which).matches("F0:F1:F2:F3:F4:F6", "", ())
    with pytest.raises(ValueError):
        check_configs([DeviceConfig(LEFT, which), DeviceConfig(RIGHT, "F0:F1:F2:F3:F4:F5")])


@pytest.mark.parametrize("which", [IDENTIFIER.lower(), IDENTIFIER.replace("-", ""), "{" + IDENTIFIER + "}"])
def test_an_identifier_of_macos_is_the_same_in_any_spelling(which: str) -> None:
    assert DeviceConfig(LEFT, which).matches(IDENTIFIER, "", ())


def test_what_was_seen_is_listed_when_the_device_is_not_found() -> None:
    choice = candidates(DeviceConfig(LEFT, "F0:F1:F2:F3:F4:F5"))
    for found in (tag(IDENTIFIER, 1.0), Advertisement("11", "", (), -30, 2.0), tag("22", 3.0, "SensorTag 2")):
        assert not choice.add(found)
    words = choice.choose(10.0)[1]
    assert words.startswith("no device 'F0:F1:F2:F3:F4:F5' is in range")
    assert words.endswith(f"; seen: SensorTag 2 (22), SensorTag 2.0 ({IDENTIFIER}), without a name (11)")
    crowd = candidates(DeviceConfig(LEFT, "x"))
    for number in range(500):
        crowd.add(tag(f"{number:03}", 1.0, f"Beacon {number}"))
    words = crowd.choose(10.0)[1]
    assert words.endswith("and 95 more") and len(words) < 500


def test_an_advertisement_without_a_name_does_not_drop_a_device_with_one() -> None:
    for config in (DeviceConfig(LEFT, "SensorTag 2.0"), DeviceConfig(LEFT, profile=TAG)):
        choice = candidates(config)
        assert choice.add(tag("A", 0.0)) and choice.add(tag("A", 0.4, name="")) and choice.add(tag("A", 0.8, name=""))
        choice.choose(0.9)
        found, _ = choice.choose(2.0)
        assert found is not None and (found.name, found.t) == ("SensorTag 2.0", 0.8)


@pytest.mark.parametrize("name", ["", "SensorTag", "CC2650 SensorTag", "My tag"])
@pytest.mark.parametrize("write", [str, str.upper])
def test_a_connected_device_is_known_by_what_it_has_whatever_it_advertises(name: str, write: type[str]) -> None:
    for profile in (TAG, OLD_TAG):
        has = [GattCharacteristic(write(one.service), write(one.characteristic), True) for one in profile.channels]
        assert find_profile(name, has) is profile
        commands = []
        host = Host(Session(), lambda packet, events: None)
        host.add("A", LEFT)
        commands = host.connect("A", name, has, 0.0)
        assert commands and all(command.request is not None for command in commands)
