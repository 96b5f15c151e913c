"""Measures of what a page shows, each a list of what is wrong in words; measures.js takes them in the page."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from attrs import frozen
from browsers import Window

SCRIPT = (Path(__file__).parent / "measures.js").read_text(encoding="utf-8")
"""Script that a page must run before any other to be measured."""
LEAST_SIZE = 12
"""Smallest size of text, px."""
LEAST_CONTRAST = 4.5
"""Smallest contrast of text against its ground (WCAG 2.2, 1.4.3, AA)."""
LEAST_RING = 3.0
"""Smallest contrast of the ring round what has the focus (WCAG 2.2, 1.4.11)."""
SCREENS = {360: 740, 768: 1024, 1280: 900}
"""Height of a screen of each width, px."""
NARROWEST = {640: 900, 1000: 700}
"""Height of the narrowest screens on which the page has its two wider layouts, by width, px."""
THEMES = ("light", "dark")


async def text_faults(view: Window) -> list[str]:
    """Return texts that are too small, over another text or a button, cut or shortened, or beyond the screen.

    Those of canvases must also stand out of their ground, if they were drawn since `measured.read()` was called."""
    measure = f"""() => ({{
        small: measured.small({LEAST_SIZE}),
        over: measured.overlapping(),
        pale: measured.pale({LEAST_CONTRAST}),
        cut: measured.cut(),
        short: measured.shortened(),
        wide: measured.wide(),
    }})"""
    found = await view.tab.evaluate(measure)
    return [f"{kind}: {one}" for kind, words in found.items() for one in words]


async def shifts(view: Window) -> list[str]:
    """Return the layout shifts without input since the page was opened."""
    found: list[str] = await view.tab.evaluate("measured.shifts")
    return found


async def axe_faults(view: Window) -> list[str]:
    """Return the violations that axe finds, with those of the size of targets, which it leaves out by itself."""
    from axe_playwright_python.base import AXE_SCRIPT

    if not await view.tab.evaluate("'axe' in globalThis"):
        await view.tab.evaluate(AXE_SCRIPT)
    options = {"resultTypes": ["violations"], "preload": False, "rules": {"target-size": {"enabled": True}}}
    found = await view.tab.evaluate("options => axe.run(options)", options)
    return [
        f"{rule['id']}: {node['target'][0]}: {' '.join(node['failureSummary'].split())}"
        for rule in found["violations"]
        for node in rule["nodes"]
    ]


@frozen
class Focus:
    """What has the focus: its name, the layer of the page, a number of its own, its box, px, and its ring."""

    name: str
    layer: str
    control: int
    box: tuple[float, float, float, float]
    ring: float
    """Contrast of the ring against the ground; 0 without a ring."""
    shown: bool
    """Flag: a part of it is on the screen."""

    def is_before(self, other: Focus) -> bool:
        """Return whether an eye that reads comes to this one first: it is above the other, or left of it in a row."""
        left, top, right, bottom = self.box
        other_left, other_top, other_right, other_bottom = other.box
        if bottom <= other_top + 1.0:
            return left < other_right and other_left < right  # in one column
        return top < other_bottom and right <= other_left + 1.0


async def focused(view: Window) -> Focus | None:
    """Return what has the focus; None if nothing has."""
    found: dict[str, Any] | None = await view.tab.evaluate("measured.focus()")
    return None if found is None else Focus(**{**found, "box": tuple(found["box"])})


TO_THE_START = """() => {
    const first = document.createElement("a");
    first.tabIndex = 0;
    document.body.prepend(first);
    first.focus();
    first.remove();
    scrollTo(0, 0);
}"""
"""Lets the next Tab begin at the start of the page, also after a click elsewhere."""


async def tab_through(view: Window) -> tuple[list[Focus], bool]:
    """Return what has the focus after each press of Tab from the start of the page, and whether Tab leaves the page."""
    await view.tab.evaluate(TO_THE_START)
    path: list[Focus] = []
    for _ in range(2 * len(await controls(view)) + 10):
        await view.tab.keyboard.press("Tab")
        now = await focused(view)
        if now is None:
            return path, True
        path.append(now)
    return path, False


async def controls(view: Window) -> list[str]:
    """Return the names of the controls that can be used now, in the order of the document."""
    found: list[str] = await view.tab.evaluate("measured.controls().map(measured.name)")
    return found


async def numbered(view: Window) -> dict[int, str]:
    """Return the names of the controls that can be used now, by their own numbers."""
    found = await view.tab.evaluate("measured.controls().map((one) => [measured.number(one), measured.name(one)])")
    return {control: name for control, name in found}


async def tab_faults(view: Window) -> list[str]:
    """Return controls that Tab does not reach, reaches against the visual order, or without a visible ring."""
    before = await numbered(view)
    path, is_left = await tab_through(view)
    lasting = before.items() & (await numbered(view)).items()  # others came or went meanwhile
    reached = {one.control for one in path}
    found = [] if is_left else [f"Tab does not leave the page, but comes to {path[-1].name}"]
    found += [f"not reached: {name}" for control, name in sorted(lasting) if control not in reached]
    found += [f"no ring (contrast {one.ring:.1f}): {one.name}" for one in path if one.ring < LEAST_RING]
    found += [f"not on the screen: {one.name}" for one in path if not one.shown]
    found += [
        f"{one.name} before {later.name}"
        for one, later in zip(path, path[1:], strict=False)
        if one.layer == later.layer and later.is_before(one)
    ]
    return found


async def key_faults(view: Window) -> list[str]:
    """Return the controls that keys do not operate: Enter or Space, and arrows where a value is chosen.

    All that can be opened is open. A control that another one has hidden is operated after a reload."""
    await view.tab.evaluate(OPEN_ALL)
    found = []
    for name in await controls(view):
        if not await view.tab.evaluate(START_OPERATION, name):
            await view.tab.reload()
            await view.until(f"measured.controls().some((one) => measured.name(one) === {json.dumps(name)})")
            await view.tab.evaluate(OPEN_ALL)
            await view.tab.evaluate(START_OPERATION, name)
        for key in await view.tab.evaluate("operated.keys"):
            await view.tab.keyboard.press(key)
            try:
                await view.until("operated.done()", patience=PATIENCE)
            except AssertionError:
                found.append(f"{key} does not operate {name}")
        await view.tab.keyboard.press("Escape")
        await view.tab.evaluate(NEXT_FRAME)
    return found


OPEN_ALL = "for (const one of document.querySelectorAll('details')) one.open = true"
NEXT_FRAME = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
"""What waits until the page has drawn the effect of a key."""
PATIENCE = 3.0
"""Longest time in which a control must do what a key says, s."""
START_OPERATION = """(name) => {
    const element = measured.controls().find((one) => measured.name(one) === name);
    if (element === undefined) return false;
    element.focus();
    const [range, choice] = [element.matches("input[type=range]"), element.matches("select")];
    const scrolls = element.tabIndex === 0 && !element.matches("a, button, input, select, summary, textarea");
    const value = () => (scrolls ? element.scrollTop : element.value);
    let [clicks, before] = [0, value()];
    element.addEventListener("click", () => { clicks += 1; }, { capture: true });
    const arrows = element.value === element.max ? ["ArrowLeft", "ArrowRight"] : ["ArrowRight", "ArrowLeft"];
    const pressed = element.matches("a") ? ["Enter"] : ["Enter", "Space"];
    globalThis.operated = {
        keys: range ? arrows : choice || scrolls ? ["ArrowDown"] : pressed,
        done: () => {
            const is = scrolls && element.scrollHeight <= element.clientHeight // there is nothing to scroll
                || (scrolls || range || choice ? value() !== before : clicks > 0);
            [clicks, before] = [0, value()];
            return is;
        },
    };
    return true;
}"""
"""Gives a control the focus, and says in `operated` which keys operate it and whether they have."""
