"""The records of a log (snooped.py) as other programs capture them: PacketLogger, pcap, pcapng, a bug report."""

from __future__ import annotations

import struct
import zipfile
from collections.abc import Iterator, Mapping
from pathlib import Path

from snooped import ACL, COMMAND, EPOCH, EVENT, Log

PKLG_TYPES = {(COMMAND, True): 0, (EVENT, False): 1, (ACL, True): 2, (ACL, False): 3}
MONITOR_OPCODES = {(COMMAND, True): 2, (EVENT, False): 3, (ACL, True): 4, (ACL, False): 5}
H4, PHDR, MONITOR = 187, 201, 254


def records(log: Log) -> Iterator[tuple[int, bool, bytes, int]]:
    """Yield time (us since 1970), direction, H4 packet and original size of each record of an H4 log."""
    for record in log.records:
        size, _, flags, _, t = struct.unpack(">IIIIq", record[:24])
        yield t - EPOCH, not flags & 1, record[24:], size


def wrapped(link: int, sent: bool, packet: bytes) -> bytes:
    """Return an H4 packet as a capture of this link type has it."""
    if link == PHDR:
        return struct.pack(">I", not sent) + packet
    if link == MONITOR:
        return struct.pack(">HH", 0, MONITOR_OPCODES[packet[0], sent]) + packet[1:]
    return packet


def pklg(log: Log, order: str = ">") -> bytes:
    """Return the log as PacketLogger saves it, with a note at its start as every one of its files has."""
    notes = struct.pack(f"{order}IIIB", 14, 1_790_000_000, 0, 0xFC) + b"hello"
    return notes + b"".join(
        struct.pack(f"{order}IIIB", 8 + len(packet), *divmod(t, 1_000_000), PKLG_TYPES[packet[0], sent]) + packet[1:]
        for t, sent, packet, _ in records(log)
    )


def pcap(log: Log, link: int = H4, order: str = "<", nano: bool = False, snap: int = 65_535) -> bytes:
    data = [struct.pack(f"{order}IHHiIII", 0xA1B23C4D if nano else 0xA1B2C3D4, 2, 4, 0, 0, snap, link)]
    for t, sent, packet, size in records(log):
        whole = wrapped(link, sent, packet)
        seconds, micro = divmod(t, 1_000_000)
        fraction = 1000 * micro if nano else micro
        kept = whole[:snap]
        data.append(struct.pack(f"{order}IIII", seconds, fraction, len(kept), size + len(whole) - len(packet)) + kept)
    return b"".join(data)


def block(order: str, kind: int, body: bytes) -> bytes:
    body += bytes(-len(body) % 4)
    return struct.pack(f"{order}II", kind, 12 + len(body)) + body + struct.pack(f"{order}I", 12 + len(body))


def option(order: str, code: int, value: bytes) -> bytes:
    return struct.pack(f"{order}HH", code, len(value)) + value + bytes(-len(value) % 4)


def pcapng(log: Log, link: int = H4, order: str = "<", exponent: int = 6, flags: bool = False) -> bytes:
    """Return the log as pcapng, after a network interface with a packet of its own, as Wireshark saves several."""
    end = option(order, 0, b"")
    data = [block(order, 0x0A0D0D0A, struct.pack(f"{order}IHHq", 0x1A2B3C4D, 1, 0, -1))]
    data.append(block(order, 1, struct.pack(f"{order}HHI", 1, 0, 0)))
    resolution = option(order, 9, bytes([exponent])) + end
    data.append(block(order, 1, struct.pack(f"{order}HHI", link, 0, 0) + resolution))
    data.append(block(order, 6, struct.pack(f"{order}5I", 0, 0, 0, 4, 4) + b"ping"))
    data.append(block(order, 5, bytes(12)))  # statistics
    for t, sent, packet, size in records(log):
        whole = wrapped(link, sent, packet)
        ticks = t * 10**exponent // 1_000_000
        head = struct.pack(
            f"{order}5I", 1, ticks >> 32, ticks & 0xFFFFFFFF, len(whole), size + len(whole) - len(packet)
        )
        direction = option(order, 2, struct.pack(f"{order}I", 2 if sent else 1)) + end if flags else b""
        data.append(block(order, 6, head + whole + bytes(-len(whole) % 4) + direction))
    return b"".join(data)


def bug_report(path: Path, logs: Mapping[str, bytes]) -> Path:
    """Write a bug report of an Android phone with these logs in it."""
    others = {"main_entry.txt": b"bugreport.txt", "bugreport-x-2026.txt": b"== dumpstate", "FS/data/anr/anr_0": b"--"}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in {**others, **logs}.items():
            archive.writestr(name, data)
    return path
