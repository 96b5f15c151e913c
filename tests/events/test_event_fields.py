"""Each field of an event has a sentence and a column of its frame with its unit, as docs/events.md says."""

from __future__ import annotations

from typing import get_args

import attrs
import event_fields
import pytest
from quoted import run_page

from solepath import Event, to_frame
from solepath.events.frames import RENAMED


def test_every_field_has_a_sentence_and_a_column_of_the_frame_of_its_event_with_its_unit() -> None:
    pytest.importorskip("pandas", reason="pandas is not installed")
    for event in get_args(Event):
        frame = to_frame([], event)
        for name, unit, _ in event_fields.rows(event):
            field, _, of_many = name.replace(".", "_").partition("[]")
            renamed = RENAMED.get((event.__name__, field), field)
            columns = [one for one in frame.columns if one == renamed or one.startswith(f"{renamed}_")]
            assert columns, f"{event.__name__}.{name}"
            assert of_many or not unit or {frame.attrs["units"].get(one) for one in columns} >= {unit}, name


def test_what_is_in_files_is_a_field_and_the_rest_a_property() -> None:
    for event in get_args(Event):
        fields = {field.name for field in attrs.fields(event)}
        for name, _, text in event_fields.rows(event):
            if "." not in name:
                assert (name in fields) is not text.endswith(event_fields.NOT_IN_FILES), f"{event.__name__}.{name}"


def test_the_programs_of_the_page_select_the_cycles_of_the_means_and_those_of_a_runner() -> None:
    pytest.importorskip("pandas", reason="pandas is not installed")
    (out, _), names = run_page("docs/events.md", programs=slice(1, 3))
    selected, of_session = map(float, out.split())
    assert selected == pytest.approx(of_session, rel=1e-9)
    assert names["runs"] and set(names["runs"]) == {None}, "nobody ran"
