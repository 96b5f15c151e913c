"""Tables of Arrow: values and units are those of the events, and other libraries read them."""

from __future__ import annotations

import pytest
from walks import insoles

from solepath import Session, to_frame
from solepath.emulate import Route

pyarrow = pytest.importorskip("pyarrow", reason="pyarrow is not installed")
polars = pytest.importorskip("polars", reason="polars is not installed")
pandas = pytest.importorskip("pandas", reason="pandas is not installed")


def test_a_table_of_arrow_has_the_values_and_units_of_the_frame() -> None:
    session = Session()
    events = [*session.feed(insoles(Route().stand(2).walk(8).stop(2)).packets), *session.finish()]
    table, frame = to_frame(events, library="arrow"), to_frame(events, library="pandas")
    table.validate(full=True)
    assert table.num_rows == len(events) > 50 and table.column_names == list(frame.columns)
    for name in table.column_names:
        metadata = table.schema.field(name).metadata or {}
        assert metadata.get(b"unit", b"").decode() == frame.attrs["units"].get(name, ""), name
        found = [value.item() if hasattr(value, "item") else value for value in frame[name]]
        expected = [None if value is pandas.NA or value != value else value for value in found]
        assert table[name].to_pylist() == expected, name
    assert polars.DataFrame(table).equals(to_frame(events, library="polars"))
