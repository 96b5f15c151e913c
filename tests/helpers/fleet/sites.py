"""Wearers of one site as their phones send, all at once, and the events of each one's session."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache
from random import Random
from typing import Any

from fleets import walked

from solepath.events import Event
from solepath.fleet import Sent
from solepath.session import Session
from solepath.types import Packet, Site

Keyed = tuple[str, Any]


@cache
def site() -> tuple[tuple[Keyed, ...], Mapping[str, list[Event]]]:
    """What is sent, keyed by wearer, and each wearer's events. All walk as one did over a bad radio, but "late" begins
    to send later and "limping" wears one insole; only "whole" takes the sensors off in the end."""
    packets = [one.what for one in walked().sent if isinstance(one.what, Packet)]
    inputs = {"late": packets[300:], "limping": [packet for packet in packets if packet.site is Site.LEFT_FOOT]}
    sent = {wearer: [Sent(wearer, n, packet) for n, packet in enumerate(inputs[wearer])] for wearer in inputs}
    events = {wearer: Session().feed(inputs[wearer]) for wearer in inputs}
    sent["whole"] = [Sent("whole", one.number, one.what) for one in walked().sent]
    session = Session()
    events["whole"] = session.feed(packets) + session.finish()
    return mixed(sent), events


def mixed(sent: Mapping[str, Iterable[Any]]) -> tuple[Keyed, ...]:
    """All of them by turns, each in its own order."""
    left = {wearer: list(items)[::-1] for wearer, items in sent.items()}
    chance, out = Random(8), []
    while any(left.values()):
        (wearer,) = chance.choices(list(left), [len(items) for items in left.values()])
        out.append((wearer, left[wearer].pop()))
    return tuple(out)
