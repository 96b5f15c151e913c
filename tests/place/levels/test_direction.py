"""The direction of stairs is that of the whole stretch, also when it is revised while or after they are climbed."""

from __future__ import annotations

from attrs import evolve
from floors import LOW, STAIRS, STOREY, Method, Pedestrian, activity_changed, beside, office

from solepath import Activity, ActivityChanged
from solepath.floorplan.index import IndexedPlan

NAME = "stairs south"


def three_floors() -> IndexedPlan:
    """Return a building of three floors that are alike."""
    plan = office()
    levels = (*plan.levels, evolve(plan.levels[1], id="2", name="floor 2", ordinal=2, elevation=2.0 * STOREY))
    connectors = [evolve(one, stops=(*one.stops, evolve(one.stops[0], level="2"))) for one in plan.connectors]
    return IndexedPlan(evolve(plan, levels=levels, connectors=tuple(connectors)))


PLAN = three_floors()


def revised(t: float, known_at: float, activity: Activity, revises: float | None) -> ActivityChanged:
    return ActivityChanged(t=t, known_at=known_at, activity=activity, probability=None, revises=revises)


def weights(part: Method) -> dict[str, float]:
    """Return the weight of all candidates on each level."""
    candidates = () if part.place is None else part.place.candidates
    return {level: sum([one.weight for one in candidates if one.level == level]) for level in ("0", "1", "2")}


def climb_without_height(pedestrian: Pedestrian, revise_after: int | None, after: Activity) -> float:
    """Climb two flights of 11 strides that the track shows as level, and return when the stairs began.

    They are reported upwards; after `revise_after` strides the whole stretch is reported as `after`."""
    start = pedestrian.t
    pedestrian.emit(activity_changed(start, start + 0.5, Activity.STAIRS_UP))
    for k in range(22):
        if k == revise_after:
            pedestrian.emit(revised(start, pedestrian.t, after, start))
        pedestrian.step(0.0, 0.25 if k < 11 else -0.25, counts=False)
    pedestrian.emit(activity_changed(pedestrian.t, pedestrian.t + 1.0, Activity.WALKING))
    return start


def after_stairs(part: Method, revise_after: int | None = None, late: bool = False) -> dict[str, float]:
    """Return the weights of the levels after stairs from the middle floor, which are revised to lead down."""
    pedestrian = Pedestrian(5, "1", (20.0, LOW)).known_to(part)
    pedestrian.walk(beside(STAIRS[NAME]), STAIRS[NAME])
    start = climb_without_height(pedestrian, revise_after, Activity.STAIRS_DOWN)
    end = pedestrian.t
    pedestrian.walk(beside(STAIRS[NAME]), (20.0, LOW))
    if late:
        down = revised(start, pedestrian.t, Activity.STAIRS_DOWN, start)
        pedestrian.emit(down, revised(end, pedestrian.t, Activity.WALKING, None))
    pedestrian.walk((18.0, LOW))
    for one in pedestrian.received:
        part.follow(PLAN, one.events, one.here)
    return weights(part)


def test_stairs_that_are_reported_upwards_lead_up(part: Method) -> None:
    found = after_stairs(part)
    assert found["2"] > 0.7 and found["0"] < 0.2


def test_stairs_that_are_revised_near_their_end_lead_down_as_a_whole(part: Method) -> None:
    found = after_stairs(part, revise_after=20)
    assert found["0"] > 0.7 and found["2"] < 0.2, "twenty strides up and two down would lead up"


def test_stairs_that_are_revised_after_the_arrival_led_down(part: Method) -> None:
    found = after_stairs(part, late=True)
    assert found["0"] > 0.6 and found["2"] < 0.25
