"""Import of btsnoop logs that are cut off, damaged or arbitrary bytes, with one sentence about what is left out."""

from __future__ import annotations

import struct

import pytest
from snooped import ACL, EVENT, FRAME, Log, data_of, frames, read, start_connection

from solepath.recording.btsnoop import devices, open_btsnoop, values  # their limits are those of hours


def test_pieces_that_were_not_logged_cost_their_packet_and_are_counted(tmp_path):
    log = start_connection(Log(piece=50))
    log.notify(0x40, FRAME, frames()[0])
    log.notify(0x40, FRAME, frames()[1], keep=slice(0, 2))  # the end is missing
    log.notify(0x40, FRAME, frames()[2])
    log.notify(0x40, FRAME, frames()[3], keep=slice(1, None))  # the beginning is
    log.notify(0x40, FRAME, frames()[4])
    packets, reports = read(log, tmp_path)
    assert data_of(packets, "insole/frame") == [frames()[0], frames()[2], frames()[4]]
    assert reports == ["packets of which a piece is missing: 1", "pieces of packets whose beginning is missing: 3"]


def test_packets_of_other_channels_are_counted_where_they_might_have_been_ours(tmp_path):
    log = start_connection(Log())
    log.notify(0x40, FRAME, frames()[0])
    log.acl(0x40, b"\x0b\x01", sent=False, channel=6)  # pairing
    log.acl(0x40, b"\x1b\x12\0", sent=False, channel=0x41)
    log.acl(0x0B, b"music", sent=True, channel=0x42)  # of a connection that is not LE
    packets, reports = read(log, tmp_path)
    assert data_of(packets, "insole/frame") == [frames()[0]]
    assert reports == ["packets of channels that are not followed (EATT perhaps): 1"]


def test_an_insole_is_found_among_connections_that_never_end(tmp_path):
    log = start_connection(Log())
    for number in range(300):
        log.connect(0x100 + number, f"D1:00:00:00:{number >> 8:02X}:{number & 255:02X}")
        if number % 50 == 0:
            log.notify(0x40, FRAME, frames()[number // 50])
    packets, reports = read(log, tmp_path)
    assert data_of(packets, "insole/frame") == [*frames()[:6]]
    assert reports == ["connections beyond 100, each of which ended the longest silent one: 201"]


def test_what_is_kept_of_a_log_is_limited_whatever_its_size(tmp_path, monkeypatch):
    monkeypatch.setattr(values, "MOST_DEVICES", 20)
    monkeypatch.setattr(devices, "MOST_ATTRIBUTES", 10)
    log = start_connection(Log())
    log.notify(0x40, FRAME, frames()[0])
    for number in range(30):
        log.connect(number, f"D1:00:00:00:00:{number:02X}")
        for handle in range(12):
            log.notify(number, handle, b"x")
    packets, reports = read(log, tmp_path)
    assert data_of(packets, "insole/frame") == [frames()[0]]
    assert {
        "packets of more than 20 devices, left out: 132",
        "what is known of more than 10 attributes of a device, left out: 38",
    } <= set(reports)


def test_the_types_of_a_device_are_limited(tmp_path):
    log = start_connection(Log())
    for first in range(0x100, 0x800, 100):
        types = b"".join(struct.pack("<HH", handle, 0x2A00) for handle in range(first, min(first + 100, 0x800)))
        log.add_request(0x40, "040100ffff", b"\x05\x01" + types)
    log.notify(0x40, FRAME, frames()[0])
    packets, reports = read(log, tmp_path)
    assert data_of(packets, "insole/frame") == [frames()[0]]
    assert reports == [f"what is known of more than 500 attributes of a device, left out: {0x800 - 0x100 - 496}"]


def drop(log):
    log.drops += 1
    log.command(0x1009)


NO_HCI = "records that are not HCI"
FLAWS = {
    "a notification without a handle": (
        "PDUs that are not of the attribute protocol",
        lambda log: log.acl(0x40, b"\x1b\x12", False),
    ),
    "no PDU": ("PDUs that are not of the attribute protocol", lambda log: log.acl(0x40, b"", False)),
    "a long write": ("long writes, which are passed over", lambda log: log.acl(0x40, b"\x16\x17\0\0\0x", True)),
    "a write that is rejected": (
        "writes that were rejected",
        lambda log: log.add_request(0x40, "12170001", "0112170080"),
    ),
    "a cut record": (
        "packets that the capture cut short (a snap length, or an Android log that is Filtered)",
        lambda log: log.record(ACL, b"\x40\x20\x40\0\x3c\0", False, 68),
    ),
    "half a header": (NO_HCI, lambda log: log.record(ACL, b"\x40\x20\x04", False)),
    "a wrong size": (NO_HCI, lambda log: log.record(ACL, b"\x40\x20\x05\0\x01\0\x04\0", False)),
    "half an event": (NO_HCI, lambda log: log.record(EVENT, b"\x05\x04\0\x40", False)),
    "a dropped record": ("records that the logger says it dropped", drop),
    "another channel": (
        "packets of channels that are not followed (EATT perhaps)",
        lambda log: log.acl(0x40, b"x", False, 0x40),
    ),
}
"""What is wrong with a part of a log, how a report calls it, and how it is logged."""


@pytest.mark.parametrize("flaw", FLAWS)
def test_each_part_that_cannot_be_used_is_counted_and_costs_only_itself(tmp_path, flaw):
    what, add = FLAWS[flaw]
    for count in (1, 3):
        log = start_connection(Log())
        for frame in frames()[:count]:
            log.notify(0x40, FRAME, frame)
            add(log)
        log.notify(0x40, FRAME, frames()[count])
        packets, reports = read(log, tmp_path)
        assert data_of(packets, "insole/frame") == [*frames()[: count + 1]]
        assert reports == [f"{what}: {count}"]


@pytest.mark.parametrize("cut", [0, 1, 10, -1])
def test_a_torn_tail_costs_one_record_and_is_reported(tmp_path, cut):
    log = start_connection(Log())
    for frame in frames()[:5]:
        log.notify(0x40, FRAME, frame)
    path, last = log.save(tmp_path / "phone.log"), len(log.records[-1])
    path.write_bytes(path.read_bytes()[: path.stat().st_size - (cut % last)])
    reports: list[str] = []
    packets = [p.data for p in open_btsnoop(path, report=reports.append) if p.channel == "insole/frame"]
    assert packets == [*frames()[: 4 if cut else 5]]
    torn = f"{path}: record {len(log.records)}: cut off in the middle; everything before it is used"
    assert reports == ([torn] if cut else [])
