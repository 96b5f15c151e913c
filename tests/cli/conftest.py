"""Shared parts of the tests of commands: recordings, and insoles that can be reached."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import walks
from programs import emulator
from recordings import recorded

from solepath.emulate.routes.route import Route


@pytest.fixture(autouse=True)
def nobody_at_a_terminal(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    with open(os.devnull) as nothing:
        monkeypatch.setattr(sys, "stdin", nothing)
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("recordings")


@pytest.fixture(scope="module")
def insoles() -> Iterator[str]:
    """Yield the address of two emulated insoles: tcp:HOST:PORT."""
    with emulator("--distance", 20) as (_, where):
        yield where


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a recording of some steps with two insoles."""
    walk = walks.insoles(Route().stand(0.5).walk(2.5, speed=1.3).stop(0.5), seed=4)
    return recorded(tmp_path_factory.mktemp("short") / "walk.jsonl", walk.packets)
