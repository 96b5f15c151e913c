"""The order of a phone's rows: protocol/fleet/stories.json; rows that are late, repeated or lost; new runs."""

from __future__ import annotations

import json
from typing import Any

import pytest
from fleets import WEARER, cut, shown, stepped, uses
from here import PROTOCOL
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.fleet import End, Fleet, Sent, Tick, read_line
from solepath.fleet.step.sent import MAX_COUNT

STORIES = json.loads((PROTOCOL / "fleet" / "stories.json").read_text())
NARROW_FLEET = Fleet(window=3)


def as_used(gives: list[dict[str, Any]]) -> list[tuple[Any, ...]]:
    """Return the outcome of a story in the form of `uses`; no event shows that an end was used."""
    words = {"used": "number", "missing": "first", "rejected": "number"}
    return [(one["what"], one["run"], one[words[one["what"]]], more(one)) for one in gives if one["what"] != "ended"]


def more(one: dict[str, Any]) -> Any:
    if one["what"] == "rejected":
        return (one["reason"], one["count"]) if "count" in one else one["reason"]
    return one.get("count")


@pytest.mark.parametrize("story", STORIES["stories"], ids=lambda story: story["title"])
def test_rows_become_the_events_of_their_story(story: dict[str, Any]) -> None:
    fleet, state, numbers = Fleet(window=story["window"]), None, []
    for line in story["rows"]:
        sent = read_line(json.dumps(line["row"]).encode())
        state, emitted = fleet.step(WEARER, state, [sent])
        numbers += [one.number for one in emitted]
        gives = line["gives"]
        assert uses(emitted) == as_used(gives), line["row"]
        if any(one["what"] in ("used", "ended") for one in gives):
            used = [one["what"] for one in gives if one["what"] in ("used", "ended")]
            assert fleet.open(WEARER, state).ended is (used[-1] == "ended")
    assert numbers == list(range(len(numbers)))


def rows(count: int, ended: bool) -> list[Sent]:
    ordered = [shown(number) for number in range(count)]
    return [*ordered, Sent(WEARER, count, End())] if ended else ordered


@settings(max_examples=40)
@given(
    late=st.lists(st.integers(0, 3), max_size=12),
    ended=st.booleans(),
    again=st.lists(st.tuples(st.integers(0, 11), st.integers(0, 20)), max_size=6),
    cuts=st.lists(st.integers(0, 20), max_size=4),
)
def test_rows_that_are_late_or_doubled_within_the_window_give_the_events_and_the_state_of_the_ordered_stream(
    late: list[int], ended: bool, again: list[tuple[int, int]], cuts: list[int]
) -> None:
    """Return rows in which each comes up to `late` places after its turn, and `again` copies come later."""
    ordered = rows(len(late), ended)
    places = [number + by for number, by in enumerate(late)] + ([len(late)] if ended else [])
    arrived = [one for _, one in sorted(zip(places, ordered, strict=True), key=lambda pair: pair[0])]
    for number, after in again:
        if number < len(ordered):
            arrived.insert(min(len(arrived), arrived.index(ordered[number]) + 1 + after), ordered[number])
    assert stepped(NARROW_FLEET, cut(arrived, cuts)) == stepped(NARROW_FLEET, [ordered])


ANY_ROW = st.one_of(
    st.builds(shown, st.integers(0, 9), st.integers(0, 2)),
    st.builds(shown, st.integers(0, MAX_COUNT), st.integers(0, MAX_COUNT)),
    st.builds(lambda number, run: Sent(WEARER, number, End(), run), st.integers(0, 9), st.integers(0, 2)),
    st.builds(lambda number, t: Sent(WEARER, number, Tick(t)), st.integers(0, 9), st.floats()),
)


@settings(max_examples=40)
@given(arrived=st.lists(ANY_ROW, max_size=25), cuts=st.lists(st.integers(0, 25), max_size=6))
def test_how_rows_are_cut_into_calls_changes_nothing_whatever_they_are(arrived: list[Sent], cuts: list[int]) -> None:
    state, emitted = stepped(NARROW_FLEET, cut(arrived, cuts))
    keyed = NARROW_FLEET.open(WEARER, None)
    assert keyed.feed(arrived) == emitted
    assert keyed.state() == state
    assert [one.number for one in emitted] == list(range(len(emitted)))
