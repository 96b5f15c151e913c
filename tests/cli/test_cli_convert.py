"""Tests `solepath convert`: a phone's log to a recording, either to MCAP; each error is one line."""

import struct
import subprocess
import sys
from pathlib import Path

import pytest
import walks
from commands import one_line, run
from recordings import recorded
from snooped import LEFT, RIGHT, TAG, Log, insoles_log

from solepath import Site
from solepath.recording import read_header, read_packets
from solepath.types.extras import install_hint


def convert(*arguments: object) -> subprocess.CompletedProcess[str]:
    return run("convert", *arguments)


def complaint(*arguments: object) -> str:
    """Return the one line on stderr of a conversion that failed."""
    return one_line(convert(*arguments)).removeprefix("solepath: ")


@pytest.fixture(scope="module")
def log(tmp_path_factory) -> Path:
    return insoles_log(walks.insoles().packets).save(tmp_path_factory.mktemp("phone") / "btsnoop_hci.log")


def recording(path: Path) -> Path:
    return recorded(path, walks.insoles().packets[:100], {"began": "2026-11-21T09:30:00Z"})


def test_a_phones_log_becomes_a_recording_that_track_takes(log, tmp_path):
    out = tmp_path / "walk.jsonl"
    result = convert(log, out)
    assert (result.returncode, result.stderr) == (0, "")
    frames = [p for p in walks.insoles().packets if p.channel == "insole/frame"]
    half = sum(p.site is Site.LEFT_FOOT for p in frames)
    assert result.stdout.splitlines() == [
        f"{LEFT}  left_foot, insole: {half} notifications",
        f"{RIGHT}  right_foot, insole: {len(frames) - half} notifications",
        f"{len(frames) + 2} packets written to {out}",
    ]
    packets = list(read_packets(out))
    assert [p.data for p in packets if p.channel == "insole/frame"] == [p.data for p in frames]
    assert read_header(out)["began"] == "2026-09-21T14:13:20.251000Z"
    assert list(tmp_path.iterdir()) == [out], "nothing else is left"
    tracked = run("track", out)
    assert tracked.returncode == 0 and "limitation" in tracked.stdout and "5" in tracked.stdout


def test_either_becomes_mcap(log, tmp_path):
    reader = pytest.importorskip("mcap.reader", reason="the extra mcap is not installed")
    for source in (log, recording(tmp_path / "walk.jsonl")):
        out = tmp_path / "WALK.MCAP"
        result = convert(source, out, "--force")
        assert (result.returncode, result.stderr) == (0, "")
        with out.open("rb") as file:
            summary = reader.make_reader(file).get_summary()
        topics = {channel.topic for channel in summary.channels.values()}
        assert {"/left_foot/packets/insole/frame", "/left_foot/samples", "/left_foot/FootMoved"} <= topics
        assert summary.statistics.message_start_time > 1_700_000_000 * 10**9


def test_the_site_and_the_channel_can_be_given(tmp_path):
    log = Log()
    log.connect(0x40, TAG)
    for _ in range(3):
        log.notify(0x40, 0x2B, bytes(18))
    path, out = log.save(tmp_path / "phone.log"), tmp_path / "walk.jsonl"
    assert f"3 values of {TAG} left out: no discovery says what is 0x002b (18 bytes)" in complaint(path, out)
    result = convert(path, out, "--site", f"{TAG}=pelvis", "--handle", f"{TAG.lower()}/0x2b=cc2650/movement")
    assert result.returncode == 0
    assert {(p.site, p.channel) for p in read_packets(out)} == {
        (Site.PELVIS, "receiver/connected"), (Site.PELVIS, "cc2650/movement"),
    }  # fmt: skip
    for spelling in (TAG.replace(":", "-").lower(), TAG.replace(":", "").lower(), f" {TAG}"):
        result = convert(
            path, out, "--force", "--site", f"{spelling}=pelvis", "--handle", f"{spelling}/43=cc2650/movement"
        )
        assert result.returncode == 0, spelling
    assert "there is no channel 'cc2650/moment': did you mean cc2650/movement?" in complaint(
        path, out, "--force", "--handle", "0x2b=cc2650/moment"
    )


def test_packets_before_a_damage_are_converted_and_the_damage_is_reported(log, tmp_path):
    source, out = tmp_path / "damaged.log", tmp_path / "out.jsonl"
    source.write_bytes(log.read_bytes() + struct.pack(">IIIIq", 1, 2, 0, 0, 0))
    result = convert(source, out)
    assert result.returncode == 2
    assert result.stderr.count("\n") == 1 and "is damaged: it claims 2 of 1 bytes" in result.stderr
    assert f" packets written to {out}" in result.stdout and out.stat().st_size > 10_000


def test_what_cannot_be_converted_replaces_nothing(log, tmp_path):
    out = tmp_path / "walk.jsonl"
    out.write_text("precious")
    bad = tmp_path / "bad.log"
    for content, flaw in (
        (b"", "is empty"),
        (b"hello", "line 1: is not JSON"),
        (log.read_bytes()[:16], "holds no packets of a device whose place is known"),
        (log.read_bytes()[:16] + struct.pack(">IIIIq", 1, 2, 0, 0, 0), "record 1: is damaged"),
        (b"btsnoop\0" + struct.pack(">II", 1, 1003), "is btsnoop of datalink 1003"),
    ):
        bad.write_bytes(content)
        target = out.with_suffix(".mcap") if content[:8] != b"btsnoop\0" else out
        assert flaw in complaint(bad, target, "--force")
        assert sorted(path.name for path in tmp_path.iterdir()) == ["bad.log", "walk.jsonl"]
        assert out.read_text() == "precious"


def test_impossible_file_names_are_rejected(log, tmp_path):
    walk = recording(tmp_path / "walk.jsonl")
    assert "ends neither in .jsonl nor in .mcap nor in .sto" in complaint(log, tmp_path / "walk.csv")
    assert "is no Bluetooth log; a recording is converted to" in complaint(walk, tmp_path / "other.jsonl")
    site = ("--site", f"{TAG}=pelvis")
    assert "--site and --handle are for Bluetooth logs" in complaint(walk, tmp_path / "walk.mcap", *site)


def test_a_new_file_has_the_mode_that_new_files_have_and_a_link_stays_one(log, tmp_path):
    plain, there, link = tmp_path / "plain", tmp_path / "there.jsonl", tmp_path / "link.jsonl"
    plain.write_text("")
    link.symlink_to(there)
    assert convert(log, link).returncode == 0
    assert link.is_symlink() and there.stat().st_mode == plain.stat().st_mode


LITTLE_ROOM = """
import resource, sys
from solepath.cli import main
resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))
sys.exit(main(["convert", *sys.argv[1:]]))
"""


def test_a_disk_that_fills_up_is_one_line_and_leaves_no_half_file(log, tmp_path):
    out = tmp_path / "walk.jsonl"
    result = subprocess.run([sys.executable, "-c", LITTLE_ROOM, log, out], capture_output=True, text=True)
    assert (result.returncode, result.stderr) == (2, f"solepath: {out}: is larger than this disk allows\n")
    assert list(tmp_path.iterdir()) == []


def test_without_mcap_the_message_names_the_package(log, tmp_path):
    """A process of its own, since this one may have loaded the package already."""
    code = "import sys; sys.modules['mcap'] = None; from solepath.cli import main; sys.exit(main(sys.argv[1:]))"
    command = [sys.executable, "-c", code, "convert", log, tmp_path / "walk.mcap"]
    result = subprocess.run(command, capture_output=True, text=True)
    assert result.returncode == 2
    assert result.stderr == f"solepath: writing MCAP needs the package mcap: {install_hint('mcap')}\n"
