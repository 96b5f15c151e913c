"""Import of btsnoop logs: devices, sites and channels of a phone's log."""

from __future__ import annotations

import struct

import pytest
import walks
from snooped import (
    BATTERY,
    FRAME,
    H4,
    INSOLE,
    LEFT,
    MONITOR,
    MOVEMENT,
    OTHER,
    RIGHT,
    TAG,
    Log,
    data_of,
    frames,
    full,
    insoles_log,
    read,
    start_connection,
)

from solepath import Packet, Sample, Site
from solepath.link.decoder import Decoder
from solepath.recording import RecordingError
from solepath.recording.btsnoop import open_btsnoop
from solepath.types.vector import GRAVITY
from solepath.wire.fragment import split


@pytest.mark.parametrize("datalink", [H4, MONITOR])
def test_the_packets_of_a_walk_in_two_insoles_come_with_their_times(tmp_path, datalink):
    """The time of the first record is 0 s; the start of the log is known to the microsecond."""
    path = insoles_log(walks.insoles().packets, Log(datalink)).save(tmp_path / "phone.log")
    log = open_btsnoop(path, report=pytest.fail)
    assert log.header == {"began": "2026-09-21T14:13:20.251000Z", "began_t": 0.0, "source": "btsnoop"}
    addresses = {Site.LEFT_FOOT: LEFT, Site.RIGHT_FOOT: RIGHT}
    connected, frames_sent = [], []
    for packet in log:
        (connected if packet.channel == "receiver/connected" else frames_sent).append(packet)
    assert [(p.t, p.site, p.device) for p in connected] == [
        (0.0, Site.LEFT_FOOT, LEFT), (connected[1].t, Site.RIGHT_FOOT, RIGHT)
    ]  # fmt: skip
    assert frames_sent == [
        Packet((999_000 + round(p.t * 1e6)) / 1e6, p.site, p.channel, p.data, addresses[p.site])
        for p in walks.insoles().packets
        if p.channel == "insole/frame"
    ]
    assert log.done == log.total == path.stat().st_size


def test_an_insole_reports_its_own_foot_unless_the_caller_names_it(tmp_path):
    log = start_connection(Log(), address=LEFT)
    log.notify(0x40, FRAME, frames(Site.RIGHT_FOOT)[0])
    assert {site for _, site, _, _ in read(log, tmp_path)[0]} == {"right_foot"}
    site_by_address = {LEFT.lower(): Site.LEFT_FOOT}
    assert {site for _, site, _, _ in read(log, tmp_path, sites=site_by_address)[0]} == {"left_foot"}


ORPHE = {0x12: "f3f9c7ce-46ee-4205-89ac-abe64e626c0f", 0x15: "24354f22-1c46-430e-a4ab-a1eeabbcdfc0"}
ORPHE_INFO = bytes([100, 1, *bytes(6), 2, 3, *bytes(10)])
"""INFO of a right foot; 8 g, 2000 degrees/s."""


def orphe(characteristics: dict[int, str]) -> Log:
    log = start_connection(Log(), address=TAG, characteristics=characteristics)
    log.add_request(0x40, "0a1500", b"\x0b" + ORPHE_INFO)
    log.add_request(0x40, "1215000d04", "13")
    for k in range(30):
        head = struct.pack(">BHBBBH", 56, k, 1, 1, 1, k * 19)
        log.notify(0x40, 0x12, head + struct.pack(">10h", 16384, *[0] * 6, 4096, 0, 0).ljust(96, b"\0"))
    return log


def test_one_characteristic_is_one_channel_where_it_is_read_and_another_where_it_is_written(tmp_path):
    """The foot and the ranges are those that the insole reports, in what is read."""
    handles_given = {("", 0x12): "orphe/values", ("", 0x15): "orphe/mode"}
    for discovered, handles in ((ORPHE, {}), ({}, handles_given), ({}, handles_given | {("", 0x15): "orphe/info"})):
        log = orphe(discovered).save(tmp_path / "phone.log")
        packets = list(open_btsnoop(log, handles=handles, report=pytest.fail))
        assert {p.site for p in packets} == {Site.RIGHT_FOOT}
        by_channel = {p.channel: p.data for p in packets}
        assert (by_channel["orphe/info"], by_channel["orphe/mode"]) == (ORPHE_INFO, b"\x0d\x04")
        decoder = Decoder(Site.RIGHT_FOOT)
        samples = [item for p in packets for item in decoder.feed(p) if isinstance(item, Sample)]
        assert len(samples) > 40
        assert samples[-1].acc == pytest.approx((GRAVITY, 0.0, 0.0)), "4096 counts at 8 g, not at 16"


def test_sensortags_share_characteristics_and_differ_in_the_others(tmp_path):
    cc2541 = {0x31: full(0xAA11), 0x34: full(0xAA41), 0x38: full(0xAA51), 0x3B: full(0xAA52)}
    cc2650 = {0x31: full(0xAA81), 0x34: full(0xAA82), 0x37: full(0xAA41)}
    log = start_connection(start_connection(Log(), 0x40, LEFT, cc2541), 0x41, RIGHT, cc2650)
    log.add_request(0x40, "123b0007", "13")
    log.notify(0x40, 0x31, b"\x01\x02\x03")
    log.notify(0x40, 0x34, b"\xb2\xee\xc5\x84")
    log.notify(0x41, 0x31, MOVEMENT)
    log.notify(0x41, 0x37, bytes(6))
    packets, reports = read(log, tmp_path, sites={LEFT: Site.LEFT_FOOT, RIGHT: Site.RIGHT_FOOT})
    assert [(site, channel) for _, site, channel, _ in packets if not channel.startswith("receiver/")] == [
        *(("left_foot", f"cc2541/{name}") for name in ("gyroscope-config", "accelerometer", "barometer")),
        *(("right_foot", f"cc2650/{name}") for name in ("movement", "barometer")),
    ]
    assert reports == []


def test_a_device_whose_place_nobody_knows_is_left_out_and_named(tmp_path):
    log = start_connection(start_connection(Log()), 0x41, TAG, {0x31: full(0xAA81)})
    log.notify(0x40, FRAME, frames()[0])
    log.notify(0x41, 0x31, MOVEMENT)
    start_connection(log, 0x42, OTHER, {0x10: "2a37", 0x12: "2a19", 0x15: "2a26"})
    log.notify(0x42, 0x10, b"\x00\x48")
    log.notify(0x42, 0x12, b"\x48")
    packets, reports = read(log, tmp_path)
    assert {device for device, *_ in packets} == {LEFT}
    nobody = f"1 value of {TAG}, a cc2650, left out: nobody says where it was worn: --site {TAG}=left_foot"
    assert sorted(reports) == ["1 other device left out", nobody], "other people's devices are not described"
    alone = start_connection(Log(), 0x41, TAG, {0x31: full(0xAA81)})
    alone.notify(0x41, 0x31, MOVEMENT)
    with pytest.raises(RecordingError, match=f"holds no packets of a device whose place is known; .*{TAG}, a cc2650"):
        read(alone, tmp_path)


def test_a_handle_is_given_to_another_device_and_what_was_discovered_stays_with_the_first(tmp_path):
    log = start_connection(Log())
    log.notify(0x40, FRAME, frames()[0])
    log.disconnect(0x40)
    log.connect(0x40, OTHER)
    log.notify(0x40, FRAME, b"not a frame")
    log.disconnect(0x40)
    log.connect(0x40, LEFT)  # phones remember, and do not discover again
    log.notify(0x40, FRAME, frames()[1])
    log.notify(0x40, BATTERY, b"\x42")
    packets, reports = read(log, tmp_path)
    assert data_of(packets, "insole/frame") == [*frames()[:2]]
    assert data_of(packets, "device/battery") == [b"\x42"]
    assert [channel for _, _, channel, _ in packets if channel.startswith("receiver/")] == [
        "receiver/connected", "receiver/disconnected", "receiver/connected",
    ]  # fmt: skip
    assert reports == [f"1 value of {OTHER} left out: no discovery says what is 0x0012 (11 bytes)"]


@pytest.mark.parametrize("payload", [244, 20])
def test_an_insole_is_known_by_its_frames_without_discovery(tmp_path, payload):
    """Frames are whole, or in fragments of an MTU of 23."""
    log = Log()
    for k, frame in enumerate(frames()[:40]):
        for piece in split(frame, payload, k % 7):
            log.notify(0x40, 0x33, piece)
    packets, reports = read(log, tmp_path)
    assert {(device, site, channel) for device, site, channel, _ in packets} == {
        ("connection-0x0040", "left_foot", "insole/frame")
    }
    assert len(packets) == sum(len(split(frame, payload, 0)) for frame in frames()[:40])
    assert reports == []


@pytest.mark.parametrize(("count", "known"), [(1, False), (2, True)])
def test_two_frames_prove_an_insole(tmp_path, count, known):
    log = Log()
    for frame in (b"\xf5\x01 nothing", *frames()[:count]):
        log.notify(0x40, 0x33, frame)
    if known:
        assert [data for *_, data in read(log, tmp_path)[0]] == [b"\xf5\x01 nothing", *frames()[:count]]
    else:
        with pytest.raises(RecordingError, match=r"2 values of connection-0x0040 .* 0x0033 \(10, \d+ bytes\)"):
            read(log, tmp_path)


def test_what_the_host_itself_serves_is_no_device(tmp_path):
    log = start_connection(Log())
    log.notify(0x40, FRAME, frames()[0])
    log.acl(0x40, b"\x1b\x12\x00" + frames()[1], sent=True)
    log.acl(0x40, b"\x52\x17\x00\x01", sent=False)
    packets, reports = read(log, tmp_path)
    assert data_of(packets, "insole/frame") == [frames()[0]] and data_of(packets, "insole/control") == []
    assert reports == []


def test_adapters_have_connections_of_their_own(tmp_path):
    log = Log(MONITOR)
    for adapter, address in ((0, LEFT), (1, RIGHT)):
        log.adapter = adapter
        start_connection(log, 0x40, address)
        log.notify(0x40, FRAME, frames((Site.LEFT_FOOT, Site.RIGHT_FOOT)[adapter])[0])
    log.adapter = 2
    for frame in frames()[:2]:
        log.notify(0x40, FRAME, frame)
    packets, reports = read(log, tmp_path)
    assert {device for device, *_ in packets} == {LEFT, RIGHT, "connection-0x0040-hci2"}
    assert len(reports) == 1 and "a session listens to the first alone" in reports[0]


def test_unknown_attributes_may_be_named_by_the_caller(tmp_path):
    log = Log()
    for _ in range(3):
        log.notify(0x40, 0x2B, MOVEMENT)
        log.notify(0x41, 0x2B, MOVEMENT)
    with pytest.raises(RecordingError, match=r"3 values of connection-0x0040 left out: .*0x002b \(18 bytes\)"):
        read(log, tmp_path)
    sites = {"connection-0x0040": Site.LEFT_FOOT, "connection-0x0041": Site.RIGHT_FOOT}
    for handles in ({("", 0x2B): "cc2650/movement"}, {(name, 0x2B): "cc2650/movement" for name in sites}):
        packets, reports = read(log, tmp_path, sites=sites, handles=handles)
        assert [(site, channel) for _, site, channel, _ in packets] == [
            ("left_foot", "cc2650/movement"), ("right_foot", "cc2650/movement"),
        ] * 3  # fmt: skip
        assert reports == []
    with pytest.raises(ValueError, match="no device has a channel 'cc2650/moment'"):
        read(log, tmp_path, handles={("", 0x2B): "cc2650/moment"})


def test_no_word_makes_one_device_or_attribute_of_another(tmp_path):
    """The caller may repeat what discovery shows."""
    log = start_connection(Log(), characteristics=INSOLE | {0x30: full(0x1234)})
    log.notify(0x40, FRAME, frames()[0])
    log.notify(0x40, 0x30, b"\x63")
    for address, handle, channel, expected in (
        (LEFT, FRAME, "device/battery", "insole/frame"),
        ("", FRAME, "cc2650/movement", "insole/frame"),
        ("", 0x30, "cc2650/movement", "of an insole"),
    ):
        complaint = f"{handle:#06x} of {LEFT} is {expected}, as its discovery says, not {channel}$"
        with pytest.raises(RecordingError, match=complaint):
            read(log, tmp_path, handles={(address, handle): channel})
    packets, _ = read(log, tmp_path, handles={("", FRAME): "insole/frame"})
    assert data_of(packets, "insole/frame") == [frames()[0]] and data_of(packets, "device/battery") == []
