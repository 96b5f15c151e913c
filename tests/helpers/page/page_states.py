"""Eight states of the page, each of a session that was fed an emulated walk: for pictures, and for what measures them.

A state is first made up to LAST before its moment. The rest comes while its page is open, because a page draws the
newest paths of the feet from what arrives."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Coroutine, Iterable, Iterator
from contextlib import asynccontextmanager
from functools import cache
from heapq import merge
from math import inf
from operator import attrgetter
from typing import Any

from attrs import evolve, frozen
from browsers import Browser, Window
from declared import THINGY
from declared import walked as worn_walk
from shown import PacketEvents, meanwhile, open_page, packet_events, show, take_until

from solepath import Packet, Sample, Session
from solepath.emulate import case_study, emulate, sampled
from solepath.emulate.demo import RADIO, ROUTE, SITE_ROUTE
from solepath.emulate.routes.building import BUILDING
from solepath.floorplan.plan import FloorPlan
from solepath.show.page.messages import Command
from solepath.show.page.player.packed_items import PackedItems
from solepath.show.page.player.player import Player
from solepath.show.page.player.player_loop import play_on
from solepath.show.page.scene.scene import Scene
from solepath.show.page.server.server import Page
from solepath.types import Site
from solepath.types.vector import ZERO
from solepath.wire.receiver import ConnectionFrame, build_connected

LAST = 1.2
"""Time before the moment of a state from which on its page is open, s: a foot's newest stride."""
SETTLING = 0.4
"""Time in which a page has drawn what it was sent, s."""
LOST_AT = 31.0
"""Time of the last packet of a sensor that goes out of reach, s; its link breaks TIMEOUT later."""
TIMEOUT = 0.72
"""Time after which a central takes a link without packets as lost, s; the usual supervision timeout of an iPhone."""
SIGNALS = {Site.LEFT_FOOT: -61, Site.RIGHT_FOOT: -54}
"""Signal strength with which the sensors connect, dBm."""


def received(packets: Iterable[Packet]) -> Iterator[Packet]:
    """Yield the packets after those that report the connections, as a receiver does."""
    for site, signal in SIGNALS.items():
        yield Packet(0.0, site, "receiver/connected", build_connected(ConnectionFrame(f"Insole {site.foot}", signal)))
    yield from packets


@cache
def plain_walk() -> tuple[PacketEvents, ...]:
    """Return the walk of `solepath demo`."""
    return packet_events(received(emulate(ROUTE, radio=RADIO).packets))


@cache
def building_walk() -> tuple[PacketEvents, ...]:
    """Return a walk on a floor plan: down by a lift, along corridors, and up by another lift."""
    session = Session(poses=True, pressures=True, losses=True, floorplan=BUILDING)
    return packet_events(received(emulate(case_study().route).packets), session)


@cache
def broken_walk() -> tuple[PacketEvents, ...]:
    """Return the walk of `solepath demo` with a left sensor that goes out of reach and does not come back."""
    left = Site.LEFT_FOOT
    kept = [one for one in emulate(ROUTE, radio=RADIO).packets if one.site is not left or one.t < LOST_AT]
    lost = [Packet(LOST_AT + TIMEOUT, left, "receiver/disconnected", b"")]
    return packet_events(received(merge(kept, lost, key=attrgetter("t"))))


@cache
def inertial_walk() -> tuple[PacketEvents, ...]:
    """Return the walk of `solepath demo` with sensors that have no cells."""
    return packet_events(worn_walk(THINGY, ROUTE, RADIO))


def mirrored_walk() -> Iterator[Sample]:
    """Yield the samples of a walk without cells, with one axis of the left gyroscope reversed."""
    for sample in sampled(SITE_ROUTE).samples:
        x, y, z = sample.gyro or ZERO
        gyro = (x, -y, z) if sample.site is Site.LEFT_FOOT else sample.gyro
        yield evolve(sample, gyro=gyro, pressure=None)


@frozen
class Shown:
    """A state LAST before its moment: its scene, what executes commands of its page, and what comes until then.

    After that, `idle` runs as long as the page is open."""

    scene: Scene
    execute: Callable[[Command], None]
    rest: Callable[[Page], Coroutine[Any, Any, None]]
    idle: Callable[[Page], Coroutine[Any, Any, None]]


def live(walk: tuple[PacketEvents, ...], moment: float, plan: FloorPlan | None = None) -> Shown:
    """Return the state of a live session at the time `moment` of a walk, s."""
    scene = take_until(Scene("Live", "default", "live", plan=plan), walk, moment - LAST)
    rest = [one for one in walk if moment - LAST < one[0].t <= moment]
    return Shown(scene, lambda command: None, lambda page: show(scene, rest), lambda page: asyncio.sleep(0.0))


def played(title: str, items: Iterable[Packet | Sample], moment: float = inf) -> Shown:
    """Return the state of a recording that is paused at the time `moment`, s, or has been played to its end."""
    scene = Scene(title, "default", "recording")
    player = Player(PackedItems(items), Session(poses=True, pressures=True, losses=True), scene)
    player.seek(min(moment, player.playback.end) - LAST)
    while player.feed_due(lambda: False):
        pass

    async def rest(page: Page) -> None:
        stop = asyncio.Event()
        asyncio.get_running_loop().call_later(LAST if moment < inf else 10.0 * LAST, stop.set)
        await play_on(page, player, stop, once=True)
        player.pause()

    return Shown(scene, player.command, rest, lambda page: play_on(page, player, asyncio.Event()))


@frozen
class State:
    """A state of the page: its name, what it is for people, and what makes it."""

    name: str
    words: str
    make: Callable[[], Shown]

    @asynccontextmanager
    async def open(self, chromium: Browser, **given: Any) -> AsyncIterator[Window]:
        """Yield a window in which the state is shown and stays; `given` are options of `window`."""
        shown = self.make()
        async with open_page(chromium, shown.scene, shown.execute, **given) as (view, page):
            await shown.rest(page)
            async with meanwhile(shown.idle(page)):
                await asyncio.sleep(SETTLING)
                yield view


STATES = {
    state.name: state
    for state in (
        State("first-seconds", "the wearer stands, and nothing was measured yet", lambda: live(plain_walk(), 2.5)),
        State("walking", "a walk without a floor plan", lambda: live(plain_walk(), 36.0)),
        State("plan", "a walk on a floor plan, at a known place", lambda: live(building_walk(), 72.0, BUILDING)),
        State("lift", "a ride in a lift", lambda: live(building_walk(), 99.0, BUILDING)),
        State("lost-link", "the left sensor is out of reach", lambda: live(broken_walk(), 36.0)),
        State("no-insole", "sensors without cells", lambda: live(inertial_walk(), 36.0)),
        State(
            "check-failed",
            "a recording in which one axis of the left gyroscope is reversed",
            lambda: played("ward.csv", mirrored_walk(), 30.0),
        ),
        State(
            "finished",
            "a recording that was played to its end",
            lambda: played("walk.jsonl", received(emulate(SITE_ROUTE, radio=RADIO).packets)),
        ),
    )
}
