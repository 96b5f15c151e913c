"""Captures of other kinds than btsnoop give the same packets: PacketLogger, pcap, pcapng, and an Android bug report."""

from __future__ import annotations

import gzip
import struct
from collections.abc import Callable
from pathlib import Path

import pytest
import walks
from captured import MONITOR, PHDR, bug_report, pcap, pcapng, pklg
from commands import one_line, run
from snooped import FRAME, Log, frames, insoles_log, start_connection
from soak import soaked

from solepath import Packet
from solepath.recording import RecordingError, read_packets
from solepath.recording.btsnoop import open_btsnoop

CAPTURES: dict[str, Callable[[Log], bytes]] = {
    "iphone.pklg": pklg,
    "mac.pklg": lambda log: pklg(log, "<"),
    "h4.pcap": pcap,
    "directed.pcap": lambda log: pcap(log, PHDR),
    "monitor.pcap": lambda log: pcap(log, MONITOR),
    "nano.pcap": lambda log: pcap(log, PHDR, ">", nano=True),
    "h4.pcapng": pcapng,
    "flags.pcapng": lambda log: pcapng(log, flags=True),
    "big.pcapng": lambda log: pcapng(log, PHDR, ">"),
    "nano.pcapng": lambda log: pcapng(log, MONITOR, exponent=9),
    "packed.pcapng.gz": lambda log: gzip.compress(pcapng(log, PHDR)),
}
DIRECTORY = "FS/data/misc/bluetooth/logs"


@pytest.fixture(scope="module")
def log() -> Log:
    """A walk in two insoles whose frames come in several pieces."""
    return insoles_log(walks.insoles().packets, Log(piece=50))


@pytest.fixture(scope="module")
def packets(log: Log, tmp_path_factory: pytest.TempPathFactory) -> list[Packet]:
    return list(open_btsnoop(log.save(tmp_path_factory.mktemp("log") / "phone.log")))


def read(path: Path, content: bytes) -> tuple[list[Packet], list[str]]:
    path.write_bytes(content)
    reports: list[str] = []
    return list(open_btsnoop(path, report=reports.append)), reports


@pytest.mark.parametrize("name", CAPTURES)
def test_a_walk_gives_the_same_packets_whatever_captured_it(
    tmp_path: Path, log: Log, packets: list[Packet], name: str
) -> None:
    """Those of the radio and of a network in the same capture are left out, and times go on from the first of HCI."""
    found, reports = read(tmp_path / name, CAPTURES[name](log))
    assert [(p.site, p.channel, p.data, p.device) for p in found] == [
        (p.site, p.channel, p.data, p.device) for p in packets
    ]
    assert [p.t for p in found] == pytest.approx([p.t for p in packets], abs=2e-6)
    is_mixed = "pcapng" in name
    assert reports == [f"{tmp_path / name}: records of link type 1 (Ethernet), which are not HCI: 1"] * is_mixed


@pytest.mark.parametrize("name", ["iphone.pklg", "h4.pcap", "flags.pcapng"])
def test_convert_and_track_take_it_to_a_summary(tmp_path: Path, log: Log, name: str) -> None:
    (tmp_path / name).write_bytes(CAPTURES[name](log))
    assert "`solepath convert` makes a recording of" in one_line(run("track", tmp_path / name))
    done = run("convert", tmp_path / name, tmp_path / "walk.jsonl")
    assert done.returncode == 0 and "left_foot, insole" in done.stdout
    frames_sent = [p.data for p in read_packets(tmp_path / "walk.jsonl") if p.channel == "insole/frame"]
    assert frames_sent == [p.data for p in walks.insoles().packets if p.channel == "insole/frame"]


@pytest.mark.parametrize("name", CAPTURES)
@pytest.mark.parametrize("cut", [1, 7, 30])
def test_a_torn_end_costs_one_record(tmp_path: Path, log: Log, packets: list[Packet], name: str, cut: int) -> None:
    found, reports = read(tmp_path / name, CAPTURES[name](log)[:-cut])
    assert len(packets) - 20 <= len(found) < len(packets) + (name.endswith("gz"))
    assert (
        name.endswith("gz") or sum("cut off in the middle; everything before it is used" in one for one in reports) == 1
    )


def test_packets_that_are_cut_short_are_said_first(tmp_path: Path, log: Log) -> None:
    """A snap length of 68 bytes, as old programs have, keeps the beginning of a frame only."""
    path = tmp_path / "walk.pcap"
    path.write_bytes(pcap(insoles_log(walks.insoles().packets), PHDR, snap=68))
    with pytest.raises(RecordingError) as caught:
        open_btsnoop(path)
    assert caught.value.what.startswith(
        "holds nothing that can be used; packets that the capture cut short (a snap length"
    )
    assert "tcpdump -s 0" in caught.value.repair
    short = start_connection(Log())
    short.notify(0x40, FRAME, frames()[0])
    for frame in frames()[1:4]:
        short.record(2, struct.pack("<HH", 0x2040, 40) + frame[:20], sent=False, original=61)
    _, reports = read(tmp_path / "short.pcap", pcap(short))
    assert "cut short" in reports[0] and reports[0].endswith(": 3")


AIR = ": Bluetooth LE on the air)"
"""What a sniffer beside the two devices captures; it has no HCI."""
OTHERS = {
    1: "1 (Ethernet)",
    189: "189 (USB)",
    251: f"251 (a sniffer{AIR}",
    256: f"256 (a sniffer such as Ubertooth{AIR}",
    272: f"272 (an nRF Sniffer{AIR}",
    999: "999",
}


@pytest.mark.parametrize("capture", [pcap, pcapng])
@pytest.mark.parametrize("link", OTHERS)
def test_a_capture_of_something_else_gets_one_line_that_says_what_it_is_and_what_to_do(
    tmp_path: Path, log: Log, link: int, capture: Callable[[Log, int], bytes]
) -> None:
    path = tmp_path / "walk.capture"
    path.write_bytes(capture(log, link))
    done = run("convert", path, tmp_path / "walk.jsonl")
    assert done.returncode == 2 and f"{OTHERS[link]}, not of HCI; repair: capture HCI on the phone" in one_line(done)
    assert not (tmp_path / "walk.jsonl").exists()
    for command in ("check", "track"):
        done = run(command, path)
        assert done.returncode == 2 and "is a Bluetooth capture: if it is of HCI, `solepath convert`" in one_line(done)


def test_a_log_is_found_in_a_bug_report(tmp_path: Path, log: Log, packets: list[Packet]) -> None:
    """A phone rotates its logs: the older part is named .last, and a filtered copy of both may lie beside."""
    whole = log.bytes()
    middle = len(log.records) // 2
    older, newer = (Log(records=part).bytes() for part in (log.records[:middle], log.records[middle:]))
    for logs in (
        {f"{DIRECTORY}/btsnoop_hci.log": whole},
        {"FS/data/log/bt/btsnoop_hci_202611291200.log": whole},
        {f"{DIRECTORY}/btsnooz_hci.log": whole},
        {f"{DIRECTORY}/btsnoop_hci.log": newer, f"{DIRECTORY}/btsnoop_hci.log.last": older},
        {f"{DIRECTORY}/btsnoop_hci.log": whole, f"{DIRECTORY}/btsnoop_hci.log.filtered": older},
    ):
        path = bug_report(tmp_path / "bugreport-walk.zip", logs)
        assert list(open_btsnoop(path, report=pytest.fail)) == packets
        assert run("convert", path, tmp_path / "walk.jsonl", "--force").returncode == 0


def test_a_bug_report_without_a_log_says_how_it_gets_one(tmp_path: Path) -> None:
    path = bug_report(tmp_path / "bugreport.zip", {f"{DIRECTORY}/btsnoop_hci.log": b""})
    done = run("convert", path, tmp_path / "walk.jsonl")
    assert "is a bug report without a Bluetooth log; repair: in the developer options" in one_line(done)


@pytest.mark.parametrize("name", [[*CAPTURES][0], *soaked(*[*CAPTURES][1:])])
def test_damage_never_ends_in_more_than_one_sentence(tmp_path: Path, log: Log, name: str) -> None:
    whole = CAPTURES[name](Log(records=log.records[:400]))
    path = tmp_path / name
    for start in range(0, len(whole), max(1, len(whole) // 60)):
        path.write_bytes(whole[:start] + b"\xff\x00\xff\xff\x7f" + whole[start + 5 :])
        try:
            list(open_btsnoop(path, report=lambda _: None))
        except RecordingError as error:
            assert str(error).startswith(str(path)) and "\n" not in str(error)
