"""Tables through the Arrow PyCapsule interface: other libraries read them, keep them and give their memory back."""

from __future__ import annotations

import gc
from typing import Any

import pytest
from walks import insoles

from solepath import Session, to_frame
from solepath.emulate import Route
from solepath.events.frames.arrow import _ALIVE
from solepath.events.frames.columns import ColumnTable

pyarrow = pytest.importorskip("pyarrow", reason="pyarrow is not installed")
polars = pytest.importorskip("polars", reason="polars is not installed")
WALK = insoles(Route().stand(2).walk(8).stop(2))


@pytest.fixture(scope="module")
def table() -> ColumnTable:
    session = Session()
    made: ColumnTable = to_frame([*session.feed(WALK.packets), *session.finish()], library="arrow")
    return made


def plain(value: Any) -> Any:
    """Return lists for tuples, as Arrow has them."""
    return [plain(each) for each in value] if isinstance(value, tuple | list) else value


def test_arrow_finds_the_memory_sound_and_the_same_values_and_units_in_it(table: ColumnTable) -> None:
    read = pyarrow.table(table)
    read.validate(full=True)
    assert read.num_rows == len(table) > 50
    for column in table.columns:
        assert read[column.name].to_pylist() == plain(column.values), column.name
        metadata = read.schema.field(column.name).metadata or {}
        assert metadata.get(b"unit") == (None if column.unit is None else column.unit.encode()), column.name
    assert pyarrow.schema(table).equals(read.schema, check_metadata=True)


def test_a_column_outlives_the_table_and_memory_is_given_back(table: ColumnTable) -> None:
    gc.collect()
    before = len(_ALIVE)
    read, frame = pyarrow.table(table), polars.DataFrame(table)
    column, series = read["t"], frame["covariance_yy"]
    unread = table.__arrow_c_stream__(), table.__arrow_c_schema__()
    assert len(_ALIVE) > before
    del read, frame, unread
    gc.collect()
    values = {one.name: one.values for one in table.columns}
    assert column.to_pylist() == values["t"] and series.to_list() == values["covariance_yy"]
    del column, series
    gc.collect()
    assert len(_ALIVE) == before
