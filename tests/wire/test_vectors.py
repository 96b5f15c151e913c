"""The vectors of protocol/ against the wire, in both directions. They were made without it."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import partial
from typing import Any

import attrs
import pytest
from attrs import frozen
from here import PROTOCOL

from solepath.events import Rejection
from solepath.link.catalogue import DECLARED, PROFILES
from solepath.link.devices import cc2541
from solepath.link.driver import Driver
from solepath.saving import codec as machine
from solepath.testing.vectors import disagreements, plain
from solepath.types import Cell, Foot
from solepath.wire import device, fragment, insole, insole_control, insole_info, receiver
from solepath.wire.envelope import seal
from solepath.wire.error import WireError
from solepath.wire.fields import build_text, build_whole, parse_text, parse_whole

VECTORS = PROTOCOL / "vectors"


@frozen
class Format:
    """How one vector file is read and written: bytes to record and back, record to the file's fields and back."""

    parse: Callable[[bytes], Any]
    build: Callable[[Any], bytes]
    to_fields: Callable[[Any], Any]
    from_fields: Callable[[Any], Any]


def record(cls: type, parse: Callable[[bytes], Any], build: Callable[[Any], bytes]) -> Format:
    """A format whose fields in the file are those of the record."""
    return Format(parse, build, machine.save, lambda fields: machine.load(cls, fields))


def single(name: str, parse: Callable[[bytes], Any], build: Callable[[Any], bytes]) -> Format:
    """A format of one plain value."""
    return Format(parse, build, lambda value: {name: value}, lambda fields: fields[name])


def info_fields(info: insole_info.InsoleInfo) -> Any:
    saved: Any = machine.save(info)
    return saved | {"cells": [[c["x"], c["y"], c["area"]] for c in saved["cells"]]}


def info_record(fields: Any) -> insole_info.InsoleInfo:
    cells = tuple(Cell(*cell) for cell in fields["cells"])
    return insole_info.InsoleInfo(**fields | {"foot": Foot(fields["foot"]), "cells": cells})


def fragment_fields(piece: fragment.Fragment) -> Any:
    return attrs.asdict(piece) | {"body": piece.body.hex()}


def fragment_record(fields: Any) -> fragment.Fragment:
    return fragment.Fragment(**fields | {"body": bytes.fromhex(fields["body"])})


COMMANDS = {
    "START": insole_control.StartSampling,
    "STOP": insole_control.StopSampling,
    "SET INTERVAL": insole_control.SetInterval,
    "RESEND": insole_control.Resend,
}


def command_fields(command: insole_control.Command) -> Any:
    saved: Any = machine.save(command)
    return {"command": next(name for name, cls in COMMANDS.items() if cls is type(command))} | saved


def command_record(fields: Any) -> Any:
    return COMMANDS[fields["command"]](**{k: v for k, v in fields.items() if k != "command"})


FORMATS = {
    "insole-frame": record(insole.InsoleFrame, insole.parse_frame, insole.build_frame),
    "insole-fragment": Format(fragment.parse_fragment, fragment.build_fragment, fragment_fields, fragment_record),
    "insole-info": Format(insole_info.parse_info, insole_info.build_info, info_fields, info_record),
    "insole-control": Format(
        insole_control.parse_control, insole_control.build_control, command_fields, command_record
    ),
    "device-battery": single("percent", device.parse_battery, device.build_battery),
    "device-firmware": single("firmware", device.parse_firmware, device.build_firmware),
    "receiver-connected": record(receiver.ConnectionFrame, receiver.parse_connected, receiver.build_connected),
    "receiver-disconnected": Format(receiver.parse_nothing, lambda _: b"", lambda _: {}, lambda _: None),
    "receiver-dropped": single("count", receiver.parse_dropped, receiver.build_dropped),
    "receiver-restarted": single("words", parse_text, build_text),
    "receiver-tick": Format(receiver.parse_nothing, lambda _: b"", lambda _: {}, lambda _: None),
    "receiver-trouble": single("words", parse_text, build_text),
}

PERIODS = ("cc2650/barometer-period", *[channel for channel in cc2541.FORMATS if channel.endswith("-period")])
"""All periods are alike; one of them has the vectors of all."""
FILE_OF = {"cc2650/movement-period": "sensortag-period"}
DECLARED_FORMATS = {
    FILE_OF.get(channel, channel.replace("/", "-")): (driver, one)
    for driver in DECLARED
    for channel, one in driver.formats.items()
    if channel not in PERIODS
}
OLD_TAG = {channel.replace("/", "-"): one for channel, one in cc2541.FORMATS.items() if channel not in PERIODS}
FORMATS |= {
    name: Format(partial(parse_whole, one), partial(build_whole, one), plain, lambda fields: fields)
    for name, one in [*OLD_TAG.items(), *[(name, one) for name, (_, one) in DECLARED_FORMATS.items()]]
}

FILES = {path.stem: json.loads(path.read_text("utf-8")) for path in sorted(VECTORS.glob("*.json"))}


def vectors(result: str) -> list[Any]:
    return [
        pytest.param(FORMATS[name], vector, id=f"{name}:{vector['id']}")
        for name, file in FILES.items()
        for vector in file["vectors"]
        if vector["result"] == result
    ]


@pytest.mark.parametrize(("wire", "vector"), vectors("valid"))
def test_the_packet_says_what_the_vector_says(wire: Format, vector: Any) -> None:
    assert wire.to_fields(wire.parse(bytes.fromhex(vector["hex"]))) == vector["fields"]


@pytest.mark.parametrize(("wire", "vector"), vectors("valid"))
def test_what_the_vector_says_is_written_as_its_packet(wire: Format, vector: Any) -> None:
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
def test_the_t5400_is_compensated_as_its_formulas_say(vector: Any) -> None:
    physical = vector["physical"]
    raw = parse_whole(cc2541.FORMATS["cc2541/barometer"], bytes.fromhex(vector["hex"]))
    fields = parse_whole(cc2541.FORMATS["cc2541/barometer-calibration"], bytes.fromhex(physical["calibration"]))
    calibration = cc2541.BarometerCalibration(**plain(fields))
    assert calibration.celsius(raw.temperature) == pytest.approx(physical["celsius"], abs=physical["tolerance"])
    pascal = calibration.pascal(raw.temperature, raw.pressure)
    assert pascal == pytest.approx(physical["pascal"], abs=physical["tolerance"])


@pytest.mark.parametrize("name", DECLARED_FORMATS)
def test_a_declared_device_means_what_its_vectors_say(name: str) -> None:
    driver: Driver = DECLARED_FORMATS[name][0]
    assert disagreements(driver, FILES[name]) == []
    changed = json.loads(json.dumps(FILES[name]))
    for vector in changed["vectors"]:
        vector["hex"] += "00"
    told = disagreements(driver, changed)
    assert len({what.partition(":")[0] for what in told}) >= 3, "it agrees with everything"


@pytest.mark.parametrize("name", FORMATS)
def test_a_vector_file_keeps_to_its_schema(name: str) -> None:
    file = FILES[name]
    assert file["schema"] == "solepath vectors 1"
    assert file["count"] == len(file["vectors"]) == len({v["id"] for v in file["vectors"]})
    for vector in file["vectors"]:
        assert vector["source"] in {"datasheet", "hand", "capture", "generated"}
        assert set(vector["notes"]) <= set(file["notes"])
        assert ("fields" in vector) == (vector["result"] == "valid")
        assert ("reason" in vector) == (vector["result"] == "invalid")


def test_every_format_has_a_vector_file_and_the_other_way_round() -> None:
    assert set(FILES) == set(FORMATS)


def test_every_channel_has_a_vector_file() -> None:
    channels = {channel.name for profile in PROFILES for channel in profile.channels}
    others = {name for name in channels if not name.endswith("-period")}
    devices = {file["channel"] for file in FILES.values() if not file["channel"].startswith("receiver/")}
    assert devices - {"cc2650/movement-period"} == others
    files = {name for name in FILES if not name.startswith("receiver-")}
    assert {name.replace("/", "-") for name in others} | {"sensortag-period", "insole-fragment"} == files


def test_the_crc_is_ccitt_false() -> None:
    assert seal(b"123456789") == b"123456789\xb1\x29"
