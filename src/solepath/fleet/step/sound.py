"""Whether what was sent is what a session takes and a state can hold."""

from __future__ import annotations

from math import inf

from ...events.fleet import Refusal
from ...types import Packet, Site
from .order import RejectedItem, What
from .sent import LATEST, LONGEST_DATA, LONGEST_DETAIL, LONGEST_NAME, End, Tick


def is_sound(packet: Packet) -> bool:
    """Goes to a session, and into a state, as it is."""
    return (
        type(packet.t) is float
        and type(packet.site) is Site
        and type(packet.channel) is str
        and type(packet.data) is bytes
        and type(packet.device) is str
        and len(packet.data) <= LONGEST_DATA
        and len(packet.channel) <= LONGEST_NAME
        and len(packet.device) <= LONGEST_NAME
    )


def sound(what: object) -> What:
    """What a session takes and a state can hold, or why not."""
    if isinstance(what, Packet):
        return what if type(what) is Packet and is_sound(what) else _mended(what)
    if isinstance(what, Tick):
        t = _number(what.t)
        if t is None:
            return RejectedItem(Refusal.MALFORMED, "a Tick without a time")
        return Tick(t) if -LATEST <= t <= LATEST else RejectedItem(Refusal.NOT_FINITE, f"a Tick at {t:g} s")
    return (
        End() if isinstance(what, End) else RejectedItem(Refusal.MALFORMED, f"a {type(what).__name__}"[:LONGEST_DETAIL])
    )


def _mended(packet: Packet) -> What:
    """Numbers and bytes of other kinds, and packets of an app's own class, as they are used here."""
    t, data = _number(packet.t), packet.data
    if isinstance(data, bytearray | memoryview):
        data = bytes(data)
    if t is None or not isinstance(data, bytes) or not isinstance(packet.site, Site):
        return RejectedItem(Refusal.MALFORMED, "a packet holds a time, a Site and bytes")
    if not isinstance(packet.channel, str) or not isinstance(packet.device, str):
        return RejectedItem(Refusal.MALFORMED, "a packet names its channel and its device")
    for name, size, most in (
        ("data", len(data), LONGEST_DATA),
        ("channel", len(packet.channel), LONGEST_NAME),
        ("device", len(packet.device), LONGEST_NAME),
    ):
        if size > most:
            return RejectedItem(Refusal.OVERSIZED, f"{name} of {size}; {most} are the most")
    return Packet(t, packet.site, str(packet.channel), bytes(data), str(packet.device))


def _number(value: object) -> float | None:
    """An int may be too large for a float; then it is as good as infinite."""
    if isinstance(value, bool) or not isinstance(value, float | int):
        return None
    try:
        return float(value)
    except OverflowError:
        return inf
