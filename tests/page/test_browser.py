"""Tests the page in a real browser, fed with the events of emulated walks."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterable
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from time import process_time

import pytest
from airs import memory
from attrs import define, evolve, field
from benches import LEFT, RIGHT
from browsers import MAX_WAIT, UNREACHABLE, Browser, Browsing, Window, window
from shown import (
    CONNECTED,
    PacketEvents,
    empty_scene,
    meanwhile,
    open_page,
    packets_between,
    repeat_walk,
    scene_after,
    show,
    square_walk,
    squares,
    walked,
)

from solepath import Connected, LinkTrouble, Placed, Session, WearerMoved
from solepath.ble import DeviceConfig, Devices
from solepath.emulate.devices.bench import Bench
from solepath.emulate.devices.faults import parse_faults
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.events import Candidate
from solepath.show.page.scene.scene import Scene
from solepath.show.page.server.server import Page
from solepath.types import Foot

PHONE_WIDTH = 360  # px
MINUTE = 60.0
MAX_HEAP_GROWTH = 0.7e6  # bytes; eight more minutes of tracks are 1800 points
FEET = ("left", "right")


async def picture(view: Window, name: str) -> str:
    """Return the pixels of a canvas."""
    found: str = await view.tab.evaluate("name => document.getElementById(name).toDataURL()", name)
    return found


async def words(view: Window, name: str) -> str | None:
    """Return what a screen reader says in place of a canvas."""
    return await view.tab.locator(f"#{name}").get_attribute("aria-label")


def offline(words: str) -> str:
    return f"document.getElementById('offline').innerText.includes('{words}')"


@define
class Line:
    """A connection, which can be cut, between a browser and the server at `port`."""

    port: int = 0
    whole: bool = True
    ends: list[asyncio.StreamWriter] = field(factory=list)

    @asynccontextmanager
    async def to(self, port: int) -> AsyncIterator[int]:
        """Yield the port of a proxy for the server at `port`."""
        self.port = port
        async with await asyncio.start_server(self._join, "127.0.0.1", 0) as server:
            yield server.sockets[0].getsockname()[1]
            self.cut()

    def cut(self) -> None:
        self.whole = False
        for end in self.ends:
            end.transport.abort()
        self.ends.clear()

    def restore(self) -> None:
        self.whole = True

    async def _join(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        if not self.whole:
            writer.transport.abort()
            return
        far_reader, far_writer = await asyncio.open_connection("127.0.0.1", self.port)
        self.ends += [writer, far_writer]
        await asyncio.gather(_forward(reader, far_writer), _forward(far_reader, writer))


async def _forward(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    with suppress(ConnectionError):
        while some := await reader.read(65_536):
            writer.write(some)
            await writer.drain()
    writer.close()


def link(site: str, state: str) -> str:
    return f"document.getElementById('foot-{site}').dataset.link === '{state}'"


async def test_the_page_connects_and_names_what_it_shows(chromium: Browser) -> None:
    async with open_page(chromium, empty_scene("Ward 3, corridor")) as (view, _):
        assert await view.text("title") == "Ward 3, corridor"
        assert await view.tab.locator("#recipe").text_content() == "default"
        assert "Ward 3, corridor" in await view.tab.title()


async def test_both_soles_change_in_picture_and_description(chromium: Browser) -> None:
    scene = scene_after(6.0)
    async with open_page(chromium, scene) as (view, _):
        await view.until(f"{link('left', 'ok')} && {link('right', 'ok')}")
        seen: dict[str, set[str]] = {foot: set() for foot in FEET}
        descriptions: dict[str, set[str | None]] = {foot: set() for foot in FEET}
        async with meanwhile(show(scene, packets_between(6.0, 40.0))), asyncio.timeout(MAX_WAIT):
            while min(map(len, seen.values())) < 10 or min(map(len, descriptions.values())) < 3:
                for foot in FEET:
                    seen[foot].add(await picture(view, f"sole-{foot}"))
                    descriptions[foot].add(await words(view, f"sole-{foot}"))
                await asyncio.sleep(0.05)
        for foot, found in descriptions.items():
            assert all(description and description.startswith(f"{foot.capitalize()} sole: ") for description in found)


async def test_the_track_and_the_ribbon_grow_with_every_step(chromium: Browser) -> None:
    scene = scene_after(6.0)
    async with open_page(chromium, scene) as (view, _):
        await view.until("Number(document.getElementById('track').dataset.points) > 0")
        before = {name: await picture(view, name) for name in ("track", "ribbon")}
        points = int(await view.tab.locator("#track").get_attribute("data-points"))
        strides, description = int(await view.text("strides")), await words(view, "track")
        await show(scene, packets_between(6.0, 12.0), speed=4.0)
        await view.until(f"Number(document.getElementById('strides').textContent) >= {strides + 4}")
        assert int(await view.tab.locator("#track").get_attribute("data-points")) > points
        assert await words(view, "track") != description
        for name, old in before.items():
            assert await picture(view, name) != old


async def test_a_late_watcher_sees_the_track_from_its_start(chromium: Browser) -> None:
    async with open_page(chromium, scene_after(40.0)) as (view, _):
        await view.until("Number(document.getElementById('track').dataset.points) > 100")
        await view.until("document.querySelectorAll('#gait-rows tr').length >= 8")
        assert await view.text("activity") == "Walking"
        assert int(await view.text("strides")) > 25


async def test_when_the_walk_stops_the_last_figures_stay(chromium: Browser) -> None:
    scene = scene_after(6.0)
    async with open_page(chromium, scene) as (view, _):
        await show(scene, packets_between(6.0, 6.5))
        for foot in Foot:
            force = scene.feet[foot].force
            assert force > 0.0
            await view.until(
                f"Math.abs(parseFloat(document.getElementById('force-{foot.value}').textContent) - {force}) <= 1 &&"
                f"document.getElementById('sole-{foot.value}').ariaLabel.includes(' newton')"
            )


async def test_a_plan_shows_the_wearer_once_the_place_is_decided_and_drops_wrong_candidates(chromium: Browser) -> None:
    ground, upper = (level.id for level in BUILDING.levels[:2])

    def place(t: float, x: float, level: str, *others: float) -> Placed:
        """Return a place whose likeliest candidate is at `x`, with others of less weight."""
        share = 0.4 / max(1, len(others))
        weights = [0.6, *(share for _ in others)] if others else [1.0]
        candidates = [
            Candidate(level, (at, 5.0, 0.0), 0.0, weight, "stairs")
            for at, weight in zip((x, *others), weights, strict=True)
        ]
        return Placed(t=t, known_at=t, level=level, position=(x, 5.0, 0.0), spread=1.0, candidates=tuple(candidates))

    scene = Scene("a building", "default", "live", plan=BUILDING)
    async with open_page(chromium, scene) as (view, _):
        seen = "document.getElementById('track').dataset"
        note = "document.getElementById('track-note').innerText"
        await view.until(f"{seen}.view === 'track' && {note}.startsWith('Where on the plan is not known yet')")
        for k in range(4):
            t, walked = 1.0 + k, 0.8 * k
            scene.take(None, [WearerMoved(t=t, known_at=t, position=(walked, 0.0, 0.0), covariance=(0.01,) * 6)])
            scene.take(None, [place(t, 5.0 + walked, ground, 25.0 + walked)])
        await view.until(f"{seen}.view === 'plan' && {seen}.points === '4' && {seen}.since === '0'")
        name = BUILDING.levels[0].name or ground
        await view.until(f"{note} === 'The wearer could be at 2 places; most likely (60 %) {name}.'")
        spoken = await words(view, "track")
        assert spoken is not None and "The wearer is" not in spoken
        scene.take(None, [place(5.0, 27.4, ground)])
        await view.until(f"{seen}.since === '4' && document.getElementById('track-note').hidden")
        await view.until("document.getElementById('track').ariaLabel.includes('The wearer is on')")
        scene.take(None, [evolve(place(6.0, 27.5, upper), room="<b>room 12</b>")])
        await view.until(
            f"{seen}.level === '{upper}' && document.getElementById('track').ariaLabel.includes(', <b>room 12</b>')"
        )
        assert await view.tab.evaluate(f"{seen}.since") == "4"


async def test_a_lost_link_shows_and_recovers(chromium: Browser) -> None:
    """Emulated devices in real time; one of them is out of reach for 1.5 s."""
    scene, session = empty_scene(), Session(poses=True, pressures=True)
    faults = parse_faults("1.5 left_foot vanish 1.5")
    devices = dict.fromkeys((LEFT, RIGHT), Insole(cells=16))
    bench = Bench(Route().stand(30.0), devices=devices, faults=faults)
    bench.prepare()
    configs = [DeviceConfig(one.site, one.address) for one in bench.peripherals]
    async with (
        open_page(chromium, scene) as (view, _),
        memory(bench) as backend,
        Devices(configs, backend=backend) as found,
    ):

        async def listen() -> None:
            async for packet in found:
                for event in session.feed(packet):
                    scene.take(None, [event])

        bench.walk_from(asyncio.get_running_loop().time())
        async with meanwhile(listen()):
            for state in ("ok", "lost", "ok"):
                await view.until(link("left", state))
                await view.until(link("right", "ok"))


async def test_the_page_reconnects_by_itself_or_on_request_after_the_server_had_ended(chromium: Browser) -> None:
    """First the network between them fails; then the program ends, and another one takes its place."""
    scene, token, line = scene_after(10.0, "before"), "the same as before", Line()
    async with AsyncExitStack() as stack:
        async with Page(scene, port=0, token=token) as first, line.to(first.port) as port:
            view = await stack.enter_async_context(window(chromium, first.url.replace(str(first.port), str(port))))
            await view.until(CONNECTED)
            line.cut()
            await view.until(offline("cannot be reached"))
            line.restore()
            await view.until(CONNECTED)
            await view.tab.locator("#offline").wait_for(state="hidden")
            await first.__aexit__(None, None, None)
            await view.until(offline("has ended"))
            async with Page(scene_after(12.0, "after"), port=0, token=token) as second:
                line.port = second.port
                await view.tab.locator("#retry").click()
                await view.until(f"{CONNECTED} && document.getElementById('title').textContent === 'after'")
                await view.tab.locator("#offline").wait_for(state="hidden")
        assert all(UNREACHABLE.search(description) for description in view.complaints), view.complaints


async def test_device_names_are_shown_as_text(chromium: Browser) -> None:
    hostile = "<img src=x onerror=\"document.title='broken'\"><script>document.title='broken'</script>"
    scene = scene_after(6.0, hostile)
    name = hostile.ljust(248, "W")  # as long as a device can have one
    scene.take(None, [Connected(t=6.0, known_at=6.0, site=LEFT, device="F0:5E:00:00:00:01", name=name, signal=-50)])
    scene.take(None, [LinkTrouble(t=6.0, known_at=6.0, site=LEFT, what="W" * 300)])
    async with open_page(chromium, scene, width=PHONE_WIDTH) as (view, _):
        assert await view.text("title") == hostile
        await view.until("document.getElementById('links').textContent.includes('onerror')")
        await view.until("document.getElementById('links').textContent.includes('WWW')")
        assert await view.tab.evaluate("document.scrollingElement.scrollWidth") <= PHONE_WIDTH
        ends = "[...document.querySelectorAll('#links *')].map(e => e.getBoundingClientRect().right)"
        assert await view.tab.evaluate(f"Math.max(...{ends})") <= PHONE_WIDTH
        assert await view.tab.locator("main img, main script, header img, header script").count() == 0
        assert await view.tab.title() != "broken"


async def stays_as_large(
    chromium: Browser, walk: Iterable[PacketEvents], speeds: tuple[float, float] = (1.0, 1.0)
) -> None:
    """Compare the page after two minutes of a walk with that after the rest of it, and print the cost."""
    scene, clock = empty_scene(), asyncio.get_running_loop().time
    async with open_page(chromium, scene) as (view, _):
        started, used = clock(), process_time()
        await show(scene, walk, speeds[0], until=2.0 * MINUTE)
        heap, elements = await view.memory()
        await show(scene, walk, speeds[1], until=10.0 * MINUTE)
        final_memory = await view.memory()
        seconds, frames = clock() - started, await view.tab.evaluate("solepath.frames")
        print(f"{frames / seconds:.1f} frames a second, {process_time() - used:.1f} s of {seconds:.0f} used")
        print(
            f"bytes and elements: {heap} and {elements} after 2 min, {final_memory[0]} and {final_memory[1]} after 10"
        )
        assert final_memory[0] < heap + MAX_HEAP_GROWTH
        assert final_memory[1] == elements
        assert await view.tab.locator("#log > *").count() <= 50


@pytest.mark.soak
async def test_ten_minutes_of_two_feet_leave_the_page_as_large_as_it_was(chromium: Browser) -> None:
    await stays_as_large(chromium, repeat_walk(square_walk(), 10.0 * MINUTE), (40.0, 80.0))


@pytest.mark.soak
def test_ten_minutes_in_real_time_leave_the_page_as_large_as_it_was(browser: Browsing) -> None:
    session = Session(poses=True, pressures=True)
    walk = ((packet, tuple(session.feed(packet))) for packet in walked(squares(15)))
    browser.run(lambda chromium: stays_as_large(chromium, walk), longest=15.0 * MINUTE)
