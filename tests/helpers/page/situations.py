"""Drives the site into each of its thirteen situations, for a test and for pictures.

Sensors are emulated insoles behind Chromium's own Bluetooth stack (web_bluetooth.py). Three things stand in for what a
person cannot time: the demonstration is held back while it is computed, and slow while it is looked at; and the worker
is killed for a failure."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, AsyncIterator
from pathlib import Path
from typing import Any

from browsers import Browser, Window, window
from web_bluetooth import WebBluetooth, web_bluetooth
from web_pages import ready

from solepath.emulate import Insole, Route
from solepath.emulate.devices.bench import Bench
from solepath.show.web.serve import serving
from solepath.types import SITE_OF_FOOT

SITUATION = "document.body.dataset.situation"
SITUATIONS = (
    "no-bluetooth", "choosing", "refused", "connecting", "connected", "walking", "lost", "resumed", "finished",
    "computing", "playing", "paused", "failed",
)  # fmt: skip
"""All situations, in the order in which they are shown here."""
WITH_SHEET = ("choosing", "walking", "finished")
"""Situations in which the sheet of controls is worth a look."""
SAID = {
    "computing": "One moment",
    "no-bluetooth": "No Bluetooth",
    "choosing": "Choose a sensor",
    "refused": "No sensor was chosen",
    "connecting": "Connecting",
    "connected": "no data yet",
    "walking": "Both sensors connected",
    "lost": "Left foot: no data",
    "resumed": "Walk goes on",
    "playing": "Both sensors emulated",
    "paused": "Paused at",
    "finished": "Finished",
    "failed": "has stopped",
}
"""Words that the site says in one situation alone, of those that it says of itself."""
INSOLES = dict.fromkeys(SITE_OF_FOOT.values(), Insole(batch=3))
"""Insoles with few frames a second: each costs a read through the browser, which a busy processor does 40 times a
second."""
WITHOUT_BLUETOOTH = "delete Navigator.prototype.bluetooth;"
STRIDES = "['left', 'right'].every((foot) => (solepath.state.feet[foot]?.strides ?? 0) >= {})"
HOLD_DEMO = """(hold) => {
    computer.held ??= computer.call.bind(computer);
    computer.call = hold ? () => new Promise(() => {}) : computer.held;
}"""
"""Lets what is computed never end, or end again."""
SLOW_DOWN = """() => {
    const choice = document.getElementById('speed-choice');
    choice.add(new Option('1×', 0.2));
    choice.value = 0.2;
    choice.dispatchEvent(new Event('change'));
}"""
"""Lets the demonstration go on for a minute: it must not end while it is looked at, however slowly."""
COUNT_SHIFTS = "globalThis.measured?.shifts.length ?? 0"
FORGET_SHIFTS = "(count) => requestAnimationFrame(() => globalThis.measured?.shifts.splice(count))"
"""Forgets the layout shifts after the first `count`: the bar of playback answers a tap, on a slow machine later than
browsers count it as that."""


async def is_shown(view: Window, name: str) -> None:
    """Wait until the site is in a situation, says so, and what it says is drawn."""
    await view.until(f"{SITUATION} === '{name}' && document.body.innerText.includes('{SAID[name]}')")
    await view.tab.evaluate("scrollTo(0, 0)")
    await asyncio.sleep(0.6)


async def situations(
    chromium: Browser, site: Path, *, script: str = "", **given: Any
) -> AsyncGenerator[tuple[str, Window], None]:
    """Yield the name of each situation with the window that shows it, in the order of SITUATIONS.

    `script` runs in the page before any other; `given` are options of `window`."""
    with serving(site) as url:
        async with window(chromium, url, script=f"{WITHOUT_BLUETOOTH}{script}", **given) as view:
            await ready(view)
            await is_shown(view, "no-bluetooth")
            yield "no-bluetooth", view
        bench = Bench(Route().stand(3.0).walk(60.0), devices=INSOLES, seed=3, mtu=512)
        bench.prepare()
        async with window(chromium, url, script=script, **given) as view:
            await ready(view)
            async with web_bluetooth(view, bench.peripherals) as radio:
                async for name in _of_a_walk(view, radio, bench, url):
                    await is_shown(view, name)
                    yield name, view


async def _of_a_walk(view: Window, radio: WebBluetooth, bench: Bench, url: str) -> AsyncIterator[str]:
    left, right = (device.address for device in bench.peripherals)
    yield "choosing"
    await radio.choose(None)
    yield "refused"
    radio.reachable = False
    await radio.choose(left)
    yield "connecting"
    radio.reachable, radio.silent = True, True
    yield "connected"
    radio.silent = False
    await radio.choose(right)
    bench.walk_from(asyncio.get_running_loop().time())
    await view.until(STRIDES.format(6))
    yield "walking"
    radio.reachable = False
    await radio.lose(left)
    yield "lost"
    radio.reachable = True
    await view.until("solepath.state.links['left foot'].state === 'ok'")
    await view.tab.evaluate("computer.call('save')")
    await radio.kill_tab()
    size = view.tab.viewport_size
    view.tab = await view.tab.context.new_page()
    assert size is not None
    await view.tab.set_viewport_size(size)
    await view.tab.goto(url)
    await ready(view)
    yield "resumed"
    await view.tab.locator("#end").click()
    yield "finished"
    await view.tab.locator("#more").click()
    await view.tab.evaluate(HOLD_DEMO, True)
    await view.tab.locator("#sheet [data-do=demo]").click()
    yield "computing"
    await view.tab.evaluate("scrollTo(0, 0)")
    await view.tab.reload()
    await ready(view)
    before = await view.tab.evaluate(COUNT_SHIFTS)
    await view.tab.locator("#demo").click()
    await view.until("!document.getElementById('playback').hidden")
    await view.tab.evaluate(FORGET_SHIFTS, before)
    await view.until(STRIDES.format(1))
    await view.tab.evaluate(SLOW_DOWN)
    await view.until("solepath.state.playback.speed === 0.2")
    yield "playing"
    await view.tab.locator("#play").click()
    yield "paused"
    await view.tab.evaluate("computer.kill()")
    yield "failed"
