"""Formats of captures: btsnoop, PacketLogger of Apple, pcap and pcapng. Each is a function that yields its records.

btsnoop is that of RFC 1761 with other datalinks, as Symbian, BlueZ and Android write it; pcap and pcapng are those of
draft-ietf-opsawg-pcap and -pcapng, with link types of tcpdump.org; PacketLogger (.pklg) is as Wireshark reads it
(wiretap/packetlogger.c), in either byte order."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import BinaryIO

from attrs import frozen

H4, PHDR, MONITOR = 187, 201, 254
"""Link types of HCI: its packets alone, after their direction, and as BlueZ's monitor has them."""
READ_LINKS = {H4, PHDR, MONITOR}
"""Link types that are read."""
NAMED_LINKS = {
    1: " (Ethernet)",
    189: " (USB)",
    220: " (USB)",
    249: " (USB)",
    251: " (a sniffer: Bluetooth LE on the air)",
    256: " (a sniffer such as Ubertooth: Bluetooth LE on the air)",
    272: " (an nRF Sniffer: Bluetooth LE on the air)",
}
"""What the link types are that people take for HCI."""
TIME_OF_1970 = 0x00DCDDB30F2F8000
"""Time of the start of 1970, us; btsnoop counts from the start of the year 0."""
MAX_PACKET = 0x1_0000 + 64
"""Largest size of the packet in a record, bytes: 65,535 bytes of ACL data, with room for the headers before them."""
MAX_BLOCK = 16_000_000
"""Largest size of a block of a pcapng file, bytes."""
LONGEST_MAGIC = 16
"""Number of bytes by which a capture is recognised."""
MICRO = 1_000_000
BTSNOOP, PCAPNG = b"btsnoop\0", b"\x0a\x0d\x0d\x0a"
PCAP = {
    b"\xa1\xb2\xc3\xd4": (">", 1),
    b"\xd4\xc3\xb2\xa1": ("<", 1),
    b"\xa1\xb2\x3c\x4d": (">", 1000),
    b"\x4d\x3c\xb2\xa1": ("<", 1000),
}
"""Byte order of a pcap file, and parts of a microsecond that its times have, by its first bytes."""
PKLG = {0: (1, True), 1: (4, False), 2: (2, True), 3: (2, False)}
"""First byte of the H4 packet, and True if the host sent it, by the type of a PacketLogger record."""
PKLG_OTHERS = {8, 9, 10, 11, *range(0xF0, 0x100)}
"""Types of its records that are no packets: voice, messages of the radio, notes of the system."""


@frozen
class Captured:
    """A record of a capture."""

    t: int
    """Time, us since 1970."""
    link: int
    """Link type."""
    data: bytes
    size: int
    """Size of the packet, bytes, of which the capture may have the start only."""
    sent: bool | None = None
    """True if the host sent it; None if the record does not say it."""
    drops: int = 0
    """Number of records that the logger says it dropped so far."""


class DamageError(Exception):
    """Error for a record that cannot be one."""


class UnreadError(Exception):
    """Error for a capture of a version that is not read."""


def is_capture(start: bytes) -> bool:
    """Return whether a file that starts with these bytes is a capture."""
    return start.startswith((BTSNOOP, PCAPNG, *PCAP)) or _order_of_pklg(start) != ""


def read_capture(file: BinaryIO) -> Iterator[Captured]:
    """Yield the records of a capture. EOFError at one that is cut off, DamageError at one that cannot be.

    UnreadError for a version that is not read."""
    start = _take(file, 4)
    if start == BTSNOOP[:4]:
        return _read_btsnoop(file)
    if start == PCAPNG:
        return _read_pcapng(file)
    return _read_pcap(file, *PCAP[start]) if start in PCAP else _read_pklg(file, start)


def _take(file: BinaryIO, size: int) -> bytes:
    data = file.read(size)
    if len(data) < size:
        raise EOFError
    return data


def _packet(file: BinaryIO, included: int, size: int) -> bytes:
    if included > min(MAX_PACKET, size):
        raise DamageError(f"it claims {included} of {size} bytes")
    return _take(file, included)


def _read_btsnoop(file: BinaryIO) -> Iterator[Captured]:
    _, version, datalink = struct.unpack(">4sII", _take(file, 12))
    links = {1002: H4, 2001: MONITOR}
    if version != 1 or datalink not in links:
        readable = "1002 (H4), 2001 (MONITOR), version 1"
        raise UnreadError(f"is btsnoop of datalink {datalink}, version {version}; this release reads {readable}")
    while head := file.read(24):
        if len(head) < 24:
            raise EOFError
        size, included, flags, drops, t = struct.unpack(">IIIIq", head)
        data, sent = _packet(file, included, size), not flags & 1
        if datalink == 2001:  # adapter and opcode are before the packet in other captures
            data, size = struct.pack(">I", flags) + data, size + 4
        yield Captured(t - TIME_OF_1970, links[datalink], data, size, sent, drops)


def _order_of_pklg(start: bytes) -> str:
    """Return the byte order of a PacketLogger file by the start of its first record, as struct has it; "" for none."""
    if len(start) < 13:
        return ""
    for order in ">", "<":
        size, _, micro = struct.unpack(f"{order}III", start[:12])
        if 9 <= size < MAX_PACKET and micro < MICRO and start[12] in PKLG.keys() | PKLG_OTHERS:
            return order
    return ""


def _read_pklg(file: BinaryIO, head: bytes) -> Iterator[Captured]:
    order = "<" if head[:2] != b"\0\0" else ">"
    while head:
        size, seconds, micro = struct.unpack(f"{order}III", head + _take(file, 12 - len(head)))
        if not 8 < size < MAX_PACKET:
            raise DamageError(f"it claims {size} bytes")
        kind, data = _take(file, 1)[0], _take(file, size - 9)
        h4, sent = PKLG.get(kind, (0, False))
        # the record does not say how long the packet was, but the packet itself does
        whole = 4 + int.from_bytes(data[2:4], "little") if h4 == 2 else 0
        yield Captured(seconds * MICRO + micro, H4, bytes([h4]) + data, 1 + max(whole, len(data)), sent)
        head = file.read(4)


def _read_pcap(file: BinaryIO, order: str, parts: int) -> Iterator[Captured]:
    *_, link = struct.unpack(f"{order}HHiIII", _take(file, 20))
    while head := file.read(16):
        if len(head) < 16:
            raise EOFError
        seconds, fraction, included, size = struct.unpack(f"{order}IIII", head)
        yield Captured(seconds * MICRO + fraction // parts, link & 0xFFFF, _packet(file, included, size), size)


@frozen
class _Interface:
    link: int
    resolution: int = MICRO
    """Parts of a second that its times have."""
    offset: int = 0
    """Time to add, s."""


def _read_pcapng(file: BinaryIO) -> Iterator[Captured]:
    order, interfaces = "<", list[_Interface]()
    kind, head = PCAPNG, file.read(4)
    while head:
        if kind == PCAPNG:  # a section, which says its byte order
            magic = _take(file, 4)
            order, interfaces = "<" if magic == b"\x4d\x3c\x2b\x1a" else ">", []
            head += magic
        (size,) = struct.unpack(f"{order}I", head[:4])
        if size % 4 or not 12 <= size <= MAX_BLOCK:
            raise DamageError(f"it claims {size} bytes")
        body = _take(file, size - 4 - len(head))[:-4]
        (number,) = struct.unpack(f"{order}I", kind)
        if number == 1:
            interfaces.append(_interface(order, body))
        elif number == 6:
            yield _enhanced(order, body, interfaces)
        kind = file.read(4)
        head = _take(file, 4) if kind else b""


def _options(order: str, body: bytes) -> dict[int, bytes]:
    options: dict[int, bytes] = {}
    while len(body) >= 4:
        code, size = struct.unpack(f"{order}HH", body[:4])
        options[code] = body[4 : 4 + size]
        body = body[4 + (size + 3) // 4 * 4 :]
    return options


def _interface(order: str, body: bytes) -> _Interface:
    (link,) = struct.unpack(f"{order}H", body[:2])
    options = _options(order, body[8:])
    exponent = options.get(9, b"\6")[0]
    offset = int.from_bytes(options.get(14, b""), "little" if order == "<" else "big", signed=True)
    return _Interface(link, 2 ** (exponent & 0x7F) if exponent & 0x80 else 10**exponent, offset)


def _enhanced(order: str, body: bytes, interfaces: list[_Interface]) -> Captured:
    number, high, low, included, size = struct.unpack(f"{order}5I", body[:20])
    if number >= len(interfaces) or included > len(body) - 20:
        raise DamageError(f"it claims {included} bytes of interface {number}")
    one = interfaces[number]
    flags = _options(order, body[20 + (included + 3) // 4 * 4 :]).get(2, b"")
    direction = int.from_bytes(flags, "little" if order == "<" else "big") & 3
    t = (high << 32 | low) * MICRO // one.resolution + one.offset * MICRO
    return Captured(t, one.link, body[20 : 20 + included], size, {1: False, 2: True}.get(direction))
