"""Forced disconnections all along a walk, through true ATT: sixty of them, and two hundred in a soak."""

from __future__ import annotations

import asyncio
import gc
import sys
import threading
from array import array
from functools import cache
from typing import Any

import numpy as np
import pytest
from airs import bumble, in_virtual_time, others
from attrs import define, field

from solepath import Connected, Disconnected, FootMoved, PacketRejected, SampleGap, Session, StrideTaken
from solepath.ble import DeviceConfig, Devices
from solepath.emulate import Route, emulate
from solepath.emulate.devices.bench import Bench
from solepath.emulate.devices.faults import Fault, FaultKind
from solepath.emulate.sensors.device import Device
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.wearers.truth import Truth
from solepath.lab.measures.strides import position_errors
from solepath.link.devices.insole import PROFILE as INSOLE
from solepath.types import Foot, Site

FEET = (Site.LEFT_FOOT, Site.RIGHT_FOOT)
ROUTE = Route().stand(3.0).walk(90.0).turn(1.5, radius=2.0).walk(60.0).turn(-1.5, radius=2.0).walk(60.0).stop(3.0)
SHORT_ROUTE = Route().stand(3.0).walk(40.0).turn(1.5, radius=2.0).walk(24.0).stop(3.0)
ROUTES = {200: ROUTE, 60: SHORT_ROUTE}
"""Route for each number of link losses."""
FIRST_CUT, CUT_INTERVAL = 3.2, 0.81
"""Time of the first link loss in the walk, and interval between losses, s.

The feet take turns. The interval differs from a stride's duration, 1.1 s, so that losses occur anywhere in a stride."""


def worn() -> dict[Site, Device]:
    """Return insoles at 50 Hz, since half the packets of 100 Hz are enough for the same number of link losses."""
    return {site: Insole(cells=24, rate=50.0) for site in FEET}


@define
class Walked:
    """The result of a walk, collected from the events that an app receives."""

    truth: Truth
    started_at: float = 0.0
    """Start of the walk, s, loop's clock."""
    places: dict[Foot, array[float]] = field(factory=lambda: {foot: array("d") for foot in Foot})
    """Estimated position of each foot at the ends of its true strides, x, y, z in m, one after the other.

    An array is one block of memory, so that its growth does not look like a leak."""
    steps: int = 0
    connected: int = 0
    disconnected: int = 0
    rejected: int = 0
    gaps: array[float] = field(factory=lambda: array("d"))
    """Durations of the gaps, s."""
    tasks: list[int] = field(factory=list)
    """Number of tasks besides those of the app, at every connection."""
    blocks: list[int] = field(factory=list)
    """Number of memory blocks that Python has allocated, at every 20th connection."""
    threads_before: int = 0
    threads: list[int] = field(factory=list)
    """Number of threads at every connection."""
    left: int = -1
    """Number of tasks of the adapter that remain after leaving Devices, while the emulated devices still run."""

    def take(self, event: object) -> None:
        match event:
            case FootMoved(foot=foot, t=t, position=position):
                done = len(self.places[foot]) // 3
                ends = self.ends(foot)
                if done < len(ends) and t - self.started_at >= ends[done]:
                    self.places[foot].extend(position)
            case StrideTaken():
                self.steps += 1
            case Connected():
                self.connected += 1
                self.tasks.append(len(others()))
                self.threads.append(threading.active_count())
                if self.connected % 20 == 0:
                    gc.collect()
                    self.blocks.append(sys.getallocatedblocks())
            case Disconnected():
                self.disconnected += 1
            case PacketRejected():
                self.rejected += 1
            case SampleGap() as gap:
                self.gaps.append(gap.duration)

    def ends(self, foot: Foot) -> list[float]:
        """Return the times between the true strides, at which the foot rests, s."""
        steps = self.truth.strides(foot)
        return [steps[0].t_start, *(step.t_end for step in steps)]

    def error(self) -> float:
        """Return the mean horizontal error of both feet at the ends of their strides, m."""
        errors = []
        for foot in Foot:
            ends = np.array(self.ends(foot))
            true = self.truth.feet[foot].pose(ends).position[:, :2]
            errors += position_errors(ends, true, ends, np.array(self.places[foot]).reshape(-1, 3)).tolist()
        return float(np.mean(errors))


def advertises(task: asyncio.Task[Any]) -> bool:
    """Return whether the task is an emulated device that advertises again after the loss of its link."""
    return getattr(task.get_coro(), "__qualname__", "") == "Server._advertise"


@cache
def walk(seed: int, cuts: int = 200) -> Walked:
    faults = [Fault(FIRST_CUT + CUT_INTERVAL * k, FEET[k % 2], FaultKind.DISCONNECT) for k in range(cuts)]
    bench = Bench(ROUTES[cuts], devices=worn(), seed=seed, faults=faults)
    truth = bench.truth()
    assert truth.duration - 2.0 > FIRST_CUT + CUT_INTERVAL * cuts
    walked = Walked(truth)

    async def listen() -> None:
        started_at = asyncio.get_running_loop().time() + 3.0
        walked.started_at = started_at
        bench.walk_from(started_at)
        bench.prepare()
        session = Session(poses=True)
        async with bumble(bench) as backend:
            before, walked.threads_before = others(), threading.active_count()
            async with Devices([DeviceConfig(None, profile=INSOLE)] * 2, backend=backend) as devices:
                async for packet in devices:
                    if packet.t > started_at + truth.duration:
                        break
                    for event in session.feed(packet):
                        walked.take(event)
            walked.left = sum(not advertises(task) for task in others() - before)
        assert not others()

    in_virtual_time(listen)
    return walked


EACH_CUT_COUNT = pytest.mark.parametrize("cuts", [60, pytest.param(200, marks=pytest.mark.soak)])


@EACH_CUT_COUNT
def test_a_session_goes_on_through_any_number_of_disconnections_and_every_gap_is_an_event(cuts: int) -> None:
    walked = walk(1, cuts)
    assert walked.disconnected == cuts
    assert walked.connected == cuts + 2
    assert walked.rejected == 0
    true = sum(len(walked.truth.strides(foot)) for foot in Foot)
    assert true > 1.5 * cuts
    assert abs(walked.steps - true) <= 0.02 * true
    # each cut costs samples, so each is a gap; none is longer than it takes to find and set up a device again
    cut = [duration for duration in walked.gaps if duration > 0.05]
    assert len(cut) == cuts
    assert max(cut) < 0.5


@EACH_CUT_COUNT
def test_no_task_and_no_thread_is_left_behind_by_so_many_connections(cuts: int) -> None:
    walked = walk(1, cuts)
    assert walked.left == 0
    assert max(walked.tasks[-cuts // 4 :]) <= max(walked.tasks[: cuts // 4])
    assert set(walked.threads) == {walked.threads_before}


@pytest.mark.soak
def test_no_memory_is_left_behind_by_two_hundred_connections() -> None:
    walked = walk(1)
    early, late = walked.blocks[2], walked.blocks[-1]  # the 60th connection, the 200th
    assert late - early <= 10 * 140, walked.blocks


def undisturbed(seed: int) -> float:
    """Return the error of the same walk without Bluetooth, m."""
    bench = Bench(ROUTE, devices=worn(), seed=seed)
    walked = Walked(bench.truth())
    session = Session(poses=True)
    for packet in emulate(ROUTE, devices=worn(), seed=seed).packets:
        for event in session.feed(packet):
            walked.take(event)
    return walked.error()


@pytest.mark.soak
@pytest.mark.parametrize("seeds", [(1, 2), (1, 2, 3, 4, 5, 6)])
def test_tracks_stay_on_average_within_twice_the_error_of_the_walks_without_disconnections(seeds: tuple[int]) -> None:
    """The errors are summed, since a single undisturbed walk may by chance have almost no error."""
    cut, whole = [walk(seed).error() for seed in seeds], [undisturbed(seed) for seed in seeds]
    print(f"m, with 200 disconnections {np.round(cut, 1)}, without {np.round(whole, 1)}")
    assert sum(cut) <= 2.0 * sum(whole)
