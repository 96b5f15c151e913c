"""The wearers of a demonstration: their walks, times and transport to the engine, the same in every process.

A stage is a directory with `plan.json` and the shared walks as recordings. Every process of a demonstration reads it,
so that no process emulates walks, and every process has the same rows of a wearer."""

from __future__ import annotations

import json
from collections.abc import Sequence
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

POOR_RADIO = Radio(loss=0.02, duplicate=0.005, corrupt=0.005, truncate=0.005, latency=0.01, jitter=0.03)
"""A poor radio connection: of a hundred notifications two never arrive, and one is damaged."""
WALKING_SPEED = 1.3
"""Walking speed, m/s."""
DEVICES: dict[str, Device] = {
    "insoles": Insole(cells=48),
    "insoles in fragments": Insole(cells=24, rate=50.0, mtu=23),
    "insoles with broken cells": Insole(cells=35, batch=4, quaternion=True, broken=((5, 0), (6, 4095))),
    "insoles out of reach": Insole(cells=48, rate=50.0),
    "CC2650": CC2650(presses=(2.0,)),
    "CC2541": CC2541(rate=20.0),
    "insoles of 96 cells": Insole(cells=96),
}
"""Device on both feet, by the name of the walk."""
LARGE_INSOLES = "insoles of 96 cells"
"""Name of the walk of which the demonstration has no wearer, since it would take half its time."""
DEMO_WALKS = tuple(name for name in DEVICES if name != LARGE_INSOLES)
SILENT_WALK = "insoles out of reach"
"""Name of the walk in which no packet arrives for some time."""
SILENCE_SHARES = (0.5, 0.65)
"""Start and end of the silence in SILENT_WALK, as shares of its duration."""


def walk(name: str, seconds: float, seed: int) -> list[Packet]:
    """Return the packets, in arrival order, of the first `seconds` of a walk in laps that starts with standing."""
    route, length = Route().stand(1.0), 0.0
    while length < WALKING_SPEED * seconds:
        route = route.walk(6.0, WALKING_SPEED).turn(pi / 2, radius=1.5)
        length += 6.0 + 1.5 * pi / 2
    worn = {site: DEVICES[name] for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT)}
    received = [p for p in emulate(route, devices=worn, radio=POOR_RADIO, seed=seed).packets if p.t < seconds]
    if name == SILENT_WALK:
        start, end = (share * seconds for share in SILENCE_SHARES)
        received = [packet for packet in received if not start <= packet.t < end]
    return received


POISON_EVERY = 97
"""One wearer in this many sends random bytes; the first is wearer number 3."""
GAP_EVERY = 10
"""One wearer in this many loses some of its rows; the first is wearer number 5."""
FIRST_RUN = 1_790_000_000_000
"""Time at which the first phone was started, ms since 1970; it is the number of a run."""


@frozen
class DemoPlan:
    """The settings that determine every byte of a demonstration.

    `seconds` is the duration of a walk. `bundle` is the time of walking that a phone sends at once, s. `parts` is the
    number of processes, and of partitions of the source and of the files. `every` is the time between two snapshots, s;
    None derives it from the duration of the run. `walks` are names of walks, of which each wearer has one."""

    wearers: int
    seconds: float
    seed: int = 1
    recipe: str = "default"
    parts: int = 1
    bundle: float = 1.0
    every: float | None = None
    walks: Sequence[str] = DEMO_WALKS


def prepare(stage: Path, plan: DemoPlan) -> None:
    """Emulate the walks and write them and the plan into the directory `stage`. Raises OSError, RecordingError."""
    for number, name in enumerate(plan.walks):
        with PacketWriter(_walk_path(stage, number)) as writer:
            for packet in walk(name, plan.seconds, plan.seed + number):
                writer.write(packet)
    (stage / "plan.json").write_text(json.dumps(asdict(plan)), encoding="utf-8")


def _walk_path(stage: Path, number: int) -> Path:
    return stage / f"walk-{number}.jsonl"


@frozen
class DemoWearer:
    """One wearer; `shift` is added to the times of the walk, s, and `run` to the run indices of the Sending."""

    name: str
    sending: Sending
    shift: float
    run: int

    def bundle(self, number: int) -> list[Sent | Unreadable]:
        """Return the rows that arrive from this wearer in this period."""
        bundles = self.sending.bundles
        if number >= len(bundles):
            return []
        name, run, shift = self.name, self.run, self.shift
        # a fast path for packets, the majority, so that the measurement shows the engine's time
        return [
            Sent(name, n, Packet(payload.t + shift, payload.site, payload.channel, payload.data), run + k)
            if type(payload) is Packet
            else self._make_row((k, n, payload))
            for k, n, payload in bundles[number]
        ]

    def remarks(self) -> list[Remark]:
        """Return the events that the fleet itself must emit for this wearer."""
        return [r if r.run is None else evolve(r, run=self.run + r.run) for r in self.sending.remarks]

    def inputs(self) -> list[DemoPayload]:
        """Return the input of this wearer's session, in order."""
        return [_shift_time(payload, self.shift) for payload in self.sending.ordered]

    def _make_row(self, item: Item) -> Sent | Unreadable:
        run_index, number, payload = item
        if isinstance(payload, dict):
            return read_sent({**payload, "wearer": self.name, "run": self.run + run_index})
        return Sent(self.name, number, _shift_time(payload, self.shift), self.run + run_index)


def _shift_time(payload: DemoPayload, shift: float) -> DemoPayload:
    if isinstance(payload, Packet):
        return Packet(payload.t + shift, payload.site, payload.channel, payload.data)
    return Tick(payload.t + shift) if isinstance(payload, Tick) else payload


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
        walks = [list(read_packets(_walk_path(stage, number))) for number in range(len(plan.walks))]
        rng = Random(f"sendings {plan.seed}")
        sendings = []
        for packets in walks:
            sendings.append(make_sending(packets, plan.bundle, rng))
            sendings.append(make_sending(packets, plan.bundle, rng, ends=True))
            sendings.append(make_sending(packets, plan.bundle, rng, runs=2))
        poisons = [make_poison(packets, plan.bundle, rng) for packets in walks]
        gaps = [gap for packets in walks if (gap := make_gap(packets, plan.bundle, rng)) is not None]
        wearers = []
        for number in range(plan.wearers):
            rng = Random(f"wearer {plan.seed} {number}")
            kind = (
                poisons if number % POISON_EVERY == 3 else (gaps or sendings) if number % GAP_EVERY == 5 else sendings
            )
            sending = rng.choice(kind)
            run = FIRST_RUN + rng.randrange(10**8)
            wearers.append(DemoWearer(f"w{number:05d}", sending, rng.uniform(0.0, 1e5), run))
        return cls(plan, sendings, poisons, gaps, wearers)

    @property
    def recipe(self) -> Recipe:
        """Recipe of the plan."""
        return by_name(self.plan.recipe)

    @property
    def bundles(self) -> int:
        """Largest number of bundles that a wearer sends."""
        return max(len(sending.bundles) for sending in chain(self.sendings, self.poisons, self.gaps))

    @property
    def poisoned(self) -> int:
        """Number of wearers who send random bytes."""
        return sum(wearer.sending in self.poisons for wearer in self.all)

    @property
    def gapped(self) -> int:
        """Number of wearers who lose rows for ever."""
        return sum(wearer.sending in self.gaps for wearer in self.all)

    def samples(self, part: int) -> int:
        """Return the number of samples of the wearers of one partition; slow at the first call."""
        return sum(count_samples(wearer.sending) for wearer in self.of_partition(part))

    def of_partition(self, part: int) -> list[DemoWearer]:
        """Return the wearers of one partition, which are those of one process."""
        return self.all[part :: self.plan.parts]
