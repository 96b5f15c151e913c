"""A fleet on bytewax: every wearer's events are those of a session without engine, however the engine runs it."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import timedelta
from pathlib import Path
from random import Random
from typing import Any

import pytest

pytest.importorskip("bytewax", reason="bytewax is not installed: it has no wheels for Python 3.13 and later")

from bytewax import operators
from bytewax.dataflow import Dataflow
from bytewax.recovery import RecoveryConfig, init_db_dir
from bytewax.testing import TestingSink, TestingSource, run_main
from sites import site

from solepath.fleet import Fleet, NumberedEvent
from solepath.fleet.bytewax import gait

INTERVAL = timedelta(milliseconds=20)
"""Time between two snapshots."""


def job(items: Iterable[Any], emitted: list[tuple[str, NumberedEvent]]) -> Dataflow:
    """Run a fleet from a list to a list; the source saves its position in the recovery store, the sink nothing."""
    flow = Dataflow("job")
    sent = operators.input("sent", flow, TestingSource(items, batch_size=50))
    operators.output("events", gait("gait", sent, Fleet()), TestingSink(emitted))
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


def test_each_wearer_has_the_events_of_a_session_of_their_own_also_when_the_job_breaks_off_again_and_again(
    store: RecoveryConfig,
) -> None:
    sent, events = site()
    items: list[Any] = list(sent)
    for place in sorted(Random(1).sample(range(len(items)), 3), reverse=True):
        items.insert(place, TestingSource.ABORT())
    emitted: list[tuple[str, NumberedEvent]] = []
    flow = job(items, emitted)
    for _ in range(3):
        run_main(flow, epoch_interval=INTERVAL, recovery_config=store)
        assert by_wearer(emitted) != events
    run_main(flow, epoch_interval=INTERVAL, recovery_config=store)
    assert by_wearer(emitted) == events
