"""Measurements between the feet need two clocks that agree."""

from __future__ import annotations

from attrs import evolve
from walks import of

from solepath import Foot, GaitCycleMeasured, Session, Site
from solepath.emulate.radio import Radio
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.walk import emulate
from solepath.wire.insole import build_frame, parse_frame  # internal: frames whose counters have restarted

T_LOST, T_RESUMED = 9.0, 13.0
"""Times of the walk between which the right insole is disconnected, s."""


def test_a_foot_that_restarted_is_measured_alone_until_its_clock_is_settled() -> None:
    insoles, session = {site: Insole(cells=24) for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT)}, Session()
    packets = []
    route = Route().stand(3.0).walk(26.0, 1.3).stop(2.0)
    for packet in emulate(route, devices=insoles, radio=Radio(jitter=0.004), seed=1).packets:
        if packet.site is Site.RIGHT_FOOT and packet.channel == "insole/frame" and packet.t >= T_LOST:
            if packet.t < T_RESUMED:
                continue
            frame = parse_frame(packet.data)
            sequence, ticks = (frame.sequence + 30000) % 2**16, (frame.ticks + 10**9) % 2**32
            data = build_frame(evolve(frame, sequence=sequence, ticks=ticks))
            packet = evolve(packet, t=max(packet.t, T_RESUMED), data=data)
        packets.append(packet)
    cycles = of(GaitCycleMeasured, session.feed(sorted(packets, key=lambda packet: packet.t)))
    after = [cycle for cycle in cycles if T_RESUMED < cycle.t_start < T_RESUMED + 5.0]
    assert {cycle.foot for cycle in after} == set(Foot) and any(cycle.steady for cycle in after)
    for cycle in after:
        assert cycle.step_time is cycle.initial_double_support is cycle.single_support is cycle.phase is None
        assert cycle.stride_time > 0.0 and cycle.stance_time > 0.0 and cycle.stride_length is not None
    both = [cycle for cycle in cycles if cycle.step_time is not None and cycle.single_support is not None]
    assert any(cycle.t > T_RESUMED + 8.0 for cycle in both) and any(cycle.t < T_LOST for cycle in both)
