"""Measurements between the feet, which need two clocks that agree, stay symmetric for a symmetric gait on any link."""

from __future__ import annotations

from functools import cache

from attrs import evolve
from walks import of

from solepath import Event, Foot, GaitCycleMeasured, GaitParameters, Packet, Session, Site
from solepath.emulate.radio import Radio
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.walk import emulate
from solepath.wire.insole import build_frame, parse_frame

ROUTE = Route().stand(3.0).walk(60.0, 1.3).stop(2.0)
T_LOST, T_RESUMED = 14.0, 22.0
"""Times of the walk between which the right insole is disconnected, s."""
BOTH_FEET_FIELDS = ("step_time", "initial_double_support", "terminal_double_support", "single_support", "phase")


@cache
def walk_packets(seed: int, jitter: float, late: float, restarts: bool) -> tuple[Packet, ...]:
    """Return both feet's packets, where the right insole is disconnected for 8 s.

    Its first packets after that arrive together, up to `late` s late; with `restarts` its counters have restarted."""
    insoles = {site: Insole(cells=24) for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT)}
    packets = []
    for packet in emulate(ROUTE, devices=insoles, radio=Radio(jitter=jitter), seed=seed).packets:
        if packet.site is Site.RIGHT_FOOT and packet.channel == "insole/frame":
            if T_LOST <= packet.t < T_RESUMED:
                continue
            if packet.t >= T_RESUMED:
                data = packet.data
                if restarts:
                    frame = parse_frame(data)
                    sequence, ticks = (frame.sequence + 30000) % 2**16, (frame.ticks + 10**9) % 2**32
                    data = build_frame(evolve(frame, sequence=sequence, ticks=ticks))
                packet = evolve(packet, t=max(packet.t, T_RESUMED + late), data=data)
        packets.append(packet)
    return tuple(sorted(packets, key=lambda packet: packet.t))


@cache
def walk_events(seed: int, jitter: float, late: float, restarts: bool) -> tuple[list[Event], GaitParameters]:
    """Return the events of a session for that walk, and its running means."""
    session = Session()
    events = session.feed(walk_packets(seed, jitter, late, restarts)) + session.finish()
    assert session.gait is not None
    return events, session.gait


def gait_cycles(jitter: float, late: float, restarts: bool) -> list[GaitCycleMeasured]:
    return of(GaitCycleMeasured, walk_events(1, jitter, late, restarts)[0])


def has_both_feet(cycle: GaitCycleMeasured) -> bool:
    return all(getattr(cycle, name) is not None for name in BOTH_FEET_FIELDS)


def test_a_foot_that_restarted_is_measured_alone_until_its_clock_is_settled() -> None:
    cycles = gait_cycles(0.05, 0.06, True)
    after = [cycle for cycle in cycles if T_RESUMED < cycle.t_start < T_RESUMED + 5.0]
    assert {cycle.foot for cycle in after} == set(Foot)
    assert any(cycle.steady for cycle in after)
    for cycle in after:
        assert [getattr(cycle, name) for name in BOTH_FEET_FIELDS] == [None] * 5
        assert cycle.stride_time > 0.0 and cycle.stance_time > 0.0 and cycle.stride_length is not None
