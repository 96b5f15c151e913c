"""The site, built once for all tests that open it."""

from __future__ import annotations

from pathlib import Path

import pytest

from solepath.emulate import emulate
from solepath.emulate.demo import SITE_ROUTE
from solepath.show.web.pyodide import BuildError, node_program, package_files
from solepath.show.web.site import build_site


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a site; skip the test without node, or where the npm registry cannot be reached."""
    try:
        node_program()
        package_files()
    except BuildError as error:
        pytest.skip(str(error))
    folder = tmp_path_factory.mktemp("web") / "site"
    build_site(folder, emulate(SITE_ROUTE).packets)
    return folder
