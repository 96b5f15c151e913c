"""Packets of insoles and SensorTags to feed to a decoder."""

from __future__ import annotations

from math import radians
from typing import Any

from attrs import evolve

from solepath.link.decoder import Decoder
from solepath.link.devices import cc2541, cc2650
from solepath.types import Cell, Foot, Packet, Site
from solepath.types.vector import GRAVITY
from solepath.wire.fields import build_whole
from solepath.wire.fragment import split
from solepath.wire.insole import InsoleFrame, InsoleSample, build_frame
from solepath.wire.insole_info import InsoleInfo, build_info

LEFT = Site.LEFT_FOOT
SAMPLE_INTERVAL = 328 / 32768
"""Time between two samples of the insole, s."""


def insole_frame(k: int, *, acc: int = 2048, cells: tuple[int, ...] = (100, 200), **changes: Any) -> bytes:
    sample = InsoleSample(cells, (0, 0, acc, 0, 0, 0))
    frame = InsoleFrame(Foot.LEFT, 1, k & 0xFFFF, 328 * k & 0xFFFFFFFF, 328, (sample,))
    return build_frame(evolve(frame, **changes))


def info_value(**changes: Any) -> bytes:
    cells = (Cell(0.05, 0.0, 1e-4), Cell(0.2, 0.01, 1e-4))
    base = InsoleInfo(Foot.LEFT, 1, 7, 32768, 328, 8 * GRAVITY / 32768, radians(500) / 32768, 0.05, 0.26, cells, "1.0")
    return build_info(evolve(base, **changes))


def packet(t: float, channel: str, data: bytes, site: Site = LEFT) -> Packet:
    return Packet(t, site, channel, data)


def frame_packet(k: int, **changes: Any) -> Packet:
    return packet(10.0 + k * SAMPLE_INTERVAL, "insole/frame", insole_frame(k, **changes))


def cc2650_value(what: str, **fields: Any) -> bytes:
    """Return the bytes of a packet to or from a CC2650."""
    return cc2650.DRIVER.write(f"cc2650/{what}", fields)


def cc2541_packet(t: float, sensor: str, **fields: Any) -> Packet:
    """Return a packet of a sensor of a CC2541."""
    return packet(t, f"cc2541/{sensor}", build_whole(cc2541.FORMATS[f"cc2541/{sensor}"], fields))


def movement_packet(k: int) -> Packet:
    value = cc2650_value("movement", gyro=(0, 0, 0), acc=(0, 0, 4096), mag=(0, 0, 0))
    return packet(10.0 + 0.1 * k, "cc2650/movement", value)


def feed(decoder: Decoder, *packets: Packet) -> list[Any]:
    return [output for one in packets for output in decoder.feed(one)]


def fed_decoder(count: int = 5) -> Decoder:
    """Return a decoder that was fed INFO and the first `count` frames of an insole."""
    decoder = Decoder(site=LEFT)
    feed(decoder, packet(9.0, "insole/info", info_value()), *[frame_packet(k) for k in range(count)])
    return decoder


def fragment_packets(k: int, frame_id: int) -> list[Packet]:
    raw = InsoleSample(tuple(range(24)), (0, 0, 2048, 0, 0, 0))
    pieces = split(insole_frame(k, samples=(raw,)), 20, frame_id)
    assert len(pieces) == 4
    return [packet(10.0 + k * SAMPLE_INTERVAL, "insole/frame", piece) for piece in pieces]


def acc_packet(t: float, counts: tuple[int, int, int] = (0, 0, 16)) -> Packet:
    return cc2541_packet(t, "accelerometer", acc=counts)


def gyro_packet(t: float, counts: tuple[int, int, int] = (0, 0, 0)) -> Packet:
    return cc2541_packet(t, "gyroscope", gyro=counts)
