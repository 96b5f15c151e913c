"""Recording when the process is killed or the disk is full, and the start time in the header."""

import asyncio
import os
import subprocess
import sys
from datetime import UTC, datetime

import pytest
from recordings import PACKETS, recorded

from solepath.recording import PacketWriter, RecordingError, read_header, read_packets, read_start_time
from solepath.types import Packet

FULL_DISK_RECORDER = """
import resource, sys
from solepath.recording import PacketWriter, RecordingError
from solepath.types import Packet, Site
limit = int(sys.argv[2])
resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
writer = PacketWriter(sys.argv[1])
try:
    for k in range(1000):
        writer.write(Packet(k * 0.01, Site.LEFT_FOOT, "insole/frame", bytes([k % 256]) * 20))
except RecordingError as error:
    print(error)
if len(sys.argv) > 3:
    resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    writer.write(Packet(99.0, Site.LEFT_FOOT, "receiver/dropped", bytes(4)))
writer.close()
print(writer.count)
"""


@pytest.mark.parametrize("more", [[], ["and then there is room"]])
def test_a_file_that_may_not_grow_ends_with_its_last_whole_packet_and_goes_on_when_there_is_room(tmp_path, more):
    """The kernel writes the part of the line that fits and then fails, as on a full disk."""
    path = tmp_path / "walk.jsonl"
    command = [sys.executable, "-c", FULL_DISK_RECORDER, path, "4097", *more]
    sentence, count = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    times = [packet.t for packet in read_packets(path, report=pytest.fail)]
    safe = [k * 0.01 for k in range(int(count) - len(more))]
    assert len(safe) > 30 and times == [*safe, *[99.0] * len(more)]
    assert sentence == f"{path}: file too large; the {len(safe)} packets before that are safe"
    line = len(path.read_bytes().splitlines(keepends=True)[-1])
    assert more or 4097 - line <= path.stat().st_size <= 4097


def test_a_pipe_whose_reader_left_is_a_clear_error():
    receiving, sending = os.pipe()
    with PacketWriter(f"/dev/fd/{sending}") as writer:
        os.close(sending)
        writer.write(PACKETS[0])
        os.close(receiving)
        for _ in range(2):
            with pytest.raises(RecordingError, match="the packet before that is safe"):
                writer.write(PACKETS[1])


@pytest.mark.parametrize(
    ("keys", "moment"),
    [
        ({}, None),
        ({"began": "2026-11-21T09:30:00Z"}, (datetime(2026, 11, 21, 9, 30, tzinfo=UTC), None)),
        ({"began": "2026-11-21T10:30:00+01:00", "began_t": 3}, (datetime(2026, 11, 21, 9, 30, tzinfo=UTC), 3.0)),
        ({"began": "2026-11-21T09:30:00"}, None),  # of no zone
        ({"began": "yesterday"}, None),
        ({"began": 12}, None),
        ({"began": "2026-11-21T09:30:00Z", "began_t": "3"}, None),
        ({"began": "2026-11-21T09:30:00Z", "began_t": 10**400}, None),
        ({"began": "0001-01-01T00:00:00+14:00"}, None),  # before the year 1 in UTC
    ],
)
def test_a_header_may_hold_the_time_of_day(tmp_path, keys, moment):
    assert read_start_time(read_header(recorded(tmp_path / "walk.jsonl", [], keys))) == moment


def test_what_is_recorded_live_may_have_anothers_header_but_its_own_start(tmp_path):
    pytest.importorskip("bleak", reason="the extra ble is not installed")
    from solepath.ble import record

    async def sent():
        for packet in PACKETS:
            yield packet

    async def passed_on(header) -> list[Packet]:
        return [packet async for packet in record(sent(), tmp_path / "walk.jsonl", header)]

    old = {"format": "solepath-packets", "version": 1, "began": "2001-01-01T00:00:00Z", "began_t": -1.0, "path": "x"}
    assert asyncio.run(passed_on(old)) == PACKETS == list(read_packets(tmp_path / "walk.jsonl"))
    header_read = read_header(tmp_path / "walk.jsonl")
    known = read_start_time(header_read)
    assert header_read["path"] == "x" and known is not None and known[0].year > 2001 and known[1] > 0.0


@pytest.mark.parametrize(
    ("header", "complaint"),
    [
        ({"format": "solepath-samples"}, 'a header that is not .*: "format" is not "solepath-packets"'),
        ({"version": 2}, "a header that is of version 2"),
        ({"version": True}, "a header that is of version true"),
        ({"note": float("nan")}, "not JSON compliant"),
        ({"note": "x" * 70_000}, "a line of 70057 bytes is too long for a recording"),
    ],
)
def test_a_header_that_none_can_be_costs_no_file(tmp_path, header, complaint):
    path = tmp_path / "walk.jsonl"
    path.write_text("precious")
    with pytest.raises(ValueError, match=complaint):
        PacketWriter(path, header)
    assert path.read_text() == "precious"
