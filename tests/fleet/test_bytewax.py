"""A fleet on bytewax: every wearer's events are those of a session without engine, however the engine runs it."""

from __future__ import annotations

import gc
import pickle
import sqlite3
from binascii import crc32
from collections.abc import Iterable, Iterator
from contextlib import closing
from datetime import timedelta
from pathlib import Path
from random import Random
from typing import Any

import pytest

pytest.importorskip("bytewax", reason="bytewax is not installed: it has no wheels for Python 3.13 and later")

from bytewax import operators
from bytewax.dataflow import Dataflow
from bytewax.recovery import RecoveryConfig, init_db_dir
from bytewax.testing import TestingSink, TestingSource, cluster_main, run_main
from sites import RECIPES, mixed, site

from solepath.fleet import End, Fleet, Keyed, NumberedEvent, Sent, SentRejection, StateRejected, Tick, Unreadable
from solepath.fleet.bytewax import gait, purge
from solepath.session import Session
from solepath.types import Packet, Site

INTERVAL = timedelta(milliseconds=20)
"""Time between two snapshots."""


def job(
    items: Iterable[Any], emitted: list[tuple[str, NumberedEvent]], recipe: str = "default", **options: Any
) -> Dataflow:
    """Run a fleet from a list to a list; the source saves its position in the recovery store, the sink nothing."""
    flow = Dataflow("job")
    sent = operators.input("sent", flow, TestingSource(items, batch_size=50))
    operators.output("events", gait("gait", sent, Fleet(RECIPES[recipe]), **options), TestingSink(emitted))
    return flow


def by_wearer(emitted: Iterable[tuple[str, NumberedEvent]]) -> dict[str, list[Any]]:
    """Return the events of each wearer in the order of their numbers, without gaps; repeated ones must be equal."""
    found: dict[str, dict[int, Any]] = {}
    for wearer, one in emitted:
        assert one.wearer == wearer
        assert found.setdefault(wearer, {}).setdefault(one.number, one.event) == one.event
    assert all(sorted(numbers) == list(range(len(numbers))) for numbers in found.values())
    return {wearer: [numbers[number] for number in sorted(numbers)] for wearer, numbers in found.items()}


@pytest.fixture
def store(tmp_path: Path) -> RecoveryConfig:
    init_db_dir(tmp_path, 1)
    return RecoveryConfig(str(tmp_path))


@pytest.mark.parametrize("recipe", RECIPES)
def test_each_wearer_has_the_events_of_a_session_of_their_own_also_when_the_job_breaks_off_again_and_again(
    recipe: str, store: RecoveryConfig
) -> None:
    sent, events = site(recipe)
    items: list[Any] = list(sent)
    for place in sorted(Random(1).sample(range(len(items)), 3), reverse=True):
        items.insert(place, TestingSource.ABORT())
    emitted: list[tuple[str, NumberedEvent]] = []
    flow = job(items, emitted, recipe)
    for _ in range(3):
        run_main(flow, epoch_interval=INTERVAL, recovery_config=store)
        assert by_wearer(emitted) != events
    run_main(flow, epoch_interval=INTERVAL, recovery_config=store)
    assert by_wearer(emitted) == events


def test_wearers_are_divided_among_workers_and_move_when_their_number_changes(store: RecoveryConfig) -> None:
    sent, events = site()
    third = len(sent) // 3
    pause = TestingSource.EOF()
    emitted: list[tuple[str, NumberedEvent]] = []
    flow = job([*sent[:third], pause, *sent[third : 2 * third], pause, *sent[2 * third :]], emitted)
    for workers in (2, 3, 1):
        cluster_main(flow, [], 0, epoch_interval=INTERVAL, recovery_config=store, worker_count_per_proc=workers)
    assert by_wearer(emitted) == events


def test_what_was_sent_may_come_in_lists_and_sessions_are_put_away_while_nothing_comes() -> None:
    sent, events = site()
    gc.collect()
    before, left = living(), []

    def lists() -> Iterator[Any]:
        for at in range(0, len(sent), 400):
            piece: dict[str, list[Any]] = {}
            for wearer, one in sent[at : at + 400]:
                piece.setdefault(wearer, []).append(one)
            yield from piece.items()
            for _ in range(1000):
                yield TestingSource.PAUSE(timedelta(milliseconds=2))
                if living() == before:
                    break
            left.append(living() - before)

    emitted: list[tuple[str, NumberedEvent]] = []
    run_main(job(lists(), emitted, idle=timedelta(milliseconds=1)))
    assert by_wearer(emitted) == events
    assert left and set(left) == {0}


def test_who_has_ended_is_forgotten_after_a_while_though_the_job_stopped_in_between_and_nobody_else_is(
    tmp_path: Path,
) -> None:
    init_db_dir(tmp_path, 1)
    store, before = RecoveryConfig(str(tmp_path), timedelta(0)), []
    pauses = [TestingSource.PAUSE(timedelta(milliseconds=5))] * 40

    def sent(wearer: str, number: int, what: Tick | End, run: int = 0) -> tuple[str, Sent]:
        return wearer, Sent(wearer, number, what, run)

    def run(items: list[Any], forget: timedelta | None) -> set[str]:
        """Return the wearers whose state is in the store."""
        run_main(job([*before, *items, *pauses], [], forget=forget), epoch_interval=INTERVAL, recovery_config=store)
        before.extend(items)
        with closing(sqlite3.connect(tmp_path / "part-0.sqlite3")) as parts:
            rows = parts.execute("SELECT state_key FROM snaps WHERE step_id LIKE '%gait%' AND ser_change NOT NULL")
            return {wearer for (wearer,) in rows}

    first_rows = [sent(wearer, 0, Tick(1.0)) for wearer in ("ended", "silent", "again")]
    ended = [sent(wearer, 1, End()) for wearer in ("ended", "again")]
    again, more = (sent("again", number, Tick(2.0 + number), run=1) for number in (0, 1))
    assert run([*first_rows, *ended], None) == {"ended", "silent", "again"}
    assert run([again], timedelta(hours=1)) == {"ended", "silent", "again"}
    assert run([more], timedelta(milliseconds=1)) == {"silent", "again"}
    assert b"ended" in (tmp_path / "part-0.sqlite3").read_bytes()
    purge(tmp_path)
    assert not any(b"ended" in path.read_bytes() for path in tmp_path.iterdir())
    assert run([*first_rows, *ended], timedelta(hours=1)) == {"ended", "silent", "again"}


def living() -> int:
    """Return the wearers whose sessions are in memory."""
    return sum([isinstance(one, Keyed) for one in gc.get_objects()])


def test_impossible_rows_are_reported_and_stall_nobody_else() -> None:
    sent, events = site()
    chance = Random(5)
    packet = Packet(0.0, Site.LEFT_FOOT, "x", b"")
    junk: list[Any] = [None, b"", {"wearer": "poison"}, object]
    junk += [Sent("limping", 0, packet), Sent("poison", 10**30, packet), Unreadable("poison", "no row")]
    junk += [
        Sent("poison", n, Packet(chance.choice([0.1 * n, float("nan")]), Site.LEFT_FOOT, channel, chance.randbytes(n)))
        for n, channel in enumerate(["insole/frame", "cc2650/movement", "insole/info", "\x00"] * 100)
    ]
    clean = {name: [one for wearer, one in sent if wearer == name] for name in events}
    emitted: list[tuple[str, NumberedEvent]] = []
    run_main(job(mixed({**clean, "poison": junk}), emitted))
    found = by_wearer(emitted)
    poisoned = found.pop("poison")
    assert found == events
    assert [event.reason for event in poisoned[:7]] == [SentRejection.NOT_SENT] * 6 + [SentRejection.UNREADABLE]
    assert len(poisoned) >= 300


def of_a_version_to_come(state: bytes) -> bytes:
    """Return a state of a later version: its first bytes and their checksum can still be read (protocol/fleet.md)."""
    first = state[:4] + b"\xfe" + state[5:37]
    return first + crc32(first).to_bytes(4, "little") + state[41:]


def test_unusable_states_are_reported_and_restarted_and_the_others_go_on(store: RecoveryConfig, tmp_path: Path) -> None:
    sent, events = site()
    half = len(sent) // 2
    emitted: list[tuple[str, NumberedEvent]] = []
    flow = job([*sent[:half], TestingSource.EOF(), *sent[half:]], emitted)
    run_main(flow, recovery_config=store)
    before = by_wearer(emitted)
    with closing(sqlite3.connect(tmp_path / "part-0.sqlite3")) as kept, kept:
        state = "FROM snaps WHERE step_id LIKE '%gait%' AND state_key"
        (newest,) = kept.execute(f"SELECT ser_change {state} = 'limping' ORDER BY snap_epoch DESC").fetchone()
        new = {"limping": of_a_version_to_come(pickle.loads(newest)[0]), "whole": b"\x00" * 90}
        for wearer, spoiled in new.items():
            kept.execute("UPDATE snaps SET ser_change = ? WHERE state_key = ?", (pickle.dumps((spoiled, None)), wearer))
    run_main(flow, recovery_config=store)
    whole = [one for wearer, one in emitted if wearer == "whole"][len(before["whole"]) :]
    found = by_wearer(one for one in emitted if one[0] != "whole")
    assert found["late"] == events["late"]
    rejected, *rest = found["limping"][len(before["limping"]) :]
    assert isinstance(rejected, StateRejected) and "version 254" in rejected.detail
    assert rest == Session().feed(one.what for wearer, one in sent[half:] if wearer == "limping")
    assert isinstance(whole[0].event, StateRejected) and whole[0].number >= len(before["whole"])
