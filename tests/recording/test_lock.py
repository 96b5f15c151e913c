"""Two writers of one recording, and an existing recording for which no packet comes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from recordings import PACKETS, recorded

from solepath.recording import PacketWriter, RecordingError, read_header, read_packets
from solepath.recording import packet_writer as module
from solepath.types import Packet, Site

RECORDER = """
import sys
from solepath.recording import PacketWriter
from solepath.types import Packet, Site
with PacketWriter(sys.argv[1]) as writer:
    writer.write(Packet(1.0, Site.LEFT_FOOT, "insole/frame", b"first"))
    print("written", flush=True)
    sys.stdin.readline()
"""


def test_a_second_writer_in_another_process_is_rejected_and_the_lock_of_a_killed_one_is_free(tmp_path: Path) -> None:
    path = tmp_path / "both.jsonl"
    command = [sys.executable, "-c", RECORDER, str(path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as first:
        assert first.stdout is not None and first.stdout.readline() == "written\n"
        before = path.read_bytes()
        for replace in (False, True):
            with pytest.raises(RecordingError, match=r"both\.jsonl: another program is recording into it"):
                PacketWriter(path, replace=replace)
        assert path.read_bytes() == before
        first.send_signal(signal.SIGKILL)
        first.communicate()
    assert [packet.data for packet in read_packets(path, report=pytest.fail)] == [b"first"]
    with PacketWriter(path, replace=True) as writer:
        writer.write(PACKETS[0])
    assert list(read_packets(path)) == PACKETS[:1]


def test_a_recording_stays_until_the_first_packet_comes(tmp_path: Path) -> None:
    path = recorded(tmp_path / "walk.jsonl", PACKETS)
    before = path.read_bytes()
    with PacketWriter(path, replace=True) as writer:
        assert writer.replaces and path.read_bytes() == before
    assert path.read_bytes() == before
    with PacketWriter(path, replace=True) as writer:
        writer.write(PACKETS[1])
        assert not writer.replaces
        assert list(read_packets(path)) == [PACKETS[1]]


def test_a_recording_that_must_not_be_replaced_is_named(tmp_path: Path) -> None:
    path = recorded(tmp_path / "walk.jsonl", PACKETS)
    before = path.read_bytes()
    with pytest.raises(
        RecordingError, match=r"walk\.jsonl: exists, and is not replaced; PacketWriter\(\.\.\., replace=True\) does"
    ):
        PacketWriter(path)
    assert path.read_bytes() == before
    PacketWriter(path, replace=True).close()  # the lock is free


def test_a_new_file_without_packets_has_a_header_or_is_removed(tmp_path: Path) -> None:
    recorded(tmp_path / "walk.jsonl", [], {"note": "x"})
    assert read_header(tmp_path / "walk.jsonl")["note"] == "x"
    PacketWriter(tmp_path / "other.jsonl").discard()
    assert not (tmp_path / "other.jsonl").exists()
    PacketWriter(tmp_path / "walk.jsonl", replace=True).discard()
    assert read_header(tmp_path / "walk.jsonl")["note"] == "x"
    (tmp_path / "empty.jsonl").touch()
    PacketWriter(tmp_path / "empty.jsonl").discard()
    assert (tmp_path / "empty.jsonl").read_bytes() == b""


def test_a_new_recording_has_its_header_before_the_first_packet(tmp_path: Path) -> None:
    """Other programs replace an empty file."""
    with PacketWriter(tmp_path / "walk.jsonl", {"note": "x"}) as writer:
        assert read_header(tmp_path / "walk.jsonl")["note"] == "x"
        assert list(read_packets(tmp_path / "walk.jsonl", report=pytest.fail)) == []
        writer.write(PACKETS[0])
    assert list(read_packets(tmp_path / "walk.jsonl")) == PACKETS[:1]


@pytest.mark.parametrize("how", ["appended", "replaced"])
def test_what_another_program_wrote_is_not_discarded(how: str, tmp_path: Path) -> None:
    path, other = tmp_path / "walk.jsonl", tmp_path / "other"
    writer = PacketWriter(path)
    if how == "appended":
        path.write_bytes(path.read_bytes() + b"notes")
    else:
        other.write_bytes(b"notes")
        other.replace(path)
    writer.discard()
    assert path.read_bytes().endswith(b"notes")


def test_a_recording_whose_header_cannot_be_written_is_an_error_at_once() -> None:
    if not Path("/dev/full").is_char_device():
        pytest.skip("no /dev/full on this system")
    with pytest.raises(RecordingError, match=r"/dev/full: no space left on device"):
        PacketWriter("/dev/full")


def test_a_file_that_its_writer_removes_while_another_opens_it_is_opened_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A lock of the removed file would protect nothing, and what is written to it would be lost."""
    path = tmp_path / "walk.jsonl"
    first, lock = PacketWriter(path), module.take_lock

    def discarded_then_locked(descriptor: int) -> bool:
        first.discard()
        return lock(descriptor)

    monkeypatch.setattr(module, "take_lock", discarded_then_locked)
    with PacketWriter(path) as second:
        second.write(PACKETS[0])
    assert list(read_packets(path)) == PACKETS[:1]


def test_a_file_that_cannot_be_locked_is_written_all_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Some network drives have no locks."""
    fcntl = pytest.importorskip("fcntl")
    from solepath.saving import lock

    def unsupported(descriptor: int, operation: int) -> None:
        raise OSError(os.strerror(95))

    assert fcntl.flock is lock.flock
    monkeypatch.setattr(lock, "flock", unsupported)
    assert list(read_packets(recorded(tmp_path / "walk.jsonl", PACKETS))) == PACKETS


def test_text_that_is_no_unicode_is_written_and_read_back_as_it_was(tmp_path: Path) -> None:
    odd = Packet(1.0, Site.LEFT_FOOT, "own/\ud800", b"\x01", "F0:\udcff")
    path = recorded(tmp_path / "walk.jsonl", [odd, PACKETS[0]], {"note": "\udcfe"})
    assert path.read_bytes().isascii()
    assert list(read_packets(path, report=pytest.fail)) == [odd, PACKETS[0]]
    assert read_header(path)["note"] == "\udcfe"


def test_values_that_json_does_not_have_cost_no_file_and_no_line(tmp_path: Path) -> None:
    path = recorded(tmp_path / "walk.jsonl", PACKETS)
    before = path.read_bytes()
    with pytest.raises(TypeError):
        PacketWriter(path, {"note": b"bytes"})
    with PacketWriter(path, replace=True) as writer:
        with pytest.raises(TypeError):
            writer.write(Packet(1.0, Site.LEFT_FOOT, b"insole/frame", b""))  # type: ignore[arg-type]
        assert path.read_bytes() == before
        writer.write(Packet(np.float32(1.5), Site.LEFT_FOOT, "insole/frame", b"\x01"))  # type: ignore[arg-type]
    assert [packet.t for packet in read_packets(path)] == [1.5]
