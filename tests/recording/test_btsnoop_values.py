"""Values of btsnoop logs compared with tshark, for all ways to discover, read, write and notify them."""

from __future__ import annotations

import shutil
import struct
import subprocess
from collections.abc import Iterable
from pathlib import Path

import pytest
from snooped import (
    BATTERY,
    FRAME,
    H4,
    INFO,
    INSOLE,
    LEFT,
    MONITOR,
    MOVEMENT,
    RIGHT,
    Log,
    data_of,
    frames,
    full,
    info,
    insole_uuid,
    read,
    start_connection,
)

from solepath import Site
from solepath.recording.btsnoop.devices import AttOperation
from solepath.recording.btsnoop.values import ValueListener
from solepath.types import Foot
from solepath.wire.insole_info import build_info, parse_info


def test_a_long_value_is_read_whole_at_any_mtu(tmp_path):
    value = info()
    assert parse_info(value).foot is Foot.LEFT and build_info(parse_info(value)) == value
    for mtu in (23, 185, len(value) + 1):
        log = Log()
        log.connect(0x40, LEFT)
        log.mtu(0x40, mtu)
        log.discover(0x40, INSOLE)
        log.add_request(0x40, "0a1500", b"\x0b" + value[: mtu - 1])
        for offset in range(mtu - 1, len(value) + 1, mtu - 1):
            log.add_request(
                0x40, struct.pack("<BHH", 0x0C, INFO, offset).hex(), b"\x0d" + value[offset : offset + mtu - 1]
            )
        log.notify(0x40, FRAME, frames()[0])
        assert data_of(read(log, tmp_path)[0], "insole/info") == [value], mtu


def test_the_rest_of_one_value_is_not_added_to_another(tmp_path):
    log = Log()
    log.connect(0x40, LEFT)
    log.discover(0x40, INSOLE | {0x20: "2a26"})
    log.add_request(0x40, "0a2000", b"\x0b" + b"v" * 22)
    log.add_request(0x40, "0c15001600", b"\x0d" + b"rest")
    log.add_request(0x40, "0a2000", b"\x0b" + b"w" * 22)
    log.add_request(0x40, "0c20002c00", "010c200007")
    log.notify(0x40, FRAME, frames()[0][:20])
    log.add_request(0x40, "0a2000", b"\x0b" + b"x" * 22)  # the log ends before the rest
    found = read(log, tmp_path, sites={LEFT: Site.LEFT_FOOT})[0]
    assert data_of(found, "device/firmware") == [b"v" * 22, b"w" * 22, b"x" * 22]
    assert data_of(found, "insole/info") == []


def test_what_was_written_counts_when_the_device_took_it(tmp_path):
    log = start_connection(Log(), characteristics={0x31: full(0xAA81), 0x34: full(0xAA82), 0x37: full(0xAA83)})
    log.add_request(0x40, "12340000ff", "0112340080")
    log.add_request(0x40, "1234007f02", "13")
    log.acl(0x40, bytes.fromhex("523700") + b"\x0a", sent=True)
    log.acl(0x40, bytes.fromhex("123400" + "7f03"), sent=True)  # the link was lost before an answer
    log.notify(0x40, 0x31, MOVEMENT)
    found, reports = read(log, tmp_path, sites={LEFT: Site.LEFT_FOOT})
    assert data_of(found, "cc2650/movement-config") == [b"\x7f\x02"]
    assert data_of(found, "cc2650/movement-period") == [b"\x0a"]
    assert reports == ["writes that were rejected: 1"]


def test_other_ways_to_discover_to_read_and_to_notify(tmp_path):
    frame = bytes.fromhex(insole_uuid(2).replace("-", ""))[::-1]
    log = Log()
    log.connect(0x40, LEFT)
    log.mtu(0x40, 247)
    log.add_request(0x40, "041200ffff", b"\x05\x02\x12\x00" + frame)  # find information, UUIDs of 128 bits
    log.add_request(0x40, "041a00ffff", "05011a00192a1b000229")  # and of 16
    log.add_request(0x40, "080100ffff262a", b"\x09\x05\x30\x00" + b"1.2")  # read by the characteristic's UUID
    log.acl(0x40, b"\x23" + struct.pack("<HH", 0x12, len(frames()[0])) + frames()[0] + b"\x1a\0\x01\0\x63", sent=False)
    log.acl(0x40, b"\x1d\x1a\0\x62", sent=False)
    log.acl(0x40, b"\x1e", sent=True)
    found, reports = read(log, tmp_path)
    assert [(channel, data) for _, _, channel, data in found[1:]] == [
        ("device/firmware", b"1.2"),
        ("insole/frame", frames()[0]),
        ("device/battery", b"\x63"),
        ("device/battery", b"\x62"),
    ]
    assert reports == []


needs_tshark = pytest.mark.skipif(shutil.which("tshark") is None, reason="tshark is not installed (apt install tshark)")


def tshark(path: Path, display_filter: str, fields: Iterable[str]) -> list[list[str]]:
    """Return these fields of every record that passes the filter, as tshark prints them."""
    fields_option = [word for name in fields for word in ("-e", name)]
    command = ["tshark", "-r", path, "-Y", display_filter, "-T", "fields", *fields_option]
    output = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return [line.split("\t") for line in output.splitlines()]


def notified_by_tshark(path: Path) -> list[tuple[int, int, int, bytes]]:
    """Return (us since 1970, connection handle, attribute handle, value) of every notification."""
    fields = ("frame.time_epoch", "bthci_acl.chandle", "btatt.handle", "btatt.value", "btatt.battery_level")
    notified = []
    for t, connection, attribute, value, battery in tshark(path, "btatt.opcode == 0x1b", fields):
        seconds, _, parts = t.partition(".")
        us = int(seconds) * 1_000_000 + int(parts[:6])
        data = bytes([int(battery)]) if battery else bytes.fromhex(value)
        notified.append((us, int(connection, 16), int(attribute, 16), data))
    return notified


def notified_by_us(path: Path) -> list[tuple[int, int, int, bytes]]:
    listener = ValueListener(path, pytest.fail)
    values = [
        item for item in listener.listen() if item.value is not None and item.value.operation is AttOperation.NOTIFIED
    ]
    assert not listener.flaws
    return [(item.t, item.connection.handle, item.value.handle, item.value.value) for item in values]


@needs_tshark
@pytest.mark.parametrize(("datalink", "piece"), [(H4, 27), (MONITOR, 100)])
def test_every_notification_agrees_with_tshark(tmp_path, datalink, piece):
    """Two insoles, of which one reconnects under the same handle, with ACL packets in pieces of both links."""
    log = Log(datalink, piece=piece)
    start_connection(log, 0x40, LEFT)
    log.connect(0x41, RIGHT, subevent=0x0A)  # the three events that tell of a connection
    log.mtu(0x41, 247)
    log.discover(0x41, INSOLE)
    for k, (left, right) in enumerate(zip(frames()[:60], frames(Site.RIGHT_FOOT), strict=False)):
        if k == 20:
            log.disconnect(0x40)
            log.connect(0x40, LEFT, subevent=0x29)
            log.mtu(0x40, 247)
        log.notify(0x40, FRAME, left)
        log.notify(0x41, FRAME, right)
        if k % 50 == 0:
            log.notify(0x40, BATTERY, bytes([k % 101]))
    path = log.save(tmp_path / "phone.log")
    own_values, tshark_values = notified_by_us(path), notified_by_tshark(path)
    assert len(own_values) == 2 * 60 + 2
    assert own_values == tshark_values
