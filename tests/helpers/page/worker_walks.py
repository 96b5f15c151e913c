"""Two insoles that a worker of the site connects and receives, with the values of packets."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from solepath import Packet
from solepath.link.devices.insole import PROFILE as INSOLE
from solepath.link.profile import Access
from solepath.show.web.worker import Worker


def connect(worker: Worker, packets: Sequence[Packet]) -> None:
    """Connect two insoles, whose values are those of the packets; their sites are also their addresses."""
    values = {(packet.site.value, packet.channel): packet.data.hex() for packet in packets}
    characteristics = [[one.service, one.characteristic, one.access is Access.NOTIFY] for one in INSOLE.channels]
    for device in ("left_foot", "right_foot"):
        _send(worker, type="add", device=device)
        answers = _send(worker, type="connected", device=device, t=0.0, characteristics=characteristics)
        while answers:
            channel = answers[-1]["channel"]
            answers = _send(worker, type="done", device=device, t=0.0, value=values.get((device, channel), ""))


def send_frames(worker: Worker, packets: Sequence[Packet], now: float | None = None) -> None:
    """Let the insoles send the frames of the packets, which the worker receives at `now`, s."""
    frames = (packet for packet in packets if packet.channel in INSOLE.streams)
    values = [[one.t, one.site.value, one.channel, one.data.hex()] for one in frames]
    _send(worker, now, type="values", values=values)


def _send(worker: Worker, now: float | None = None, **message: Any) -> Any:
    return json.loads(worker.receive(json.dumps(message), now))
