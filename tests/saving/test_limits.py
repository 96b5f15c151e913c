"""Reading a state takes memory and time in proportion to what a state may have, whatever the bytes or the JSON hold."""

from __future__ import annotations

import tracemalloc
import zlib
from collections.abc import Callable
from typing import Any

import pytest
from made import places, replaced
from signed import signed

from solepath import Session, SnapshotError
from solepath.saving.codec import no_class
from solepath.saving.limits import MAX_DEPTH, MAX_SIZE, MAX_VALUES, check_size
from solepath.saving.streams import HEADER, Lists, from_bytes, to_bytes
from solepath.session.packed import HEADER as SESSION_HEADER

START = Session().pack()[: SESSION_HEADER.size]


def body_of(counts: tuple[int, int, int, int], rest: bytes) -> bytes:
    return zlib.compress(HEADER.pack(*counts) + rest)


@pytest.mark.parametrize("counts", [(MAX_VALUES + 1, 0, 0, 0), (0, MAX_VALUES + 1, 0, 0), (0, 0, MAX_VALUES + 1, 0),
                                    (MAX_VALUES, 1, 0, 0), (2**31, 2**31, 2**31, 0)])  # fmt: skip
def test_more_values_than_a_state_may_have_are_not_read(counts: tuple[int, int, int, int]) -> None:
    saved = signed(START + body_of(counts, bytes(MAX_SIZE)))
    tracemalloc.start()
    with pytest.raises(SnapshotError, match=f"no state has more than {MAX_VALUES} values"):
        Session.unpack(saved)
    assert tracemalloc.get_traced_memory()[1] < 2_000_000
    tracemalloc.stop()


def test_what_could_not_be_read_is_not_written() -> None:
    assert [*from_bytes(to_bytes(Lists([0.0] * MAX_VALUES, [], [], [])), no_class).floats] == [0.0] * MAX_VALUES
    with pytest.raises(ValueError, match="no state has more"):
        to_bytes(Lists([0.0] * MAX_VALUES, [1], [], []))
    check_size([0.0] * MAX_VALUES)
    with pytest.raises(ValueError, match="no snapshot has more"):
        check_size([0.0] * MAX_VALUES + [0.0])


def nested(depth: int) -> Any:
    value: Any = []
    for _ in range(depth):
        value = [value]
    return value


def endless() -> list[Any]:
    value: list[Any] = []
    value.append(value)
    return value


HOSTILE_VALUES: dict[str, Callable[[], Any]] = {
    "deep": lambda: nested(1_000_000),
    "just too deep": lambda: nested(MAX_DEPTH + 1),
    "endless": endless,
    "long": lambda: [0.5] * (MAX_VALUES + 1),
    "long object": lambda: dict.fromkeys(map(str, range(MAX_VALUES + 1))),
    "long text": lambda: "x" * (MAX_SIZE + 1),
    "very huge": lambda: 1 << 10_000_000,
}
"""Functions that return a value; each is called in its own test, since millions of values would slow all others."""


@pytest.mark.parametrize("what", HOSTILE_VALUES)
def test_hostile_json_is_rejected_in_one_sentence(what: str) -> None:
    state, hostile = Session().snapshot(), HOSTILE_VALUES[what]()
    for place in (every := places(state))[:: len(every) // 15]:
        with pytest.raises(SnapshotError) as caught:
            Session.restore(replaced(state, place, hostile))
        text = str(caught.value)
        assert text and "\n" not in text and len(text) < 300
