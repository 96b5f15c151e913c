"""Rows and lines of a fleet: protocol/fleet/lines.json, and any other content of a table or a topic."""

from __future__ import annotations

import json
from math import nan
from typing import Any

import pytest
from fleets import walked
from here import PROTOCOL
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.events import PacketRejected, Rejection
from solepath.fleet import (
    EVENT_COLUMNS,
    SENT_COLUMNS,
    End,
    Fleet,
    NumberedEvent,
    NumbersMissing,
    Sent,
    Tick,
    Unreadable,
    event_row,
    read_line,
    read_message,
    read_sent,
    sent_line,
    sent_row,
)
from solepath.fleet.step.sent import MAX_COUNT
from solepath.types import Packet, Site

LINES = json.loads((PROTOCOL / "fleet" / "lines.json").read_text())
NAMES = st.text(st.characters(exclude_categories=["Cs"]), max_size=8)
COUNTS = st.integers(0, MAX_COUNT)
TIMES = st.floats(allow_nan=False, allow_infinity=False)
PACKETS = st.builds(Packet, TIMES, st.sampled_from(Site), NAMES, st.binary(max_size=8), NAMES)
SENT = st.builds(Sent, NAMES, COUNTS, st.one_of(PACKETS, st.builds(Tick, TIMES), st.just(End())), COUNTS)
ANYTHING = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5), st.binary(max_size=5)),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=3), inner, max_size=3)),
    max_leaves=6,
)


def as_fields(sent: Sent) -> dict[str, Any]:
    """Return the item with the keys of the lines."""
    match sent.what:
        case Packet(t, site, channel, data, device):
            what = {"t": t, "site": site.value, "channel": channel, "data": data.hex(), "device": device}
            return {"wearer": sent.wearer, "run": sent.run, "number": sent.number, "packet": what}
        case Tick(t):
            return {"wearer": sent.wearer, "run": sent.run, "number": sent.number, "tick": t}
    return {"wearer": sent.wearer, "run": sent.run, "number": sent.number, "end": True}


@pytest.mark.parametrize("line", LINES["lines"], ids=lambda line: line["id"])
def test_a_line_is_as_in_the_protocol(line: dict[str, Any]) -> None:
    read = read_line(line["line"].encode())
    if line["result"] == "valid":
        assert isinstance(read, Sent) and as_fields(read) == line["sent"]
        assert (sent_line(read) == line["line"].encode() + b"\n") is line["canonical"]
    else:
        assert isinstance(read, Unreadable) and read.what
        assert (read.wearer, read.run, read.number) == (line["wearer"], line["run"], line["number"])


@settings(max_examples=60)
@given(sent=SENT)
def test_what_is_sent_is_read_again_from_its_row_and_from_its_line(sent: Sent) -> None:
    row = sent_row(sent)
    assert row.keys() == SENT_COLUMNS.keys()
    assert read_sent(row) == sent == read_line(sent_line(sent))
    assert all(value is None or type(value) is SENT_COLUMNS[name] for name, value in row.items())


@settings(max_examples=25)
@given(row=st.one_of(ANYTHING, st.fixed_dictionaries({}, optional=dict.fromkeys(SENT_COLUMNS, ANYTHING))))
def test_a_row_of_anything_is_read_or_is_unreadable(row: Any) -> None:
    assert isinstance(read_sent(row), Sent | Unreadable)


@settings(max_examples=60)
@given(sent=SENT, at=st.integers(0, 400), byte=st.integers(0, 255), end=st.integers(0, 400))
def test_a_line_that_was_torn_or_damaged_is_read_or_is_unreadable(sent: Sent, at: int, byte: int, end: int) -> None:
    line = bytearray(sent_line(sent))
    line[at % len(line)] = byte
    assert isinstance(read_line(bytes(line)), Sent | Unreadable)
    assert isinstance(read_line(sent_line(sent)[: min(end, len(line) - 2)]), Unreadable)


def test_what_is_no_line_is_unreadable() -> None:
    for line in (None, "text", b"\xff", b"[" * 50_000, b"1" * 70_000, b'{"number":' + b"9" * 5000 + b"}"):
        assert isinstance(read_line(line), Unreadable)


@settings(max_examples=60)
@given(some=st.lists(st.tuples(st.sampled_from("ab"), COUNTS), min_size=1))
def test_a_message_holds_lines_of_its_wearer_and_takes_no_other(some: list[tuple[str, int]]) -> None:
    sent = [Sent(wearer, number, End()) for wearer, number in some]
    read = read_message("a", b"".join([*map(sent_line, sent), b"{"]))
    assert [one for one in read if isinstance(one, Sent)] == [one for one in sent if one.wearer == "a"]
    assert len(read) == len(sent) + 1 and read[-1] == read_line(b"{")
    assert all(one.number is None for one in read if isinstance(one, Unreadable))


def test_a_message_without_lines_or_with_too_many_is_one_unreadable_row() -> None:
    for value in (None, "text", b"", b"\n\n", b"{}\n" * 5000):
        assert len(read_message("a", value)) == 1


def test_a_row_of_an_event_has_what_its_line_in_a_file_has() -> None:
    for event in walked().events:
        record = event.to_dict()
        columns = {key: record.pop(key, None) for key in ("event", "t", "known_at", "final", "foot")}
        assert event_row(NumberedEvent("w", 7, event)) == {
            "wearer": "w", "number": 7, **columns, "fields": json.dumps(record)
        }  # fmt: skip


def test_an_event_without_a_foot_or_with_a_time_that_is_none_is_a_row_too() -> None:
    missing = event_row(NumberedEvent("w", 0, NumbersMissing(t=0.0, known_at=0.0, run=0, first=3, count=4)))
    assert missing["foot"] is None and json.loads(missing["fields"]) == {"run": 0, "first": 3, "count": 4}
    lost = PacketRejected(t=nan, known_at=1.0, site=Site.PELVIS, channel="\ud83d", reason=Rejection.NOT_FINITE)
    row = event_row(NumberedEvent("w", 1, lost))
    assert row["t"] is None and json.loads(row["fields"])["channel"] == "\ud83d"


def test_every_event_of_a_walk_is_a_row_of_the_columns() -> None:
    _, numbered = Fleet(poses=True, pressures=True).step("w", None, walked().sent[:300])
    assert len(numbered) > 300
    for one in numbered:
        row = event_row(one)
        assert all(value is None or type(value) is EVENT_COLUMNS[name] for name, value in row.items()), one
