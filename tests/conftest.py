"""What tests share: where the recorded data are."""

import os
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def data_dir() -> Path:
    """The folder of recorded data: SOLEPATH_DATA says where, or it lies beside the checkout; without it, a skip."""
    named = os.environ.get("SOLEPATH_DATA")
    folder = Path(named) if named else Path(__file__).resolve().parents[2] / "shared" / "data"
    if not folder.is_dir():
        pytest.skip(f"no recorded data at {folder}; SOLEPATH_DATA says where they are")
    return folder
