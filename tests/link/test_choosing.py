"""Which of the devices in range is the configured one, which configs contradict each other, and what is said once."""

from __future__ import annotations

from math import nextafter

import pytest

from solepath.ble.candidates import Advertisement, Candidates
from solepath.link.devices.cc2650 import PROFILE as TAG
from solepath.link.devices.insole import PROFILE as INSOLE
from solepath.link.setup.config import DeviceConfig, check_configs, identify
from solepath.link.setup.device_setup import RecentTroubles, shorten, trouble
from solepath.session.json_host import filters
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
