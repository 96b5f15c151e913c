"""Movella DOT (dot.py) in its mode "orientation (quaternion)", which sends the attitude at 60 Hz.

It is for sensors on pelvis, thighs and shanks, whose recipe needs only attitudes (protocol/dot-orientation.md). Source:
Movella DOT BLE Service Specification, document XD0506P, revision C, July 2023. It was never tried on hardware."""

from __future__ import annotations

from math import fsum
from typing import Any

from construct import ExprValidator, Int32ul, Struct, Terminated

from ...types.attrs import evolve
from ...wire.fields import Fields
from ..driver import Driver, Known, Measured, Reading
from ..profile import Access, Channel, Write
from . import dot

QUATERNION_MODE = 5
"""Number of the payload mode: timestamp, orientation as a quaternion."""
NAME = "dot-orientation"
MAX_LENGTH_ERROR = 0.01
"""Largest deviation of a quaternion's length from 1, which values of another mode exceed."""


def _has_length_one(quat: tuple[float, ...], _: Any) -> bool:
    # the squared length deviates from 1 by twice as much as the length
    return dot.all_finite(quat, None) and abs(fsum([part * part for part in quat]) - 1.0) < 2.0 * MAX_LENGTH_ERROR


def _replace_prefix(channel: str) -> str:
    return channel.replace(dot.PROFILE.name, NAME, 1)


PROFILE = evolve(
    dot.PROFILE,
    name=NAME,
    channels=(
        Channel("dot-orientation/quaternion", dot.uuid(0x2000), dot.uuid(0x2004), Access.NOTIFY),
        *[
            evolve(channel, name=_replace_prefix(channel.name))
            for channel in dot.PROFILE.channels
            if channel.name != "dot/rates"
        ],
    ),
    setup=(
        Write("dot-orientation/device-control", dot.PROFILE.setup[0].value),
        Write("dot-orientation/control", bytes([1, 1, QUATERNION_MODE])),
    ),
    reads=("dot-orientation/battery",),
    streams=("dot-orientation/quaternion",),
)

FORMATS = {
    "dot-orientation/quaternion": Struct(
        "ticks" / Int32ul, "quat" / ExprValidator(Fields("<4f"), _has_length_one), Terminated
    ),
    "dot-orientation/control": dot.FORMATS["dot/control"],
    "dot-orientation/device-control": dot.FORMATS["dot/device-control"],
    "dot-orientation/battery": dot.FORMATS["dot/battery"],
}


def _quaternion(value: Any, known: Known) -> Reading:
    return Reading((Measured(quat=value.quat),), ticks=value.ticks)


def _control(value: Any, known: Known) -> Reading:
    """Read a write that starts or stops a mode; the device is silent when stopped, or when it sends another mode."""
    return Reading(silent=value.action == 0 or value.mode != QUATERNION_MODE)


DRIVER = Driver(
    PROFILE,
    FORMATS,
    readers={
        "dot-orientation/quaternion": _quaternion,
        "dot-orientation/control": _control,
        "dot-orientation/device-control": dot.device_control,
        "dot-orientation/battery": dot.battery,
    },
    tick_rate=1e6,
    tick_modulus=1 << 32,
)
