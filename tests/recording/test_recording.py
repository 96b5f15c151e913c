"""Reading and writing of recordings of packets, clause by clause of protocol/recording.md."""

import bz2
import gzip
import json
import lzma
import zipfile
from datetime import UTC, datetime
from pathlib import Path

import pytest
from attrs import evolve
from here import PROTOCOL
from hypothesis import given
from hypothesis import strategies as st
from recordings import PACKETS, recorded

from solepath.recording import (
    LONGEST_LINE,
    PacketWriter,
    RecordingError,
    open_source,
    read_header,
    read_packets,
    read_start_time,
)
from solepath.recording.packet_writer import format_packet
from solepath.recording.source import label_files
from solepath.types import Foot, Packet, Site

HEADER = '{"format": "solepath-packets", "version": 1}\n'


def recording_file(tmp_path: Path, text: str) -> Path:
    """Write a recording with this text."""
    path = tmp_path / "walk.jsonl"
    path.write_text(text)
    return path


def line_of(**fields) -> str:
    return json.dumps({"t": 1.0, "site": "left_foot", "channel": "insole/frame", "data": "f5"} | fields) + "\n"


def read_until_damage(path: Path) -> tuple[list[Packet], str]:
    """Return the packets before the damage, and the sentence of the error."""
    packets = []
    with pytest.raises(RecordingError) as caught:
        for packet in read_packets(path):
            packets.append(packet)
    sentence = str(caught.value)
    assert "\n" not in sentence and sentence.startswith(str(path))
    return packets, sentence


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
    path = recorded(tmp_path_factory.mktemp("recordings") / "any.jsonl", packets)
    assert list(read_packets(path)) == packets


def test_the_longest_line_is_written_and_read_and_one_byte_more_is_not(tmp_path):
    path = tmp_path / "walk.jsonl"
    short = Packet(1.5, Site.LEFT_FOOT, "", b"")
    longest = evolve(short, channel="c" * (LONGEST_LINE - len(format_packet(short))))
    with PacketWriter(path) as writer:
        writer.write(longest)
        for unfit in (evolve(longest, channel=longest.channel + "c"), evolve(longest, t=float("nan"))):
            with pytest.raises(ValueError, match="a line of 65537 bytes is too long|nan"):
                writer.write(unfit)
        writer.write(PACKETS[0])
    assert list(read_packets(path, report=pytest.fail)) == [longest, PACKETS[0]]
    path.write_bytes(path.read_bytes().replace(b'"cc', b'"ccc'))
    reports = []
    assert list(read_packets(path, report=reports.append)) == PACKETS[:1]
    assert reports == [f"{path}: line 2: is longer than 65536 bytes; this line is left out"]


def test_the_example_of_the_specification_is_read(tmp_path):
    text = (PROTOCOL / "recording.md").read_text()
    path = recording_file(tmp_path, text.split("## Example")[1].split("```")[1].strip() + "\n")
    battery, keys = read_packets(path)
    assert battery == Packet(12.5, Site.LEFT_FOOT, "device/battery", b"c")
    assert keys == Packet(12.75, Site.RIGHT_FOOT, "cc2650/keys", b"\x01", "C3:9F:02:5E:71:AA")
    assert read_start_time(read_header(path)) == (datetime(2026, 11, 21, 9, 30, 0, 250_000, UTC), 12.5)


def test_every_line_is_on_its_way_to_the_disk_before_the_next_packet(tmp_path):
    path = tmp_path / "walk.jsonl"
    with PacketWriter(path) as writer:
        for count, packet in enumerate(PACKETS, start=1):
            writer.write(packet)
            assert path.read_bytes().count(b"\n") == 1 + count


def test_unknown_keys_are_ignored_in_header_and_packets(tmp_path):
    path = recording_file(
        tmp_path, '{"version": 1, "note": "x", "format": "solepath-packets"}\n' + line_of(rssi=-60, t=2)
    )
    assert list(read_packets(path)) == [Packet(2.0, Site.LEFT_FOOT, "insole/frame", b"\xf5")]


def test_upper_case_digits_and_blank_lines_are_read(tmp_path):
    path = recording_file(tmp_path, HEADER + "\n  \n" + line_of(data="F5aB"))
    assert [packet.data for packet in read_packets(path)] == [b"\xf5\xab"]


@given(cut=st.integers(min_value=1, max_value=10_000))
def test_cut_anywhere_after_the_header_no_packet_before_the_cut_is_lost(tmp_path_factory, cut):
    path = recorded(tmp_path_factory.mktemp("recordings") / "walk.jsonl", PACKETS)
    whole_bytes = path.read_bytes()
    first = whole_bytes.index(b"\n") + 1
    cut_bytes = whole_bytes[: first + cut % (len(whole_bytes) - first)]
    path.write_bytes(cut_bytes)
    reports = []
    packets = list(read_packets(path, report=reports.append))
    whole_lines = sum(line.endswith(b"}") for line in cut_bytes[first:].split(b"\n"))
    assert packets == PACKETS[:whole_lines]
    torn = not cut_bytes.endswith((b"\n", b"}"))
    assert len(reports) == torn
    if torn:
        assert f"line {whole_lines + 2}: cut off" in reports[0]


@pytest.mark.parametrize("version", [2, 0, "1", 1.0, True, None])
def test_an_unknown_version_is_rejected(tmp_path, version):
    header = json.dumps({"format": "solepath-packets", "version": version})
    packets, sentence = read_until_damage(recording_file(tmp_path, f"{header}\n{line_of()}"))
    assert packets == []
    assert f"line 1: is of version {json.dumps(version)}; this release reads version 1" in sentence


@pytest.mark.parametrize("first", ['{"format": "solepath-pack', line_of(), "hello", '"x"\n'])
def test_a_file_without_a_whole_header_is_rejected(tmp_path, first):
    assert "line 1: " in read_until_damage(recording_file(tmp_path, first))[1]


@pytest.mark.parametrize("nothing", ["", "\n\n"])
def test_an_empty_file_is_called_empty(tmp_path, nothing):
    assert read_until_damage(recording_file(tmp_path, nothing))[1].endswith("is empty")


def test_a_missing_file_and_a_directory_are_named(tmp_path):
    assert read_until_damage(tmp_path / "none.jsonl")[1].endswith("no such file or directory")
    assert read_until_damage(tmp_path)[1].endswith("is a folder, not a recording")


def test_progress_ends_at_the_size_of_the_file(tmp_path):
    path = recorded(tmp_path / "walk.jsonl", PACKETS)
    read = []
    list(read_packets(path, progress=read.append))
    assert read == sorted(read) and read[-1] == path.stat().st_size


def test_a_source_gives_one_foot_and_counts_how_far_it_is(tmp_path):
    """A sensor that is on no foot is with both."""
    path = recorded(tmp_path / "walk.jsonl", PACKETS, {"note": "x"})
    for foot in (None, *Foot):
        source = open_source(path, foot)
        assert (source.header["note"], source.total, source.done) == ("x", path.stat().st_size, 0)
        expected = [p for p in PACKETS if foot is None or p.site.foot in (None, foot)]
        assert list(source) == expected and source.done == source.total
        assert list(source) == expected and list(source.look_ahead()) == PACKETS, "a file is read again"
    recorded(path, PACKETS[1:2])
    with pytest.raises(RecordingError, match="walk.jsonl: holds no packets of the left foot"):
        list(open_source(path, Foot.LEFT))
    reports = []
    empty = recorded(tmp_path / "none.jsonl", [])
    assert list(open_source(empty, report=reports.append)) == []
    assert reports == [f"{empty}: holds no packets"]


def test_a_source_of_samples_counts_them_and_has_a_title(tmp_path):
    files = [tmp_path / "left.csv", tmp_path / "right.csv"]
    for file in files:
        file.write_text("t,acc_x,acc_y,acc_z\n0,0,0,9.8\n0.01,0,0,9.8\n")
    source = open_source(files)
    assert (source.name, source.total, len(list(source)), source.done) == ("left.csv, right.csv", 4, 4, 4)
    source.clock_offset = -0.005
    assert [(s.t, s.site.foot) for s in source] == [
        (-0.005, Foot.RIGHT), (0.0, Foot.LEFT), (0.005, Foot.RIGHT), (0.01, Foot.LEFT)
    ]  # fmt: skip
    for size in (79, 80, 81):
        pair = [Path("x.csv"), Path("y" * (size - 11) + ".csv")]
        assert label_files(pair) == (f"{pair[0]}, {pair[1]}" if size <= 80 else "x.csv and 1 more")
    names = [Path(f"{letter * 36}.csv") for letter in "abc"]
    assert label_files(names) == f"{names[0]} and 2 more"
    assert label_files([Path("a/x.csv"), Path("b/x.csv")]) == "a/x.csv, b/x.csv"
    assert label_files([Path("y" * 99)]) == "y" * 99


def test_a_folder_names_the_recordings_in_it(tmp_path):
    for name in ("d.csv", "b.jsonl", "a.txt", "c.NPZ", "z.pdf"):
        (tmp_path / name).touch()
    assert read_until_damage(tmp_path)[1].endswith(
        "is a folder, not a recording; it has a.txt, b.jsonl, c.NPZ and others"
    )
    (tmp_path / "d.csv").unlink()
    assert read_until_damage(tmp_path)[1].endswith("it has a.txt, b.jsonl, c.NPZ")


def test_a_packet_behind_more_blanks_than_a_line_may_have_is_left_out(tmp_path):
    lines = recorded(tmp_path / "walk.jsonl", PACKETS).read_bytes().splitlines(keepends=True)
    (tmp_path / "walk.jsonl").write_bytes(
        b"".join([*lines[:2], b" " * (LONGEST_LINE + 1) + lines[2], b"  \n", *lines[3:], b" "])
    )
    reports = []
    assert list(read_packets(tmp_path / "walk.jsonl", report=reports.append)) == [PACKETS[0], PACKETS[2]]
    assert len(reports) == 1 and "line 3: is longer than 65536 bytes; this line is left out" in reports[0]


def test_a_byte_order_mark_is_no_part_of_a_recording(tmp_path):
    path = recorded(tmp_path / "walk.jsonl", PACKETS)
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    assert list(read_packets(path, report=pytest.fail)) == PACKETS


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be"])
def test_a_recording_in_another_encoding_says_which_is_wanted(tmp_path, encoding):
    path = recorded(tmp_path / "walk.jsonl", PACKETS)
    path.write_bytes(path.read_text().encode(encoding))
    _, sentence = read_until_damage(path)
    assert sentence.endswith("line 1: is text in UTF-16; a recording is in UTF-8: save it so")


@pytest.mark.parametrize("suffix", [".gz", ".bz2", ".xz", ".zip"])
def test_a_compressed_recording_is_read_as_it_is_and_a_torn_one_up_to_there(tmp_path, suffix):
    plain, path = recorded(tmp_path / "walk.jsonl", PACKETS * 500), tmp_path / f"walk.jsonl{suffix}"
    if suffix == ".zip":
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.write(plain, "walk.jsonl")
            archive.writestr("__MACOSX/._walk.jsonl", b"\0")
            archive.writestr("readme.md", b"a walk")
    else:
        path.write_bytes({".gz": gzip, ".bz2": bz2, ".xz": lzma}[suffix].compress(plain.read_bytes()))
    assert list(open_source(path, report=pytest.fail)) == PACKETS * 500
    whole = path.read_bytes()
    if suffix != ".zip":
        path.write_bytes(whole[: len(whole) * 3 // 4])
        reports = []
        found = list(read_packets(path, report=reports.append)) if suffix == ".gz" else []
        assert suffix != ".gz" or (found == (PACKETS * 500)[: len(found)] and 100 < len(found) < 1500 and reports)
    path.write_bytes(whole[:100] + b"\xff\x00\xff" + whole[103:])
    with pytest.raises(RecordingError, match="cannot be unpacked|is not JSON|is not text|cut off|is missing"):
        list(read_packets(path, report=lambda _: None))
