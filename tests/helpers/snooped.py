"""btsnoop logs made for tests with `struct` alone: the records of connections and attributes that a phone writes."""

from __future__ import annotations

import struct
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

import walks
from attrs import define, field

from solepath import Packet, Site
from solepath.recording.btsnoop import open_btsnoop

EPOCH = 0x00DCDDB30F2F8000
T_START = 1_790_000_000_250_000
"""Start of the logs, us since 1970: 2026-09-21."""
H4, MONITOR = 1002, 2001
LEFT, RIGHT, TAG, OTHER = "C1:00:00:00:00:0A", "C1:00:00:00:00:0B", "C1:00:00:00:00:0C", "C1:00:00:00:00:0D"
COMMAND, ACL, EVENT = 1, 2, 4


@define
class Log:
    """A log; `t` is the time of the last record, us since 1970, and grows by 1 ms with every record."""

    datalink: int = H4
    t: int = T_START
    piece: int = 251
    """Largest number of bytes of L2CAP in one ACL packet."""
    records: list[bytes] = field(factory=list)
    drops: int = 0
    adapter: int = 0

    def record(self, kind: int, data: bytes, sent: bool, original: int | None = None) -> None:
        self.t += 1000
        flags = (0 if sent else 1) | (0 if kind == ACL else 2)
        if self.datalink == H4:
            data = bytes([kind]) + data
        elif self.datalink == MONITOR:
            flags = (
                self.adapter << 16
                | {(COMMAND, True): 2, (EVENT, False): 3, (ACL, True): 4, (ACL, False): 5}[kind, sent]
            )
        size = len(data) if original is None else original
        self.records.append(struct.pack(">IIIIq", size, len(data), flags, self.drops, self.t + EPOCH) + data)

    def event(self, code: int, parameters: bytes) -> None:
        self.record(EVENT, bytes([code, len(parameters)]) + parameters, sent=False)

    def command(self, opcode: int, parameters: bytes = b"") -> None:
        self.record(COMMAND, struct.pack("<HB", opcode, len(parameters)) + parameters, sent=True)

    def connect(self, handle: int, address: str, subevent: int = 0x01) -> None:
        peer = bytes.fromhex(address.replace(":", ""))[::-1]
        start = struct.pack("<BBHBB", subevent, 0, handle, 0, 1) + peer
        own_address = b"" if subevent == 0x01 else bytes(12)
        rest = b"\x00\x01" if subevent == 0x29 else b""
        self.event(0x3E, start + own_address + struct.pack("<HHHB", 12, 0, 500, 0) + rest + (b"\xff" if rest else b""))

    def disconnect(self, handle: int) -> None:
        self.event(0x05, struct.pack("<BHB", 0, handle, 0x08))

    def acl(self, handle: int, pdu: bytes, sent: bool, channel: int = 4, keep: slice = slice(None)) -> None:
        """Log one L2CAP PDU, in pieces if it is long; `keep` selects the logged pieces."""
        frame = struct.pack("<HH", len(pdu), channel) + pdu
        pieces = [frame[k : k + self.piece] for k in range(0, len(frame), self.piece)]
        for k, piece in list(enumerate(pieces))[keep]:
            boundary = 1 if k else (0 if sent else 2)
            self.record(ACL, struct.pack("<HH", handle | boundary << 12, len(piece)) + piece, sent)

    def add_request(self, handle: int, request: str, answer: str | bytes) -> None:
        """Log a request of the host and the answer of the device, as hexadecimal text or bytes."""
        self.acl(handle, bytes.fromhex(request), sent=True)
        self.acl(handle, bytes.fromhex(answer) if isinstance(answer, str) else answer, sent=False)

    def mtu(self, handle: int, mtu: int) -> None:
        encoded = struct.pack("<H", mtu).hex()
        self.add_request(handle, "02" + encoded, "03" + encoded)

    def discover(self, handle: int, characteristics: dict[int, str]) -> None:
        """Log a discovery as hosts do it: by declarations, with an error at the end. Value handle -> UUID."""
        for value, uuid in characteristics.items():
            kind = bytes.fromhex(uuid.replace("-", ""))[::-1]
            declared = struct.pack("<HBH", value - 1, 0x10, value) + kind
            first = struct.pack("<H", value - 1).hex()
            self.add_request(handle, f"08{first}ffff0328", bytes([0x09, len(declared)]) + declared)
        self.add_request(handle, "08f0ffffff0328", "0108f0ff0a")

    def notify(
        self, handle: int, attribute: int, value: bytes, keep: slice = slice(None), t: int | None = None
    ) -> None:
        if t is not None:
            self.t = t - 1000
        self.acl(handle, struct.pack("<BH", 0x1B, attribute) + value, sent=False, keep=keep)

    def bytes(self) -> bytes:
        return b"btsnoop\0" + struct.pack(">II", 1, self.datalink) + b"".join(self.records)

    def save(self, path: Path) -> Path:
        path.write_bytes(self.bytes())
        return path


def insole_uuid(short: int) -> str:
    return f"6016{short:04x}-c8fb-4908-9b03-31fbe15925c4"


INSOLE = {0x12: insole_uuid(2), 0x15: insole_uuid(3), 0x17: insole_uuid(4), 0x1A: "2a19"}
"""UUID of each value handle: frame, INFO, control, battery."""
FRAME, INFO, CONTROL, BATTERY = INSOLE
MOVEMENT = bytes(range(18))


def insoles_log(packets: Iterable[Packet], log: Log | None = None) -> Log:
    """Return a phone's log of two insoles: it finds them, reads their attributes, and receives their frames."""
    log = Log() if log is None else log
    handles = {Site.LEFT_FOOT: 0x40, Site.RIGHT_FOOT: 0x41}
    for handle, address in zip(handles.values(), (LEFT, RIGHT), strict=True):
        log.connect(handle, address)
        log.mtu(handle, 247)
        log.discover(handle, INSOLE)
    frame = next(iter(INSOLE))
    for packet in packets:
        if packet.channel == "insole/frame":
            log.notify(handles[packet.site], frame, packet.data, t=T_START + 1_000_000 + round(packet.t * 1e6))
    return log


@cache
def frames(site: Site = Site.LEFT_FOOT) -> tuple[bytes, ...]:
    return tuple(p.data for p in walks.insoles(cells=96).packets if p.site is site and p.channel == "insole/frame")


@cache
def info() -> bytes:
    return next(
        p.data for p in walks.insoles(cells=96).packets if p.site is Site.LEFT_FOOT and p.channel == "insole/info"
    )


def read(log: Log, tmp_path: Path, **wishes: Any) -> tuple[list[tuple[str, str, str, bytes]], list[str]]:
    """Return (device, site, channel, data) of every packet, and the reports without the file's name."""
    reports: list[str] = []
    path = log.save(tmp_path / "phone.log")
    packets = list(open_btsnoop(path, report=reports.append, **wishes))
    assert [p.t for p in packets] == sorted(p.t for p in packets)
    values = [(p.device, p.site.value, p.channel, p.data) for p in packets]
    return values, [report.removeprefix(f"{path}: ") for report in reports]


def data_of(found: list[tuple[str, str, str, bytes]], channel: str) -> list[bytes]:
    return [data for address, _, name, data in found if (address, name) == (LEFT, channel)]


def start_connection(
    log: Log, handle: int = 0x40, address: str = LEFT, characteristics: dict[int, str] = INSOLE
) -> Log:
    log.connect(handle, address)
    log.mtu(handle, 247)
    log.discover(handle, characteristics)
    return log


def full(short: int) -> str:
    return f"f000{short:04x}-0451-4000-b000-000000000000"
