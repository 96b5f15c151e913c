"""The example app on Toga's test backend: its labels and canvases after a walk; and what Briefcase packs it with."""

from __future__ import annotations

import asyncio
import importlib.util
import re
import sys
import tomllib
from collections.abc import AsyncIterator, Iterator
from pathlib import Path
from typing import Any

import bleak
import pytest
from attrs import evolve
from here import EXAMPLES, ROOT

from solepath import Foot, Packet
from solepath.emulate import Route, emulate

pytest.importorskip("toga", reason="toga-core is not installed (extra: test)")
pytest.importorskip("toga_dummy", reason="toga-dummy is not installed (extra: test)")

WALK = emulate(Route().stand(2).walk(10, speed=1.3).stop(2), seed=1)
PATH = EXAMPLES / "toga" / "gait_app" / "__main__.py"


@pytest.fixture
def example(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    monkeypatch.setenv("TOGA_BACKEND", "toga_dummy")
    spec = importlib.util.spec_from_file_location("gait_app", PATH)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "gait_app", module)  # Toga looks there for the app's own files
    spec.loader.exec_module(module)
    yield module


def opened(example: Any) -> Any:
    app = example.GaitApp("solepath", "org.example.solepath")
    for canvas, height in ((app.soles, 190), (app.map, 240)):  # this backend lays nothing out
        canvas.style.width, canvas.style.height, canvas.style.flex = 348, height, 0
    return app


async def of(packets: tuple[Packet, ...]) -> AsyncIterator[Packet]:
    for packet in packets:
        yield packet


def shown(canvas: Any, what: str) -> list[Any]:
    """Return the drawn items of a kind: rect, line to, arc."""
    return [done[1] for done in canvas._impl.draw_instructions if isinstance(done, tuple) and done[0] == what]


async def test_after_a_walk_the_labels_show_the_walk_and_the_canvases_show_it(example: Any) -> None:
    app = opened(example)
    assert {label.text for label in app.figures.values()} == {"0", "–"}
    app.toggle_listening(of(WALK.packets))
    assert app.start.text == "Stop" and not app.show.enabled
    await app.listening
    labels = {name: label.text for name, label in app.figures.items()}
    true = [step for foot in Foot for step in WALK.truth.strides(foot)]
    assert int(labels["strides"]) == len(true)
    assert float(labels["length"]) == pytest.approx(1.4, abs=0.1)
    assert float(labels["cadence"]) == pytest.approx(111, abs=5)
    assert abs(float(labels["asymmetry"].rstrip("%"))) < 5.0
    assert app.activity.text == "standing" and app.status.text == "ended"
    assert app.start.text == "Insoles" and app.show.enabled
    cells, track = shown(app.soles, "rect"), shown(app.map, "line to")
    assert len(cells) == 2 * 96 and len(track) == len(true) + 2
    for canvas, drawn in ((app.soles, cells), (app.map, track)):
        width, height = canvas.layout.content_width, canvas.layout.content_height
        assert width == 348 and height in (190, 240)
        assert all([0.0 <= one["x"] <= width and 0.0 <= one["y"] <= height for one in drawn])
    ys = [one["y"] for one in track]
    assert max(ys) - min(ys) > 0.5 * app.map.layout.content_height, "10 m straight on are drawn straight up"


async def test_one_sample_that_is_far_too_high_does_not_pale_what_the_soles_show(example: Any) -> None:
    app = opened(example)
    app.toggle_listening(of(WALK.packets))
    await app.listening
    highest = max(max(load.values) for load in app.load.values())
    assert 0.5 * highest < app.peak, "who stands bears less than who walks"
    before, load = app.peak, app.load[Foot.LEFT]
    app.take([evolve(load, values=(1e6, *load.values[1:]))])
    app.draw()
    assert app.peak <= 1.1 * before
    assert [one["text"] for one in shown(app.soles, "fill text")] == ["L", "R"]


async def test_the_emulated_wearer_can_be_stopped_and_the_reason_why_sensors_stop_is_reported(example: Any) -> None:
    async def broken() -> AsyncIterator[Packet]:
        raise OSError("Bluetooth is off: switch it on")
        yield WALK.packets[0]

    app = opened(example)
    app.toggle_listening(example.emulated(100.0))
    listening = app.listening
    while app.strides < 4:
        await asyncio.sleep(0.01)
    app.toggle_listening(of(()))  # the button says Stop by now
    await asyncio.wait([listening])
    assert app.status.text == "stopped" and app.listening is None and app.strides >= 4
    app.toggle_listening(broken())
    await asyncio.wait([app.listening])
    assert app.status.text == "Bluetooth is off: switch it on"
    assert app.strides == 0 and app.start.text == "Insoles"


BRIEFCASE = tomllib.loads((PATH.parents[1] / "pyproject.toml").read_text())["tool"]["briefcase"]["app"]["gait_app"]


def test_briefcase_packs_the_app_the_library_and_all_that_bluetooth_needs() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert BRIEFCASE["requires"] == project["dependencies"] + project["optional-dependencies"]["ble"]
    sources = [(PATH.parents[1] / source).resolve() for source in BRIEFCASE["sources"]]
    assert sources == [PATH.parent, ROOT / "src" / "solepath"]
    (toga,) = BRIEFCASE["android"]["requires"]
    assert toga.replace("android", "core") in project["optional-dependencies"]["test"]


def test_briefcase_declares_what_bleaks_android_backend_needs() -> None:
    backend = Path(bleak.__file__).parent / "backends" / "android"
    proxies = {path.stem for path in backend.glob("*.py") if "(static_proxy(" in path.read_text()}
    assert proxies and proxies == set(
        re.findall(r"'bleak\.backends\.android\.(\w+)'", BRIEFCASE["android"]["build_gradle_extra_content"])
    )
    # Briefcase makes of it BLUETOOTH_CONNECT, and BLUETOOTH_SCAN with neverForLocation where no location is declared
    assert BRIEFCASE["permission"].keys() == {"bluetooth"}
    assert {name.removeprefix("android.permission.") for name in BRIEFCASE["android"]["permission"]} == {
        "WAKE_LOCK", "FOREGROUND_SERVICE", "FOREGROUND_SERVICE_CONNECTED_DEVICE", "POST_NOTIFICATIONS"
    }  # fmt: skip
