"""Recordings of packets: protocol/recording.md, clause by clause."""

import asyncio
import json
import os
import signal
import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path

import pytest
import walks
from here import PROTOCOL
from hypothesis import given
from hypothesis import strategies as st

from solepath import Session
from solepath.recording import PacketWriter, RecordingError, RecordingWarning, began, read_header, read_packets
from solepath.types import Packet, Site

HEADER = '{"format": "solepath-packets", "version": 1}\n'
PACKETS = [
    Packet(12.5, Site.LEFT_FOOT, "device/battery", b"\x63"),
    Packet(12.5, Site.RIGHT_FOOT, "insole/frame", bytes(range(256))),
    Packet(0.1 + 12.65, Site.PELVIS, "cc2650/keys", b""),
]


def written(path: Path, packets=PACKETS) -> Path:
    with PacketWriter(path) as writer:
        for packet in packets:
            writer.write(packet)
    return path


def line_of(**fields) -> str:
    return json.dumps({"t": 1.0, "site": "left_foot", "channel": "insole/frame", "data": "f5"} | fields) + "\n"


def read_what_there_is(path: Path) -> tuple[list[Packet], str]:
    """The packets before the damage, and the one sentence about it."""
    packets = []
    with pytest.raises(RecordingError) as caught:
        for packet in read_packets(path):
            packets.append(packet)
    sentence = str(caught.value)
    assert "\n" not in sentence and sentence.startswith(str(path))
    return packets, sentence


def test_what_was_written_is_read_back(tmp_path):
    assert list(read_packets(written(tmp_path / "walk.jsonl"))) == PACKETS


@given(
    times=st.lists(st.floats(allow_nan=False, allow_infinity=False), max_size=8),
    contents=st.lists(
        st.tuples(
            st.sampled_from(Site),
            st.text(st.characters(codec="utf-8"), max_size=20),
            st.binary(max_size=64),
            st.text(st.characters(codec="utf-8"), max_size=20),
        ),
        min_size=8,
        max_size=8,
    ),
)
def test_any_packets_survive_writing_and_reading(tmp_path_factory, times, contents):
    packets = [Packet(t, *content) for t, content in zip(times, contents, strict=False)]
    path = written(tmp_path_factory.mktemp("recordings") / "any.jsonl", packets)
    assert list(read_packets(path)) == packets


def test_the_example_of_the_specification_is_read(tmp_path):
    text = (PROTOCOL / "recording.md").read_text()
    path = tmp_path / "example.jsonl"
    path.write_text(text.split("## Example")[1].split("```")[1].strip() + "\n")
    battery, keys = read_packets(path)
    assert battery == Packet(12.5, Site.LEFT_FOOT, "device/battery", b"c")
    assert keys == Packet(12.75, Site.RIGHT_FOOT, "cc2650/keys", b"\x01", "C3:9F:02:5E:71:AA")
    assert began(read_header(path)) == (datetime(2026, 11, 21, 9, 30, 0, 250_000, UTC), 12.5)


def test_every_line_is_on_its_way_to_the_disk_before_the_next_packet(tmp_path):
    path = tmp_path / "walk.jsonl"
    with PacketWriter(path) as writer:
        for count, packet in enumerate(PACKETS, start=1):
            writer.write(packet)
            assert path.read_bytes().count(b"\n") == 1 + count


def test_unknown_keys_are_ignored_in_header_and_packets(tmp_path):
    path = tmp_path / "walk.jsonl"
    path.write_text('{"version": 1, "note": "x", "format": "solepath-packets"}\n' + line_of(rssi=-60, t=2))
    assert list(read_packets(path)) == [Packet(2.0, Site.LEFT_FOOT, "insole/frame", b"\xf5")]


def test_a_header_alone_is_a_recording_of_nothing(tmp_path):
    assert list(read_packets(written(tmp_path / "walk.jsonl", []))) == []


def test_upper_case_digits_and_blank_lines_are_read(tmp_path):
    path = tmp_path / "walk.jsonl"
    path.write_text(HEADER + "\n  \n" + line_of(data="F5aB"))
    assert [packet.data for packet in read_packets(path)] == [b"\xf5\xab"]


@given(cut=st.integers(min_value=1, max_value=10_000))
def test_cut_anywhere_after_the_header_no_packet_before_the_cut_is_lost(tmp_path_factory, cut):
    path = written(tmp_path_factory.mktemp("recordings") / "walk.jsonl")
    whole = path.read_bytes()
    first = whole.index(b"\n") + 1
    kept = whole[: first + cut % (len(whole) - first)]
    path.write_bytes(kept)
    reports = []
    packets = list(read_packets(path, report=reports.append))
    whole_lines = sum(line.endswith(b"}") for line in kept[first:].split(b"\n"))
    assert packets == PACKETS[:whole_lines]
    torn = not kept.endswith((b"\n", b"}"))
    assert len(reports) == torn
    if torn:
        assert f"line {whole_lines + 2}: cut off" in reports[0]


def test_a_torn_last_line_warns_when_nobody_asked_for_the_report(tmp_path):
    path = written(tmp_path / "walk.jsonl")
    path.write_bytes(path.read_bytes()[:-9])
    with pytest.warns(RecordingWarning, match="line 4: cut off in the middle; everything before it is used"):
        assert list(read_packets(path)) == PACKETS[:2]


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("hello\n", "is not JSON"),
        ("[1, 2]\n", "is not a JSON object but [1, 2]"),
        ('{"t": NaN}\n', "NaN is not JSON"),
        ("\x00\x01\n", "is not JSON"),
        ("[" * 30_000 + "\n", "is not JSON"),
        ('{"t": 1.0, "site": "left_foot", "channel": "x"}\n', '"data" is missing'),
        (line_of(t="1"), '"t" is not a number but "1"'),
        (line_of(t=True), '"t" is not a number but true'),
        (line_of().replace("1.0", "1e999"), '"t" is not a finite number'),
        (line_of(t=10**400), '"t" is not a finite number'),
        (line_of(site="hand"), '"site" is not one of left_foot'),
        (line_of(site=["left_foot"]), '"site" is not one of left_foot'),
        (line_of(channel=7), '"channel" is not text but 7'),
        (line_of(data="f5 0"), '"data" is not pairs of hexadecimal digits but "f5 0"'),
        (line_of(data="f5f"), '"data" is not pairs'),
        (line_of(data=None), '"data" is not pairs'),
        (line_of(device=None), '"device" is not text but null'),
        (line_of(data="00" * 40_000), "is longer than 65536 bytes"),
    ],
)
def test_a_bad_line_is_named_after_everything_before_it_was_read(tmp_path, line, complaint):
    path = tmp_path / "walk.jsonl"
    path.write_text(HEADER + line_of(t=0.5) + line + line_of(t=9.0))
    packets, sentence = read_what_there_is(path)
    assert [packet.t for packet in packets] == [0.5]
    assert f": line 3: {complaint}" in sentence
    assert sentence.isprintable() and len(sentence) < 400


def test_bytes_that_are_not_text_are_named(tmp_path):
    path = tmp_path / "walk.jsonl"
    path.write_bytes(HEADER.encode() + b'{"t": \xff}\n')
    assert "line 2: is not text" in read_what_there_is(path)[1]


@pytest.mark.parametrize("version", [2, 0, "1", 1.0, True, None])
def test_an_unknown_version_is_refused(tmp_path, version):
    path = tmp_path / "walk.jsonl"
    path.write_text(json.dumps({"format": "solepath-packets", "version": version}) + "\n" + line_of())
    packets, sentence = read_what_there_is(path)
    assert packets == []
    assert f"line 1: is of version {json.dumps(version)}; this release reads version 1" in sentence


@pytest.mark.parametrize("first", ['{"format": "solepath-pack', line_of(), "hello", '"x"\n'])
def test_a_file_without_a_whole_header_is_refused(tmp_path, first):
    path = tmp_path / "walk.jsonl"
    path.write_text(first)
    assert "line 1: " in read_what_there_is(path)[1]


@pytest.mark.parametrize("nothing", ["", "\n\n"])
def test_an_empty_file_is_called_empty(tmp_path, nothing):
    path = tmp_path / "walk.jsonl"
    path.write_text(nothing)
    assert read_what_there_is(path)[1].endswith("is empty")


def test_a_missing_file_and_a_directory_are_named(tmp_path):
    assert read_what_there_is(tmp_path / "none.jsonl")[1].endswith("no such file or directory")
    assert read_what_there_is(tmp_path)[1].endswith("is a directory, not a recording")


def test_a_receivers_clock_that_was_set_back_is_left_to_the_decoder(tmp_path):
    path = tmp_path / "walk.jsonl"
    path.write_text(HEADER + line_of(t=9.0) + line_of(t=0.5))
    assert [packet.t for packet in read_packets(path)] == [9.0, 0.5]


def test_progress_ends_at_the_size_of_the_file(tmp_path):
    path = written(tmp_path / "walk.jsonl")
    read = []
    list(read_packets(path, progress=read.append))
    assert read == sorted(read) and read[-1] == path.stat().st_size


def test_packets_that_no_recording_can_hold_are_refused_and_leave_it_whole(tmp_path):
    path = tmp_path / "walk.jsonl"
    with PacketWriter(path) as writer:
        writer.write(PACKETS[0])
        for unfit in (
            Packet(float("nan"), Site.LEFT_FOOT, "insole/frame", b""),
            Packet(13.0, Site.LEFT_FOOT, "insole/frame", bytes(40_000)),
        ):
            with pytest.raises(ValueError):
                writer.write(unfit)
        writer.write(PACKETS[1])
    assert list(read_packets(path)) == PACKETS[:2]


def test_a_device_that_nobody_knows_is_not_written(tmp_path):
    named = Packet(1.0, Site.LEFT_FOOT, "insole/frame", b"", "C3:9F:02:5E:71:AA")
    path = written(tmp_path / "walk.jsonl", [PACKETS[0], named])
    first, second = (json.loads(line) for line in path.read_text().splitlines()[1:])
    assert "device" not in first and second["device"] == "C3:9F:02:5E:71:AA"


@pytest.mark.parametrize("name", list(walks.packets()))
def test_a_recording_gives_the_same_events_bit_for_bit(tmp_path, name):
    """Of both feet, with losses, duplicates and damaged packets, and what the receiver says of itself."""
    packets = [Packet(p.t, p.site, p.channel, p.data, f"F0:{p.site.value}") for p in walks.packets()[name]]
    end = packets[-1].t
    packets[40:40] = [
        Packet(packets[40].t, Site.LEFT_FOOT, "receiver/connected", b"\xc4solepath L", "F0:left_foot"),
        Packet(packets[40].t, Site.RIGHT_FOOT, "receiver/dropped", b"\x03\0\0\0"),
    ]
    packets += [Packet(end + 0.1 * k, Site.LEFT_FOOT, "receiver/tick", b"") for k in range(30)]

    def events(stream) -> list[str]:
        session = Session(poses=True)
        told = [event for packet in stream for event in session.feed(packet)] + session.finish()
        return [repr(event) for event in told]  # repr tells every bit of a float, and -0.0 from 0.0

    recorded = events(read_packets(written(tmp_path / "walk.jsonl", packets)))
    assert recorded == events(packets)
    assert sum(line.startswith(("Connected", "StreamStale")) for line in recorded) >= 2


# --- a recorder that dies ---------------------------------------------------------------------------------------------

LIVE = """
import os, sys, time
from solepath.recording import PacketWriter
from solepath.types import Packet, Site
began = time.monotonic()
with PacketWriter(sys.argv[1]) as writer:
    for k in range(100_000):
        time.sleep(max(0.0, began + k / 200 - time.monotonic()))
        os.write(1, b"?")  # arrived
        writer.write(Packet(k / 200, Site.LEFT_FOOT, "insole/frame", bytes([k % 256]) * 177))
        os.write(1, b"!")  # written
"""


def test_a_recorder_killed_in_mid_walk_loses_at_most_the_packet_in_its_hand(tmp_path):
    """Two insoles at 100 Hz in real time: 5 ms, where 200 would be allowed."""
    path = tmp_path / "walk.jsonl"
    recorder = subprocess.Popen([sys.executable, "-c", LIVE, str(path)], stdout=subprocess.PIPE)
    try:
        assert recorder.stdout is not None
        diary = b""
        while diary.count(b"!") < 300 and (more := recorder.stdout.read1()):
            diary += more
        recorder.send_signal(signal.SIGKILL)
        diary += recorder.stdout.read()
    finally:
        recorder.kill()
        assert recorder.wait() == -signal.SIGKILL
        recorder.stdout.close()
    flaws = []
    packets = list(read_packets(path, report=flaws.append))
    assert 300 <= diary.count(b"!") <= len(packets) <= diary.count(b"?") and len(flaws) <= 1
    assert [packet.data[0] for packet in packets] == [k % 256 for k in range(len(packets))], "none is missing within"
    assert diary.count(b"?") / 200 - packets[-1].t < 0.2


# --- a disk that is full ----------------------------------------------------------------------------------------------

FULL = """
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


@pytest.mark.parametrize("limit", [4096, 4097, 4150, 5000])
def test_a_file_that_may_not_grow_ends_with_its_last_whole_packet_and_the_error_counts_them(tmp_path, limit):
    """The kernel takes the part of the line that fits and then refuses, as a disk does that fills up."""
    path = tmp_path / "walk.jsonl"
    done = subprocess.run([sys.executable, "-c", FULL, path, str(limit)], capture_output=True, text=True, check=True)
    sentence, count = done.stdout.splitlines()
    packets = list(read_packets(path, report=pytest.fail))
    assert len(packets) == int(count) > 30
    assert [packet.t for packet in packets] == [k * 0.01 for k in range(len(packets))]
    assert sentence == f"{path}: file too large; the {count} packets before that are safe"
    line = len(path.read_bytes().splitlines(keepends=True)[-1])
    assert limit - line <= path.stat().st_size <= limit


def test_once_there_is_room_again_writing_goes_on(tmp_path):
    path = tmp_path / "walk.jsonl"
    done = subprocess.run([sys.executable, "-c", FULL, path, "4100", "x"], capture_output=True, text=True, check=True)
    packets = list(read_packets(path, report=pytest.fail))
    assert len(packets) == int(done.stdout.splitlines()[-1])
    assert packets[-1].t == 99.0 and packets[-2].t == (len(packets) - 2) * 0.01


SMALL_DISK = """
import json, sys
from pathlib import Path
from solepath.recording import PacketWriter, RecordingError, read_packets
from solepath.types import Packet, Site
folder = Path(sys.argv[1])
(folder / "ballast").write_bytes(bytes(8192))
writer, errors = PacketWriter(folder / "walk.jsonl"), []
def write(times):
    try:
        for k in times:
            writer.write(Packet(k * 0.01, Site.LEFT_FOOT, "insole/frame", bytes([k % 256]) * 177))
    except RecordingError as error:
        errors.append(str(error))
    return [round(packet.t / 0.01) for packet in read_packets(folder / "walk.jsonl", report=errors.append)]
full = write(range(1000))
still_full = write(range(1000, 1001))
(folder / "ballast").unlink()
again = write(range(2000, 2005))
print(json.dumps([full, still_full, again, errors]))
"""


def test_a_disk_that_fills_up_loses_nothing_and_takes_more_when_there_is_room(tmp_path):
    """A file system of 32 kB of our own, which needs a user namespace that may mount one."""
    inside = 'mount -t tmpfs -o size=32k none "$0" && exec "$@"'
    small = ["unshare", "--map-root-user", "--mount", "sh", "-c", inside, str(tmp_path)]
    try:
        permitted = subprocess.run([*small, "true"], capture_output=True).returncode == 0
    except FileNotFoundError:
        permitted = False
    if not permitted:
        pytest.skip("no file system may be mounted here")
    command = [*small, sys.executable, "-c", SMALL_DISK, str(tmp_path)]
    full, still_full, again, errors = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
    count = len(full)
    assert count > 30 and full == still_full == list(range(count))
    assert again == [*full, *range(2000, 2005)]
    sentence = f"{tmp_path}/walk.jsonl: no space left on device; the {count} packets before that are safe"
    assert errors == [sentence, sentence]


@pytest.mark.skipif(not Path("/dev/full").is_char_device(), reason="no /dev/full on this system")
def test_a_full_disk_is_told_in_the_systems_own_words():
    with pytest.raises(
        RecordingError, match="^/dev/full: no space left on device; the 0 packets before that are safe$"
    ):
        PacketWriter("/dev/full")
    assert Path("/dev/full").is_char_device()


def test_a_pipe_whose_reader_left_is_a_clear_error():
    receiving, sending = os.pipe()
    with PacketWriter(f"/dev/fd/{sending}") as writer:
        os.close(sending)
        writer.write(PACKETS[0])
        os.close(receiving)
        for _ in range(2):
            with pytest.raises(RecordingError, match="the packet before that is safe"):
                writer.write(PACKETS[1])


def test_a_file_that_cannot_be_opened_is_named(tmp_path):
    with pytest.raises(RecordingError, match="none/walk.jsonl: no such file or directory"):
        PacketWriter(tmp_path / "none" / "walk.jsonl")


# --- what o'clock it was ----------------------------------------------------------------------------------------------


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
def test_a_header_may_say_what_oclock_it_was(tmp_path, keys, moment):
    path = tmp_path / "walk.jsonl"
    with PacketWriter(path, keys):
        pass
    assert began(read_header(path)) == moment


def test_the_header_of_one_recording_can_be_that_of_another_whatever_its_keys(tmp_path):
    keys = {"path": "x", "self": 1, "header": {"a": [None]}, "": "T\ud800r", "began": "never"}
    with PacketWriter(tmp_path / "one.jsonl", keys):
        pass
    said = read_header(tmp_path / "one.jsonl")
    assert said == {"format": "solepath-packets", "version": 1, **keys}
    with PacketWriter(tmp_path / "other.jsonl", said):
        pass
    assert (tmp_path / "other.jsonl").read_bytes() == (tmp_path / "one.jsonl").read_bytes()


def test_what_is_recorded_live_may_have_anothers_header_but_its_own_beginning(tmp_path):
    pytest.importorskip("bleak", reason="the extra ble is not installed")
    from solepath.ble import record

    async def sent():
        for packet in PACKETS:
            yield packet

    async def recorded(header) -> tuple[float, list[Packet]]:
        now = asyncio.get_running_loop().time()
        return now, [packet async for packet in record(sent(), tmp_path / "walk.jsonl", header)]

    old = {"format": "solepath-packets", "version": 1, "began": "2001-01-01T00:00:00Z", "began_t": -1.0, "path": "x"}
    now, passed_on = asyncio.run(recorded(old))
    said = read_header(tmp_path / "walk.jsonl")
    known = began(said)
    assert passed_on == PACKETS == list(read_packets(tmp_path / "walk.jsonl"))
    assert said["path"] == "x" and known is not None
    assert known[0].year > 2001 and now <= known[1] < now + 10


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


@pytest.mark.parametrize("content", ["", "hello\n", '{"format": "solepath-packets", "version": 7}\n', "{}"])
def test_what_has_no_header_has_no_header_to_read(tmp_path, content):
    path = tmp_path / "walk.jsonl"
    path.write_text("\n" + content)
    with pytest.raises(RecordingError):
        read_header(path)
