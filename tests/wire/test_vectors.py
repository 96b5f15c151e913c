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
from solepath.link.devices import DECLARED
from solepath.link.driver import Driver
from solepath.link.known import PROFILES
from solepath.saving import codec as machine
from solepath.testing.vectors import disagreements, plain
from solepath.types import Cell, Foot
from solepath.wire import cc2541, cc2650, device, fragment, insole, insole_control, insole_info, period, receiver
from solepath.wire.envelope import crc16
from solepath.wire.error import WireError
from solepath.wire.fields import build_whole, parse_whole

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
    "cc2650-movement": record(cc2650.Movement, cc2650.parse_movement, cc2650.build_movement),
    "cc2650-movement-config": record(cc2650.MovementConfig, cc2650.parse_movement_config, cc2650.build_movement_config),
    "cc2650-barometer": record(cc2650.Cc2650Barometer, cc2650.parse_barometer, cc2650.build_barometer),
    "cc2650-barometer-config": record(
        cc2650.Cc2650BarometerConfig, cc2650.parse_barometer_config, cc2650.build_barometer_config
    ),
    "cc2650-keys": record(cc2650.Cc2650Keys, cc2650.parse_keys, cc2650.build_keys),
    "cc2541-accelerometer": record(cc2541.Accelerometer, cc2541.parse_accelerometer, cc2541.build_accelerometer),
    "cc2541-accelerometer-config": record(
        cc2541.AccelerometerConfig, cc2541.parse_accelerometer_config, cc2541.build_accelerometer_config
    ),
    "cc2541-gyroscope": record(cc2541.Gyroscope, cc2541.parse_gyroscope, cc2541.build_gyroscope),
    "cc2541-gyroscope-config": record(
        cc2541.GyroscopeConfig, cc2541.parse_gyroscope_config, cc2541.build_gyroscope_config
    ),
    "cc2541-magnetometer": record(cc2541.Magnetometer, cc2541.parse_magnetometer, cc2541.build_magnetometer),
    "cc2541-magnetometer-config": record(
        cc2541.MagnetometerConfig, cc2541.parse_magnetometer_config, cc2541.build_magnetometer_config
    ),
    "cc2541-barometer": record(cc2541.Cc2541Barometer, cc2541.parse_barometer, cc2541.build_barometer),
    "cc2541-barometer-config": record(
        cc2541.Cc2541BarometerConfig, cc2541.parse_barometer_config, cc2541.build_barometer_config
    ),
    "cc2541-barometer-calibration": record(
        cc2541.BarometerCalibration, cc2541.parse_barometer_calibration, cc2541.build_barometer_calibration
    ),
    "cc2541-keys": record(cc2541.Cc2541Keys, cc2541.parse_keys, cc2541.build_keys),
    "device-battery": single("percent", device.parse_battery, device.build_battery),
    "device-firmware": single("firmware", device.parse_firmware, device.build_firmware),
    "receiver-connected": record(receiver.ConnectionFrame, receiver.parse_connected, receiver.build_connected),
    "receiver-disconnected": Format(receiver.parse_nothing, lambda _: b"", lambda _: {}, lambda _: None),
    "receiver-dropped": single("count", receiver.parse_dropped, receiver.build_dropped),
    "receiver-restarted": single("words", receiver.parse_words, receiver.build_words),
    "receiver-tick": Format(receiver.parse_nothing, lambda _: b"", lambda _: {}, lambda _: None),
    "receiver-trouble": single("words", receiver.parse_words, receiver.build_words),
    "sensortag-period": single("period", period.parse_period, period.build_period),
}

DECLARED_FORMATS = {channel.replace("/", "-"): (d, d.formats[channel]) for d in DECLARED for channel in d.formats}
FORMATS |= {
    name: Format(partial(parse_whole, one), partial(build_whole, one), plain, lambda fields: fields)
    for name, (_, one) in DECLARED_FORMATS.items()
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
    raw = cc2541.parse_barometer(bytes.fromhex(vector["hex"]))
    calibration = cc2541.parse_barometer_calibration(bytes.fromhex(physical["calibration"]))
    assert calibration.celsius(raw) == pytest.approx(physical["celsius"], abs=physical["tolerance"])
    assert calibration.pascal(raw) == pytest.approx(physical["pascal"], abs=physical["tolerance"])


def test_left_and_right_keys_are_the_other_way_round_on_the_older_tag() -> None:
    assert cc2650.parse_keys(b"\x01").down == ("left",)
    assert cc2541.parse_keys(b"\x01").down == ("right",)
    assert cc2541.parse_keys(b"\x07").down == ("left", "right", "side")


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
    assert crc16(b"123456789") == 0x29B1
