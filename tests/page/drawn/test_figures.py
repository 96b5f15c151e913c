"""Tests the page's figures: colours, pace, losses and gait, from events alone and the same for all watchers."""

from __future__ import annotations

from functools import cache
from math import radians

from attrs import evolve
from page_events import foot_moved
from shown import frame, shown
from walks import insoles

from solepath import (
    Activity,
    ActivityChanged,
    Event,
    Foot,
    FootPressed,
    GaitCycleMeasured,
    LayoutKnown,
    Packet,
    PacketsLost,
    Session,
    Site,
    ToeOff,
)
from solepath.body.gait.means import GaitMeans
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.show.page.scene.scales import FIRST_ENDS
from solepath.show.page.scene.scene import Scene
from solepath.show.tables.gait import gait_lines, gait_rows

LEFT, RIGHT = Foot.LEFT, Foot.RIGHT
WALK = Route().stand(1.5).walk(14.0, 1.3).stop(6.0)


@cache
def walk() -> tuple[Event, ...]:
    return tuple(Session(poses=True, pressures=True).feed(insoles(WALK).packets))


def scene_until(t: float) -> Scene:
    return shown([event for event in walk() if event.known_at <= t])


def changed(t: float, activity: Activity) -> ActivityChanged:
    return ActivityChanged(t=t, known_at=t, activity=activity, probability=None, revises=None, final=False)


def test_the_activity_is_unknown_while_no_foot_sends() -> None:
    scene = shown([foot_moved(1.0), foot_moved(1.0, RIGHT), changed(1.0, Activity.WALKING)])
    assert frame(scene)["activity"] == {"now": "WALKING", "since": 1.0, "last": None}
    shown([foot_moved(1.0 + 0.1 * k) for k in range(60)], scene)
    assert frame(scene)["activity"]["now"] == "WALKING", "the other foot is heard"
    scene.tick(12.0)
    assert frame(scene)["activity"] == {"now": "UNKNOWN", "since": 6.9, "last": "WALKING"}
    shown([foot_moved(12.5)], scene)
    assert frame(scene)["activity"] == {"now": "WALKING", "since": 1.0, "last": None}


def test_the_pace_is_that_of_the_newest_strides() -> None:
    scene = scene_until(8.0)
    strides = [event for event in walk() if isinstance(event, GaitCycleMeasured) and event.known_at <= 8.0]
    newest = [[one for one in strides if one.foot is foot][-2:] for foot in Foot]
    assert [len(some) for some in newest] == [2, 2]
    cadences = [sum(one.cadence for one in some) / 2 for some in newest]
    speeds = [sum(one.speed or 0.0 for one in some) / 2 for some in newest]
    assert frame(scene)["pace"] == {"cadence": round(sum(cadences) / 2, 1), "speed": round(sum(speeds) / 2, 2)}
    assert abs(frame(scene)["pace"]["speed"] - 1.3) < 0.1


def test_a_wearer_who_stands_or_whose_sensors_are_silent_has_no_pace() -> None:
    assert frame(scene_until(1.2))["pace"] is None
    assert frame(shown(walk()))["pace"] is None
    scene = scene_until(8.0)
    scene.tick(10.0)
    assert frame(scene)["pace"] is None
    scene = shown([changed(7.9, Activity.STANDING)], scene_until(8.0))
    assert frame(scene)["pace"] is None, "no stride came since"


def pressed(t: float, foot: Foot, kilopascals: list[float]) -> FootPressed:
    cells = layout(96, foot).cells
    values = tuple(1000.0 * one * cell.area for one, cell in zip(kilopascals, cells, strict=True))
    return FootPressed(t=t, known_at=t, foot=foot, values=values, force=sum(values), centre=None)


def layout_events() -> list[Event]:
    known = [event for event in walk() if isinstance(event, LayoutKnown)]
    assert all(event.layout.scale is not None for event in known)
    return list(known)


def test_a_scale_has_the_peaks_of_one_stance_and_not_of_several() -> None:
    heel, toes = [300.0] * 20 + [0.0] * 76, [0.0] * 76 + [300.0] * 20
    down, up = ([pressed(t + 0.01 * k, LEFT, some) for k in range(9)] for t, some in ((2.0, heel), (2.1, toes)))
    toe_off = ToeOff(t=2.09, known_at=2.09, foot=LEFT)
    assert frame(shown([*layout_events(), *down, *up]))["scales"]["kPa"]["top"] == 400.0
    assert frame(shown([*layout_events(), *down, toe_off, *up]))["scales"]["kPa"]["top"] == FIRST_ENDS["kPa"]


def test_a_loss_is_that_of_the_last_ten_seconds() -> None:
    scene = Scene("a walk", "default")

    def feed_samples(start: float, end: float) -> None:
        for k in range(round(100 * (end - start))):
            t = start + 0.01 * k
            scene.take(Packet(t + 0.02, Site.LEFT_FOOT, "insole/frame", b""), [foot_moved(t, known_at=t + 0.02)])

    feed_samples(0.0, 2.0)
    shown([PacketsLost(t=12.0, known_at=12.0, site=Site.LEFT_FOOT, channel="insole/frame", count=1000)], scene)
    feed_samples(12.0, 14.0)
    link = frame(scene)["links"]["left foot"]
    assert (link["lost"], 0.7 < link["loss"] < 0.9) == (1000, True)
    feed_samples(14.0, 24.0)
    link = frame(scene)["links"]["left foot"]
    assert (link["lost"], link["loss"]) == (1000, 0.0)
    scene.tick(27.0)
    link = frame(scene)["links"]["left foot"]
    assert (link["state"], link["lost"], link["loss"]) == ("silent", 1000, None), "nothing comes"


def strides(feet: tuple[Foot, ...], count: int, angles: tuple[float, float] = (0.1, -0.05)) -> list[GaitCycleMeasured]:
    """Return strides of each foot, one more than the `count` that are steady."""
    first = next(event for event in walk() if isinstance(event, GaitCycleMeasured) and event.steady)
    angle = dict(zip(Foot, angles, strict=True))
    return [
        evolve(first, foot=foot, t_start=1.0 + k, t=2.0 + k, known_at=2.3 + k, toe_off_angle=angle[foot])
        for k in range(count + 1)
        for foot in feet
    ]


def test_one_foot_alone_has_nothing_of_both() -> None:
    gait_frame = frame(shown(strides((RIGHT,), 7)))["gait"]
    assert gait_frame["strides"] == {"left": None, "right": 7}
    for row in gait_frame["rows"]:
        assert row["left"] is None and row["both"] is None and row["sd"] is None and row["asymmetry"] is None
        assert row["difference"] is None


def test_angles_that_lean_to_either_side_differ_by_degrees_and_not_by_hundreds_of_per_cent() -> None:
    means = GaitMeans()
    for stride in strides((LEFT, RIGHT), 7, (radians(3.0), radians(-1.0))):
        means.add(stride)
    parameters = means.of(False)
    assert parameters is not None
    rows = {row.name: row for row in gait_rows(parameters)}
    row = rows["toe_off_angle"]
    assert (round(row.difference or 0.0, 6), row.asymmetry, row.cv) == (-4.0, None, None)
    assert row.asymmetry_text == "-4.0 deg"
    assert rows["stride_time"].difference is None and rows["stride_time"].asymmetry_text == "+0.0 %"
    (line,) = [line for line in gait_lines(means) if line.startswith("toe-off angle")]
    assert line.endswith("-4.0 deg")
