"""Snapshots as other encoders write them."""

from __future__ import annotations

from typing import Any


def other(value: Any) -> Any:
    """Return the value as JavaScript would write it: 1.0 is 1, -0.0 is 0, keys in order."""
    if isinstance(value, float) and value.is_integer():
        return int(value)
    if isinstance(value, dict):
        return {key: other(value[key]) for key in sorted(value)}
    return [other(item) for item in value] if isinstance(value, list) else value
