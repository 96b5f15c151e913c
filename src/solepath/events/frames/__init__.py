"""Events and samples as tables of pandas, polars or Arrow: one row per record, units in the metadata."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from typing import Any

from ...types import Sample
from ...types.extras import install_hint
from ..happening import Happening
from .columns import ColumnTable, table_of
from .forms import TableColumn, ValueKind

LIBRARIES = ("pandas", "polars")
"""Libraries of data frames; the first that is installed is taken."""
WHOLE = {ValueKind.FLOAT: "float64", ValueKind.INT: "int64", ValueKind.BOOL: "bool"}
"""Types of pandas for columns without a missing value, and for all columns of floats, which have NaN instead."""
WITH_MISSING = {ValueKind.INT: "Int64", ValueKind.BOOL: "boolean"}
"""Types of pandas for columns with a missing value."""


def to_frame(
    records: Iterable[Happening | Sample], of: type[Happening] | None = None, *, library: str | None = None
) -> Any:
    """Return a data frame with one row per event or sample, of pandas if that is installed, else of polars.

    `of` is a class of events, such as StrideTaken or GaitCycleMeasured: the frame then has only those events, and all
    columns of that class, also without a single row. `library` is "pandas", "polars" or "arrow"; a frame of "arrow" is
    a ColumnTable, which any library with the Arrow PyCapsule interface reads without a copy.

    The columns are the fields, in SI units, in the order of their first occurrence; an event has its class's name in
    the column `event`. A vector has one column for each component (position_x, position_y, position_z, m), and a record
    within an event one for each field (features_clearance, m). Any other tuple is one column of lists. A value that a
    record does not have is missing in its row. Four columns are not named as their fields, because another event has a
    value of another kind or unit in a field of that name: level_name, phase_name, turn_name and offset_sigma
    (columns.py).

    Units are in `frame.attrs["units"]` of pandas, by column; in the metadata "unit" of a field of Arrow; and in
    `ColumnTable.units`. Polars has no place for them. ImportError when the library is not installed."""
    table = table_of(records, of)
    if library == "arrow":
        return table
    names = LIBRARIES if library is None else (library,)
    if not set(names) <= set(LIBRARIES):
        raise ValueError(f'library is "pandas", "polars" or "arrow", not {library!r}')
    for name in names:
        try:
            module = import_module(name)
        except ImportError:
            continue
        return _pandas(module, table) if name == "pandas" else module.DataFrame(table)
    hint = "pip install polars" if library == "polars" else install_hint("frames")
    raise ImportError(f"to_frame needs {' or '.join(names)}: {hint}") from None


def _pandas(pandas: Any, table: ColumnTable) -> Any:
    frame = pandas.DataFrame({column.name: _series(pandas, column) for column in table.columns})
    frame.attrs["units"] = table.units
    return frame


def _series(pandas: Any, column: TableColumn) -> Any:
    kinds = WHOLE if column.kind is ValueKind.FLOAT or None not in column.values else WITH_MISSING
    return pandas.Series(column.values, dtype=kinds.get(column.kind, "object"))
