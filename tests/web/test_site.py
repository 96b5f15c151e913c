"""The static site in a real browser: Python runs in it, and the server may be gone."""

from __future__ import annotations

import json
from contextlib import ExitStack
from pathlib import Path
from typing import Any
from urllib.error import URLError
from urllib.request import urlopen

import pytest
from browsers import Browser, Window
from web_pages import WORDS, demo_packets, open_site, ready, scene_of

from solepath.show.page.messages import encode
from solepath.show.web.serve import serving

TO_THE_END = """(() => { const seek = document.getElementById('seek');
    seek.value = seek.max; seek.dispatchEvent(new Event('change')); })()"""


@pytest.mark.soak
async def test_without_its_server_the_demonstration_gives_the_strides_that_cpython_gives(
    chromium: Browser, site: Path
) -> None:
    expected = json.loads(encode(scene_of(demo_packets(site)).whole_message()))
    with ExitStack() as server:
        url = server.enter_context(serving(site))
        async with open_site(chromium, url) as view:
            await view.until("navigator.serviceWorker.controller !== null")
            server.close()
            with pytest.raises(URLError):
                urlopen(url)
            await view.tab.reload()
            await ready(view)
            await view.tab.locator("#demo").click()
            await view.until("solepath.state.playback?.state === 'playing' && solepath.frames > 10")
            await view.until("solepath.state.feet.left?.cells?.length === 96")
            await view.tab.evaluate(TO_THE_END)
            await view.until("solepath.state.playback.state === 'ended'")
            shown = await view.tab.evaluate("({ feet: solepath.state.feet, tracks: solepath.state.tracks })")
            for foot in ("left", "right"):
                assert shown["feet"][foot]["strides"] == expected["frame"]["feet"][foot]["strides"] >= 4
                assert shown["feet"][foot]["distance"] == expected["frame"]["feet"][foot]["distance"]
                assert shown["tracks"][foot] == expected["tracks"][foot]
            await view.tab.locator("#report").click()
            await view.until("!document.getElementById('report-file').hidden")
            async with view.tab.context.expect_page() as opening:
                await view.tab.locator("#report-link").click()
            report = await opening.value
            await report.wait_for_load_state()
            assert "left foot took" in await report.inner_text("main")
            assert (await report.evaluate("getComputedStyle(document.querySelector('figure')).padding")) != "0px"
            await check_bad_files(view)
            await check_isolation(view, site)
            assert not view.complaints, view.complaints


async def check_bad_files(view: Window) -> None:
    for name, content, words in (
        ("walk.jsonl", b"{\n", "line 1: is not JSON"),
        ("picture.png", b"\x89PNG", "neither a recording"),
        ("walk.jsonl.gz", b"\x1f\x8bno gzip at all", "cannot be read"),
    ):
        file: Any = {"name": name, "mimeType": "application/octet-stream", "buffer": content}
        await view.tab.locator("#file").set_input_files([file])
        await view.until(f"{WORDS}.includes('{words}')")


async def check_isolation(view: Window, site: Path) -> None:
    """Neither page nor worker reaches another origin."""
    with serving(site) as elsewhere:
        for scope in (view.tab, view.tab.workers[0]):
            how = await scope.evaluate(
                "url => fetch(url, {mode: 'no-cors'}).then(() => 'reached', (e) => e.name)", elsewhere
            )
            assert how == "TypeError"
    assert all("Content Security Policy" in words for words in view.complaints), view.complaints
    view.complaints.clear()
    view.requests[:] = [one for one in view.requests if not one.startswith(elsewhere)]
