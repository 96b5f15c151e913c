"""The wearers of a demonstration: who walks what, when, and how it reaches the engine; the same wherever it is asked.

A stage is a directory with `plan.json` and the shared walks as recordings. Every process of a demonstration reads it,
so that none has to emulate anything, and what one wearer sends is the same for all.
"""

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
from .sending import Item, Remark, Sending, What, gap, poison, samples_of, sending

ROUGH = Radio(loss=0.02, duplicate=0.005, corrupt=0.005, truncate=0.005, latency=0.01, jitter=0.03)
"""Of a hundred notifications two never arrive, and one is damaged."""
SPEED = 1.3
"""m/s."""
DEVICES: dict[str, Device] = {
    "insoles": Insole(cells=48),
    "insoles in fragments": Insole(cells=24, rate=50.0, mtu=23),
    "insoles with broken cells": Insole(cells=35, batch=4, quaternion=True, broken=((5, 0), (6, 4095))),
    "insoles out of reach": Insole(cells=48, rate=50.0),
    "CC2650": CC2650(presses=(2.0,)),
    "CC2541": CC2541(rate=20.0),
}
"""What is worn on both feet, by the name of the walk."""
SILENT = "insoles out of reach"
"""The walk in which nothing is heard for a while."""
SILENCE = (0.5, 0.65)
"""From which to which share of it."""


def walk(name: str, seconds: float, seed: int) -> list[Packet]:
    """What is heard in the first `seconds` of a walk in laps that begins with a stand, in the order of arrival."""
    route, length = Route().stand(1.0), 0.0
    while length < SPEED * seconds:
        route = route.walk(6.0, SPEED).turn(pi / 2, radius=1.5)
        length += 6.0 + 1.5 * pi / 2
    worn = {site: DEVICES[name] for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT)}
    heard = [packet for packet in emulate(route, devices=worn, radio=ROUGH, seed=seed).packets if packet.t < seconds]
    if name == SILENT:
        begin, end = (share * seconds for share in SILENCE)
        heard = [packet for packet in heard if not begin <= packet.t < end]
    return heard


POISONED = 97
"""One in so many wearers sends any bytes, the fourth first."""
GAPPED = 10
"""One in so many loses some of what is sent for good, the sixth first."""
FIRST_RUN = 1_790_000_000_000
"""ms; when the phones were started."""


@frozen
class DemoPlan:
    """What decides every byte of a demonstration. `seconds`: of walking. `bundle`: s of it that a phone sends at a
    time. `parts`: of the source and of the files, and processes. `every`: s between two snapshots; None:
    as fits the run."""

    wearers: int
    seconds: float
    seed: int = 1
    recipe: str = "default"
    parts: int = 1
    bundle: float = 1.0
    every: float | None = None


def prepare(stage: Path, plan: DemoPlan) -> None:
    """Emulate the walks and write them and the plan into `stage`, a directory. OSError, RecordingError."""
    for number, name in enumerate(DEVICES):
        with PacketWriter(_recording(stage, number)) as writer:
            for packet in walk(name, plan.seconds, plan.seed + number):
                writer.write(packet)
    (stage / "plan.json").write_text(json.dumps(asdict(plan)), encoding="utf-8")


def _recording(stage: Path, number: int) -> Path:
    return stage / f"walk-{number}.jsonl"


@frozen
class DemoWearer:
    """One of them. `shift`: s from the walk's time to his. `run`: of his phone."""

    name: str
    sending: Sending
    shift: float
    run: int

    def bundle(self, number: int) -> list[Sent | Unreadable]:
        """What arrives of him in this piece of time."""
        bundles = self.sending.bundles
        if number >= len(bundles):
            return []
        name, run, shift = self.name, self.run, self.shift
        # most are packets, and the engine is what is to be measured
        return [
            Sent(name, at, Packet(what.t + shift, what.site, what.channel, what.data), run + k)
            if type(what) is Packet
            else self._other((k, at, what))
            for k, at, what in bundles[number]
        ]

    def remarks(self) -> list[Remark]:
        """What the fleet is to say of him beside his session."""
        return [r if r.run is None else evolve(r, run=self.run + r.run) for r in self.sending.remarks]

    def heard(self) -> list[What]:
        """What his session is to hear, in order."""
        return [_later(what, self.shift) for what in self.sending.ordered]

    def _other(self, item: Item) -> Sent | Unreadable:
        k, number, what = item
        if isinstance(what, dict):
            return read_sent({**what, "wearer": self.name, "run": self.run + k})
        return Sent(self.name, number, _later(what, self.shift), self.run + k)


def _later(what: What, shift: float) -> What:
    if isinstance(what, Packet):
        return Packet(what.t + shift, what.site, what.channel, what.data)
    return Tick(what.t + shift) if isinstance(what, Tick) else what


@define(eq=False)
class Wearers:
    """All of them."""

    plan: DemoPlan
    sendings: list[Sending]
    """Of those who are sound."""
    poisons: list[Sending]
    gaps: list[Sending]
    """None where walks are too short for one."""
    all: list[DemoWearer]

    @classmethod
    def read(cls, stage: Path) -> Wearers:
        """Those of a stage."""
        plan = DemoPlan(**json.loads((stage / "plan.json").read_text(encoding="utf-8")))
        walks = [list(read_packets(_recording(stage, number))) for number in range(len(DEVICES))]
        rng = Random(f"sendings {plan.seed}")
        sendings = []
        for packets in walks:
            sendings.append(sending(packets, plan.bundle, rng))
            sendings.append(sending(packets, plan.bundle, rng, ends=True))
            sendings.append(sending(packets, plan.bundle, rng, runs=2))
        poisons = [poison(packets, plan.bundle, rng) for packets in walks]
        gaps = [one for packets in walks if (one := gap(packets, plan.bundle, rng)) is not None]
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
        """The most that any of them sends."""
        return max(len(one.bundles) for one in chain(self.sendings, self.poisons, self.gaps))

    @property
    def poisoned(self) -> int:
        """How many send any bytes."""
        return sum(one.sending in self.poisons for one in self.all)

    @property
    def gapped(self) -> int:
        """How many lose something for good."""
        return sum(one.sending in self.gaps for one in self.all)

    def samples(self, part: int) -> int:
        """Of those of one part. Takes a moment the first time."""
        return sum(samples_of(one.sending) for one in self.of_part(part))

    def of_part(self, part: int) -> list[DemoWearer]:
        """Those of one partition, or process."""
        return self.all[part :: self.plan.parts]
