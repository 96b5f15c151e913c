"""Cases of a test that are for the soak alone, where the first ones show the promise and the others widen it."""

from __future__ import annotations

from typing import Any

import pytest


def soaked(*values: Any) -> list[Any]:
    """Return each value as a case of the soak, for a test with one parameter."""
    return [pytest.param(value, marks=pytest.mark.soak) for value in values]


def longer(*values: Any) -> list[Any]:
    """Return each value as a case of what takes minutes."""
    return [pytest.param(value, marks=pytest.mark.long) for value in values]
