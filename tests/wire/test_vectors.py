"""Comparison of the wire package with the vectors of protocol/, which were made without it, in both directions."""

from __future__ import annotations

import json
from typing import Any

import pytest
from formats import DECLARED_FORMATS, FORMATS, VECTORS, Format

from solepath.events import Rejection
from solepath.link.catalogue import PROFILES
from solepath.link.devices import cc2541
from solepath.link.driver import Driver
from solepath.testing.vectors import disagreements, plain
from solepath.wire import fragment
from solepath.wire.error import WireError
from solepath.wire.fields import parse_whole

NO_DEVICE = ("receiver/", "rsc/")
"""Starts of channels that are of no device with samples."""
FILES = {path.stem: json.loads(path.read_text("utf-8")) for path in sorted(VECTORS.glob("*.json"))}


def vectors(result: str) -> list[Any]:
    return [
        pytest.param(FORMATS[name], vector, id=f"{name}:{vector['id']}")
        for name, file in FILES.items()
        for vector in file["vectors"]
        if vector["result"] == result
    ]


@pytest.mark.parametrize(("wire", "vector"), vectors("valid"))
def test_the_packet_parses_to_the_vector(wire: Format, vector: Any) -> None:
    assert wire.to_fields(wire.parse(bytes.fromhex(vector["hex"]))) == vector["fields"]


@pytest.mark.parametrize(("wire", "vector"), vectors("valid"))
def test_the_vector_builds_its_packet(wire: Format, vector: Any) -> None:
    assert wire.build(wire.from_fields(vector["fields"])).hex() == vector["hex"]


@pytest.mark.parametrize(("wire", "vector"), vectors("invalid"))
def test_an_invalid_packet_is_rejected_for_the_reason_named(wire: Format, vector: Any) -> None:
    with pytest.raises(WireError) as caught:
        wire.parse(bytes.fromhex(vector["hex"]))
    assert caught.value.reason == Rejection(vector["reason"])
    assert caught.value.detail


@pytest.mark.parametrize("case", [pytest.param(case, id=case["id"]) for case in FILES["insole-fragment"]["splits"]])
def test_a_frame_is_cut_into_the_notifications_of_the_vector(case: Any) -> None:
    frame = bytes.fromhex(case["frame"])
    notifications = fragment.split(frame, case["payload"], case["frame_id"])
    assert [n.hex() for n in notifications] == case["notifications"]
    assert all(len(n) <= case["payload"] for n in notifications)
    if len(notifications) > 1:
        assert all(fragment.is_fragment(n) for n in notifications)
        assert b"".join(fragment.parse_fragment(n).body for n in notifications) == frame


@pytest.mark.parametrize(
    "vector", [v for v in FILES["cc2541-barometer"]["vectors"] if "physical" in v], ids=lambda vector: vector["id"]
)
def test_the_t5400_is_compensated_by_its_formulas(vector: Any) -> None:
    physical = vector["physical"]
    raw = parse_whole(cc2541.FORMATS["cc2541/barometer"], bytes.fromhex(vector["hex"]))
    fields = parse_whole(cc2541.FORMATS["cc2541/barometer-calibration"], bytes.fromhex(physical["calibration"]))
    calibration = cc2541.BarometerCalibration(**plain(fields))
    assert calibration.celsius(raw.temperature) == pytest.approx(physical["celsius"], abs=physical["tolerance"])
    pascal = calibration.pascal(raw.temperature, raw.pressure)
    assert pascal == pytest.approx(physical["pascal"], abs=physical["tolerance"])


@pytest.mark.parametrize("name", DECLARED_FORMATS)
def test_a_declared_device_agrees_with_its_vectors(name: str) -> None:
    driver: Driver = DECLARED_FORMATS[name][0]
    assert disagreements(driver, FILES[name]) == []


def test_every_format_has_a_vector_file_and_the_other_way_round() -> None:
    assert set(FILES) == set(FORMATS)


def test_every_channel_has_a_vector_file() -> None:
    channels = {channel.name for profile in PROFILES for channel in profile.channels}
    non_period_channels = {name for name in channels if not name.endswith("-period")}
    file_channels = {file["channel"] for file in FILES.values() if not file["channel"].startswith(NO_DEVICE)}
    assert file_channels - {"cc2650/movement-period"} == non_period_channels
    files = {name for name in FILES if not name.replace("-", "/").startswith(NO_DEVICE)}
    assert {name.replace("/", "-") for name in non_period_channels} | {"sensortag-period", "insole-fragment"} == files
