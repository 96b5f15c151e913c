"""btsnoop logs: what a phone's HCI snoop log holds, against tshark, against bumble, and against what may be wrong."""

from __future__ import annotations

import asyncio
import os
import shutil
import struct
import subprocess
from functools import cache
from pathlib import Path

import pytest
import walks
from hypothesis import example, given, settings
from hypothesis import strategies as st
from snooped import BEGAN, H1, H4, INSOLE, LEFT, MONITOR, OTHER, RIGHT, TAG, Log, insole_uuid

from solepath import Packet, PacketRejected, Sample, Session, Site
from solepath.events import Connected, Disconnected, StrideTaken
from solepath.link.decoder import Decoder
from solepath.recording import RecordingError
from solepath.recording.btsnoop import is_btsnoop, open_btsnoop
from solepath.recording.btsnoop.att import AttOperation, Op
from solepath.recording.btsnoop.values import Value, ValueListener
from solepath.types import Foot
from solepath.types.vector import GRAVITY
from solepath.wire.fragment import split
from solepath.wire.insole_info import build_info, parse_info

FRAME, INFO, CONTROL, BATTERY = INSOLE
MOVEMENT = bytes(range(18))


@cache
def frames(site: Site = Site.LEFT_FOOT) -> tuple[bytes, ...]:
    return tuple(p.data for p in walks.insoles().packets if p.site is site and p.channel == "insole/frame")


@cache
def info(site: Site = Site.LEFT_FOOT) -> bytes:
    return next(p.data for p in walks.insoles().packets if p.site is site and p.channel == "insole/info")


def read(log: Log, tmp_path: Path, **wishes) -> tuple[list[tuple[str, str, str, bytes]], list[str]]:
    """(device, site, channel, data) of every packet, and the reports without the file's name."""
    reports: list[str] = []
    path = log.save(tmp_path / "phone.log")
    packets = list(open_btsnoop(path, report=reports.append, **wishes))
    assert [p.t for p in packets] == sorted(p.t for p in packets)
    found = [(p.device, p.site.value, p.channel, p.data) for p in packets]
    return found, [report.removeprefix(f"{path}: ") for report in reports]


def data_of(found: list[tuple[str, str, str, bytes]], channel: str, device: str = LEFT) -> list[bytes]:
    return [data for of, _, name, data in found if (of, name) == (device, channel)]


def begin(log: Log, handle: int = 0x40, address: str = LEFT, characteristics: dict[int, str] = INSOLE) -> Log:
    log.connect(handle, address)
    log.mtu(handle, 247)
    log.discover(handle, characteristics)
    return log


def full(short: int) -> str:
    return f"f000{short:04x}-0451-4000-b000-000000000000"


# --- against tshark ---------------------------------------------------------------------------------------------------

needs_tshark = pytest.mark.skipif(shutil.which("tshark") is None, reason="tshark is not installed (apt install tshark)")


def heard_by_tshark(path: Path) -> list[tuple[int, int, int, bytes]]:
    """(us since 1970, connection handle, attribute handle, value) of every notification."""
    fields = ("frame.time_epoch", "bthci_acl.chandle", "btatt.handle", "btatt.value", "btatt.battery_level")
    wanted = [word for name in fields for word in ("-e", name)]
    told = subprocess.run(
        ["tshark", "-r", path, "-Y", "btatt.opcode == 0x1b", "-T", "fields", *wanted],
        capture_output=True,
        text=True,
        check=True,
    )
    heard = []
    for line in told.stdout.splitlines():
        t, connection, attribute, value, battery = line.split("\t")
        seconds, _, parts = t.partition(".")
        us = int(seconds) * 1_000_000 + int(parts[:6])
        data = bytes([int(battery)]) if battery else bytes.fromhex(value)
        heard.append((us, int(connection, 16), int(attribute, 16), data))
    return heard


def heard_by_us(path: Path) -> list[tuple[int, int, int, bytes]]:
    listener = ValueListener(path, pytest.fail)
    values = [item for item in listener.listen() if isinstance(item, Value) and item.how is AttOperation.NOTIFIED]
    assert not listener.flaws
    return [(value.t, value.link.handle, value.attribute, value.data) for value in values]


@needs_tshark
@pytest.mark.parametrize(("datalink", "piece"), [(H4, 251), (H4, 27), (H1, 251), (MONITOR, 100)])
def test_every_notification_is_what_tshark_says_it_is(tmp_path, datalink, piece):
    """Two insoles with an end and a new beginning under the same handle, and ACL packets in pieces of two links."""
    log = Log(datalink, piece=piece)
    begin(log, 0x40, LEFT)
    log.connect(0x41, RIGHT, subevent=0x0A)
    log.mtu(0x41, 247)
    log.discover(0x41, INSOLE)
    for k, (left, right) in enumerate(zip(frames(), frames(Site.RIGHT_FOOT), strict=False)):
        if k == 200:
            log.disconnect(0x40)
            log.connect(0x40, LEFT)
            log.mtu(0x40, 247)
        log.notify(0x40, FRAME, left)
        log.notify(0x41, FRAME, right)
        if k % 50 == 0:
            log.notify(0x40, BATTERY, bytes([k % 101]))
    path = log.save(tmp_path / "phone.log")
    ours, theirs = heard_by_us(path), heard_by_tshark(path)
    assert len(ours) > 1200
    assert ours == theirs


def told_by_tshark(path: Path) -> list[tuple[AttOperation, int, bytes]]:
    """(how, attribute handle, value) of every value that was read, joined by the offsets, and every one that was
    written and taken. Of each PDU by itself tshark says handle, offset and value; values that it knows have a field of
    their own."""
    fields = ("opcode", "handle", "value", "offset", "battery_level", "firmware_revision_string")
    fields += ("characteristic_configuration_client",)
    wanted = [word for name in fields for word in ("-e", f"btatt.{name}")]
    only = "btatt.opcode in {0x0a, 0x0b, 0x0c, 0x0d, 0x12, 0x13, 0x52}"
    command = ["tshark", "-r", path, "-Y", only, "-T", "fields", *wanted]
    told: list[tuple[AttOperation, int, bytes]] = []
    offset, pending = 0, b""
    for line in subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines():
        opcode, attribute, plain, at, battery, firmware, client = line.split("\t")
        data = bytes.fromhex(plain) + firmware.encode()
        data += bytes([int(battery)]) if battery else struct.pack("<H", int(client, 16)) if client else b""
        handle = int(attribute, 16)
        match int(opcode, 16):
            case 0x0B:
                told.append((AttOperation.READ, handle, data))
            case 0x0C:
                offset = int(at)
            case 0x0D:
                how, of, begun = told.pop()
                assert (how, of, len(begun)) == (AttOperation.READ, handle, offset)
                told.append((how, of, begun + data))
            case 0x12:
                pending = data
            case 0x13:
                told.append((AttOperation.WRITTEN, handle, pending))
            case 0x52:
                told.append((AttOperation.WRITTEN, handle, data))
    return told


def told_to_us(path: Path) -> list[tuple[AttOperation, int, bytes]]:
    values = [item for item in ValueListener(path, pytest.fail).listen() if isinstance(item, Value)]
    return [(value.how, value.attribute, value.data) for value in values if value.how is not AttOperation.NOTIFIED]


@needs_tshark
@pytest.mark.parametrize(("datalink", "mtu"), [(H4, 23), (H1, 185), (MONITOR, 247)])
def test_every_value_that_was_read_or_written_is_what_tshark_says_it_is(tmp_path, datalink, mtu):
    """Short and long values, one that just fills its answer, requests with a response, refused ones, and commands."""
    tag = {0x31: full(0xAA81), 0x34: full(0xAA82), 0x37: full(0xAA83)}
    log = Log(datalink, piece=27)
    log.connect(0x40, LEFT)
    log.mtu(0x40, mtu)
    log.discover(0x40, INSOLE | tag | {0x20: "2a26"})
    for value in (info(), info()[: 2 * (mtu - 1)], bytes(range(mtu - 1)), b"\x01"):
        log.asked(0x40, "0a1500", b"\x0b" + value[: mtu - 1])
        for offset in range(mtu - 1, len(value) + 1, mtu - 1):
            log.asked(0x40, struct.pack("<BHH", 0x0C, INFO, offset).hex(), b"\x0d" + value[offset : offset + mtu - 1])
        log.asked(0x40, "0a2000", b"\x0bv1.2")
        log.asked(0x40, "0a1a00", b"\x0b\x63")
        log.asked(0x40, "12340000ff", "0112340080")
        log.asked(0x40, "1234007f02", "13")
        log.acl(0x40, bytes.fromhex("523700") + b"\x0a", sent=True)
        log.notify(0x40, FRAME, frames()[0][: mtu - 3])
    path = log.save(tmp_path / "phone.log")
    ours = told_to_us(path)
    assert len(ours) == 20 and ours == told_by_tshark(path)


async def snooped_by_bumble(central_log: Path, device_log: Path) -> list[bytes]:
    """A host discovers an emulated insole over bumble's virtual controllers, reads, writes and subscribes; what it
    got. Both hosts keep a log."""
    from bumble.controller import Controller
    from bumble.core import UUID
    from bumble.device import Device, Peer
    from bumble.gatt import Characteristic, Service
    from bumble.hci import Address
    from bumble.host import Host
    from bumble.link import LocalLink
    from bumble.snoop import BtSnooper
    from bumble.transport.common import AsyncPipeSink

    link = LocalLink()
    ends = []
    with central_log.open("wb") as ours, device_log.open("wb") as theirs:
        for name, address, file in (("phone", OTHER, ours), ("insole", LEFT, theirs)):
            controller = Controller(name, link=link)
            host = Host(controller, AsyncPipeSink(controller))
            host.snooper = BtSnooper(file)
            ends.append(Device(name=name, address=Address(address), host=host))
        phone, insole = ends
        properties = Characteristic.Properties
        frame = Characteristic(insole_uuid(2), properties.NOTIFY, 0, b"")
        about = Characteristic(insole_uuid(3), properties.READ, Characteristic.READABLE, info())
        control = Characteristic(insole_uuid(4), properties.WRITE, Characteristic.WRITEABLE, b"")
        battery = Characteristic(UUID("2a19"), properties.NOTIFY | properties.READ, Characteristic.READABLE, b"\x5a")
        insole.add_service(Service(insole_uuid(1), [frame, about, control]))
        insole.add_service(Service(UUID("180f"), [battery]))
        got: list[bytes] = []
        for end in ends:
            await end.power_on()
        for _ in range(2):
            await insole.start_advertising()
            connection = await phone.connect(LEFT)
            peer = Peer(connection)
            await peer.request_mtu(247)
            await peer.discover_services()
            await peer.discover_characteristics()
            (there,) = peer.get_characteristics_by_uuid(frame.uuid)
            (read,) = peer.get_characteristics_by_uuid(about.uuid)
            (written,) = peer.get_characteristics_by_uuid(control.uuid)
            assert await read.read_value() == info()
            await there.subscribe(got.append)
            await written.write_value(b"\x01", with_response=True)
            for data in frames()[:150]:
                await insole.notify_subscribers(frame, data)
                await asyncio.sleep(0)
            while len(got) % 150:
                await asyncio.sleep(0.001)
            await connection.disconnect()
        for end in ends:
            await end.power_off()
    return got


@pytest.fixture(scope="module")
def bumble_logs(tmp_path_factory) -> tuple[Path, Path, list[bytes]]:
    pytest.importorskip("bumble")
    folder = tmp_path_factory.mktemp("bumble")
    central, device = folder / "phone.log", folder / "insole.log"
    got = asyncio.run(asyncio.wait_for(snooped_by_bumble(central, device), 30))
    assert len(got) == 300
    return central, device, got


@needs_tshark
def test_of_real_traffic_of_a_host_every_value_is_what_tshark_says_it_is(bumble_logs):
    for path in bumble_logs[:2]:
        ours = heard_by_us(path)
        assert len(ours) == 300 and ours == heard_by_tshark(path)
        told = told_to_us(path)
        assert (AttOperation.READ, info()) in [(how, data) for how, _, data in told]
        assert told == told_by_tshark(path)


def test_the_log_of_the_host_that_listens_and_of_the_one_that_sends_give_the_same_packets(bumble_logs):
    central, device, got = bumble_logs
    told = []
    for path in (central, device):
        packets = list(open_btsnoop(path, report=pytest.fail))
        assert {(p.device, p.site) for p in packets} == {(LEFT, Site.LEFT_FOOT)}
        told.append([(p.channel, p.data) for p in packets if not p.channel.startswith("receiver/")])
    assert told[0] == told[1]
    assert [data for channel, data in told[0] if channel == "insole/frame"] == got
    assert told[0][:2] == [("insole/info", info()), ("insole/control", b"\x01")], "read over several answers, written"


def test_a_log_gives_a_session_the_walk_and_its_interruption(bumble_logs):
    events = Session().feed(open_btsnoop(bumble_logs[0], report=pytest.fail))
    kinds = [type(event) for event in events]
    assert kinds.count(Connected) == kinds.count(Disconnected) == 2
    assert {event.device for event in events if isinstance(event, Connected)} == {LEFT}


# --- which device, which channel, which site --------------------------------------------------------------------------


def test_a_walk_in_two_insoles_gives_the_same_steps_as_the_walk_itself(tmp_path):
    walk = walks.insoles()
    log = Log()
    handles = {Site.LEFT_FOOT: 0x40, Site.RIGHT_FOOT: 0x41}
    begin(log, 0x40, LEFT)
    begin(log, 0x41, RIGHT)
    for packet in walk.packets:
        if packet.channel == "insole/frame":
            log.notify(handles[packet.site], FRAME, packet.data, t=BEGAN + 1_000_000 + round(packet.t * 1e6))
        elif packet.channel == "insole/info":
            log.asked(handles[packet.site], "0a1500", b"\x0b" + packet.data[:246])
            for offset in range(246, len(packet.data) + 1, 246):
                blob = struct.pack("<BHH", 0x0C, INFO, offset).hex()
                log.asked(handles[packet.site], blob, b"\x0d" + packet.data[offset : offset + 246])
    path = log.save(tmp_path / "phone.log")

    def steps(packets) -> list[tuple[Foot, int, float]]:
        session = Session()
        events = [event for packet in packets for event in session.feed(packet)] + session.finish()
        taken = [event for event in events if isinstance(event, StrideTaken)]
        return [(step.foot, step.number, round(step.length, 2)) for step in taken]

    assert steps(open_btsnoop(path, report=pytest.fail)) == steps(walk.packets) != []


def test_an_insole_says_itself_of_which_foot_it_is_unless_the_caller_knows_better(tmp_path):
    log = begin(Log(), address=LEFT)
    log.notify(0x40, FRAME, frames(Site.RIGHT_FOOT)[0])
    assert {site for _, site, _, _ in read(log, tmp_path)[0]} == {"right_foot"}
    there = {LEFT.lower(): Site.LEFT_FOOT}
    assert {site for _, site, _, _ in read(log, tmp_path, sites=there)[0]} == {"left_foot"}


ORPHE = {0x12: "f3f9c7ce-46ee-4205-89ac-abe64e626c0f", 0x15: "24354f22-1c46-430e-a4ab-a1eeabbcdfc0"}
ORPHE_INFO = bytes([100, 1, *bytes(6), 2, 3, *bytes(10)])
"""Of a right foot; 8 g, 2000 degrees/s."""


def orphe(characteristics: dict[int, str] = ORPHE, info: bytes = ORPHE_INFO) -> Log:
    log = begin(Log(), address=TAG, characteristics=characteristics)
    log.asked(0x40, "0a1500", b"\x0b" + info)
    log.asked(0x40, "1215000d04", "13")
    for k in range(30):
        head = struct.pack(">BHBBBH", 56, k, 1, 1, 1, k * 19)
        log.notify(0x40, 0x12, head + struct.pack(">10h", 16384, *[0] * 6, 4096, 0, 0).ljust(96, b"\0"))
    return log


def test_one_characteristic_is_one_channel_where_it_is_read_and_another_where_it_is_written(tmp_path):
    told = {("", 0x12): "orphe/values", ("", 0x15): "orphe/mode"}
    for discovered, handles in ((ORPHE, {}), ({}, told), ({}, told | {("", 0x15): "orphe/info"})):
        found, reports = read(orphe(discovered), tmp_path, sites={TAG: Site.RIGHT_FOOT}, handles=handles)
        assert data_of(found, "orphe/info", TAG) == [ORPHE_INFO]
        assert data_of(found, "orphe/mode", TAG) == [b"\x0d\x04"]
        assert len(data_of(found, "orphe/values", TAG)) == 30 and reports == []


def test_the_foot_and_the_ranges_of_another_makers_insole_are_those_that_it_says(tmp_path):
    path = orphe().save(tmp_path / "phone.log")
    packets = list(open_btsnoop(path, report=pytest.fail))
    assert {p.site for p in packets} == {Site.RIGHT_FOOT}
    assert not [event for event in Session().feed(packets) if isinstance(event, PacketRejected)]
    decoder = Decoder(Site.RIGHT_FOOT)
    samples = [item for p in packets for item in decoder.feed(p) if isinstance(item, Sample)]
    assert len(samples) > 40
    assert samples[-1].acc == pytest.approx((GRAVITY, 0.0, 0.0)), "4096 counts at 8 g, not at 16"


def test_an_info_that_cannot_be_read_places_no_device(tmp_path):
    with pytest.raises(RecordingError, match=f"30 values of {TAG}, an orphe, left out: nobody says where"):
        read(orphe(info=b"\xff" * 12), tmp_path)


def test_sensortags_share_characteristics_and_are_told_apart_by_the_others(tmp_path):
    old = {0x31: full(0xAA11), 0x34: full(0xAA41), 0x38: full(0xAA51), 0x3B: full(0xAA52)}
    new = {0x31: full(0xAA81), 0x34: full(0xAA82), 0x37: full(0xAA41)}
    log = begin(begin(Log(), 0x40, LEFT, old), 0x41, RIGHT, new)
    log.asked(0x40, "123b0007", "13")
    log.notify(0x40, 0x31, b"\x01\x02\x03")
    log.notify(0x40, 0x34, b"\xb2\xee\xc5\x84")
    log.notify(0x41, 0x31, MOVEMENT)
    log.notify(0x41, 0x37, bytes(6))
    found, reports = read(log, tmp_path, sites={LEFT: Site.LEFT_FOOT, RIGHT: Site.RIGHT_FOOT})
    assert [(site, channel) for _, site, channel, _ in found if not channel.startswith("receiver/")] == [
        ("left_foot", "cc2541/gyroscope-config"),
        ("left_foot", "cc2541/accelerometer"),
        ("left_foot", "cc2541/barometer"),
        ("right_foot", "cc2650/movement"),
        ("right_foot", "cc2650/barometer"),
    ]
    assert reports == []


def test_a_device_whose_place_nobody_knows_is_left_out_and_named(tmp_path):
    log = begin(begin(Log()), 0x41, TAG, {0x31: full(0xAA81)})
    log.notify(0x40, FRAME, frames()[0])
    log.notify(0x41, 0x31, MOVEMENT)
    found, reports = read(log, tmp_path)
    assert {device for device, *_ in found} == {LEFT}
    assert reports == [f"1 value of {TAG}, a cc2650, left out: nobody says where it was worn"]
    alone = begin(Log(), 0x41, TAG, {0x31: full(0xAA81)})
    alone.notify(0x41, 0x31, MOVEMENT)
    with pytest.raises(RecordingError, match=f"holds no packets of a device whose place is known; .*{TAG}, a cc2650"):
        read(alone, tmp_path)


def test_a_site_for_a_device_that_is_not_there_is_refused_with_those_that_are(tmp_path):
    log = begin(Log())
    log.notify(0x40, FRAME, frames()[0])
    with pytest.raises(RecordingError, match=f"holds no device {TAG} .* there is {LEFT}$"):
        read(log, tmp_path, sites={TAG: Site.PELVIS})


def test_other_peoples_devices_are_counted_not_described(tmp_path):
    log = begin(begin(Log()), 0x41, OTHER, {0x10: "2a37", 0x12: "2a19", 0x15: "2a26"})
    log.notify(0x40, FRAME, frames()[0])
    log.notify(0x41, 0x10, b"\x00\x48")
    log.notify(0x41, 0x12, b"\x48")
    found, reports = read(log, tmp_path)
    assert {device for device, *_ in found} == {LEFT}
    assert reports == ["1 other device left out"]


def test_two_devices_at_one_site_are_pointed_out(tmp_path):
    log = begin(begin(Log()), 0x41, RIGHT)
    log.notify(0x40, FRAME, frames()[0])
    log.notify(0x41, FRAME, frames()[0])
    assert read(log, tmp_path)[1] == [f"{LEFT} and {RIGHT} are at the left_foot; a session listens to the first alone"]


@pytest.mark.parametrize("subevent", [0x01, 0x0A, 0x29])
def test_a_connection_is_known_by_any_of_its_three_events(tmp_path, subevent):
    log = Log()
    log.connect(0x40, LEFT, subevent)
    log.mtu(0x40, 247)
    log.discover(0x40, INSOLE)
    log.notify(0x40, FRAME, frames()[0])
    assert data_of(read(log, tmp_path)[0], "insole/frame") == [frames()[0]]


def test_a_connection_that_failed_is_none(tmp_path):
    log = begin(Log())
    log.event(0x3E, struct.pack("<BBHBB", 1, 0x3E, 0x40, 0, 1) + bytes(13))
    log.event(0x05, struct.pack("<BHB", 0x02, 0x40, 0x13))
    log.notify(0x40, FRAME, frames()[0])
    assert data_of(read(log, tmp_path)[0], "insole/frame") == [frames()[0]]


def test_a_handle_is_given_to_another_device_and_what_was_discovered_stays_with_the_first(tmp_path):
    log = begin(Log())
    log.notify(0x40, FRAME, frames()[0])
    log.disconnect(0x40)
    log.connect(0x40, OTHER)
    log.notify(0x40, FRAME, b"not a frame")
    log.disconnect(0x40)
    log.connect(0x40, LEFT)  # phones remember, and do not discover again
    log.notify(0x40, FRAME, frames()[1])
    log.notify(0x40, BATTERY, b"\x42")
    found, reports = read(log, tmp_path)
    assert data_of(found, "insole/frame") == [*frames()[:2]]
    assert data_of(found, "device/battery") == [b"\x42"]
    assert [channel for _, _, channel, _ in found if channel.startswith("receiver/")] == [
        "receiver/connected", "receiver/disconnected", "receiver/connected",
    ]  # fmt: skip
    assert reports == [f"1 value of {OTHER} left out: no discovery says what is 0x0012 (11 bytes)"]


def test_after_a_reset_no_connection_is_left(tmp_path):
    log = begin(Log())
    log.notify(0x40, FRAME, frames()[0])
    log.command(0x0C03)
    log.notify(0x40, 0x77, b"whose is this?")
    found, reports = read(log, tmp_path)
    assert found[-1][2] == "receiver/disconnected"
    assert reports == ["1 value of connection-0x0040 left out: no discovery says what is 0x0077 (14 bytes)"]


def test_adapters_have_handles_of_their_own(tmp_path):
    log = Log(MONITOR)
    for adapter, address in enumerate((LEFT, RIGHT)):
        log.adapter = adapter
        begin(log, 0x40, address)
    for adapter, site in enumerate((Site.LEFT_FOOT, Site.RIGHT_FOOT)):
        log.adapter = adapter
        log.notify(0x40, FRAME, frames(site)[0])
    found = read(log, tmp_path)[0]
    assert data_of(found, "insole/frame", LEFT) == [frames()[0]]
    assert data_of(found, "insole/frame", RIGHT) == [frames(Site.RIGHT_FOOT)[0]]


# --- logs that begin when all was said --------------------------------------------------------------------------------


@pytest.mark.parametrize("payload", [244, 20])
def test_an_insole_is_known_by_its_frames_when_nothing_else_tells(tmp_path, payload):
    """As whole frames, and in fragments of an MTU of 23."""
    log = Log()
    for k, frame in enumerate(frames()[:40]):
        for piece in split(frame, payload, k % 7):
            log.notify(0x40, 0x33, piece)
    found, reports = read(log, tmp_path)
    assert {(device, site, channel) for device, site, channel, _ in found} == {
        ("connection-0x0040", "left_foot", "insole/frame")
    }
    assert len(found) == sum(len(split(frame, payload, 0)) for frame in frames()[:40])
    assert reports == []


def test_one_frame_alone_is_no_proof(tmp_path):
    log = Log()
    log.notify(0x40, 0x33, frames()[0])
    with pytest.raises(RecordingError, match=r"1 value of connection-0x0040 left out: .* is 0x0033 \(172 bytes\)"):
        read(log, tmp_path)


def test_what_cannot_be_known_may_be_told(tmp_path):
    log = Log()
    for _ in range(3):
        log.notify(0x40, 0x2B, MOVEMENT)
        log.notify(0x41, 0x2B, MOVEMENT)
    with pytest.raises(RecordingError, match=r"3 values of connection-0x0040 left out: .*0x002b \(18 bytes\)"):
        read(log, tmp_path)
    sites = {"connection-0x0040": Site.LEFT_FOOT, "connection-0x0041": Site.RIGHT_FOOT}
    for handles in ({("", 0x2B): "cc2650/movement"}, {(name, 0x2B): "cc2650/movement" for name in sites}):
        found, reports = read(log, tmp_path, sites=sites, handles=handles)
        assert [(site, channel) for _, site, channel, _ in found] == [
            ("left_foot", "cc2650/movement"), ("right_foot", "cc2650/movement"),
        ] * 3  # fmt: skip
        assert reports == []
    with pytest.raises(ValueError, match="no device has a channel 'cc2650/moment'"):
        read(log, tmp_path, handles={("", 0x2B): "cc2650/moment"})


def test_what_is_said_of_an_attribute_that_is_not_there_is_refused(tmp_path):
    log = begin(Log())
    log.notify(0x40, FRAME, frames()[0])
    for wish, complaint in (
        ((LEFT.lower(), 0x99), f"holds no value of an attribute 0x0099 of {LEFT}, which was said to be insole/info$"),
        (("", 0x99), "holds no value of an attribute 0x0099, which was said to be insole/info$"),
        ((TAG, FRAME), f"holds no device {TAG}, whose 0x0012 was said to be insole/info$"),
    ):
        with pytest.raises(RecordingError, match=complaint):
            read(log, tmp_path, handles={wish: "insole/info"})


def test_no_word_makes_one_device_or_attribute_of_another(tmp_path):
    """But what discovery says as well may be said, and an attribute that is of no known kind named."""
    log = begin(Log(), characteristics=INSOLE | {0x30: full(0x1234)})
    log.notify(0x40, FRAME, frames()[0])
    log.notify(0x40, 0x30, b"\x63")
    log.notify(0x40, 0x33, b"\x63")
    for address in (LEFT, ""):
        for handle, channel, of in (
            (FRAME, "cc2650/movement", "insole/frame"),
            (FRAME, "device/battery", "insole/frame"),
            (0x33, "cc2650/movement", "of an insole"),
        ):
            complaint = f"{handle:#06x} of {LEFT} is {of}, as its discovery says, not {channel}$"
            with pytest.raises(RecordingError, match=complaint):
                read(log, tmp_path, handles={(address, handle): channel})
    assert len(read(log, tmp_path, handles={("", FRAME): "insole/frame"})[0]) == 2
    wishes = {(LEFT, 0x30): "device/battery", ("", 0x33): "device/battery"}
    assert data_of(read(log, tmp_path, handles=wishes)[0], "device/battery") == [b"\x63"] * 2


def test_what_is_said_of_any_device_counts_for_those_of_which_nothing_is_known(tmp_path):
    log = begin(Log())
    log.notify(0x40, FRAME, frames()[0])
    log.notify(0x41, FRAME, MOVEMENT)
    sites = {"connection-0x0041": Site.PELVIS}
    found, reports = read(log, tmp_path, sites=sites, handles={("", FRAME): "cc2650/movement"})
    assert {(site, channel) for _, site, channel, _ in found} == {
        ("left_foot", "receiver/connected"), ("left_foot", "insole/frame"), ("pelvis", "cc2650/movement"),
    }  # fmt: skip
    assert reports == []


# --- reading and writing ----------------------------------------------------------------------------------------------


def test_a_long_value_is_read_whole_at_any_mtu(tmp_path):
    value = info()
    assert parse_info(value).foot is Foot.LEFT and build_info(parse_info(value)) == value
    for mtu in (23, 185, len(value) + 1):
        log = Log()
        log.connect(0x40, LEFT)
        log.mtu(0x40, mtu)
        log.discover(0x40, INSOLE)
        log.asked(0x40, "0a1500", b"\x0b" + value[: mtu - 1])
        for offset in range(mtu - 1, len(value) + 1, mtu - 1):
            log.asked(0x40, struct.pack("<BHH", 0x0C, INFO, offset).hex(), b"\x0d" + value[offset : offset + mtu - 1])
        log.notify(0x40, FRAME, frames()[0])
        assert data_of(read(log, tmp_path)[0], "insole/info") == [value], mtu


def test_a_value_that_just_fills_the_answer_is_whole_when_nobody_asks_on(tmp_path):
    for after in ("0a1a00", None):
        log = Log()
        log.connect(0x40, LEFT)
        log.discover(0x40, INSOLE | {0x20: "2a26"})
        log.asked(0x40, "0a2000", b"\x0b" + b"v" * 22)
        if after:
            log.asked(0x40, after, b"\x0b\x63")
        log.notify(0x40, FRAME, frames()[0][:20])
        found = read(log, tmp_path, sites={LEFT: Site.LEFT_FOOT})[0]
        assert data_of(found, "device/firmware") == [b"v" * 22]
        assert data_of(found, "device/battery") == ([b"\x63"] if after else [])


def test_the_rest_of_one_value_is_not_added_to_another(tmp_path):
    log = Log()
    log.connect(0x40, LEFT)
    log.discover(0x40, INSOLE | {0x20: "2a26"})
    log.asked(0x40, "0a2000", b"\x0b" + b"v" * 22)
    log.asked(0x40, "0c15001600", b"\x0d" + b"rest")
    log.asked(0x40, "0a2000", b"\x0b" + b"w" * 22)
    log.asked(0x40, "0c20002c00", "010c200007")
    log.notify(0x40, FRAME, frames()[0][:20])
    found = read(log, tmp_path, sites={LEFT: Site.LEFT_FOOT})[0]
    assert data_of(found, "device/firmware") == [b"v" * 22, b"w" * 22]
    assert data_of(found, "insole/info") == []


def test_what_was_written_counts_when_the_device_took_it(tmp_path):
    log = begin(Log(), characteristics={0x31: full(0xAA81), 0x34: full(0xAA82), 0x37: full(0xAA83)})
    log.asked(0x40, "12340000ff", "0112340080")
    log.asked(0x40, "1234007f02", "13")
    log.acl(0x40, bytes.fromhex("523700") + b"\x0a", sent=True)
    log.acl(0x40, bytes.fromhex("123400" + "7f03"), sent=True)  # the link was lost before an answer
    log.notify(0x40, 0x31, MOVEMENT)
    found, reports = read(log, tmp_path, sites={LEFT: Site.LEFT_FOOT})
    assert data_of(found, "cc2650/movement-config") == [b"\x7f\x02"]
    assert data_of(found, "cc2650/movement-period") == [b"\x0a"]
    assert reports == ["writes that were refused: 1"]


def test_other_ways_to_discover_to_read_and_to_notify(tmp_path):
    frame = bytes.fromhex(insole_uuid(2).replace("-", ""))[::-1]
    log = Log()
    log.connect(0x40, LEFT)
    log.mtu(0x40, 247)
    log.asked(0x40, "041200ffff", b"\x05\x02\x12\x00" + frame)  # find information, UUIDs of 128 bits
    log.asked(0x40, "041a00ffff", "05011a00192a1b000229")  # and of 16
    log.asked(0x40, "080100ffff262a", b"\x09\x05\x30\x00" + b"1.2")  # read by the characteristic's UUID
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


# --- what is missing or wrong -----------------------------------------------------------------------------------------


def test_pieces_that_were_not_logged_cost_their_packet_and_are_counted(tmp_path):
    log = begin(Log(piece=50))
    log.notify(0x40, FRAME, frames()[0])
    log.notify(0x40, FRAME, frames()[1], keep=slice(0, 2))  # the end is missing
    log.notify(0x40, FRAME, frames()[2])
    log.notify(0x40, FRAME, frames()[3], keep=slice(1, None))  # the beginning is
    log.notify(0x40, FRAME, frames()[4])
    found, reports = read(log, tmp_path)
    assert data_of(found, "insole/frame") == [frames()[0], frames()[2], frames()[4]]
    assert reports == ["packets of which a piece is missing: 1", "pieces of packets whose beginning is missing: 3"]


def test_packets_of_other_channels_are_counted_where_they_might_have_been_ours(tmp_path):
    log = begin(Log())
    log.notify(0x40, FRAME, frames()[0])
    log.acl(0x40, b"\x0b\x01", sent=False, channel=6)  # pairing
    log.acl(0x40, b"\x1b\x12\0", sent=False, channel=0x41)
    log.acl(0x0B, b"music", sent=True, channel=0x42)  # of a connection that is not LE
    found, reports = read(log, tmp_path)
    assert data_of(found, "insole/frame") == [frames()[0]]
    assert reports == ["packets of channels that are not followed (EATT perhaps): 1"]


def test_records_that_the_logger_cut_short_or_dropped_are_counted(tmp_path):
    log = begin(Log())
    log.notify(0x40, FRAME, frames()[0])
    log.record(2, struct.pack("<HHHHBH", 0x2040, 184, 180, 4, 0x1B, FRAME) + b"\xf5", sent=False, original=189)
    log.drops = 7
    log.notify(0x40, FRAME, frames()[1])
    found, reports = read(log, tmp_path)
    assert data_of(found, "insole/frame") == [*frames()[:2]]
    assert reports == ["records that the logger cut short: 1", "records that the logger says it dropped: 7"]


@given(cut=st.integers(min_value=1, max_value=10_000))
@settings(max_examples=40, deadline=None)
def test_a_torn_tail_costs_one_record_and_is_reported(tmp_path_factory, cut):
    log = begin(Log())
    for frame in frames()[:20]:
        log.notify(0x40, FRAME, frame)
    sizes = [len(record) for record in log.records]
    cut = cut % sum(sizes[-19:])
    path = log.save(tmp_path_factory.mktemp("torn") / "phone.log")
    path.write_bytes(path.read_bytes()[: path.stat().st_size - cut])
    left, whole = sum(sizes) - cut, 0
    while whole < len(sizes) and left >= sizes[whole]:
        left -= sizes[whole]
        whole += 1
    reports: list[str] = []
    packets = [p.data for p in open_btsnoop(path, report=reports.append) if p.channel == "insole/frame"]
    assert packets == [*frames()[: 20 - (len(sizes) - whole)]]
    torn = f"{path}: record {whole + 1}: cut off in the middle; everything before it is used"
    assert reports == ([torn] if left else [])


def test_a_damaged_record_is_named_after_everything_before_it(tmp_path):
    log = begin(Log())
    log.notify(0x40, FRAME, frames()[0])
    number = len(log.records) + 1
    log.records.append(struct.pack(">IIIIq", 5, 0xFFFFFFFF, 1, 0, 0))
    path = log.save(tmp_path / "phone.log")
    packets: list[Packet] = []
    with pytest.raises(RecordingError) as caught:
        packets.extend(open_btsnoop(path, report=pytest.fail))
    del packets[:]
    with pytest.raises(RecordingError):
        for packet in open_btsnoop(path, report=pytest.fail):
            packets.append(packet)
    assert [p.channel for p in packets] == ["receiver/connected", "insole/frame"]
    assert str(caught.value) == f"{path}: record {number}: is damaged: it claims 4294967295 of 5 bytes"


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        (b"", "is empty"),
        (b"btsnoop", "does not begin as a btsnoop log"),
        (b"PK\x03\x04" + bytes(40), "does not begin as a btsnoop log"),
        (b"btsnoop\0" + struct.pack(">II", 2, 1002), "is btsnoop of version 2; this release reads version 1"),
        (
            b"btsnoop\0" + struct.pack(">II", 1, 1003),
            r"is btsnoop of datalink 1003; this release reads 1001 \(H1\), 1002 \(H4\), 2001 \(MONITOR\)",
        ),
        (b"btsnoop\0" + struct.pack(">II", 1, 1002), "holds no packets of a device whose place is known"),
    ],
)
def test_what_is_no_log_of_ours_is_refused(tmp_path, content, complaint):
    path = tmp_path / "phone.log"
    path.write_bytes(content)
    assert is_btsnoop(path) == (content[:8] == b"btsnoop\0")
    with pytest.raises(RecordingError, match=complaint):
        open_btsnoop(path)


def test_a_pipe_is_refused_without_waiting_for_it(tmp_path):
    pipe = tmp_path / "pipe.log"
    os.mkfifo(pipe)
    for use in (is_btsnoop, open_btsnoop):
        with pytest.raises(RecordingError, match="pipe.log: is a pipe or a device; it is read more than once"):
            use(pipe)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(RecordingError, match="none.log: no such file or directory"):
        open_btsnoop(tmp_path / "none.log")


def _eventful() -> Log:
    log = begin(Log(piece=40))
    log.asked(0x40, "0a1500", b"\x0b" + info()[:60])
    log.asked(0x40, "1217000a", "13")
    for frame in frames()[:5]:
        log.notify(0x40, FRAME, frame)
    log.disconnect(0x40)
    log.connect(0x41, TAG, 0x29)
    log.acl(0x41, b"\x52\x10\0abc", sent=False)
    log.acl(0x41, b"\x1b\x10\0abc", sent=True)
    return log


OPCODES = st.sampled_from([op.to_bytes() for op in Op])
SIZES = st.sampled_from([b"", b"\x00", b"\x01", b"\x02", b"\x07", b"\x15", b"\x15\x00", b"\x00\x28", b"\x03\x28"])
PDUS = st.builds(lambda *parts: b"".join(parts), OPCODES, SIZES, SIZES, st.binary(max_size=30)) | st.binary(max_size=30)


@settings(max_examples=200, deadline=None)
@given(
    changes=st.lists(st.tuples(st.integers(0, 10**6), st.integers(1, 255)), max_size=12),
    records=st.lists(
        st.tuples(st.sampled_from((1, 2, 4)), st.binary(max_size=60), st.booleans(), st.integers(0, 10**6)), max_size=6
    ),
    pdus=st.lists(st.tuples(PDUS, st.booleans(), st.integers(0, 10**6)), max_size=20),
    t=st.sampled_from((0, BEGAN, -(2**62), 2**62)),
)
@example(changes=[], records=[], pdus=[], t=2**62)
def test_whatever_bytes_a_log_holds_only_a_recording_error_comes_of_it(tmp_path_factory, changes, records, pdus, t):
    log = _eventful()
    for kind, data, sent, at in records:
        log.record(kind, data, sent)
        log.records.insert(at % len(log.records), log.records.pop())
    for data, sent, at in pdus:
        log.acl(0x40, data, sent, keep=slice(0, 1))
        log.records.insert(at % len(log.records), log.records.pop())
    log.t = t
    log.notify(0x41, 0x10, b"")
    content = bytearray(log.bytes())
    for at, bits in changes:
        content[16 + at % (len(content) - 16)] ^= bits
    path = tmp_path_factory.mktemp("hostile") / "phone.log"
    path.write_bytes(content)
    try:
        found = open_btsnoop(path, sites={}, report=str)
        header = found.header
        assert header["source"] == "btsnoop"
        Session().feed(found)
    except RecordingError as error:
        assert str(error).isprintable()
