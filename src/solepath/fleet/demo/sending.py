"""Transport of a phone's packets to the engine: in bundles, with packets late, repeated or out of order.

A Sending is made once and shared by many wearers, who differ in name, runs and time of walking."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from operator import itemgetter
from random import Random
from typing import Any

from attrs import frozen

from ...link.decoder import Decoder
from ...link.kinds import make_kinds
from ...types import Packet, Sample, Site
from ..events import SentRejection
from ..step.sent import MAX_DATA_LENGTH, End, Tick

LATE_SHARE, MAX_DELAY_ROWS = 0.02, 100
"""Share of the rows that come late, and the largest number of rows that overtake one; less than the fleet's window."""
REPEATED_SHARE, MAX_REPEAT_ROWS = 0.02, 400
"""Share of the rows that come a second time, and the largest number of other rows between the two."""
LOST_ROWS, TOO_LATE_ROWS = 12, 400
"""Number of rows that are lost, and of rows after which one of them arrives; the second exceeds the fleet's window."""
TICK_INTERVAL = 0.25
"""Time without a packet after which a phone sends the time, s."""

DemoPayload = Packet | Tick | End
Row = dict[str, Any]
"""A row of a faulty phone: the columns of protocol/fleet.md with any values."""
INVALID_ROW_SHARE, CHANGED_SHARE = 0.1, 0.5
"""Shares of a faulty phone's packets that become an invalid row, and that become this or get random bytes."""
Item = tuple[int, int, DemoPayload | Row]
"""(index of the phone's run, number, payload)."""


@frozen
class Remark:
    """An expected event of the fleet itself about a row.

    `run` is the index of the phone's run; None for a row without readable run and number. `number` is that of the
    rejected row, or the first missing one. `why` is the reason of a SentRejected or the count of a NumbersMissing."""

    event: str
    run: int | None
    number: int | None
    why: str | int


@frozen(eq=False)
class Sending:
    """The rows of a phone.

    `bundles` holds the items in the order of arrival, one bundle for each period. `ordered` holds the session's input
    in the right order. `remarks` holds the events that the fleet itself must emit."""

    bundles: tuple[tuple[Item, ...], ...]
    ordered: tuple[DemoPayload, ...]
    remarks: tuple[Remark, ...] = ()


def make_sending(packets: Sequence[Packet], every: float, rng: Random, *, runs: int = 1, ends: bool = False) -> Sending:
    """Return the Sending of a walk, in bundles of `every` s.

    `runs` is the number of times that the phone's app was started during the walk. `ends` adds an End."""
    received = [*_add_ticks(packets), *([End()] if ends else [])]
    cuts = [len(received) * k // runs for k in range(runs + 1)]
    arrived: list[Item] = []
    for run in range(runs):
        numbered = list(enumerate(received[cuts[run] : cuts[run + 1]]))
        arrived += [(run, number, payload) for number, payload in _disturb(numbered, rng)]
    return Sending(_make_bundles(arrived, every), tuple(received))


def make_gap(packets: Sequence[Packet], every: float, rng: Random) -> Sending | None:
    """Return the Sending of a walk that loses LOST_ROWS consecutive rows; one of them comes after it was given up.

    Returns None when the walk has too few rows for that."""
    received = list(_add_ticks(packets))
    first = len(received) // 8
    end = first + LOST_ROWS
    if len(received) < end + TOO_LATE_ROWS + MAX_DELAY_ROWS:
        return None
    delivered = _disturb([(n, payload) for n, payload in enumerate(received) if not first <= n < end], rng)
    index = next(k for k, (number, _) in enumerate(delivered) if number >= end + TOO_LATE_ROWS)
    late = rng.randrange(first, end)
    delivered.insert(index, (late, received[late]))
    remarks = (Remark("NumbersMissing", 0, first, LOST_ROWS), Remark("SentRejected", 0, late, SentRejection.LATE.value))
    items = [(0, number, payload) for number, payload in delivered]
    return Sending(_make_bundles(items, every), tuple([*received[:first], *received[end:]]), remarks)


def make_poison(packets: Sequence[Packet], every: float, rng: Random) -> Sending:
    """Return a Sending of a walk with random bytes in many packets, and with invalid rows."""
    received, items, remarks, number = list[DemoPayload](), list[Item](), list[Remark](), 0
    for packet in packets:
        draw = rng.random()
        if draw < INVALID_ROW_SHARE:
            row = _make_bad_row(packet, number, rng)
            is_numbered = row["number"] == number  # other rows have no place in the order
            run, remark_number = (0, number) if is_numbered else (None, None)
            remarks.append(Remark("SentRejected", run, remark_number, SentRejection.UNREADABLE.value))
            number += is_numbered
            items.append((0, number, row))
            continue
        if draw < CHANGED_SHARE:
            site = rng.choice(list(Site))
            data = rng.randbytes(rng.choice((0, 1, 20, 244, MAX_DATA_LENGTH)))
            packet = Packet(packet.t, site, rng.choice((packet.channel, "insole/frame", "\N{SKULL}")), data)
        received.append(packet)
        items.append((0, number, packet))
        number += 1
    return Sending(_make_bundles(items, every), tuple(received), tuple(remarks))


def _make_bad_row(packet: Packet, number: int, rng: Random) -> Row:
    row: Row = {"t": packet.t, "site": packet.site.value, "channel": packet.channel, "data": packet.data}
    faults: tuple[Row, ...] = (
        {"site": "tail"},
        {"data": None},
        {"t": "noon"},
        {"data": bytes(MAX_DATA_LENGTH + 1)},
        {"number": -1},
        {"number": None, "channel": 7},
    )
    return {"number": number, **row, **rng.choice(faults)}


def _add_ticks(packets: Sequence[Packet]) -> Iterator[DemoPayload]:
    """Yield the packets, and a Tick every TICK_INTERVAL while no packet arrives."""
    now = packets[0].t if packets else 0.0
    for packet in packets:
        while packet.t - now > 2 * TICK_INTERVAL:
            now += TICK_INTERVAL
            yield Tick(now)
        now = max(now, packet.t)
        yield packet


def _disturb(sent: Iterable[tuple[int, DemoPayload]], rng: Random) -> list[tuple[int, DemoPayload]]:
    """Return the rows with some of them late, repeated and out of order."""
    placed: list[tuple[float, int, DemoPayload]] = []
    for index, (number, payload) in enumerate(sent):
        delay = rng.uniform(1, MAX_DELAY_ROWS) if rng.random() < LATE_SHARE else 0.0
        placed.append((index + delay, number, payload))
        if rng.random() < REPEATED_SHARE:
            placed.append((index + delay + rng.uniform(0, MAX_REPEAT_ROWS), number, payload))
    return [(number, payload) for _, number, payload in sorted(placed, key=itemgetter(0))]


def _make_bundles(items: Iterable[Item], every: float) -> tuple[tuple[Item, ...], ...]:
    """Return bundles of `every` s by the newest time that arrived; late rows may make the last bundle longer."""
    bundles: list[list[Item]] = [[]]
    due = every
    for item in items:
        payload = item[2]
        t = payload.t if isinstance(payload, Packet | Tick) else 0.0
        while t >= due:
            bundles.append([])
            due += every
        bundles[-1].append(item)
    return tuple(tuple(bundle) for bundle in bundles)


@cache
def count_samples(sending: Sending) -> int:
    """Return the number of samples that links make of the packets of a Sending."""
    kinds, links, count = make_kinds(()), dict[Site, Decoder](), 0
    for packet in sending.ordered:
        if not isinstance(packet, Packet):
            continue
        link = links.setdefault(packet.site, Decoder(packet.site))
        count += sum(isinstance(item, Sample) for item in link.feed(packet, kinds))
    return count + sum(isinstance(item, Sample) for link in links.values() for item in link.finish())
