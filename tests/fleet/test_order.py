"""The order of what a phone sends: protocol/fleet/stories.json, and whatever late, doubled and lost rows do to it."""

from __future__ import annotations

import json
from typing import Any

import pytest
from fleets import WEARER, cut, shown, stepped, uses
from here import PROTOCOL
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.fleet import End, Fleet, NumbersMissing, Sent, Tick, read_line
from solepath.fleet.step.order import HELD
from solepath.fleet.step.sent import LONGEST_DATA, MOST
from solepath.types import Packet, Site

STORIES = json.loads((PROTOCOL / "fleet" / "stories.json").read_text())
FLEET = Fleet()
NARROW = Fleet(window=3)


def as_used(gives: list[dict[str, Any]]) -> list[tuple[Any, ...]]:
    """What a story says, as `uses` has it; that an end was used shows in no event."""
    words = {"used": "number", "missing": "first", "rejected": "number"}
    return [(one["what"], one["run"], one[words[one["what"]]], more(one)) for one in gives if one["what"] != "ended"]


def more(one: dict[str, Any]) -> Any:
    if one["what"] == "rejected":
        return (one["reason"], one["count"]) if "count" in one else one["reason"]
    return one.get("count")


@pytest.mark.parametrize("story", STORIES["stories"], ids=lambda story: story["title"])
def test_rows_become_what_their_story_says(story: dict[str, Any]) -> None:
    fleet, state, numbers = Fleet(window=story["window"]), None, []
    for line in story["rows"]:
        sent = read_line(json.dumps(line["row"]).encode())
        state, told = fleet.step(WEARER, state, [sent])
        numbers += [one.number for one in told]
        gives = line["gives"]
        assert uses(told) == as_used(gives), line["row"]
        if any(one["what"] in ("used", "ended") for one in gives):
            used = [one["what"] for one in gives if one["what"] in ("used", "ended")]
            assert fleet.open(WEARER, state).ended is (used[-1] == "ended")
    assert numbers == list(range(len(numbers)))


def test_there_are_as_many_stories_as_they_say() -> None:
    assert STORIES["schema"] == "solepath fleet stories 1" and STORIES["count"] == len(STORIES["stories"])


def rows(count: int, ended: bool) -> list[Sent]:
    ordered = [shown(number) for number in range(count)]
    return [*ordered, Sent(WEARER, count, End())] if ended else ordered


@settings(max_examples=40, deadline=None)
@given(
    late=st.lists(st.integers(0, 3), max_size=12),
    ended=st.booleans(),
    again=st.lists(st.tuples(st.integers(0, 11), st.integers(0, 20)), max_size=6),
    cuts=st.lists(st.integers(0, 20), max_size=4),
)
def test_rows_that_are_late_or_doubled_within_the_window_give_the_events_and_the_state_of_the_ordered_stream(
    late: list[int], ended: bool, again: list[tuple[int, int]], cuts: list[int]
) -> None:
    """`late`: by how many places each row may come later than its turn; `again`: copies that come some time after."""
    ordered = rows(len(late), ended)
    places = [number + by for number, by in enumerate(late)] + ([len(late)] if ended else [])
    arrived = [one for _, one in sorted(zip(places, ordered, strict=True), key=lambda pair: pair[0])]
    for number, after in again:
        if number < len(ordered):
            arrived.insert(min(len(arrived), arrived.index(ordered[number]) + 1 + after), ordered[number])
    assert stepped(NARROW, cut(arrived, cuts)) == stepped(NARROW, [ordered])


ANY = st.one_of(
    st.builds(shown, st.integers(0, 9), st.integers(0, 2)),
    st.builds(shown, st.integers(0, MOST), st.integers(0, MOST)),
    st.builds(lambda number, run: Sent(WEARER, number, End(), run), st.integers(0, 9), st.integers(0, 2)),
    st.builds(lambda number, t: Sent(WEARER, number, Tick(t)), st.integers(0, 9), st.floats()),
)


@settings(max_examples=40, deadline=None)
@given(arrived=st.lists(ANY, max_size=25), cuts=st.lists(st.integers(0, 25), max_size=6))
def test_how_rows_are_cut_into_calls_changes_nothing_whatever_they_are(arrived: list[Sent], cuts: list[int]) -> None:
    state, told = stepped(NARROW, cut(arrived, cuts))
    keyed = NARROW.open(WEARER, None)
    assert keyed.feed(arrived) == told
    assert keyed.state() == state
    assert [one.number for one in told] == list(range(len(told)))


@settings(max_examples=40, deadline=None)
@given(arrived=st.lists(st.builds(shown, st.integers(0, 40), st.integers(0, 3)), max_size=60))
def test_no_row_is_used_twice_and_those_of_a_run_are_used_in_order(arrived: list[Sent]) -> None:
    keyed = NARROW.open(WEARER, None)
    used = [(run, number) for what, run, number, _ in uses(keyed.feed(arrived)) if what == "used"]
    assert len(used) == len(set(used))
    assert all(numbers == sorted(numbers) for run in range(4) for numbers in [[n for of, n in used if of == run]])


def test_rows_are_waited_for_as_far_as_the_window_says_and_no_further() -> None:
    window = 256
    assert not uses(FLEET.open(WEARER, None).feed([shown(number) for number in range(1, window + 1)]))
    told = uses(FLEET.open(WEARER, None).feed([shown(number) for number in range(1, window + 2)]))
    assert told[0] == ("missing", 0, 0, 1)
    assert [number for _, _, number, _ in told[1:]] == list(range(1, window + 2))


def test_what_is_held_is_bounded_in_bytes_too() -> None:
    data, count = bytes(LONGEST_DATA), 40
    keyed = FLEET.open(WEARER, None)
    large = [Sent(WEARER, number, Packet(0.0, Site.PELVIS, "story/0-1", data)) for number in range(1, count)]
    fits = HELD // (LONGEST_DATA + len("story/0-1"))
    assert keyed.feed(large[:fits]) == []
    assert HELD // 2 < len(keyed.state()) < HELD + 4096
    told = keyed.feed(large[fits:])
    assert isinstance(told[0].event, NumbersMissing) and len(told) == 1 + len(large)


def test_a_phone_that_loses_every_other_row_is_heard_all_the_same() -> None:
    told = uses(NARROW.open(WEARER, None).feed([shown(number) for number in range(0, 200, 2)]))
    assert [number for what, _, number, _ in told if what == "used"] == list(range(0, 194, 2)), "three are held"
    assert sum(count for what, _, _, count in told if what == "missing") == 96


def test_what_was_given_up_long_ago_is_forgotten_but_nothing_is_used_twice() -> None:
    keyed = Fleet(window=0).open(WEARER, None)
    keyed.feed([shown(number) for number in range(0, 100, 2)])
    late = uses(keyed.feed([shown(number) for number in range(100)]))
    known = [(67, "late"), (69, ("late", 2)), (73, ("late", 4)), (81, ("late", 8)), (97, ("late", 16))]
    assert late == [*[("rejected", 0, *one) for one in known], ("used", 0, 99, None)], "16 spans are remembered"
