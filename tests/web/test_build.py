"""Two builds of the site give the same bytes, and not too many."""

from __future__ import annotations

from pathlib import Path

import pytest

from solepath.emulate import emulate
from solepath.emulate.demo import SITE_ROUTE
from solepath.show.web.site import build_site, compressed_size

MAX_SIZE = 7_000_000
"""Largest size of the site as a server sends it, bytes."""


@pytest.mark.long
@pytest.mark.usefixtures("site")  # skips the test where no site can be built
def test_two_builds_give_the_same_bytes_of_less_than_7_MB(tmp_path: Path) -> None:
    packets = emulate(SITE_ROUTE).packets
    files, first = build_site(tmp_path / "one", packets), build_site(tmp_path / "two", packets)
    assert [name for name in files.keys() | first.keys() if files.get(name) != first.get(name)] == []
    assert sum(map(compressed_size, files.values())) < MAX_SIZE
