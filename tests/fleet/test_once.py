"""Once accepts the first delivery of every event and rejects repeated deliveries."""

from __future__ import annotations

import json

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from solepath.fleet import Once
from solepath.saving.codec import SnapshotError

WEARERS = st.sampled_from(["anna", "bert", ""])
IDENTITIES = st.lists(st.tuples(WEARERS, st.integers(0, 12)), max_size=60)


def passed(once: Once, delivered: list[tuple[str, int]]) -> list[tuple[str, int]]:
    return [identity for identity in delivered if once.accept(*identity)]


@given(IDENTITIES)
@example([("anna", number) for number in (0, 1, 2, 5, 6, 2, 3, 4, 5, 6, 7)])  # of a producer that was killed
def test_whatever_the_order_each_identity_passes_the_first_time_only(delivered: list[tuple[str, int]]) -> None:
    assert passed(Once(), delivered) == list(dict.fromkeys(delivered))


@given(IDENTITIES, st.integers(0, 60))
def test_a_reader_that_was_saved_goes_on_as_if_nothing_had_happened(delivered: list[tuple[str, int]], cut: int) -> None:
    once = Once()
    before = passed(once, delivered[:cut])
    again = Once.restore(json.loads(json.dumps(once.snapshot())))
    assert again == once
    assert before + passed(again, delivered[cut:]) == passed(Once(), delivered)


@given(st.lists(st.integers(0, 10**9), max_size=300), st.integers(1, 4))
def test_what_is_remembered_is_bounded_and_never_lets_a_number_pass_twice(numbers: list[int], limit: int) -> None:
    once = Once(limit)
    accepted = [n for n in numbers if once.accept("anna", n)]
    assert len(set(accepted)) == len(accepted)
    for wearer in map(str, range(2 * limit)):
        assert once.accept(wearer, 0)
    state = once.snapshot()["state"]
    assert isinstance(state, dict) and isinstance(state["_received"], dict)
    assert len(state["_received"]) == limit


def test_a_reader_restarts_from_the_newest_number_of_each_wearer_that_its_table_holds() -> None:
    once = Once.after({"anna": 7})
    assert [once.accept("anna", number) for number in (0, 6, 7, 8)] == [False, False, False, True]
    assert once.accept("bert", 0)


SAVED = Once.after({"anna": 7}).snapshot()


@pytest.mark.parametrize(
    "saved",
    [
        None, {}, {"solepath.once": 2, "state": {}}, {"solepath.once": 1}, {"solepath.once": 1, "state": {}},
        {"solepath.once": 1, "state": {"limit": 0, "_received": {}}},
        {"solepath.once": 1, "state": {"limit": 9, "_received": {"anna": {"end": -1, "missing": []}}}},
        {"solepath.once": 1, "state": {"limit": 9, "_received": {"anna": {"end": 3, "missing": [[2, 5]]}}}},
        {"solepath.once": 1, "state": {"limit": 9, "_received": {"anna": {"end": 9, "missing": [[4, 5], [1, 2]]}}}},
    ],
)  # fmt: skip
def test_an_invalid_snapshot_is_rejected(saved: object) -> None:
    assert Once.restore(SAVED).snapshot() == SAVED
    with pytest.raises(SnapshotError):
        Once.restore(saved)
