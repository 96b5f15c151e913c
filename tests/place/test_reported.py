"""A person says where they are on the floor plan: its hypotheses are weighed, and the track is corrected."""

from __future__ import annotations

from cmath import rect
from math import cos, dist, hypot, inf, sin

import pytest
from attrs import evolve
from floors import HIGH, LOW, RIGHT, STAIRS, Method, Pedestrian, beside, follow, indexed_office, lost, placed
from views import told

from solepath import Session, Site
from solepath.body.part import StartGiven
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.walk import sampled
from solepath.events import Event, Placed, PositionRejected, PositionReported, TrackRevised
from solepath.floorplan.plan import ConnectorKind, Point, Start
from solepath_lab.emulated.buildings import corridor


def reported(t: float, place: Point, sigma: float = 1.0, level: str = "0") -> PositionReported:
    return PositionReported(t=t, known_at=t, site=Site.LEFT_FOOT, position=place, level=level, sigma=sigma)


def off(part: Method, place: Point) -> float:
    return inf if part.place is None else dist(part.place.position[:2], place)


def test_a_report_finds_a_wearer_without_a_start(part: Method) -> None:
    part.plan = indexed_office()
    pedestrian = Pedestrian(3, "0", (12.0, LOW))
    assert not told(part, reported(0.0, pedestrian.place))
    pedestrian.walk((RIGHT, LOW), (RIGHT, HIGH), (20.0, HIGH))
    events = follow(part, pedestrian.received)
    assert lost(events) == [] and off(part, pedestrian.place) < 1.0
    assert dist(placed(events)[0].position[:2], (12.0, LOW)) < 3.0


def test_a_report_decides_between_places_that_walls_cannot(part: Method) -> None:
    pedestrian = Pedestrian(4, "0", (12.0, LOW))
    part.plan = indexed_office()
    told(part, StartGiven(Start("0", (14.0, LOW), None, 6.0)))
    pedestrian.walk((16.0, LOW))
    follow(part, pedestrian.received)
    assert part.place is not None and (before := part.place.spread) > 1.5
    assert not told(part, reported(pedestrian.t, pedestrian.place, 0.5))
    pedestrian.received.clear()
    pedestrian.walk((17.0, LOW))
    follow(part, pedestrian.received)
    assert part.place.spread < 0.6 * before and off(part, pedestrian.place) < 2.5


def test_a_place_where_the_track_cannot_have_led_is_rejected_and_a_second_one_is_used(part: Method) -> None:
    pedestrian = Pedestrian(5, "0", (12.0, LOW)).known_to(part)
    part.plan = indexed_office()
    pedestrian.walk((20.0, LOW))
    follow(part, pedestrian.received)
    (rejected,) = told(part, reported(pedestrian.t, (20.0, HIGH)))
    assert isinstance(rejected, PositionRejected) and rejected.distance > 10.0 and "away" in rejected.what
    (again,) = told(part, reported(pedestrian.t, (20.0, HIGH)))
    assert isinstance(again, PositionRejected), "on the spot it confirms nothing"
    pedestrian.received.clear()
    pedestrian.walk((31.0, LOW))
    follow(part, pedestrian.received)
    assert off(part, pedestrian.place) < 1.0, "one report moves nothing"
    elsewhere = (pedestrian.place[0], pedestrian.place[1] + HIGH - LOW)
    assert not told(part, reported(pedestrian.t, elsewhere))
    pedestrian.received.clear()
    pedestrian.walk((34.0, LOW))
    follow(part, pedestrian.received)
    assert off(part, (34.0, HIGH)) < 2.0


@pytest.mark.parametrize(("level", "place", "word"), [("7", (12.0, LOW), "no level"), ("0", (900.0, LOW), "nowhere")])
def test_a_place_that_is_not_on_the_plan_is_rejected_with_the_reason(
    part: Method, level: str, place: Point, word: str
) -> None:
    part.plan = indexed_office()
    (rejected,) = told(part, reported(1.0, place, level=level))
    assert isinstance(rejected, PositionRejected) and word in rejected.what and not part.particles


def test_a_revision_of_the_track_moves_nobody_on_the_plan(part: Method) -> None:
    pedestrian = Pedestrian(6, "0", (12.0, LOW)).known_to(part)
    part.plan = indexed_office()
    pedestrian.walk((20.0, LOW))
    follow(part, pedestrian.received)
    by, turn = (-9.0, 14.0), 0.7
    told(part, TrackRevised(t=pedestrian.t, known_at=pedestrian.t, by=by, turn=turn, nodes=()))
    x, y, z = pedestrian.track
    pedestrian.track = (x + by[0], y + by[1], z)
    pedestrian.turned += turn
    pedestrian.received.clear()
    pedestrian.walk((28.0, LOW))
    events = follow(part, pedestrian.received)
    assert lost(events) == [] and off(part, pedestrian.place) < 1.0


@pytest.mark.soak
def test_a_session_on_a_plan_corrects_track_and_place_by_a_position_on_a_level() -> None:
    walk = corridor()
    samples = sampled(walk.route)
    session = Session(poses=True, floorplan=BUILDING, start=walk.start)
    fed_without_a_plan = Session()
    fed_without_a_plan.feed(samples.samples[0])
    until = 40.0
    events = session.feed([sample for sample in samples.samples if sample.t < until])
    newest = [event for event in events if isinstance(event, Placed)][-1]
    x, y, _ = newest.position
    answer: list[Event] = session.here((x + 0.5, y), 1.0, level=newest.level)
    assert isinstance(answer[0], PositionReported) and isinstance(answer[1], TrackRevised)
    assert session.position is not None and walk.start.heading is not None
    (sx, sy), c, s = walk.start.place, cos(walk.start.heading), sin(walk.start.heading)
    px, py = session.position.position[:2]
    on_plan = (sx + c * px - s * py, sy + s * px + c * py)
    assert hypot(on_plan[0] - x - 0.5, on_plan[1] - y) < 1.0
    saved = Session.unpack(session.pack(), floorplan=BUILDING)
    rest = [sample for sample in samples.samples if until <= sample.t < until + 10.0]
    assert saved.feed(rest) == session.feed(rest)
    with pytest.raises(ValueError, match="attic"):
        session.here((x, y), level="attic")
    with pytest.raises(ValueError, match="without a floor plan"):
        fed_without_a_plan.here((x, y), level=newest.level)


@pytest.mark.parametrize("revised_after", [5, 15, 25])
def test_a_revision_of_the_track_on_the_way_over_stairs_moves_nobody_either(part: Method, revised_after: int) -> None:
    """It comes on the first flight, on the second, and before the end of the stairs is reported."""
    name, level = "stairs south", "1"
    pedestrian = Pedestrian(6, "0", (20.0, LOW)).known_to(part)
    part.plan = indexed_office()
    pedestrian.walk(beside(STAIRS[name]), STAIRS[name])
    before = len(pedestrian.received)
    pedestrian.climb(level, name)
    pedestrian.walk(beside(STAIRS[name]), (20.0, LOW))
    by, turn, (x, y) = (-9.0, 14.0), 0.7, (0.0, 0.0)
    for k, one in enumerate(pedestrian.received):
        here = one.here
        if k == before + revised_after:
            told(part, TrackRevised(t=here.t, known_at=here.t, by=by, turn=turn, nodes=()))
            x, y, _ = here.position
        if k >= before + revised_after:
            way = complex(here.position[0] - x, here.position[1] - y) * rect(1.0, turn)
            position = (x + by[0] + way.real, y + by[1] + way.imag, here.position[2])
            here = evolve(here, position=position)
        part.follow(indexed_office(), one.events, here)
    assert part.place is not None and part.place.level == level and off(part, pedestrian.place) < 1.5


def test_whoever_stands_at_a_lift_reports_its_name() -> None:
    session = Session(floorplan=BUILDING)
    walk = corridor()
    session.feed([sample for sample in sampled(walk.route).samples if sample.t < 5.0])
    (lift,) = [one for one in BUILDING.connectors if one.kind is ConnectorKind.LIFT][:1]
    stop = lift.stops[0]
    reported_there, *_ = session.here(lift.name, level=stop.level)
    assert isinstance(reported_there, PositionReported)
    assert reported_there.position == pytest.approx(stop.place, abs=0.01) and reported_there.level == stop.level
    with pytest.raises(ValueError, match=lift.name):
        session.here("the printer", level=stop.level)
    with pytest.raises(ValueError, match="attic"):
        session.here(lift.name, level="attic")
