"""The wearers of a demonstration: their walks, times and transport to the engine, the same in every process.

A stage is a directory with `plan.json` and the shared walks as recordings. Every process of a demonstration reads it,
so that none has to emulate anything, and what one wearer sends is the same for all."""

from __future__ import annotations

import json
from itertools import chain
from math import pi
from pathlib import Path
from random import Random

from attrs import asdict, define, evolve, frozen

from ...emulate.radio import Radio
from ...emulate.routes.route import Route
from ...emulate.sensors.device import Device
from ...emulate.sensors.insole_device import Insole
from ...emulate.sensors.sensortags import CC2541, CC2650
from ...emulate.walk import emulate
from ...recipes import Recipe, by_name
from ...recording import PacketWriter, read_packets
from ...types import Packet, Site
from ..rows import read_sent
from ..step.sent import Sent, Tick, Unreadable
from .sending import DemoPayload, Item, Remark, Sending, count_samples, make_gap, make_poison, make_sending

ROUGH = Radio(loss=0.02, duplicate=0.005, corrupt=0.005, truncate=0.005, latency=0.01, jitter=0.03)
"""A poor radio: of a hundred notifications two never arrive, and one is damaged."""
SPEED = 1.3
"""Walking speed, m/s."""
DEVICES: dict[str, Device] = {
    "insoles": Insole(cells=48),
    "insoles in fragments": Insole(cells=24, rate=50.0, mtu=23),
    "insoles with broken cells": Insole(cells=35, batch=4, quaternion=True, broken=((5, 0), (6, 4095))),
    "insoles out of reach": Insole(cells=48, rate=50.0),
    "CC2650": CC2650(presses=(2.0,)),
    "CC2541": CC2541(rate=20.0),
}
"""Device on both feet, by the name of the walk."""
SILENT = "insoles out of reach"
"""The walk in which nothing arrives for some time."""
SILENCE = (0.5, 0.65)
"""Start and end of that silence, as shares of the walk."""


def walk(name: str, seconds: float, seed: int) -> list[Packet]:
    """Return the packets of the first `seconds` of a walk in laps that starts with a stand, in arrival order."""
    route, length = Route().stand(1.0), 0.0
    while length < SPEED * seconds:
        route = route.walk(6.0, SPEED).turn(pi / 2, radius=1.5)
        length += 6.0 + 1.5 * pi / 2
    worn = {site: DEVICES[name] for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT)}
    received = [packet for packet in emulate(route, devices=worn, radio=ROUGH, seed=seed).packets if packet.t < seconds]
    if name == SILENT:
        start, end = (share * seconds for share in SILENCE)
        received = [packet for packet in received if not start <= packet.t < end]
    return received


POISONED = 97
"""One wearer in this many sends random bytes, the fourth first."""
GAPPED = 10
"""One wearer in this many loses some of its rows for ever, the sixth first."""
FIRST_RUN = 1_790_000_000_000
"""Time at which the phones were started, ms."""


@frozen
class DemoPlan:
    """Settings that determine every byte of a demonstration.

    `seconds` is the duration of walking. `bundle` is the time of walking that a phone sends at once, s. `parts` is the
    number of partitions of the source and of the files, and of processes. `every` is the time between two snapshots, s;
    None chooses it to suit the run."""

    wearers: int
    seconds: float
    seed: int = 1
    recipe: str = "default"
    parts: int = 1
    bundle: float = 1.0
    every: float | None = None


def prepare(stage: Path, plan: DemoPlan) -> None:
    """Emulate the walks and write them and the plan into the directory `stage`. Raises OSError, RecordingError."""
    for number, name in enumerate(DEVICES):
        with PacketWriter(_recording(stage, number)) as writer:
            for packet in walk(name, plan.seconds, plan.seed + number):
                writer.write(packet)
    (stage / "plan.json").write_text(json.dumps(asdict(plan)), encoding="utf-8")


def _recording(stage: Path, number: int) -> Path:
    return stage / f"walk-{number}.jsonl"


@frozen
class DemoWearer:
    """One wearer; `shift` is the offset from the walk's time to its own, s, `run` that of its phone."""

    name: str
    sending: Sending
    shift: float
    run: int

    def bundle(self, number: int) -> list[Sent | Unreadable]:
        """Return what arrives from this wearer in this period."""
        bundles = self.sending.bundles
        if number >= len(bundles):
            return []
        name, run, shift = self.name, self.run, self.shift
        # a fast path for packets, the majority, since the engine is what is measured
        return [
            Sent(name, at, Packet(what.t + shift, what.site, what.channel, what.data), run + k)
            if type(what) is Packet
            else self._make_other((k, at, what))
            for k, at, what in bundles[number]
        ]

    def remarks(self) -> list[Remark]:
        """Return the events that the fleet itself must emit for this wearer."""
        return [r if r.run is None else evolve(r, run=self.run + r.run) for r in self.sending.remarks]

    def inputs(self) -> list[DemoPayload]:
        """Return the input of this wearer's session, in order."""
        return [_shift(what, self.shift) for what in self.sending.ordered]

    def _make_other(self, item: Item) -> Sent | Unreadable:
        k, number, what = item
        if isinstance(what, dict):
            return read_sent({**what, "wearer": self.name, "run": self.run + k})
        return Sent(self.name, number, _shift(what, self.shift), self.run + k)


def _shift(what: DemoPayload, shift: float) -> DemoPayload:
    if isinstance(what, Packet):
        return Packet(what.t + shift, what.site, what.channel, what.data)
    return Tick(what.t + shift) if isinstance(what, Tick) else what


@define(eq=False)
class Wearers:
    """All wearers of a stage."""

    plan: DemoPlan
    sendings: list[Sending]
    """Sendings of wearers without faults."""
    poisons: list[Sending]
    """Sendings with random bytes."""
    gaps: list[Sending]
    """Sendings with lost rows; empty if the walks are too short."""
    all: list[DemoWearer]

    @classmethod
    def read(cls, stage: Path) -> Wearers:
        """Read the wearers of a stage."""
        plan = DemoPlan(**json.loads((stage / "plan.json").read_text(encoding="utf-8")))
        walks = [list(read_packets(_recording(stage, number))) for number in range(len(DEVICES))]
        rng = Random(f"sendings {plan.seed}")
        sendings = []
        for packets in walks:
            sendings.append(make_sending(packets, plan.bundle, rng))
            sendings.append(make_sending(packets, plan.bundle, rng, ends=True))
            sendings.append(make_sending(packets, plan.bundle, rng, runs=2))
        poisons = [make_poison(packets, plan.bundle, rng) for packets in walks]
        gaps = [one for packets in walks if (one := make_gap(packets, plan.bundle, rng)) is not None]
        found = []
        for number in range(plan.wearers):
            rng = Random(f"wearer {plan.seed} {number}")
            kind = poisons if number % POISONED == 3 else (gaps or sendings) if number % GAPPED == 5 else sendings
            drawn = rng.choice(kind)
            run = FIRST_RUN + rng.randrange(10**8)
            found.append(DemoWearer(f"w{number:05d}", drawn, rng.uniform(0.0, 1e5), run))
        return cls(plan, sendings, poisons, gaps, found)

    @property
    def recipe(self) -> Recipe:
        return by_name(self.plan.recipe)

    @property
    def bundles(self) -> int:
        """Largest number of bundles that a wearer sends."""
        return max(len(one.bundles) for one in chain(self.sendings, self.poisons, self.gaps))

    @property
    def poisoned(self) -> int:
        """Number of wearers who send random bytes."""
        return sum(one.sending in self.poisons for one in self.all)

    @property
    def gapped(self) -> int:
        """Number of wearers who lose rows for ever."""
        return sum(one.sending in self.gaps for one in self.all)

    def samples(self, part: int) -> int:
        """Return the number of samples of one part's wearers; slow at the first call."""
        return sum(count_samples(one.sending) for one in self.of_part(part))

    def of_part(self, part: int) -> list[DemoWearer]:
        """Return the wearers of one partition, or process."""
        return self.all[part :: self.plan.parts]
