"""Live events for drawing: the wearer's position after each stride, and the cells' loads in each sample."""

from __future__ import annotations

import json
from math import fsum
from typing import Any

import pytest
from attrs import evolve
from one_foot import SOLE, TARE, above
from toys import BASE, more
from walks import LEFT, insoles, of, samples

from solepath import (
    Calibration,
    CellFault,
    CellsFailed,
    Event,
    Foot,
    FootPressed,
    LayoutKnown,
    Packet,
    Phase,
    Sample,
    Session,
    Site,
    StrideTaken,
    WearerMoved,
    recipes,
)
from solepath.calibration import InsoleCalibration, Newtons
from solepath.emulate.sensors.insoles import layout
from solepath.events import LiveEvent
from solepath.link.driver import Measured, Reading

LIVE_FLAGS = {"poses": True, "pressures": True}
WITH_LAYOUT = Calibration(insoles={Foot.LEFT: InsoleCalibration(SOLE)})


def frames(*cells: tuple[float, ...], t_start: float = 0.0) -> list[Sample]:
    """Return samples of the left foot's cells, without motion, at 100 Hz."""
    return [Sample(t_start + 0.01 * k, LEFT, pressure=values) for k, values in enumerate(cells)]


STRIDE_LOADS = (above(100, 100, 50, 150), above(0, 0, 0, 200), TARE, above(30, 10, 0, 0), above(100, 100, 50, 150))
"""Loads of the cells, N, during a stride: whole sole, forefoot, in the air, heel, whole sole.

The swing is known only when the load has risen again."""


def shown(session: Session, items: list[Sample]) -> list[FootPressed]:
    return of(FootPressed, session.feed(items))


@pytest.mark.parametrize("kind", ["packets", "samples"])
def test_live_events_change_no_other_events(kind: str) -> None:
    fed = insoles().packets if kind == "packets" else samples()
    plain, live = Session(), Session(**LIVE_FLAGS)
    plain_events = plain.feed(fed) + plain.finish()
    emitted = live.feed(fed) + live.finish()
    assert of(LiveEvent, plain_events) == []
    assert [repr(event) for event in emitted if not isinstance(event, LiveEvent)] == [
        repr(event) for event in plain_events
    ]
    assert live.position == plain.position


def test_each_live_event_is_emitted_on_request_only() -> None:
    for flags, kinds in (("poses", {"FootMoved", "WearerMoved"}), ("pressures", {"FootPressed"})):
        emitted = Session(**{flags: True}).feed(insoles().packets)
        assert {type(event).__name__ for event in of(LiveEvent, emitted)} == kinds


@pytest.mark.parametrize("name", ["default", "kupt-dfpc", "walking-modes"])
def test_every_stride_is_followed_by_the_position_of_the_wearer(name: str) -> None:
    session = Session(recipes.by_name(name), poses=True)
    stride_count = 0
    for packet in insoles().packets:
        emitted = session.feed(packet)
        strides, moved = of(StrideTaken, emitted), of(WearerMoved, emitted)
        assert len(moved) == bool(strides)
        stride_count += len(strides)
        for event in moved:
            position = session.position
            assert position is not None and emitted.index(event) > emitted.index(strides[-1])
            assert (event.t, event.position, event.covariance) == (position.t, position.position, position.covariance)
            assert event.known_at == max(packet.t, event.t) and not event.final
    assert stride_count > 5


def test_every_sample_with_cells_is_shown_with_its_own_times() -> None:
    fed = samples()
    emitted = shown(Session(pressures=True), list(fed))
    assert [(e.t, e.foot) for e in emitted] == [(s.t, s.site.foot) for s in fed if s.pressure]
    for event in emitted:
        assert len(event.values) == 24 and min(event.values) >= 0.0 and not event.final
        assert event.force == pytest.approx(fsum(event.values), rel=1e-12)


def test_a_foot_that_has_not_stepped_yet_is_shown_as_its_cells_have_it() -> None:
    standing = shown(Session(pressures=True), frames(*[STRIDE_LOADS[0]] * 50))
    assert len(standing) == 50
    assert {event.values for event in standing} == {STRIDE_LOADS[0]} and standing[0].force == 460.0


def test_what_cells_show_in_the_air_is_not_shown_once_it_is_known() -> None:
    emitted = shown(Session(calibration=WITH_LAYOUT, pressures=True), frames(*STRIDE_LOADS, *STRIDE_LOADS))
    assert [event.values for event in emitted[:2]] == [*STRIDE_LOADS[:2]]
    assert [event.values for event in emitted[-3:]] == [(0.0,) * 4, (30.0, 10.0, 0.0, 0.0), (100.0, 100.0, 50.0, 150.0)]
    assert [event.force for event in emitted[-3:]] == [0.0, 40.0, 400.0]


def test_the_centre_is_where_the_load_is_and_in_the_air_there_is_none() -> None:
    emitted = shown(Session(calibration=WITH_LAYOUT, pressures=True), frames(*STRIDE_LOADS, *STRIDE_LOADS))
    assert emitted[-3].centre is None
    assert emitted[-2].centre == pytest.approx((0.05, 0.005))
    assert emitted[-1].centre == pytest.approx((0.05 * 0.5 + 0.13 * 0.125 + 0.20 * 0.375, 0.02 * 0.375))


@pytest.mark.parametrize("count", [1, 2, 24])
def test_cells_that_are_more_than_the_layout_of_their_device_has_are_not_shown(count: int) -> None:
    """The device of an app says where its one cell is, and sends the values of so many."""

    def cells(sent: Any, known: Any) -> Reading:
        return Reading((Measured(pressure=(*sent.up, *[20.0] * 23)[: sent.count]),))

    driver = evolve(BASE, readers={"toy/data": cells, "toy/more": more})
    session = Session(profiles=[driver], pressures=True)
    session.feed(Packet(0.5, LEFT, "toy/more", driver.write("toy/more", {"what": 7, "value": [0.0]})))
    values = [
        driver.write("toy/data", {"number": 0, "ticks": 0, "count": count, "up": [load]})
        for load in (400.0, 0.0, 300.0, 0.0, 400.0)
    ]
    events = session.feed([Packet(1.0 + 0.01 * k, LEFT, "toy/data", value) for k, value in enumerate(values)])
    pressed = of(FootPressed, events + session.finish())
    assert len(pressed) == (len(values) if count == 1 else 0)
    assert count > 1 or pressed[-1].centre == (0.1, 0.0)


def test_in_a_walk_the_centre_goes_from_heel_to_toe_and_is_absent_while_the_foot_swings() -> None:
    session = Session(**LIVE_FLAGS)
    paths: list[list[float]] = [[]]
    swings = centres = 0
    for packet in insoles().packets:
        for event in of(FootPressed, session.feed(packet)):
            if event.foot is not Foot.LEFT or event.t < 3.0:
                continue
            if event.centre is not None:
                paths[-1].append(event.centre[0])
            elif paths[-1]:
                paths.append([])
            if session.phase(Foot.LEFT) is Phase.SWING:
                swings += 1
                centres += event.centre is not None
    stances = [path for path in paths if len(path) > 30][:2]
    assert len(stances) == 2
    for path in stances:
        assert path[2] < 0.09 and path[-3] > 0.17
    assert swings > 80 and centres < 0.25 * swings


def test_a_cell_without_a_number_is_shown_as_nothing_even_where_a_cubic_makes_something_of_nothing() -> None:
    cubic = Newtons((5.0, 1.0, 0.0, 0.0), 1.0, 2000.0)
    session = Session(calibration=Calibration(insoles={Foot.LEFT: InsoleCalibration(newtons=cubic)}), pressures=True)
    numberless: Any = (100.0, None, 50.0, 150.0)
    emitted = session.feed(frames(*[numberless] * 150))
    assert [(event.fault, event.cells) for event in of(CellsFailed, emitted)] == [(CellFault.MISSING, (1,))]
    assert {event.values for event in of(FootPressed, emitted)} == {(105.0, 0.0, 55.0, 155.0)}


def layouts(events: list[Event]) -> list[tuple[Site, int]]:
    return [(event.site, event.layout.id) for event in of(LayoutKnown, events)]


def test_a_calibrations_layout_is_reported_once_samples_have_as_many_cells() -> None:
    session = Session(calibration=WITH_LAYOUT, pressures=True)
    emitted = session.feed(frames(*STRIDE_LOADS))
    assert layouts(emitted) == [(LEFT, 7)]
    assert emitted.index(of(LayoutKnown, emitted)[0]) < emitted.index(of(FootPressed, emitted)[0])
    restored = Session.restore(json.loads(json.dumps(session.snapshot())))
    for each_session in (session, restored):
        assert layouts(each_session.feed(frames(*STRIDE_LOADS, t_start=1.0))) == []


def test_a_calibrations_layout_of_another_number_of_cells_is_not_reported() -> None:
    session = Session(calibration=WITH_LAYOUT)
    assert layouts(session.feed(frames(*[(1.0, 2.0)] * 200))) == []


def test_a_layout_of_the_device_replaces_that_of_the_calibration() -> None:
    insoles_ = {Foot.LEFT: InsoleCalibration(evolve(layout(96, Foot.LEFT), id=99))}
    packets = [packet for packet in insoles().packets if packet.site is LEFT]
    first_events = Session(calibration=Calibration(insoles=insoles_)).feed(packets)
    (plain_events,) = layouts(first_events)
    assert plain_events[1] != 99
    late_session = Session(calibration=Calibration(insoles=insoles_))
    assert layouts(late_session.feed(frames((50.0,) * 96))) == [(LEFT, 99)]
    assert layouts(late_session.feed(packets)) == [plain_events]
