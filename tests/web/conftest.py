"""The site, built once for all tests that open it, in whichever process they run."""

from __future__ import annotations

import os
from pathlib import Path
from time import monotonic, sleep

import pytest

from solepath.emulate import emulate
from solepath.emulate.routes.route import Route
from solepath.show.web.pyodide import BuildError, package_files
from solepath.show.web.site import build_site

DEMO_ROUTE = Route().stand(1.0).walk(12.0).stop(1.0)
"""Route of the demonstration of the site, shorter than that of `solepath web`."""
MAX_BUILD_TIME = 180.0
"""Longest time for which a process waits for the site that another one builds, s."""


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a site; skip the test without node, or where the npm registry cannot be reached."""
    try:
        package_files()
    except BuildError as error:
        pytest.skip(str(error))
    shared = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        shared = shared.parent
    folder, built = shared / "web" / "site", shared / "web" / "built"
    try:
        folder.parent.mkdir()
    except FileExistsError:  # another process builds it
        end = monotonic() + MAX_BUILD_TIME
        while not built.exists():
            assert monotonic() < end, "the site is not built"
            sleep(0.1)
    else:
        build_site(folder, emulate(DEMO_ROUTE).packets)
        built.touch()
    return folder
