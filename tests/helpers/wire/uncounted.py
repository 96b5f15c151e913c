"""Devices without counters: what they send of a walk, and how a radio delivers it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache
from math import radians
from random import Random

from attrs import frozen
from construct import Struct, Terminated

from solepath import Event, Foot, Packet, Session, Site
from solepath.emulate import Route, Walker
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.link.driver import Driver, Measured, Reading
from solepath.link.profile import Access, Channel, Profile
from solepath.walk.walk import Walk
from solepath.wire.fields import Fields

ACC, GYRO = 16 * 9.80665 / 32768, radians(2000 / 32768)
"""Value of a count, m/s^2 and rad/s."""
SERVICE = "5d1e0001-9c60-4cf1-a1b3-1a2b3c4d5e6f"
SITE = Site.LEFT_FOOT


def board(rate: float) -> Driver:
    """Return a board whose notifications are acceleration and angular rate, and nothing else."""
    profile = Profile(
        name="board",
        names=("Board",),
        services=(SERVICE,),
        channels=(Channel("board/motion", SERVICE, SERVICE.replace("0001", "0002"), Access.NOTIFY),),
        setup=(),
        streams=("board/motion",),
        nominal_rate=rate,
        stale_after=1.0,
    )
    return Driver(profile, {"board/motion": Struct("acc" / Fields("<3h"), "gyro" / Fields("<3h"), Terminated)}, {
        "board/motion": lambda sent, known: Reading(
            (Measured(tuple([v * ACC for v in sent.acc]), tuple([v * GYRO for v in sent.gyro])),)
        )
    })  # fmt: skip


@cache
def sent(rate: float, distance: float, seed: int = 1) -> tuple[tuple[float, bytes], ...]:
    """Return the time and the bytes of each sample of a walk, measured `rate` times a second."""
    driver, values = board(rate), []
    for sample in Walker(Route().stand(2.0).walk(distance).stop(2.0), seed=seed).samples(Foot.LEFT, rate, LSM6DSOX):
        counts = [[round(v / one) for v in vector] for vector, one in ((sample.acc, ACC), (sample.gyro, GYRO))]
        acc, gyro = [[max(-32768, min(32767, v)) for v in vector] for vector in counts]
        values.append((sample.t, driver.write("board/motion", {"acc": acc, "gyro": gyro})))
    return tuple(values)


@frozen
class Radio:
    """How notifications arrive: in bursts of so many, some twice, some not at all, with so much jitter, s."""

    burst: int = 1
    twice: float = 0.0
    loss: float = 0.0
    jitter: float = 0.002
    seed: int = 1

    def deliver(self, values: Iterable[tuple[float, bytes]]) -> list[tuple[float, bytes]]:
        """Return arrival and bytes of what arrives of `values`, which are times and bytes."""
        random, out, batch, newest = Random(self.seed), [], [], 0.0
        for t, data in values:
            batch.append(data)
            if len(batch) < self.burst:
                continue
            newest = max(newest, 100.004 + t + random.expovariate(1.0 / self.jitter))
            for one in batch:
                if random.random() < self.loss:
                    continue
                for _ in range(2 if random.random() < self.twice else 1):
                    out.append((newest, one))
                    newest += 1e-4
            batch = []
        return out


def follow(driver: Driver, arrivals: Sequence[tuple[float, bytes]]) -> tuple[Session, Walk, list[Event]]:
    """Return the session that was fed them, its walk and its events."""
    session, walk, events = Session(losses=True, profiles=[driver]), Walk(), list[Event]()
    for arrival, data in arrivals:
        packet = Packet(arrival, SITE, "board/motion", data)
        found = session.feed(packet)
        events += found
        walk.take(packet, found)
    found = session.finish()
    walk.take(None, found)
    return session, walk, events + found
