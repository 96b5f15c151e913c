"""examples/browser as a reader makes it, with a recording, and with two sensors that are a script of the page."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path

import attr
import attrs
import construct
import pytest
from browsers import Browser, window
from here import EXAMPLES, ROOT
from recordings import recorded
from walks import insoles
from web_pages import PATIENCE

from solepath.show.web.pyodide import VERSION, BuildError, package_files
from solepath.show.web.serve import serving
from solepath.types import Foot, Packet

WALK = insoles()
READY = "document.getElementById('out').textContent.includes('Python is ready')"
SENSORS = """
const rows = %s, uuid = (n) => `6016000${n}-c8fb-4908-9b03-31fbe15925c4`, site = ['left_foot', 'right_foot'];
const value = (hex) => new DataView(Uint8Array.fromHex(hex).buffer);
globalThis.frames = [];
const characteristic = (worn, n) => Object.assign(new EventTarget(), {
    readValue: async () => value(rows.find((row) => row.site === worn && row.channel === 'insole/info').data),
    startNotifications: async () => {},
    writeValue: async (bytes) => { globalThis.started = (globalThis.started ?? 0) + bytes[0]; },
    send(hex) { this.value = value(hex); this.dispatchEvent(new Event('characteristicvaluechanged')); },
});
Object.defineProperty(navigator, 'bluetooth', { value: { requestDevice: async () => {
    const worn = site.shift(), made = {};
    const service = { getCharacteristic: async (id) => (made[id] ??= characteristic(worn, id)) };
    frames.push([worn, () => made[uuid(2)]]);
    return { gatt: { connect: async () => ({ getPrimaryService: async () => service }) } };
} } });
globalThis.walk = () => {
    performance.now = () => 1000 * globalThis.t;
    for (const row of rows) if (row.channel === 'insole/frame') {
        globalThis.t = row.t;
        frames.find(([worn]) => worn === row.site)[1]().send(row.data);
    }
};"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of the example after the commands of its first lines."""
    try:
        files = package_files()
    except BuildError as error:
        pytest.skip(str(error))
    folder = tmp_path_factory.mktemp("browser")
    (folder / "index.html").write_text((EXAMPLES / "browser" / "index.html").read_text())
    pyodide = folder / "node_modules" / "pyodide"
    pyodide.mkdir(parents=True)
    for name, data in files.items():
        (pyodide / name).write_bytes(data)
    archive = io.BytesIO()
    packages = [ROOT / "src" / "solepath", *[Path(one.__file__ or "").parent for one in (attr, attrs, construct)]]
    with zipfile.ZipFile(archive, "w") as zipped:
        for package in packages:
            for path in package.rglob("*.*"):
                zipped.write(path, path.relative_to(package.parent))
    (folder / "python.zip").write_bytes(archive.getvalue())
    return folder


def strides() -> int:
    return sum(len(WALK.truth.strides(foot)) for foot in Foot)


async def test_a_recording_is_played_and_every_stride_shown(chromium: Browser, folder: Path, tmp_path: Path) -> None:
    recorded(tmp_path / "walk.jsonl", WALK.packets)
    with serving(folder) as url:
        async with window(chromium, url) as view:
            await view.until(READY, patience=PATIENCE)
            await view.tab.locator("#file").set_input_files(tmp_path / "walk.jsonl")
            await view.until("document.getElementById('out').textContent.includes('has ended')", patience=PATIENCE)
            assert (await view.text("out")).count(" m\n") == strides()
            assert not [one for one in view.requests if not one.startswith(url)]


async def test_two_insoles_are_connected_by_buttons(chromium: Browser, folder: Path) -> None:
    rows = [row_of(packet) for packet in WALK.packets]
    with serving(folder) as url:
        async with window(chromium, url, script=SENSORS % json.dumps(rows)) as view:
            await view.until(READY, patience=PATIENCE)
            await view.tab.locator("#left_foot").click()
            await view.tab.locator("#right_foot").click()
            await view.until("globalThis.started === 2")
            await view.tab.evaluate("walk()")
            assert (await view.text("out")).count(" m\n") == strides()


def row_of(packet: Packet) -> dict[str, object]:
    return {"t": packet.t, "site": packet.site.value, "channel": packet.channel, "data": packet.data.hex()}


def test_the_commands_name_the_version_that_is_tested_and_the_page_is_short() -> None:
    text = (EXAMPLES / "browser" / "index.html").read_text()
    assert f"npm install pyodide@{VERSION}\n" in text and len(text.splitlines()) < 60
