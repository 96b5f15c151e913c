"""What tests share: where the recorded data are, and what the default recipe makes of them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from solepath.evaluate.jobs import evaluate, find
from solepath.evaluate.report import Result

if TYPE_CHECKING:
    from browsers import Browsing


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """The folder of recorded data: SOLEPATH_DATA says where, or it lies beside the checkout; without it, a skip."""
    named = os.environ.get("SOLEPATH_DATA")
    folder = Path(named) if named else Path(__file__).resolve().parents[2] / "shared" / "data"
    if not folder.is_dir():
        pytest.skip(f"no recorded data at {folder}; SOLEPATH_DATA says where they are")
    return folder


@pytest.fixture(scope="session")
def results(data_dir: Path) -> list[Result]:
    """The default recipe on all recorded data that have a truth, but for those that it must first learn for in folds:
    that takes minutes."""
    quick = [data_set.name for data_set in find(data_dir) if not data_set.folds]
    return list(evaluate(data_dir, ["default"], only=quick, processes=2))


@pytest.fixture(scope="session")
def browser() -> Iterator[Browsing]:
    """The browser that all tests of the page share; a skip where there can be none."""
    from browsers import browsing, why_not

    reason = why_not()
    if reason is not None:
        pytest.skip(reason)
    with browsing() as found:
        yield found
