"""What tests share: where the recorded data are, and what the default recipe makes of them."""

import os
from pathlib import Path

import pytest

from solepath.evaluate.jobs import evaluate, find
from solepath.evaluate.report import Result


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
