"""Events as a table of pandas or polars, one row per event."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from .happening import Happening

AXES = {"position": "xyz", "velocity": "xyz", "displacement": "xyz", "compensation": "xyz", "centre": "xy"}
"""Components of each field that is a vector; each component becomes a column."""


def to_frame(events: Iterable[Happening]) -> Any:
    """Return a data frame with one row per event, of pandas if that is installed, else of polars.

    Its columns are the keys of `to_dict`, in the order of their first occurrence. A vector has one column for each
    component (position_x, position_y, position_z, m). A record within an event has one column for each field
    (features_clearance, m). Any other list is one column of lists. A value that an event does not have is missing in
    its row. ImportError when neither library is installed."""
    rows = [_flat(event.to_dict()) for event in events]
    names = {name: None for row in rows for name in row}
    columns = {name: [row.get(name) for row in rows] for name in names}
    try:
        import pandas
    except ImportError:
        pass
    else:
        return pandas.DataFrame(columns)
    try:
        import polars
    except ImportError:
        raise ImportError("to_frame needs pandas or polars: pip install pandas") from None
    return polars.DataFrame([polars.Series(name, values, strict=False) for name, values in columns.items()])


def _flat(record: dict[str, Any]) -> dict[str, Any]:
    """Return `record` with a key for each component of a vector and each field of a record within it."""
    flat: dict[str, Any] = {}
    for name, value in record.items():
        if isinstance(value, dict):
            flat |= {f"{name}_{inner}": one for inner, one in _flat(value).items()}
        elif name in AXES:
            flat |= {f"{name}_{axis}": one for axis, one in zip(AXES[name], value or (None,) * 3, strict=False)}
        else:
            flat[name] = value
    return flat
