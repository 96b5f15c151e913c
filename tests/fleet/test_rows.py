"""Rows and lines of a fleet: protocol/fleet/lines.json, and any other content of a table or a topic."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from math import nan
from typing import Any, get_args, get_origin, get_type_hints

import attrs
import pytest
from fleets import walked
from here import PROTOCOL
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.events import Event, HeelStrike, PacketRejected, Rejection
from solepath.events.happening import Happening
from solepath.fleet import (
    EVENT_COLUMNS,
    SENT_COLUMNS,
    End,
    Fleet,
    FleetEvent,
    NumberedEvent,
    NumbersMissing,
    Sent,
    SentRejection,
    Tick,
    Unreadable,
    event_row,
    read_line,
    read_lines,
    read_sent,
    sent_line,
    sent_row,
)
from solepath.fleet.step.sent import MAX_COUNT, MAX_DATA_LENGTH, MAX_NAME_LENGTH
from solepath.types import Foot, Packet, Site
from solepath.types.attrs import frozen

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


@settings(max_examples=60)
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
@given(some=st.lists(st.tuples(st.sampled_from("ab"), COUNTS)))
def test_lines_are_read_as_a_list_for_each_wearer_in_their_order(some: list[tuple[str, int]]) -> None:
    sent = [Sent(wearer, number, End()) for wearer, number in some]
    read = read_lines([*map(sent_line, sent), b"{"])
    expected = {name: [one for one in sent if one.wearer == name] for name, _ in some}
    assert dict(read[:-1]) == expected and list(expected) == [name for name, _ in read[:-1]]
    assert read[-1] == ("", [read_line(b"{")])


def test_a_row_of_an_event_has_what_its_line_in_a_file_has() -> None:
    for event in walked().events:
        record = event.to_dict()
        columns = {key: record.pop(key, None) for key in ("event", "t", "known_at", "final", "foot")}
        assert event_row(NumberedEvent("w", 7, event)) == {
            "wearer": "w", "number": 7, **columns, "fields": json.dumps(record)
        }  # fmt: skip


@frozen(kw_only=True)
class Counted(Happening):
    """An app's own event with mappings, which no event of solepath has."""

    counts: dict[Any, Any]
    inner: tuple[Any, ...] = ()


@settings(max_examples=60)
@given(counts=st.dictionaries(st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), NAMES), st.floats()))
def test_a_row_has_the_keys_of_mappings_that_its_line_in_a_file_has(counts: dict[Any, float]) -> None:
    event = Counted(t=1.0, known_at=1.0, counts=counts, inner=({True: None, None: False, 2: b"a"},))
    record = event.to_dict()
    fields = event_row(NumberedEvent("w", 0, event))["fields"]
    assert fields == json.dumps({"counts": record["counts"], "inner": record["inner"]}, allow_nan=False)


def annotations(cls: Any) -> Iterator[Any]:
    """Yield all types of which a value of this type is made."""
    yield cls
    inner = get_type_hints(cls).values() if attrs.has(cls) else get_args(cls)
    for one in inner:
        yield from annotations(one)


def may_hold_a_mapping(cls: type) -> bool:
    return any(
        one in (Any, object) or isinstance(plain := get_origin(one) or one, type) and issubclass(plain, Mapping)
        for one in annotations(cls)
    )


def test_no_event_of_the_package_has_a_mapping() -> None:
    assert [cls for cls in (*get_args(Event), *get_args(FleetEvent)) if may_hold_a_mapping(cls)] == []
    assert may_hold_a_mapping(Counted)


def test_a_row_holds_no_more_than_a_phone_sends() -> None:
    row = sent_row(Sent("w", 3, Packet(1.0, Site.PELVIS, "c", bytes(MAX_DATA_LENGTH), "d" * MAX_NAME_LENGTH)))
    assert isinstance(read_sent(row), Sent)
    for key, value in (("data", bytes(MAX_DATA_LENGTH + 1)), ("channel", "c" * 257), ("device", "d" * 257)):
        assert read_sent(row | {key: value}) == Unreadable("w", read_sent(row | {key: value}).what, 0, 3)


def test_tables_may_bring_bytes_and_numbers_of_their_own_kinds() -> None:
    numpy = pytest.importorskip("numpy")
    row = sent_row(Sent("w", 3, Packet(1.0, Site.PELVIS, "c", b"ab"), 2))
    own = {"data": bytearray(b"ab"), "number": numpy.int64(3), "run": numpy.int32(2), "t": numpy.float64(1.0)}
    assert read_sent({**row, **own}) == read_sent(row)
    assert type(read_sent({**row, **own}).number) is int


def test_an_event_is_a_row_with_its_identity_its_times_its_foot_and_the_rest_as_json() -> None:
    numbered = NumberedEvent("w", 7, HeelStrike(t=1.5, known_at=1.75, foot=Foot.LEFT))
    row = event_row(numbered)
    assert row.keys() == EVENT_COLUMNS.keys()
    rest = json.loads(row.pop("fields"))
    assert row == {
        "wearer": "w", "number": 7, "event": "HeelStrike", "t": 1.5, "known_at": 1.75, "final": True, "foot": "left",
    }  # fmt: skip
    assert not rest.keys() & row.keys()


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


def test_the_protocol_names_all_events_of_a_fleet() -> None:
    page = (PROTOCOL / "fleet.md").read_text()
    for kind in FleetEvent.__args__:
        own = {field.name for field in attrs.fields(kind)} - {"t", "known_at", "final"}
        (line,) = [line for line in page.splitlines() if line.startswith(f"| `{kind.__name__}` |")]
        assert own == set(re.findall(r"`(\w+)`", line.split("|")[2]))
    assert all(f"`{reason.value}`" in page for reason in SentRejection)
    assert all(f"| `{name}` |" in page for name in SENT_COLUMNS)
