"""Measurements between the feet need two clocks that agree: a symmetric gait stays symmetric with any link."""

from __future__ import annotations

import json
from functools import cache

import pytest
from attrs import evolve
from walks import of

from solepath import ClockReset, Event, Foot, GaitCycleMeasured, GaitParameters, Packet, Session, Site
from solepath.emulate.radio import Radio
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.walk import emulate
from solepath.wire.insole import build_frame, parse_frame

ROUTE = Route().stand(3.0).walk(60.0, 1.3).stop(2.0)
LOST, BACK = 14.0, 22.0
"""s of the walk: the right insole's link is away between them."""
TOGETHER = ("step_time", "initial_double_support", "terminal_double_support", "single_support", "phase")


@cache
def walked(seed: int, jitter: float, late: float, restarts: bool) -> tuple[Packet, ...]:
    """Both feet's packets. The right link is lost for 8 s; what it delivers first comes `late` s late, all at once, and
    with `restarts` the insole has restarted meanwhile."""
    insoles = {site: Insole(cells=24) for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT)}
    packets = []
    for packet in emulate(ROUTE, devices=insoles, radio=Radio(jitter=jitter), seed=seed).packets:
        if packet.site is Site.RIGHT_FOOT and packet.channel == "insole/frame":
            if LOST <= packet.t < BACK:
                continue
            if packet.t >= BACK:
                data = packet.data
                if restarts:
                    frame = parse_frame(data)
                    sequence, ticks = (frame.sequence + 30000) % 2**16, (frame.ticks + 10**9) % 2**32
                    data = build_frame(evolve(frame, sequence=sequence, ticks=ticks))
                packet = evolve(packet, t=max(packet.t, BACK + late), data=data)
        packets.append(packet)
    return tuple(sorted(packets, key=lambda packet: packet.t))


@cache
def walk_events(seed: int, jitter: float, late: float, restarts: bool) -> tuple[list[Event], GaitParameters]:
    """Return the events of a session for that walk, and its running means."""
    session = Session()
    events = session.feed(walked(seed, jitter, late, restarts)) + session.finish()
    assert session.gait is not None
    return events, session.gait


def strides(jitter: float, late: float, restarts: bool) -> list[GaitCycleMeasured]:
    return of(GaitCycleMeasured, walk_events(1, jitter, late, restarts)[0])


def compares(stride: GaitCycleMeasured) -> bool:
    return all(getattr(stride, name) is not None for name in TOGETHER)


@pytest.mark.parametrize("restarts", [False, True], ids=["goes on", "begins anew"])
@pytest.mark.parametrize("seed", [1, *(pytest.param(seed, marks=pytest.mark.soak) for seed in (2, 3, 4, 5))])
def test_a_symmetric_walker_stays_one_after_a_link_was_lost(seed: int, restarts: bool) -> None:
    events, gait = walk_events(seed, 0.05, 0.06, restarts)
    assert len(of(ClockReset, events)) == restarts
    assert abs(gait.asymmetry("step_time") or 1.0) < 0.03
    assert abs(gait.asymmetry("initial_double_support") or 1.0) < 0.06
    assert abs(gait.asymmetry("terminal_double_support") or 1.0) < 0.06
    cycles = of(GaitCycleMeasured, events)
    assert sum(compares(stride) for stride in cycles) > 0.1 * len(cycles)
    assert any(compares(stride) for stride in cycles if stride.t > BACK)


def test_a_foot_that_restarted_is_measured_alone_until_its_clock_is_settled() -> None:
    cycles = strides(0.05, 0.06, True)
    after = [stride for stride in cycles if BACK < stride.t_start < BACK + 5.0]
    assert {stride.foot for stride in after} == set(Foot)
    assert any(stride.steady for stride in after)
    for stride in after:
        assert [getattr(stride, name) for name in TOGETHER] == [None] * 5
        assert stride.stride_time > 0.0 and stride.stance_time > 0.0 and stride.stride_length is not None


def test_a_toe_off_that_was_only_found_after_a_gap_is_no_toe_off_of_that_time() -> None:
    cycles = strides(0.004, 0.0, False)
    supports = [stride.initial_double_support for stride in cycles if stride.initial_double_support is not None]
    assert len(supports) > 35
    assert min(supports) > 0.08 and max(supports) < 0.15


def test_over_a_good_link_both_feet_are_compared_from_their_first_strides_on() -> None:
    cycles = strides(0.004, 0.0, False)
    assert all(compares(stride) for stride in cycles if stride.t_start > 7.0 and stride.t < LOST - 1.5)


def test_how_the_feet_are_compared_does_not_depend_on_cuts_and_goes_on_after_a_restore() -> None:
    packets = [packet for packet in walked(1, 0.05, 0.06, True) if packet.t < 29.0]
    whole = Session().feed(packets)
    session, pieces = Session(), list[Event]()
    for start in range(0, len(packets), 1700):
        pieces += session.feed(packets[start : start + 1700])
        session = Session.restore(json.loads(json.dumps(session.snapshot())))
    assert pieces == whole
