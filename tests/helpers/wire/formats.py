"""Parser and builder in wire for each vector file of protocol/."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import attrs
from attrs import frozen
from here import PROTOCOL

from solepath.link.catalogue import DECLARED
from solepath.link.devices import cc2541
from solepath.saving import codec
from solepath.testing.vectors import plain
from solepath.types import Cell, Foot
from solepath.wire import device, fragment, insole, insole_control, insole_info, receiver
from solepath.wire.fields import build_text, build_whole, parse_text, parse_whole

VECTORS = PROTOCOL / "vectors"


@frozen
class Format:
    """Functions for one vector file: bytes to record and back, record to the file's fields and back."""

    parse: Callable[[bytes], Any]
    build: Callable[[Any], bytes]
    to_fields: Callable[[Any], Any]
    from_fields: Callable[[Any], Any]


def record(cls: type, parse: Callable[[bytes], Any], build: Callable[[Any], bytes]) -> Format:
    """Return a format whose fields in the file are those of the record."""
    return Format(parse, build, codec.save, lambda fields: codec.load(cls, fields))


def single(name: str, parse: Callable[[bytes], Any], build: Callable[[Any], bytes]) -> Format:
    """Return a format of one plain value."""
    return Format(parse, build, lambda value: {name: value}, lambda fields: fields[name])


def info_fields(info: insole_info.InsoleInfo) -> Any:
    saved: Any = codec.save(info)
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
    saved: Any = codec.save(command)
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
    "device-firmware": single("firmware", parse_text, build_text),
    "receiver-connected": record(receiver.ConnectionFrame, receiver.parse_connected, receiver.build_connected),
    "receiver-disconnected": Format(receiver.parse_nothing, lambda _: b"", lambda _: {}, lambda _: None),
    "receiver-dropped": single("count", receiver.parse_dropped, receiver.build_dropped),
    "receiver-position": record(receiver.PositionFrame, receiver.parse_position, receiver.build_position),
    "receiver-restarted": single("words", parse_text, build_text),
    "receiver-tick": Format(receiver.parse_nothing, lambda _: b"", lambda _: {}, lambda _: None),
    "receiver-trouble": single("words", parse_text, build_text),
}

PERIODS = ("cc2650/barometer-period", *[channel for channel in cc2541.FORMATS if channel.endswith("-period")])
"""Channels with the same format as cc2650/movement-period, whose vectors stand for all of them."""
FILE_OF_CHANNEL = {"cc2650/movement-period": "sensortag-period"}
DECLARED_FORMATS = {
    FILE_OF_CHANNEL.get(channel, channel.replace("/", "-")): (driver, definition)
    for driver in DECLARED
    for channel, definition in driver.formats.items()
    if channel not in PERIODS
}
CC2541_FORMATS = {
    channel.replace("/", "-"): definition for channel, definition in cc2541.FORMATS.items() if channel not in PERIODS
}
FORMATS |= {
    name: Format(partial(parse_whole, definition), partial(build_whole, definition), plain, lambda fields: fields)
    for name, definition in [
        *CC2541_FORMATS.items(),
        *[(name, definition) for name, (_, definition) in DECLARED_FORMATS.items()],
    ]
}
