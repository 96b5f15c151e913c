"""Emulated walks as the events of a session, for the tests, the benchmark and the pictures of the page."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Callable, Coroutine, Iterable
from contextlib import asynccontextmanager
from functools import cache
from math import pi
from typing import Any
from urllib.parse import urlsplit

import attrs
from attrs import evolve
from browsers import Browser, Window, window

from solepath import Event, Packet, Sample, Session
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.walk import emulate
from solepath.show.page.messages import Command, encode
from solepath.show.page.scene.scene import Scene
from solepath.show.page.server.server import Page
from solepath.types import SITE_OF_FOOT, Foot
from solepath_lab.emulated.buildings import corridor

REFRESH = 1.0 / 60.0
"""Time between two groups of packets that a scene takes, s."""
MAX_PART = 2.0 * REFRESH
TIMES = frozenset({"t", "known_at", "sampled_at", "t_start", "t_end", "t_toe_off", "t_heel_strike", "revises"})
"""Fields of events that hold a time, s."""
CONNECTED = "document.getElementById('connection').dataset.state === 'open' && solepath.state.known"
"""Whether the page has its connection and the first scene, before which its state has no members."""

PacketEvents = tuple[Packet | Sample, tuple[Event, ...]]
"""Packet or sample that a session was fed, and the events that it returned for it."""


def squares(count: int) -> Route:
    """Return a route `count` times round a square of 10 m, back to its start; one lap takes 43 s."""
    route = Route().stand(1.0)
    for _ in range(4 * count):
        route = route.walk(10.0, 1.3).turn(pi / 2, radius=1.5)
    return route.stop(2.0)


def walked(route: Route, cells: int = 96) -> tuple[Packet, ...]:
    """Return the packets of insoles on both feet at 100 Hz on a walk along `route`."""
    return emulate(route, devices={SITE_OF_FOOT[foot]: Insole(cells=cells) for foot in Foot}).packets


def packet_events(items: Iterable[Packet | Sample], session: Session | None = None) -> tuple[PacketEvents, ...]:
    """Return each packet or sample with the events that a session, by default a new one, returns for it."""
    feeding = Session(poses=True, pressures=True, losses=True) if session is None else session
    return tuple((item, tuple(feeding.feed(item))) for item in items)


def shown(events: Iterable[Event], scene: Scene | None = None) -> Scene:
    """Return a scene that has taken the events."""
    scene = Scene("a walk", "default") if scene is None else scene
    for event in events:
        scene.take(None, [event])
    return scene


def frame(scene: Scene) -> dict[str, Any]:
    """Return the present frame of a scene, as a page gets it."""
    whole = json.loads(encode(scene.whole_message()))["frame"]
    assert isinstance(whole, dict)
    return whole


@cache
def square_walk() -> tuple[PacketEvents, ...]:
    """Return a walk of one lap round the square; tests use parts of it."""
    return packet_events(walked(squares(1)))


@cache
def corridor_walk() -> tuple[PacketEvents, ...]:
    """Return the first half a minute of a walk along a corridor, on the building's plan."""
    walk = corridor()
    session = Session(poses=True, pressures=True, losses=True, floorplan=BUILDING, start=walk.start)
    return packet_events((packet for packet in walked(walk.route) if packet.t < 30.0), session)


def packets_between(start: float, end: float) -> list[PacketEvents]:
    """Return the packets and events of the walk round the square from `start` to `end`, s."""
    return [one for one in square_walk() if start < one[0].t <= end]


def empty_scene(title: str = "round a square") -> Scene:
    """Return a scene without any event."""
    return Scene(title, "default", "live")


def scene_after(seconds: float, title: str = "round a square") -> Scene:
    """Return the scene after the first `seconds` of the walk round the square."""
    return take_until(empty_scene(title), square_walk(), seconds)


def scene_on_plan(seconds: float) -> Scene:
    """Return the scene, with the floor plan, after the first `seconds` of the walk along the corridor."""
    return take_until(Scene("along a corridor", "default", "live", plan=BUILDING), corridor_walk(), seconds)


def take_until(scene: Scene, walk: Iterable[PacketEvents], seconds: float) -> Scene:
    for packet, events in walk:
        if packet.t > seconds:
            break
        scene.take(packet, events)
    return scene


def later(event: Event, by: float) -> Event:
    """Return the event with all its times later by `by`, s."""
    times = {
        one.name: value + by
        for one in attrs.fields(type(event))
        if one.name in TIMES and (value := getattr(event, one.name)) is not None
    }
    return evolve(event, **times)


async def show(scene: Scene, walk: Iterable[PacketEvents], speed: float = 1.0, until: float | None = None) -> None:
    """Feed the packets to the scene when they are due, at `speed` times real time, up to the time `until`, s.

    It is slower where that is too fast for the machine: the page has its turn after every MAX_PART of the walk."""
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
            due += speed * min(now - last, MAX_PART)
            last = now
        scene.take(packet, events)


@asynccontextmanager
async def open_page(
    chromium: Browser,
    scene: Scene,
    commands: Callable[[Command], None] | None = None,
    *,
    token: bool = True,
    **given: Any,
) -> AsyncIterator[tuple[Window, Page]]:
    """Yield a window with the scene's page, connected, and the server of the page.

    At the end the console of the page must be empty, and it must have sent requests to its server only. `token` says
    whether it may send commands; `given` are options of `window`."""
    async with Page(scene, port=0, commands=commands) as page:
        url = page.url if token else page.url.partition("#")[0]
        async with window(chromium, url, **given) as view:
            await view.until(CONNECTED)
            yield view, page
        assert not view.complaints, view.complaints
        assert {urlsplit(one).netloc for one in view.requests} == {urlsplit(url).netloc}


@asynccontextmanager
async def meanwhile(work: Coroutine[Any, Any, None]) -> AsyncIterator[None]:
    """Run `work` during the context, and cancel it at the end."""
    task = asyncio.create_task(work)
    try:
        yield
    finally:
        task.cancel()
        await asyncio.wait([task])
    if not task.cancelled():
        task.result()
