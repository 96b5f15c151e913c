"""Files that are larger than they look, or have no end: one line, within a bound of memory."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
import threading
import zipfile
from pathlib import Path

import numpy as np
import pytest
from recordings import PACKETS, recorded
from tabled import still

from solepath.recording import RecordingError, open_source, read_packets, read_samples
from solepath.recording.samples import npz, numbers, sheet

MEMORY = 1_500_000_000
"""Largest size of the address space of a command, bytes; numpy alone takes some 600 MB of it."""

BOUNDED = """
import json, resource, sys
from solepath.cli import main
limit, *commands = json.loads(sys.argv[1])
resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
for command in commands:
    print(main(command), file=sys.stderr)
"""


def complaints(*commands: tuple[object, ...]) -> list[str]:
    """Return the one line on stderr of each command, all of which fail with little memory in one process."""
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1"}  # each thread takes address space
    given = json.dumps([MEMORY, *([str(word) for word in command] for command in commands)])
    command = [sys.executable, "-c", BOUNDED, given]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, env=environment, check=True)
    lines = done.stderr.splitlines()
    assert lines[1::2] == ["2"] * len(commands), done.stderr[-500:]
    return lines[::2]


def array_header(shape: tuple[int, ...], descr: str = "<f8") -> bytes:
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(stream, {"descr": descr, "fortran_order": False, "shape": shape})
    return stream.getvalue()


def inflating(path: Path, claimed: tuple[int, ...], actual: int, descr: str = "<f8") -> Path:
    """Write an archive whose `acc` claims this shape and type, and inflates to `actual` bytes of zeros."""
    np.savez(path, **{key: value for key, value in still().items() if key != "acc"})
    with (
        zipfile.ZipFile(path, "a", zipfile.ZIP_DEFLATED, compresslevel=1) as archive,
        archive.open("acc.npy", "w") as file,
    ):
        file.write(array_header(claimed, descr))
        for _ in range(actual // 10_000_000):
            file.write(bytes(10_000_000))
    return path


@pytest.mark.long
def test_what_inflates_to_a_gigabyte_is_rejected_before_that(tmp_path: Path) -> None:
    whole = inflating(tmp_path / "whole.npz", (40_000_000, 3), 960_000_000)
    assert whole.stat().st_size < 5_000_000
    value = inflating(tmp_path / "value.npz", (1,), 200_000_000, "<U50000000")
    lying = inflating(tmp_path / "lying.npz", (200, 3), 100_000_000)
    data = bytearray(lying.read_bytes())
    size = data.rfind((100_000_128).to_bytes(4, "little"))
    data[size : size + 4] = (128 + 4800).to_bytes(4, "little")
    lying.write_bytes(data)
    of_whole, of_value, of_lying = complaints(*(("track", path) for path in (whole, value, lying)))
    assert "whole.npz: holds more than 100,000,000 numbers" in of_whole
    assert "acc: holds <U50000000 of the shape (1,), not columns of numbers" in of_value
    assert "acc: cannot be read" in of_lying


def test_an_array_that_claims_more_than_its_file_holds_is_rejected_before_memory_is_taken(tmp_path: Path) -> None:
    path = inflating(tmp_path / "walk.npz", (10**12, 3), 10_000_000)
    with pytest.raises(RecordingError, match=r"acc: cannot be read \((Unable to allocate|EOF)"):
        read_samples(path)
    exact = inflating(tmp_path / "exact.npz", (200, 3), 0)
    with zipfile.ZipFile(exact, "a") as archive, archive.open("pressure.npy", "w") as file:
        file.write(array_header((200, 3)) + bytes(4799))
    with pytest.raises(RecordingError, match="cannot be read .*expected 4800 bytes got 4799"):
        read_samples(exact)


def test_a_device_without_end_is_rejected_in_one_line(tmp_path: Path) -> None:
    walk, commands = recorded(tmp_path / "good.jsonl", PACKETS), []
    for name in ("walk.csv", "walk.npz", "walk.jsonl", "me.json", "plan.geojson"):
        (tmp_path / name).symlink_to("/dev/zero")
        option = {"me.json": "--calibration", "plan.geojson": "--floorplan"}.get(name)
        commands.append(("track", walk, option, tmp_path / name) if option else ("track", tmp_path / name))
    reasons = (
        "line 1: is longer than 65536 ",
        "is not an .npz",
        "line 1: is longer",
        "is larger than",
        "is larger than",
    )
    for sentence, reason, command in zip(complaints(*commands), reasons, commands, strict=True):
        assert f"{command[-1]}: {reason}" in sentence


def test_an_endless_table_is_rejected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, header = tmp_path / "walk.csv", "t,acc_x,acc_y,acc_z\n"
    path.write_text(header + "".join(f"{k / 100},0,0,9.8\n" for k in range(300)))
    monkeypatch.setattr(numbers, "MAX_VALUES", 1000)
    with pytest.raises(RecordingError, match="holds more than 1,000 numbers"):
        list(read_samples(path))
    monkeypatch.setattr(sheet, "MAX_LENGTH", 2000)
    with pytest.raises(RecordingError, match="is longer than 2,000 characters"):
        list(read_samples(path))


def fed(pipe: Path, data: bytes) -> threading.Thread:
    """Make a pipe and write data into it, once, in another thread."""
    os.mkfifo(pipe)
    thread = threading.Thread(target=pipe.write_bytes, args=(data,), daemon=True)
    thread.start()
    return thread


@pytest.mark.parametrize("name", ["walk.csv", "walk.npz"])
def test_samples_come_through_a_pipe_as_from_a_file(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    if name == "walk.npz":
        np.savez(path, **still())
    else:
        path.write_text("t,acc_x,acc_y,acc_z\n" + "".join(f"{k / 100},0,0,9.8\n" for k in range(300)))
    fed(tmp_path / f"pipe-{name}", path.read_bytes())
    assert list(read_samples(tmp_path / f"pipe-{name}")) == list(read_samples(path))


def test_an_archive_that_is_too_large_for_a_pipe_is_rejected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(npz, "MAX_PIPED", 1000)
    np.savez(tmp_path / "walk.npz", **still())
    fed(tmp_path / "pipe.npz", (tmp_path / "walk.npz").read_bytes())
    with pytest.raises(RecordingError, match="is a pipe of more than 0 MB: save it as a file"):
        list(read_samples(tmp_path / "pipe.npz"))


def test_a_pipe_of_packets_is_opened_once_and_can_be_read_ahead(tmp_path: Path) -> None:
    path = recorded(tmp_path / "walk.jsonl", PACKETS, {"note": "x"})
    fed(tmp_path / "pipe", path.read_bytes())
    source = open_source(tmp_path / "pipe")
    assert source.header["note"] == "x"
    assert next(source.look_ahead()) == PACKETS[0]
    assert list(source) == PACKETS == list(read_packets(path))
