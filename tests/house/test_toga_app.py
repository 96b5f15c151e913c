"""The example app on Toga's test backend: its lines after a walk; and what Briefcase packs it with."""

from __future__ import annotations

import asyncio
import importlib.util
import sys
import tomllib
from collections.abc import AsyncIterator, Iterator
from typing import Any

import pytest
from here import EXAMPLES, ROOT
from walks import insoles

from solepath import Packet
from solepath.emulate import Route

pytest.importorskip("toga", reason="toga-core is not installed (extra: test)")
assert_action_performed = pytest.importorskip(
    "toga_dummy.utils", reason="toga-dummy is not installed (extra: test)"
).assert_action_performed

WALK = insoles(Route().stand(2).walk(10, speed=1.3).stop(2))
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
    return example.GaitApp("solepath", "org.example.solepath")


def texts(app: Any) -> list[str]:
    return app.label.text.split("\n")


async def of(packets: tuple[Packet, ...]) -> AsyncIterator[Packet]:
    for packet in packets:
        yield packet


async def test_after_a_walk_the_lines_show_the_walk(example: Any) -> None:
    app = opened(example)
    assert set(texts(app)) == {""}
    app.toggle(of(WALK.packets))
    await app.listening
    activity, cadence, status = texts(app)
    assert (activity, status) == ("standing", "ended")
    assert cadence.endswith(" steps a minute") and float(cadence.split()[0]) == pytest.approx(111, abs=5)
    assert app.start.text == "Insoles" and app.show.enabled
    assert_action_performed(app, "beep")  # at a right heel-strike


async def test_the_emulated_wearer_can_be_stopped_and_the_reason_why_sensors_stop_is_reported(example: Any) -> None:
    async def broken() -> AsyncIterator[Packet]:
        raise OSError("Bluetooth is off: switch it on")
        yield WALK.packets[0]

    app = opened(example)
    app.toggle(example.emulated(100.0))
    listening = app.listening
    while texts(app)[0] != "walking":
        await asyncio.sleep(0.01)
    assert app.start.text == "Stop" and not app.show.enabled
    app.toggle(of(()))  # the button says Stop by now
    await asyncio.wait([listening])
    assert texts(app)[2] == "stopped" and app.start.text == "Insoles"
    app.toggle(broken())
    await asyncio.wait([app.listening])
    assert texts(app)[2] == "Bluetooth is off: switch it on" and app.start.text == "Insoles"


BRIEFCASE = tomllib.loads((PATH.parents[1] / "pyproject.toml").read_text())["tool"]["briefcase"]["app"]["gait_app"]


def test_briefcase_packs_the_app_the_library_and_all_that_bluetooth_needs() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert BRIEFCASE["requires"] == project["dependencies"] + project["optional-dependencies"]["ble"]
    sources = [(PATH.parents[1] / source).resolve() for source in BRIEFCASE["sources"]]
    assert sources == [PATH.parent, ROOT / "src" / "solepath"]
    (toga,) = BRIEFCASE["android"]["requires"]
    assert toga.replace("android", "core") in project["optional-dependencies"]["test"]
