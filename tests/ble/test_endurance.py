"""Forced disconnections all along a walk, through true ATT: every one is a gap, and nothing is left behind by it."""

from __future__ import annotations

import asyncio
import gc
import sys
import threading
from array import array
from typing import Any

import pytest
from airs import bumble, in_virtual_time, others
from soak import longer

from solepath import Connected, Disconnected, PacketRejected, SampleGap, Session, StrideTaken
from solepath.ble import DeviceConfig, Devices
from solepath.emulate import Insole, Route
from solepath.emulate.devices.bench import Bench
from solepath.emulate.devices.faults import Fault, FaultKind
from solepath.link.devices.insole import PROFILE as INSOLE
from solepath.types import Foot, Site

FEET = (Site.LEFT_FOOT, Site.RIGHT_FOOT)
FIRST_CUT, CUT_INTERVAL = 3.2, 0.81
"""Time of the first link loss in the walk, and interval between losses, s.

The feet take turns. The interval differs from a stride's duration, 1.1 s, so that losses occur anywhere in a stride."""
ROUTES = {
    40: Route().stand(3.0).walk(44.0).stop(3.0),
    200: Route().stand(3.0).walk(90.0).turn(1.5, radius=2.0).walk(60.0).turn(-1.5, radius=2.0).walk(60.0).stop(3.0),
}
"""Route for each number of link losses."""


def advertises(task: asyncio.Task[Any]) -> bool:
    """Return whether the task is an emulated device that advertises again after the loss of its link."""
    return getattr(task.get_coro(), "__qualname__", "") == "Server._advertise"


@pytest.mark.parametrize("cuts", longer(40, 200))
def test_a_session_goes_on_through_any_number_of_disconnections_every_gap_is_an_event_and_nothing_is_left_behind(
    cuts: int,
) -> None:
    faults = [Fault(FIRST_CUT + CUT_INTERVAL * k, FEET[k % 2], FaultKind.DISCONNECT) for k in range(cuts)]
    insoles = {site: Insole(cells=24, rate=50.0) for site in FEET}
    bench = Bench(ROUTES[cuts], devices=insoles, seed=1, faults=faults)
    truth = bench.truth()
    assert truth.duration - 2.0 > FIRST_CUT + CUT_INTERVAL * cuts
    counts = dict.fromkeys((StrideTaken, Connected, Disconnected, PacketRejected), 0)
    # an array is one block of memory, so that its growth does not look like a leak
    gaps, tasks, threads, blocks = array("d"), array("l"), array("l"), array("l")

    async def listen() -> int:
        started_at = asyncio.get_running_loop().time() + 3.0
        bench.walk_from(started_at)
        bench.prepare()
        session = Session()
        async with bumble(bench) as backend:
            before = others()
            async with Devices([DeviceConfig(None, profile=INSOLE)] * 2, backend=backend) as devices:
                async for packet in devices:
                    if packet.t > started_at + truth.duration:
                        break
                    for event in session.feed(packet):
                        if type(event) in counts:
                            counts[type(event)] += 1
                        if isinstance(event, SampleGap) and event.longest > 0.05:
                            gaps.append(event.longest)
                        if isinstance(event, Connected):
                            gc.collect()
                            tasks.append(len(others()))
                            threads.append(threading.active_count())
                            blocks.append(sys.getallocatedblocks())
            left = sum(not advertises(task) for task in others() - before)
        assert not others()
        return left

    threads_before = threading.active_count()
    assert in_virtual_time(listen) == 0
    true = sum(len(truth.strides(foot)) for foot in Foot)
    assert (counts[Connected], counts[Disconnected], counts[PacketRejected]) == (cuts + 2, cuts, 0)
    assert true > 1.5 * cuts and abs(counts[StrideTaken] - true) <= 0.02 * true
    # each cut costs samples, so each is a gap; none is longer than it takes to find and set up a device again
    assert len(gaps) == cuts and max(gaps) < 0.5
    assert max(tasks[-cuts // 4 :]) <= max(tasks[: cuts // 4])
    assert set(threads) == {threads_before}
    if cuts == 200:  # a session fills its windows during the first ones
        assert blocks[-1] - blocks[60] <= 10 * 140
