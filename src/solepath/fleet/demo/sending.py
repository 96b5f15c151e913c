"""How what a phone heard reaches the engine: in bundles, with packets that come late, twice or out of order.

A Sending is made once and shared by many wearers: a wearer's own are its name, its runs and when it walked.
"""

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
"""Share of what is sent that comes late, and how many others may come before it: fewer than the fleet's window."""
TWICE, AGAIN = 0.02, 400
"""The same of what comes a second time."""
LOST, TOO_LATE = 12, 400
"""Rows that are lost for good, and how many may come before one of them comes after all: more than the window."""
QUIET = 0.25
"""s without a packet after which a phone says what time it is."""

What = Packet | Tick | End
Row = dict[str, Any]
"""What a phone out of its mind sends: columns of protocol/fleet.md with anything in them."""
Item = tuple[int, int, What | Row]
"""(which run of the phone, number, what)."""


@frozen
class Remark:
    """What only a fleet is to say of something that was sent. `run`: which of the phone; None where no place in the
    order can be read. `number`: of what is refused, or the first that is missing. `why`: the reason of a SentRejected,
    the count of a NumbersMissing."""

    event: str
    run: int | None
    number: int | None
    why: str | int


@frozen(eq=False)
class Sending:
    """`bundles`: what arrives, one for each piece of time. `ordered`: what the session is to hear of it, in order.
    `remarks`: what the fleet is to say beside."""

    bundles: tuple[tuple[Item, ...], ...]
    ordered: tuple[What, ...]
    remarks: tuple[Remark, ...] = ()


def sending(packets: Sequence[Packet], every: float, rng: Random, *, runs: int = 1, ends: bool = False) -> Sending:
    """Of a walk, in bundles of `every` s. `runs`: how often the phone's app was started meanwhile. `ends`: the wearer
    takes the sensors off at last."""
    heard = [*_with_ticks(packets), *([End()] if ends else [])]
    cuts = [len(heard) * k // runs for k in range(runs + 1)]
    arrived: list[Item] = []
    for run in range(runs):
        numbered = list(enumerate(heard[cuts[run] : cuts[run + 1]]))
        arrived += [(run, number, what) for number, what in _disturbed(numbered, rng)]
    return Sending(_bundles(arrived, every), tuple(heard))


def gap(packets: Sequence[Packet], every: float, rng: Random) -> Sending | None:
    """Of a walk of which LOST rows in a row never come, but for one of them, long after it was given up. None where too
    little comes after them for that."""
    heard = list(_with_ticks(packets))
    first = len(heard) // 8
    end = first + LOST
    if len(heard) < end + TOO_LATE + BEHIND:
        return None
    placed = _disturbed([(n, what) for n, what in enumerate(heard) if not first <= n < end], rng)
    at = next(place for place, (number, _) in enumerate(placed) if number >= end + TOO_LATE)
    late = rng.randrange(first, end)
    placed.insert(at, (late, heard[late]))
    remarks = (Remark("NumbersMissing", 0, first, LOST), Remark("SentRejected", 0, late, SentRejection.LATE.value))
    items = [(0, number, what) for number, what in placed]
    return Sending(_bundles(items, every), tuple([*heard[:first], *heard[end:]]), remarks)


def poison(packets: Sequence[Packet], every: float, rng: Random) -> Sending:
    """Any bytes instead of half of a walk's, among rows that are none."""
    heard, items, remarks, number = list[What](), list[Item](), list[Remark](), 0
    for packet in packets:
        drawn = rng.random()
        if drawn < 0.1:
            row = _no_row(packet, number, rng)
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
        heard.append(packet)
        items.append((0, number, packet))
        number += 1
    return Sending(_bundles(items, every), tuple(heard), tuple(remarks))


def _no_row(packet: Packet, number: int, rng: Random) -> Row:
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


def _with_ticks(packets: Sequence[Packet]) -> Iterator[What]:
    """What was heard, and what time it was where nothing was."""
    now = packets[0].t if packets else 0.0
    for packet in packets:
        while packet.t - now > 2 * QUIET:
            now += QUIET
            yield Tick(now)
        now = max(now, packet.t)
        yield packet


def _disturbed(sent: Iterable[tuple[int, What]], rng: Random) -> list[tuple[int, What]]:
    """Late, twice and out of order."""
    placed: list[tuple[float, int, What]] = []
    for at, (number, what) in enumerate(sent):
        late = rng.uniform(1, BEHIND) if rng.random() < LATE else 0.0
        placed.append((at + late, number, what))
        if rng.random() < TWICE:
            placed.append((at + late + rng.uniform(0, AGAIN), number, what))
    return [(number, what) for _, number, what in sorted(placed, key=itemgetter(0))]


def _bundles(items: Iterable[Item], every: float) -> tuple[tuple[Item, ...], ...]:
    """What arrives by the clock of the newest that arrived; the last bundle may be long by what came late."""
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
def samples_of(sending: Sending) -> int:
    """How many samples links make of it."""
    known, links, found = make_kinds(()), dict[Site, Decoder](), 0
    for packet in sending.ordered:
        if not isinstance(packet, Packet):
            continue
        link = links.setdefault(packet.site, Decoder(packet.site))
        found += sum(isinstance(item, Sample) for item in link.feed(packet, known))
    return found + sum(isinstance(item, Sample) for link in links.values() for item in link.finish())
