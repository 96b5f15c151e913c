"""Transport of a phone's packets to the engine: in bundles, with packets late, repeated or out of order.

A Sending is made once and shared by many wearers; only a wearer's name, runs and time of walking are its own."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from operator import itemgetter
from random import Random
from typing import Any

from attrs import frozen

from ...events.fleet import SentRejection
from ...link.decoder import Decoder
from ...link.kinds import make_kinds
from ...types import Packet, Sample, Site
from ..step.sent import LONGEST_DATA, End, Tick

LATE, BEHIND = 0.02, 100
"""Share of the rows that come late, and the largest number of others that may come before one of them.

That number is less than the fleet's window."""
TWICE, AGAIN = 0.02, 400
"""Share of the rows that come a second time, and the largest number of others that may come in between."""
LOST, TOO_LATE = 12, 400
"""Rows that are lost for ever, and the number of rows before one of them arrives after all.

That number is more than the fleet's window."""
TICK_AFTER = 0.25
"""Time without a packet after which a phone sends the time, s."""

DemoPayload = Packet | Tick | End
Row = dict[str, Any]
"""A row of a faulty phone: columns of protocol/fleet.md with any content."""
Item = tuple[int, int, DemoPayload | Row]
"""(run index of the phone, number, content)."""


@frozen
class Remark:
    """An expected event of the fleet itself about something that was sent.

    `run` is the index of the phone's run; None where no place in the order can be read. `number` is that of the
    rejected row, or the first missing one. `why` is the reason of a SentRejected or the count of a NumbersMissing."""

    event: str
    run: int | None
    number: int | None
    why: str | int


@frozen(eq=False)
class Sending:
    """The output of a phone.

    `bundles` holds the items that arrive, one bundle for each period. `ordered` holds the session's input in order.
    `remarks` holds the events that the fleet itself must emit."""

    bundles: tuple[tuple[Item, ...], ...]
    ordered: tuple[DemoPayload, ...]
    remarks: tuple[Remark, ...] = ()


def make_sending(packets: Sequence[Packet], every: float, rng: Random, *, runs: int = 1, ends: bool = False) -> Sending:
    """Return the Sending of a walk, in bundles of `every` s.

    `runs` is the number of times that the phone's app was started meanwhile. `ends` adds that the wearer takes the
    sensors off at last."""
    received = [*_add_ticks(packets), *([End()] if ends else [])]
    cuts = [len(received) * k // runs for k in range(runs + 1)]
    arrived: list[Item] = []
    for run in range(runs):
        numbered = list(enumerate(received[cuts[run] : cuts[run + 1]]))
        arrived += [(run, number, what) for number, what in _disturb(numbered, rng)]
    return Sending(_make_bundles(arrived, every), tuple(received))


def make_gap(packets: Sequence[Packet], every: float, rng: Random) -> Sending | None:
    """Return the Sending of a walk that loses LOST consecutive rows, one of which comes long after it was given up.

    Returns None when too few rows come after them for that."""
    received = list(_add_ticks(packets))
    first = len(received) // 8
    end = first + LOST
    if len(received) < end + TOO_LATE + BEHIND:
        return None
    placed = _disturb([(n, what) for n, what in enumerate(received) if not first <= n < end], rng)
    at = next(place for place, (number, _) in enumerate(placed) if number >= end + TOO_LATE)
    late = rng.randrange(first, end)
    placed.insert(at, (late, received[late]))
    remarks = (Remark("NumbersMissing", 0, first, LOST), Remark("SentRejected", 0, late, SentRejection.LATE.value))
    items = [(0, number, what) for number, what in placed]
    return Sending(_make_bundles(items, every), tuple([*received[:first], *received[end:]]), remarks)


def make_poison(packets: Sequence[Packet], every: float, rng: Random) -> Sending:
    """Return a Sending with random bytes in half of a walk's packets, among invalid rows."""
    received, items, remarks, number = list[DemoPayload](), list[Item](), list[Remark](), 0
    for packet in packets:
        drawn = rng.random()
        if drawn < 0.1:
            row = _make_bad_row(packet, number, rng)
            numbered = row["number"] == number  # others have no place in the order
            run, place = (0, number) if numbered else (None, None)
            remarks.append(Remark("SentRejected", run, place, SentRejection.UNREADABLE.value))
            number += numbered
            items.append((0, number, row))
            continue
        if drawn < 0.5:
            site = rng.choice(list(Site))
            data = rng.randbytes(rng.choice((0, 1, 20, 244, LONGEST_DATA)))
            packet = Packet(packet.t, site, rng.choice((packet.channel, "insole/frame", "\N{SKULL}")), data)
        received.append(packet)
        items.append((0, number, packet))
        number += 1
    return Sending(_make_bundles(items, every), tuple(received), tuple(remarks))


def _make_bad_row(packet: Packet, number: int, rng: Random) -> Row:
    row: Row = {"t": packet.t, "site": packet.site.value, "channel": packet.channel, "data": packet.data}
    wrong: tuple[Row, ...] = (
        {"site": "tail"},
        {"data": None},
        {"t": "noon"},
        {"data": bytes(LONGEST_DATA + 1)},
        {"number": -1},
        {"number": None, "channel": 7},
    )
    return {"number": number, **row, **rng.choice(wrong)}


def _add_ticks(packets: Sequence[Packet]) -> Iterator[DemoPayload]:
    """Yield the packets, and ticks where nothing arrives."""
    now = packets[0].t if packets else 0.0
    for packet in packets:
        while packet.t - now > 2 * TICK_AFTER:
            now += TICK_AFTER
            yield Tick(now)
        now = max(now, packet.t)
        yield packet


def _disturb(sent: Iterable[tuple[int, DemoPayload]], rng: Random) -> list[tuple[int, DemoPayload]]:
    """Return the rows with some of them late, repeated and out of order."""
    placed: list[tuple[float, int, DemoPayload]] = []
    for at, (number, what) in enumerate(sent):
        late = rng.uniform(1, BEHIND) if rng.random() < LATE else 0.0
        placed.append((at + late, number, what))
        if rng.random() < TWICE:
            placed.append((at + late + rng.uniform(0, AGAIN), number, what))
    return [(number, what) for _, number, what in sorted(placed, key=itemgetter(0))]


def _make_bundles(items: Iterable[Item], every: float) -> tuple[tuple[Item, ...], ...]:
    """Return bundles by the newest time that arrived; late rows may make the last bundle longer."""
    found: list[list[Item]] = [[]]
    due = every
    for item in items:
        what = item[2]
        t = what.t if isinstance(what, Packet | Tick) else 0.0
        while t >= due:
            found.append([])
            due += every
        found[-1].append(item)
    return tuple(tuple(bundle) for bundle in found)


@cache
def count_samples(sending: Sending) -> int:
    """Return the number of samples that links make of it."""
    known, links, found = make_kinds(()), dict[Site, Decoder](), 0
    for packet in sending.ordered:
        if not isinstance(packet, Packet):
            continue
        link = links.setdefault(packet.site, Decoder(packet.site))
        found += sum(isinstance(item, Sample) for item in link.feed(packet, known))
    return found + sum(isinstance(item, Sample) for link in links.values() for item in link.finish())
