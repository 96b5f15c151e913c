"""What tests of the place share."""

from __future__ import annotations

import pytest
from floors import METHODS, Method


@pytest.fixture(params=METHODS)
def part(request: pytest.FixtureRequest) -> Method:
    """Each way to find a wearer on a plan, as new."""
    found: Method = request.param()
    return found
