"""Events from the packets in which the receiver reports on connections and on itself (protocol/receiver.md)."""

from __future__ import annotations

from ..events import (
    Connected,
    Disconnected,
    LinkEvent,
    LinkTrouble,
    PacketsDropped,
    PositionReported,
    Rejection,
    StreamRestarted,
)
from ..types import Packet, Site
from ..wire.error import WireError
from ..wire.fields import parse_text
from ..wire.receiver import PositionFrame, parse_connected, parse_dropped, parse_nothing, parse_position


def parse_receiver_event(packet: Packet) -> list[LinkEvent]:
    """Return the event of a packet of a channel receiver/...; a tick has none.

    A tick only lets time pass while no device sends. WireError when the packet cannot be used."""
    t, site = packet.t, packet.site
    match packet.channel:
        case "receiver/tick":
            parse_nothing(packet.data)
            return []
        case "receiver/connected":
            connection = parse_connected(packet.data)
            return [Connected(t=t, site=site, device=packet.device, name=connection.name, signal=connection.signal)]
        case "receiver/disconnected":
            parse_nothing(packet.data)
            return [Disconnected(t=t, site=site)]
        case "receiver/dropped":
            return [PacketsDropped(t=t, site=site, count=parse_dropped(packet.data))]
        case "receiver/restarted":
            return [StreamRestarted(t=t, site=site, channel=parse_text(packet.data))]
        case "receiver/position":
            return [reported_position(parse_position(packet.data), t, site)]
        case "receiver/trouble":
            return [LinkTrouble(t=t, site=site, what=parse_text(packet.data))]
    raise WireError(Rejection.UNKNOWN_CHANNEL, f"no channel {packet.channel!r}")


def reported_position(frame: PositionFrame, t: float, site: Site) -> PositionReported:
    """Return the event of a position that a person reports at `t`, s."""
    return PositionReported(
        t=t, site=site, position=frame.position, place=frame.place, level=frame.level, sigma=frame.sigma
    )
