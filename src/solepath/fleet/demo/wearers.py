"""The wearers of a demonstration: their walks, and what their phones send, late, twice, lost or damaged."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from functools import cache
from math import ceil, pi
from operator import itemgetter
from random import Random
from typing import Any

from attrs import evolve, frozen

from ...emulate.radio import Radio
from ...emulate.routes.route import Route
from ...emulate.sensors.device import Device
from ...emulate.sensors.insole_device import Insole
from ...emulate.sensors.sensortags import CC2541, CC2650
from ...emulate.walk import emulate
from ...link.decoder import Decoder
from ...types import Packet, Sample, Site
from ..rows import sent_line
from ..step.sent import MAX_DATA_LENGTH, Sent

POOR_RADIO = Radio(loss=0.02, duplicate=0.005, corrupt=0.005, truncate=0.005, latency=0.01, jitter=0.03)
"""A poor radio connection: of a hundred notifications two never arrive, and one is damaged."""
WALKING_SPEED = 1.3
"""Walking speed, m/s."""
LARGE_INSOLES = "insoles of 96 cells"
"""Name of the walk of which the demonstration has no wearer, since it would take half its time."""
DEVICES: dict[str, Device] = {
    "insoles": Insole(cells=48),
    "CC2650": CC2650(),
    "CC2541": CC2541(rate=20.0),
    LARGE_INSOLES: Insole(cells=96),
}
"""Device on both feet, by the name of the walk."""
DEMO_WALKS = tuple(name for name in DEVICES if name != LARGE_INSOLES)
LATE_SHARE, MAX_DELAY_ROWS = 0.02, 100
"""Share of the rows that come late, and the largest number of rows that overtake one; less than the fleet's window."""
REPEATED_SHARE, MAX_REPEAT_ROWS = 0.02, 400
"""Share of the rows that come a second time, and the largest number of other rows between the two."""
LOST_ROWS, TOO_LATE_ROWS = 12, 500
"""Number of rows that are lost, and of rows after which one of them arrives; the second exceeds the fleet's window."""
INVALID_ROW_SHARE, CHANGED_SHARE = 0.1, 0.5
"""Shares of a faulty phone's packets that become an invalid row, and that become this or get random bytes."""
POISON_EVERY, GAP_EVERY = 97, 10
"""One wearer in so many sends random bytes (the first is number 3), and loses rows (the first is number 5)."""
FIRST_RUN = 1_790_000_000_000
"""Time at which the first phone was started, ms since 1970; it is the number of a run."""

Item = tuple[int, Packet | dict[str, Any]]
"""Number and packet, or for a faulty phone the columns of protocol/fleet.md with any values."""


@frozen
class DemoPlan:
    """The settings that determine every byte of a demonstration.

    `seconds` is the duration of a walk. `processes` is the number of tasks that Spark runs at a time. `walks` are names
    of walks, of which each wearer has one."""

    wearers: int
    seconds: float
    seed: int = 1
    recipe: str = "default"
    processes: int = 1
    walks: Sequence[str] = DEMO_WALKS


@frozen(eq=False)
class Sending:
    """The rows of a phone, which many wearers share.

    `bundles` holds the items in the order of arrival, one bundle for each second. `ordered` holds the session's input
    in the right order. `remarks` holds the names of the events that the fleet itself must emit."""

    bundles: tuple[tuple[Item, ...], ...]
    ordered: tuple[Packet, ...]
    remarks: tuple[str, ...] = ()


@frozen
class DemoWearer:
    """One wearer; `shift` is added to the times of the walk, s."""

    name: str
    sending: Sending
    shift: float
    run: int

    def bundle(self, number: int) -> bytes:
        """Return the lines that arrive from this wearer in this second."""
        bundles = self.sending.bundles
        return b"".join(map(self._line, bundles[number])) if number < len(bundles) else b""

    def inputs(self) -> list[Packet]:
        """Return the input of this wearer's session, in order."""
        return [self._shifted(packet) for packet in self.sending.ordered]

    def _line(self, item: Item) -> bytes:
        number, what = item
        if isinstance(what, Packet):
            return sent_line(Sent(self.name, number, self._shifted(what), self.run))
        return json.dumps({**what, "wearer": self.name, "run": self.run}).encode() + b"\n"

    def _shifted(self, packet: Packet) -> Packet:
        return evolve(packet, t=packet.t + self.shift)


def make_wearers(plan: DemoPlan) -> list[DemoWearer]:
    """Emulate the walks and return the wearers, the same for the same plan."""
    walks = [walk(name, plan.seconds, plan.seed + number) for number, name in enumerate(plan.walks)]
    rng = Random(f"sendings {plan.seed}")
    makers = (make_healthy, make_poison, make_gap)
    healthy, poisons, gaps = [[make(packets, rng) for packets in walks] for make in makers]
    gaps = [sending for sending in gaps if sending.remarks] or healthy
    wearers = []
    for number in range(plan.wearers):
        rng = Random(f"wearer {plan.seed} {number}")
        kind = poisons if number % POISON_EVERY == 3 else gaps if number % GAP_EVERY == 5 else healthy
        run = FIRST_RUN + rng.randrange(10**8)
        wearers.append(DemoWearer(f"w{number:05d}", rng.choice(kind), rng.uniform(0.0, 1e5), run))
    return wearers


def walk(name: str, seconds: float, seed: int) -> list[Packet]:
    """Return the packets, in arrival order, of the first `seconds` of a walk in laps that starts with standing."""
    route = Route().stand(1.0)
    for _ in range(ceil(WALKING_SPEED * seconds / (6.0 + 1.5 * pi / 2))):
        route = route.walk(6.0, WALKING_SPEED).turn(pi / 2, radius=1.5)
    worn = {site: DEVICES[name] for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT)}
    return [p for p in emulate(route, devices=worn, radio=POOR_RADIO, seed=seed).packets if p.t < seconds]


def make_healthy(packets: Sequence[Packet], rng: Random) -> Sending:
    """Return the Sending of a walk with rows that come late, twice and out of order."""
    return Sending(_make_bundles(_disturb([*enumerate(packets)], rng)), tuple(packets))


def make_gap(packets: Sequence[Packet], rng: Random) -> Sending:
    """Return the Sending of a walk that loses LOST_ROWS consecutive rows; one of them comes after it was given up.

    A walk with too few rows for that loses none."""
    first = len(packets) // 8
    lost = [*enumerate(packets)][first : first + LOST_ROWS]
    kept = [item for item in enumerate(packets) if item not in lost]
    *bundles, last = _make_bundles(_disturb(kept, rng))
    # the engine may use the rows of a bundle in any order, so the late row comes in a later bundle
    if sum(map(len, bundles)) < first + LOST_ROWS + TOO_LATE_ROWS:
        return make_healthy(packets, rng)
    late = rng.choice(lost)
    ordered = tuple([packet for _, packet in kept])
    return Sending((*bundles, (*last, late)), ordered, ("NumbersMissing", "SentRejected"))


def make_poison(packets: Sequence[Packet], rng: Random) -> Sending:
    """Return a Sending of a walk with random bytes in many packets, and with invalid rows."""
    items = list[Item]()
    for number, packet in enumerate(packets):
        what: Packet | dict[str, Any] = packet
        draw = rng.random()
        if draw < INVALID_ROW_SHARE:
            what = {"number": number, "t": packet.t, "site": "tail", "channel": packet.channel}
        elif draw < CHANGED_SHARE:
            data = rng.randbytes(rng.choice((0, 1, 20, 244, MAX_DATA_LENGTH)))
            what = Packet(packet.t, rng.choice(list(Site)), rng.choice((packet.channel, "\N{SKULL}")), data)
        items.append((number, what))
    received = tuple([what for _, what in items if isinstance(what, Packet)])
    return Sending(_make_bundles(items), received, ("SentRejected",) * (len(items) - len(received)))


def _disturb(sent: Iterable[Item], rng: Random) -> list[Item]:
    """Return the rows with some of them late, repeated and out of order."""
    placed: list[tuple[float, Item]] = []
    for index, item in enumerate(sent):
        delay = rng.uniform(1, MAX_DELAY_ROWS) if rng.random() < LATE_SHARE else 0.0
        placed.append((index + delay, item))
        if rng.random() < REPEATED_SHARE:
            placed.append((index + delay + rng.uniform(0, MAX_REPEAT_ROWS), item))
    return [item for _, item in sorted(placed, key=itemgetter(0))]


def _make_bundles(items: Iterable[Item]) -> tuple[tuple[Item, ...], ...]:
    """Return bundles of a second by the newest time that arrived; late rows may make the last bundle longer."""
    bundles: list[list[Item]] = [[]]
    for item in items:
        while isinstance(item[1], Packet) and item[1].t >= len(bundles):
            bundles.append([])
        bundles[-1].append(item)
    return tuple(map(tuple, bundles))


@cache
def count_samples(sending: Sending) -> int:
    """Return the number of samples that links make of the packets."""
    links = {site: Decoder(site) for site in Site}
    outputs = [links[packet.site].feed(packet) for packet in sending.ordered]
    outputs += [link.finish() for link in links.values()]
    return sum(isinstance(item, Sample) for output in outputs for item in output)
