"""Walks with declared devices on the feet: samples of a walker written as each device writes them, over a radio."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable
from math import degrees, radians
from typing import Any

import numpy as np
from attrs import frozen

from solepath.emulate.radio import Radio
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.device import Notification
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.link.devices import dot, orphe, thingy
from solepath.link.driver import Driver
from solepath.types import SITE_OF_FOOT, Foot, Packet, Sample
from solepath.types.vector import GRAVITY

SETUP = 0.05
"""Time of the start of measurement, s; attributes are read and written before."""


@frozen
class Worn:
    """A device to be emulated.

    `rate` is the true sample rate, Hz. `each` is the number of samples in a packet. `build` makes the value of packet k
    from its samples. `read` makes the value of each channel that is read."""

    driver: Driver
    rate: float
    each: int
    build: Callable[[int, list[Sample]], Any]
    read: dict[str, Callable[[Foot], bytes]]
    beside: tuple[tuple[float, str, bytes], ...] = ()
    """Notifications (time, s, channel, data) besides the stream."""


def counts(values: Iterable[float], unit: float) -> list[int]:
    return [max(-32768, min(32767, round(value / unit))) for value in values]


def binary32(values: Iterable[float]) -> list[float]:
    return [struct.unpack("<f", struct.pack("<f", value))[0] for value in values]


def _orphe(k: int, samples: list[Sample]) -> Any:
    ms = round(1000 * (43_000.0 + samples[0].t))
    return {
        "header": 56,
        "serial": (65_300 + k) % 65_536,
        "hour": ms // 3_600_000 % 24,
        "minute": ms // 60_000 % 60,
        "second": ms // 1000 % 60,
        "millisecond": ms % 1000,
        "samples": [
            {
                "quat": [16384, 0, 0, 0],
                "gyro": counts(s.gyro or (), radians(0.07)),
                "acc": counts(s.acc or (), 16 * GRAVITY / 32768),
                "pressure": [min(65535, round(10 * load)) for load in (s.pressure or ())[:6]],
            }
            for s in reversed(samples)
        ],
        "unused": "00" * 32,
    }


def _dot(k: int, samples: list[Sample]) -> Any:
    (sample,) = samples
    acc, gyro = binary32(sample.acc or ()), binary32(map(degrees, sample.gyro or ()))
    return {"ticks": (2**32 - 4_000_000 + round(1e6 * sample.t)) % 2**32, "acc": acc, "gyro": gyro}


def _thingy(k: int, samples: list[Sample]) -> Any:
    (sample,) = samples
    acc = counts([-value for value in sample.acc or ()], GRAVITY / 1024)
    return {"acc": acc, "gyro": counts(sample.gyro or (), radians(1 / 32)), "mag": [320, 0, -688]}


def _orphe_info(foot: Foot) -> bytes:
    return bytes([2, foot is Foot.RIGHT, 0, 0, 0, 0, 0, 0, 3, 3]) + bytes(10)


ORPHE = Worn(orphe.DRIVER, 100.4, 2, _orphe, {"orphe/info": _orphe_info, "device/firmware": lambda foot: b"1.0"})
DOT = Worn(dot.DRIVER, 60.0, 1, _dot, {"dot/battery": lambda foot: b"\x5a\x00"})
THINGY = Worn(
    thingy.DRIVER,
    100.0,
    1,
    _thingy,
    {"device/battery": lambda foot: b"\x50"},
    tuple((1.0 * k, "thingy/pressure", bytes.fromhex("f503000019")) for k in range(1, 8)),
)

EVERY = (ORPHE, DOT, THINGY)


def sent(worn: Worn, walker: Walker, foot: Foot) -> list[Notification]:
    """Return all packets of the device on a foot, from the first read and write on."""
    profile, cells = worn.driver.profile, layout(8, foot)
    samples = walker.samples(foot, worn.rate, LSM6DSOX, layout=cells if worn is ORPHE else None)
    values = [(channel, worn.read[channel](foot)) for channel in profile.reads]
    values += [(write.channel, write.value) for write in profile.setup]
    notifications = [Notification(SETUP * k / len(values), *value, True) for k, value in enumerate(values)]
    (stream,) = profile.streams
    for k in range(len(samples) // worn.each):
        packet_samples = samples[k * worn.each : (k + 1) * worn.each]
        notifications.append(
            Notification(SETUP + packet_samples[-1].t, stream, worn.driver.write(stream, worn.build(k, packet_samples)))
        )
    notifications += [Notification(*value) for value in worn.beside]
    return sorted(notifications, key=lambda notification: notification.t)


def walked(worn: Worn, route: Route, radio: Radio, seed: int = 7) -> tuple[Packet, ...]:
    """Return the packets of both feet in the order of arrival."""
    walker = Walker(route, seed=seed)
    packets = [
        packet
        for foot in Foot
        for packet in radio.transmit(
            sent(worn, walker, foot), SITE_OF_FOOT[foot], np.random.default_rng([seed, list(Foot).index(foot)])
        )
    ]
    return tuple(sorted(packets, key=lambda packet: packet.t))
