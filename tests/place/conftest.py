"""Fixtures of the tests of the place on a plan."""

from __future__ import annotations

import pytest
from floors import METHODS, Method


@pytest.fixture(params=METHODS)
def part(request: pytest.FixtureRequest) -> Method:
    """Return each method of finding a wearer on a plan, new."""
    method: Method = request.param()
    return method
