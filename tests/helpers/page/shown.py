"""Emulated walks as the events of a session, for the tests, the benchmark and the pictures of the page."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Callable, Coroutine, Iterable, Iterator
from contextlib import asynccontextmanager
from functools import cache
from itertools import chain
from math import pi
from typing import Any
from urllib.parse import urlsplit

import attrs
from attrs import evolve
from browsers import Browser, Window, window

from solepath import Event, Packet, Session
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.route import Route
from solepath.emulate.routes.ways import corridor
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.walk import emulate
from solepath.show.page.messages import Command, encode
from solepath.show.page.scene.scene import Scene
from solepath.show.page.server.server import Page
from solepath.types import SITE_OF_FOOT, Foot

REFRESH = 1.0 / 60.0
"""Time between two parts of what is shown, s."""
LONGEST_PART = 2.0 * REFRESH
TIMES = frozenset({"t", "known_at", "t_start", "t_end", "t_toe_off", "t_heel_strike", "revises"})
"""Fields of events that are moments, s."""
CONNECTED = "document.getElementById('connection').dataset.state === 'open'"

PacketEvents = tuple[Packet, tuple[Event, ...]]
"""Packet that a session was fed, and the events that it returned for it."""


def squares(count: int) -> Route:
    """Return a route so many times round a square of 10 m, back to its start; once takes 43 s."""
    route = Route().stand(1.0)
    for _ in range(4 * count):
        route = route.walk(10.0, 1.3).turn(pi / 2, radius=1.5)
    return route.stop(2.0)


def walked(route: Route, cells: int = 96) -> tuple[Packet, ...]:
    """Return packets of insoles on both feet at 100 Hz."""
    return emulate(route, devices={SITE_OF_FOOT[foot]: Insole(cells=cells) for foot in Foot}).packets


def packet_events(packets: Iterable[Packet], session: Session | None = None) -> tuple[PacketEvents, ...]:
    """Return these packets with the events of a session for each."""
    made = Session(poses=True, pressures=True) if session is None else session
    return tuple((packet, tuple(made.feed(packet))) for packet in packets)


def shown(events: Iterable[Event], scene: Scene | None = None) -> Scene:
    """Return a scene that has taken the events."""
    scene = Scene("a walk", "default") if scene is None else scene
    for event in events:
        scene.take(None, [event])
    return scene


def frame(scene: Scene) -> dict[str, Any]:
    """Return the present frame of a scene, as a page gets it."""
    whole = json.loads(encode(scene.whole_message()[0]))["frame"]
    assert isinstance(whole, dict)
    return whole


@cache
def square() -> tuple[PacketEvents, ...]:
    """Return the walk once round the square, of which tests use parts."""
    return packet_events(walked(squares(1)))


@cache
def corridor_walk() -> tuple[PacketEvents, ...]:
    """Return the first half a minute of a walk along a corridor, on the building's plan."""
    way = corridor()
    session = Session(poses=True, pressures=True, floorplan=BUILDING, start=way.start)
    return packet_events((packet for packet in walked(way.route) if packet.t < 30.0), session)


def between(start: float, end: float) -> list[PacketEvents]:
    """Return the packets and events between these moments of the walk round the square, s."""
    return [one for one in square() if start < one[0].t <= end]


def fresh(title: str = "round a square") -> Scene:
    """Return the scene of a session that was fed nothing."""
    return Scene(title, "default", "live")


def after(seconds: float, title: str = "round a square") -> Scene:
    """Return the scene so many s into the walk round the square."""
    return _taken(fresh(title), square(), seconds)


def placed(seconds: float) -> Scene:
    """Return the scene so many s into the walk along the corridor."""
    return _taken(Scene("along a corridor", "default", "live", plan=BUILDING), corridor_walk(), seconds)


def _taken(scene: Scene, walk: Iterable[PacketEvents], seconds: float) -> Scene:
    for packet, events in walk:
        if packet.t > seconds:
            break
        scene.take(packet, events)
    return scene


def again(walk: tuple[PacketEvents, ...], seconds: float) -> Iterator[PacketEvents]:
    """Yield the walk, and repeat it from where it ended, for so many s at the least."""
    length = walk[-1][0].t - walk[0][0].t + 0.01
    return chain.from_iterable(_later(walk, k * length) for k in range(int(seconds / length) + 1))


def _later(walk: tuple[PacketEvents, ...], by: float) -> Iterator[PacketEvents]:
    for packet, events in walk:
        yield evolve(packet, t=packet.t + by), tuple(later(event, by) for event in events)


def later(event: Event, by: float) -> Event:
    """Return the event, so many s later."""
    moved = {
        one.name: value + by
        for one in attrs.fields(type(event))
        if one.name in TIMES and (value := getattr(event, one.name)) is not None
    }
    return evolve(event, **moved)


async def show(scene: Scene, walk: Iterable[PacketEvents], speed: float = 1.0, until: float | None = None) -> None:
    """Let the scene take packets when they are due, at so many times real time; until so many s of the walk.

    It is slower where that is too fast for the machine: the page has its turn after every part."""
    clock = asyncio.get_running_loop().time
    due: float | None = None
    last = clock()
    for packet, events in walk:
        if until is not None and packet.t > until:
            break
        due = packet.t if due is None else due
        while packet.t > due:
            await asyncio.sleep(REFRESH)
            now = clock()
            due += speed * min(now - last, LONGEST_PART)
            last = now
        scene.take(packet, events)


@asynccontextmanager
async def opened(
    chromium: Browser,
    scene: Scene,
    commands: Callable[[Command], None] | None = None,
    *,
    token: bool = True,
    **given: Any,
) -> AsyncIterator[tuple[Window, Page]]:
    """Yield the scene's page in a window, connected, and its server.

    At the end the page must have complained of nothing and sent requests to nobody else. `token` says whether it may
    send commands; `given` goes to `window`."""
    async with Page(scene, port=0, commands=commands) as page:
        url = page.url if token else page.url.partition("#")[0]
        async with window(chromium, url, **given) as view:
            await view.until(CONNECTED)
            yield view, page
        assert not view.complaints, view.complaints
        assert {urlsplit(one).netloc for one in view.requests} == {urlsplit(url).netloc}


@asynccontextmanager
async def meanwhile(work: Coroutine[Any, Any, None]) -> AsyncIterator[None]:
    """Run `work` during the context; what is left of it at the end is cancelled."""
    going_on = asyncio.create_task(work)
    try:
        yield
    finally:
        going_on.cancel()
        await asyncio.wait([going_on])
    if not going_on.cancelled():
        going_on.result()
