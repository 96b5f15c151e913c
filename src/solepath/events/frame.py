"""Events as a table of pandas or polars, one row per event."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from .happening import Happening

AXES = {"position": "xyz", "velocity": "xyz", "displacement": "xyz", "compensation": "xyz", "centre": "xy"}
"""Fields that are vectors: one column for each of their components."""


def to_frame(events: Iterable[Happening]) -> Any:
    """Return a data frame with one row per event, of pandas where that is installed, else of polars.

    Its columns are the keys of `to_dict`, in the order in which they first come: a vector is one column a component
    (position_x, position_y, position_z, m), a record within an event one column a field (features_clearance, m), any
    other list one column that holds lists. A value that an event does not have is missing in its row. ImportError where
    neither library is installed."""
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
    """Return the record with its vectors and the records within it as separate columns."""
    flat: dict[str, Any] = {}
    for name, value in record.items():
        if isinstance(value, dict):
            flat |= {f"{name}_{inner}": one for inner, one in _flat(value).items()}
        elif name in AXES:
            flat |= {f"{name}_{axis}": one for axis, one in zip(AXES[name], value or (None,) * 3, strict=False)}
        else:
            flat[name] = value
    return flat
