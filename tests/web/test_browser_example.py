"""examples/browser as a reader makes it, with a recording, and with two sensors that are a script of the page."""

from __future__ import annotations

import io
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

from solepath.show.web.pyodide import BuildError, package_files
from solepath.show.web.serve import serving
from solepath.types import Foot

WALK = insoles()
READY = "document.getElementById('out').textContent.includes('Python is ready')"


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


@pytest.mark.soak
async def test_a_recording_is_played_and_every_stride_shown(chromium: Browser, folder: Path, tmp_path: Path) -> None:
    recorded(tmp_path / "walk.jsonl", WALK.packets)
    with serving(folder) as url:
        async with window(chromium, url) as view:
            await view.until(READY)
            await view.tab.locator("#file").set_input_files(tmp_path / "walk.jsonl")
            await view.until("document.getElementById('out').textContent.includes('has ended')")
            assert (await view.text("out")).count(" m\n") == strides()
            assert (await view.text("out")).count("right  EveryHeelStrike") >= 1
            assert not [one for one in view.requests if not one.startswith(url)]
