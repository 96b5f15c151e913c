"""What the page shows: out of events alone, the same to whoever has watched from the start and who comes late."""

from __future__ import annotations

import base64
import json
import pickle
import re
from collections.abc import Iterable
from copy import deepcopy
from functools import cache
from math import inf, nan, pi
from typing import Any

from attrs import evolve
from here import PROTOCOL
from hypothesis import given, settings
from hypothesis import strategies as st
from shown import frame, later, shown
from walks import ROUGH, SHORT, insoles, samples

from solepath import (
    Activity,
    ActivityChanged,
    BatteryLevel,
    Candidate,
    CellFault,
    CellsFailed,
    Connected,
    Disconnected,
    Event,
    Foot,
    FootHeard,
    FootMoved,
    FootPressed,
    FootSilent,
    LayoutKnown,
    Packet,
    PacketRejected,
    PacketsLost,
    Phase,
    Placed,
    PlaceLost,
    Sample,
    SampleGap,
    Session,
    Site,
    StreamResumed,
    StreamStale,
    StrideTaken,
    TurnMade,
    WearerMoved,
)
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.sensortags import CC2650
from solepath.emulate.walk import emulate
from solepath.papers.pressure_contour.recipe import PRESSURE_CONTOUR
from solepath.recipes import DEFAULT, Recipe
from solepath.show.page.messages import FASTEST, SLOWEST, encode, parse_command
from solepath.show.page.player.playback import Playback
from solepath.show.page.scene.lists import MOST_POINTS, RECENT
from solepath.show.page.scene.log import MOST_LINES, sentence
from solepath.show.page.scene.scene import Scene
from solepath.show.tables.gait import gait_lines, gait_rows
from solepath.types import Turn

LEFT, RIGHT = Foot.LEFT, Foot.RIGHT
LISTS = ("phases", "tracks", "places", "log")


def fed(items: Iterable[Packet | Sample], recipe: Recipe = DEFAULT) -> tuple[Session, list[Event]]:
    """A session that has heard all of them, and what it said."""
    session = Session(recipe, poses=True, pressures=True)
    return session, session.feed(items)


@cache
def walk() -> tuple[Session, tuple[Event, ...]]:
    session, events = fed(insoles(SHORT, ROUGH).packets)
    return session, tuple(events)


def step(t: float, x: float, foot: Foot = LEFT) -> StrideTaken:
    """A step to x m."""
    first = next(event for event in walk()[1] if isinstance(event, StrideTaken))
    return evolve(first, foot=foot, t=t, known_at=t, t_start=t - 1.0, t_end=t, position=(x, 0.0, 0.0))


def moved(t: float, known_at: float | None = None, foot: Foot = LEFT, x: float = 0.0) -> FootMoved:
    at = t if known_at is None else known_at
    return FootMoved(t=t, known_at=at, foot=foot, position=(x, 0.0, 0.0), velocity=(0.0, 0.0, 0.0), phase=Phase.SWING)


# --- a page that applies what comes ----------------------------------------------------------------------------------


class Reader:
    """Does what protocol/page.md tells a page to do."""

    def __init__(self) -> None:
        self.scene: dict[str, Any] = {}
        self.wholes = 0

    def take(self, text: str) -> None:
        message = json.loads(text)
        if message["type"] == "scene":
            self.scene = message
            self.wholes += 1
            return
        now = self.scene["frame"]
        for key, value in message.items():
            if key not in LISTS:
                now[key] = value
        for name, points in message.get("tracks", {}).items():
            for point in points:
                self.scene["tracks"][name] = self._longer(self.scene["tracks"][name], point)
        for point in message.get("places", []):
            self.scene["places"] = self._longer(self.scene["places"], point)
        for foot, begun in message.get("phases", {}).items():
            kept = self.scene["phases"][foot]
            for one in begun:
                kept.append(one)
                while len(kept) > 1 and (kept[1][0] <= one[0] - 20.0 or len(kept) > 500):
                    kept.pop(0)
        for line in message.get("log", []):
            self.scene["log"] = [*self.scene["log"], line][-50:]

    def _longer(self, points: list[Any], point: Any) -> list[Any]:
        points = [*points, point]
        return points[::2] if len(points) > 2000 else points


def eventful() -> list[Event]:
    """A walk, and everything else that a page can be told."""
    events = list(walk()[1])
    begin, end = events[0].known_at, events[-1].known_at
    middle, third = events[len(events) // 2].known_at, events[len(events) // 3].known_at
    candidate = Candidate("0", (1.0, 2.0, 0.0), 0.5, 0.75, "stairs A")
    other = Candidate("1", (1.0, 2.0, 3.0), None, 0.25, "stairs A")
    others = [
        Connected(t=begin, known_at=begin, site=Site.LEFT_FOOT, device="", name="Insole", signal=-60),
        Connected(t=begin, known_at=begin, site=Site.PELVIS, device="", name="", signal=None),
        Placed(t=third, known_at=third, level="0", position=(1.0, 2.0, 0.0), spread=2.0, candidates=(candidate, other)),
        Placed(t=middle, known_at=middle, level="0", position=(1.0, 2.0, 0.0), spread=0.5, candidates=(candidate,)),
        PlaceLost(t=end, known_at=end, what="the track goes where the plan has no way"),
        Disconnected(t=third, known_at=third, site=Site.LEFT_FOOT),
        BatteryLevel(t=third, known_at=third, site=Site.LEFT_FOOT, level=0.1),
        Connected(t=middle, known_at=middle, site=Site.LEFT_FOOT, device="", name="Insole", signal=-60),
        TurnMade(t=middle, known_at=middle, t_start=third, angle=pi / 2, turn=Turn.LEFT),
    ]
    return sorted([*events, *others], key=lambda event: event.known_at)


@cache
def long_way() -> list[Event]:
    return [step(1.0 + k, 0.7 * k) for k in range(MOST_POINTS + 2 * RECENT)]


def agree(events: list[Event], looks: list[int], scene: Scene | None = None) -> Reader:
    """Somebody looks after so many events each; what they have is what somebody gets who comes at the end."""
    scene = Scene("a walk", "default", plan=BUILDING) if scene is None else scene
    reader = Reader()
    message, cursor = scene.whole()
    reader.take(encode(message))
    for index, event in enumerate(events):
        scene.take(None, [event])
        for _ in range(looks.count(index)):
            news, cursor = scene.since(cursor)
            if news is not None:
                reader.take(encode(news))
    news, cursor = scene.since(cursor)
    if news is not None:
        reader.take(encode(news))
    late = json.loads(encode(scene.whole()[0]))
    for one in (late, reader.scene):
        for key in LISTS:
            one["frame"].pop(key, None)
        one["frame"].pop("type", None)
    assert reader.scene == late
    return reader


@settings(deadline=None, max_examples=8)
@given(st.data())
def test_who_hears_what_changed_ends_with_what_who_comes_late_is_shown(data: st.DataObject) -> None:
    events = eventful()
    looks = data.draw(st.lists(st.integers(0, len(events) - 1), max_size=40))
    agree(events, looks)


@settings(deadline=None, max_examples=8)
@given(st.lists(st.integers(0, MOST_POINTS + 2 * RECENT), max_size=30))
def test_a_long_track_is_thinned_alike_on_both_sides(looks: list[int]) -> None:
    agree(long_way(), looks)


def test_a_page_that_is_far_behind_gets_everything_anew() -> None:
    events: list[Event] = [step(1.0 + k, 0.7 * k) for k in range(RECENT + 10)]
    assert agree(events, []).wholes == 2
    assert agree(events, [RECENT // 2]).wholes == 1


def test_a_page_that_drew_no_soles_draws_anew_when_the_cells_are_known() -> None:
    known = [event for event in walk()[1] if isinstance(event, LayoutKnown) and event.site is Site.LEFT_FOOT]
    reader = agree(list(known), [0])
    assert reader.wholes == 2
    assert len(reader.scene["layouts"]["left"]["cells"]) == 96
    assert reader.scene["layouts"]["left"]["unit"] == "N"
    scene = shown(known)
    _, cursor = scene.whole()
    news, _ = shown(known, scene).since(cursor)  # the same once more
    assert news is None or news["type"] == "frame"


def test_nothing_new_is_no_message() -> None:
    scene = shown(walk()[1])
    _, cursor = scene.whole()
    assert scene.since(cursor) == (None, cursor)
    scene.tick(scene.now)
    assert scene.since(cursor)[0] is None


# --- it shows what the session says ----------------------------------------------------------------------------------


def test_a_page_shows_where_the_feet_and_the_wearer_are() -> None:
    session, events = walk()
    told = frame(shown(events))
    for foot in Foot:
        one = told["feet"][foot.value]
        assert one["position"] == [round(v, 3) for v in session.feet[foot].position]
        assert one["phase"] == session.phase(foot).value  # type: ignore[union-attr]
        taken = [event for event in events if isinstance(event, StrideTaken) and event.foot is foot]
        assert one["steps"] == len(taken)
        assert one["distance"] == round(sum(event.length for event in taken), 2)
    last = [event for event in events if isinstance(event, WearerMoved)][-1]
    assert told["wearer"]["position"] == [round(v, 3) for v in last.position]
    assert told["support"] == session.support.value  # type: ignore[union-attr]
    assert told["activity"]["now"] == session.activity.value


def test_cells_are_one_byte_each_of_the_highest_so_far() -> None:
    _, events = walk()
    pressed = [event for event in events if isinstance(event, FootPressed) and event.foot is LEFT]
    told = frame(shown(events))["feet"]["left"]
    assert told["peak"] == round(max(max(event.values) for event in pressed), 3)
    cells = base64.b64decode(told["cells"])
    values = pressed[-1].values
    assert [round(255.0 * value / told["peak"]) for value in values] == [*cells]
    assert told["force"] == round(sum(values), 1)
    highest = max(pressed, key=lambda event: max(event.values))
    assert max(base64.b64decode(frame(shown([highest]))["feet"]["left"]["cells"])) == 255


def test_the_gait_is_the_table_of_the_terminal() -> None:
    _, events = fed(insoles(Route().stand(1.5).walk(14.0, 1.3).stop(1.0)).packets)
    scene = shown(events)
    told, means = frame(scene)["gait"], scene.observer.gait
    parameters = means.of(False)
    assert parameters is not None
    assert told["cadence"] == round(parameters.cadence or 0.0, 1)
    lines = gait_lines(means)
    assert [row["name"] for row in told["rows"]] == [row.name for row in gait_rows(parameters)]
    for row in told["rows"]:
        line = next(line for line in lines if line.startswith(f"{row['label']} {row['unit']} "))
        for one in ("left", "right"):
            assert row[one] is not None and f"{row[one]:.{row['digits']}f}" in line
        assert f"{row['both']:.{row['digits']}f}" in line


def test_both_feet_support_the_wearer_only_while_both_are_heard() -> None:
    scene = shown([moved(1.0), moved(1.0, foot=RIGHT)])
    assert frame(scene)["support"] == "FLIGHT"
    shown([moved(1.0 + 0.1 * k) for k in range(30)], scene)
    scene.tick(4.0)
    told = frame(scene)
    assert told["support"] is None
    assert told["feet"]["right"]["phase"] is None
    assert told["feet"]["left"]["phase"] == "SWING"


# --- whatever there is -----------------------------------------------------------------------------------------------


def test_one_foot_alone_is_shown_alone() -> None:
    _, events = fed([packet for packet in insoles().packets if packet.site is Site.RIGHT_FOOT])
    told = frame(shown(events))
    assert told["feet"]["left"] is None
    assert told["feet"]["right"]["steps"] > 2
    assert told["support"] is None
    assert [*told["links"]] == ["right foot"]


def test_an_insole_without_an_inertial_sensor_shows_its_cells_and_phases() -> None:
    bare = [evolve(one, acc=None, gyro=None) for one in samples()]
    told = frame(shown(fed(bare)[1]))
    for foot in Foot:
        one = told["feet"][foot.value]
        assert one["cells"] is not None and one["rate"] == 100 and one["position"] is None
        assert one["phase"] in {phase.value for phase in Phase}
    assert told["support"] is not None


def test_sensors_without_cells_show_steps_and_no_soles() -> None:
    _, events = fed(emulate(SHORT, devices={Site.LEFT_FOOT: CC2650(), Site.RIGHT_FOOT: CC2650()}, seed=1).packets)
    message = json.loads(encode(shown(events).whole()[0]))
    assert message["layouts"] == {"left": None, "right": None}
    for foot in Foot:
        one = message["frame"]["feet"][foot.value]
        assert one["cells"] is None and one["force"] is None and one["centre"] is None
        assert one["position"] is not None
        assert len(message["tracks"][foot.value]) > 2


def test_other_recipes_are_shown_as_well() -> None:
    _, events = fed(insoles().packets, PRESSURE_CONTOUR)
    told = frame(shown(events))
    assert told["feet"]["left"]["steps"] == len([e for e in events if isinstance(e, StrideTaken) and e.foot is LEFT])
    assert told["feet"]["right"]["phase"] is not None


def test_feet_that_fall_silent_show_nothing_and_come_back() -> None:
    _, events = walk()
    scene = shown(events)
    end = scene.now
    scene.tick(end + 5.0)
    for one in frame(scene)["feet"].values():
        assert one["phase"] is None and one["cells"] is None and one["centre"] is None and one["rate"] == 0
        assert one["steps"] > 2, "what they did is still known"
    assert frame(scene)["links"]["left foot"]["state"] == "silent"
    assert 4.9 < frame(scene)["links"]["left foot"]["silent_for"] < 5.2
    shown([later(event, 20.0) for event in events], scene)
    told = frame(scene)
    assert told["links"]["left foot"]["state"] == "ok"
    assert told["feet"]["left"]["phase"] is not None and told["feet"]["left"]["cells"] is not None


def test_a_link_is_waited_for_heard_lost_and_heard_again() -> None:
    site = Site.LEFT_FOOT
    scene = shown([Connected(t=0.0, known_at=0.0, site=site, device="", name="Insole", signal=-50)])

    def state() -> str:
        return str(frame(scene)["links"]["left foot"]["state"])

    assert state() == "waiting"
    shown([moved(1.0 + 0.01 * k) for k in range(100)], scene)
    assert state() == "ok"
    assert frame(scene)["links"]["left foot"]["rate"] == 100
    shown([Disconnected(t=2.0, known_at=2.0, site=site), moved(1.99, known_at=2.05)], scene)
    assert state() == "lost", "what was still under way is no connection"
    scene.tick(7.0)
    assert frame(scene)["links"]["left foot"]["silent_for"] > 4.9
    assert frame(scene)["links"]["left foot"]["rate"] == 0
    shown([Connected(t=7.5, known_at=7.5, site=site, device="", name="Insole", signal=-50)], scene)
    assert state() == "waiting"
    shown([moved(8.0)], scene)
    assert state() == "ok"
    shown([StreamStale(t=8.5, known_at=9.0, site=site, silent_for=1.0)], scene)
    assert state() == "silent"
    shown([StreamResumed(t=9.4, known_at=9.4, site=site, silent_for=1.4), moved(9.4)], scene)
    assert state() == "ok"


def test_a_sensor_that_is_on_no_foot_has_a_link_and_no_rate() -> None:
    scene = shown([Connected(t=0.0, known_at=0.0, site=Site.PELVIS, device="", name="Tag", signal=-50)])
    link = frame(scene)["links"]["pelvis"]
    assert (link["state"], link["rate"], link["name"]) == ("ok", None, "Tag")
    shown([StreamStale(t=2.0, known_at=3.0, site=Site.PELVIS, silent_for=1.0)], scene)
    assert frame(scene)["links"]["pelvis"]["state"] == "silent"


def test_losses_are_shares_of_the_packets_that_were_sent() -> None:
    scene = Scene("a walk", "default")
    for k in range(30):
        t = 0.02 * k + 0.05
        packet = Packet(t, Site.LEFT_FOOT, "insole/frame", b"")
        scene.take(packet, [moved(t - 0.05, known_at=t), moved(t - 0.04, known_at=t)])
    shown([PacketsLost(t=0.7, known_at=0.7, site=Site.LEFT_FOOT, channel="insole/frame", count=10)], scene)
    link = frame(scene)["links"]["left foot"]
    assert (link["lost"], link["loss"]) == (10, 0.25)


def test_samples_that_came_in_no_packets_have_no_loss() -> None:
    _, events = fed(samples())
    links = frame(shown(events))["links"]
    assert [link["loss"] for link in links.values()] == [None, None]
    assert [link["rate"] for link in links.values()] == [100, 100]


def test_an_activity_that_was_taken_back_is_not_shown() -> None:
    def changed(t: float, activity: Activity, revises: float | None = None) -> ActivityChanged:
        return ActivityChanged(t=t, known_at=t + 1.0, activity=activity, probability=None, revises=revises, final=False)

    scene = shown([changed(1.0, Activity.WALKING), changed(5.0, Activity.ELEVATOR_UP)])
    assert frame(scene)["activity"] == {"now": "ELEVATOR_UP", "since": 5.0, "last": None}
    shown([changed(5.0, Activity.WALKING, revises=5.0)], scene)
    assert frame(scene)["activity"] == {"now": "WALKING", "since": 1.0, "last": None}


def test_a_place_is_shown_until_it_is_lost() -> None:
    events = eventful()
    scene = shown([event for event in events if not isinstance(event, PlaceLost)], Scene("", "", plan=BUILDING))
    message = json.loads(encode(scene.whole()[0]))
    assert message["frame"]["place"]["candidates"][0]["origin"] == "stairs A"
    assert len(message["places"]) == 1, "of several candidates on several levels there is no one place"
    assert [line for line in message["log"] if line[1] == "place"]
    shown([event for event in events if isinstance(event, PlaceLost)], scene)
    assert frame(scene)["place"] is None


def test_numbers_that_are_none_are_shown_as_none() -> None:
    odd = evolve(moved(1.0), position=(nan, inf, -inf))
    pressed = FootPressed(t=1.0, known_at=1.0, foot=LEFT, values=(nan, inf, 1.0), force=nan, centre=(nan, 0.0))
    told = frame(shown([odd, pressed, evolve(pressed, t=1.01, known_at=1.01)]))["feet"]["left"]
    assert told["position"] == [None, None, None]
    assert told["force"] is None
    assert len(base64.b64decode(told["cells"])) == 3


def test_what_happened_at_no_time_is_not_shown() -> None:
    events = [moved(1.0)]
    for time in (nan, inf, -inf):
        for field in ("t", "known_at"):
            assert encode(frame(shown([*events, evolve(moved(1.0), **{field: time})]))) == encode(frame(shown(events)))


def test_a_page_says_how_a_recording_is_played() -> None:
    scene = Scene("a walk", "default", "recording", playback=Playback(begin=0.0, end=9.0, t=0.0))
    _, cursor = scene.whole()
    assert scene.playback is not None
    scene.playback.state, scene.playback.t = "playing", 1.0
    news, _ = scene.since(cursor)
    assert news == {
        "type": "frame",
        "t": 0.0,
        "playback": {"begin": 0.0, "end": 9.0, "t": 1.0, "state": "playing", "speed": 1.0, "seeking": None},
    }


# --- memory ----------------------------------------------------------------------------------------------------------


def test_hours_of_walking_do_not_make_a_scene_larger() -> None:
    many = FootMoved | FootPressed | PacketsLost | PacketRejected | SampleGap
    once = [event for event in eventful() if not isinstance(event, many)]
    length = once[-1].known_at + 1.0
    scene, sizes = Scene("hours", "default", plan=BUILDING), []
    for lap in range(500):
        for event in eventful() if lap % 125 == 124 else once:
            event = later(event, lap * length)
            if isinstance(event, StrideTaken | WearerMoved | Placed):
                x, y, z = event.position
                event = evolve(event, position=(x + lap, y, z))
            scene.take(None, [event])
        if lap % 125 == 124:
            message = scene.whole()[0]
            assert all(len(track) <= MOST_POINTS for track in message["tracks"].values())
            assert len(message["places"]) <= MOST_POINTS
            assert len(message["log"]) == MOST_LINES
            assert all(len(phases) < 100 for phases in message["phases"].values())
            sizes.append(len(pickle.dumps(scene)))
    assert max(sizes[2:]) < 1.3 * max(sizes[:2])
    assert max(sizes) < 1_000_000


# --- the log ---------------------------------------------------------------------------------------------------------


def test_every_event_is_either_a_sentence_or_none() -> None:
    said = [told for event in eventful() if (told := sentence(event)) is not None]
    assert {kind for kind, _ in said} <= {"link", "wear", "gait", "place"}
    assert all(text and "\n" not in text and "_" not in text for _, text in said)


def test_the_log_speaks_of_feet_and_not_of_events() -> None:
    failed = CellsFailed(t=1.0, known_at=1.0, site=Site.LEFT_FOOT, fault=CellFault.DEAD, cells=(3,))
    assert sentence(failed) == ("wear", "left foot: 1 cell shows no load; left out from now on")
    assert sentence(evolve(failed, cells=(3, 4))) == (
        "wear", "left foot: 2 cells show no load; left out from now on",
    )  # fmt: skip
    turned = TurnMade(t=1.0, known_at=1.0, t_start=0.0, angle=-pi / 2, turn=Turn.RIGHT)
    assert sentence(turned) == ("gait", "turned right by 90 degrees")


def test_a_low_battery_is_said_once() -> None:
    levels = [BatteryLevel(t=t, known_at=t, site=Site.LEFT_FOOT, level=0.2 - 0.01 * t) for t in (1.0, 6.0, 7.0, 8.0)]
    assert [line[2] for line in shown(levels).log.lines.items] == ["left foot: the battery is at 14 %"]


def test_a_silence_that_the_link_told_is_not_told_again_of_the_foot() -> None:
    stale = StreamStale(t=1.0, known_at=2.0, site=Site.LEFT_FOOT, silent_for=1.0)
    silent = FootSilent(t=1.0, known_at=2.5, foot=LEFT, silent_for=1.5)
    heard = FootHeard(t=3.0, known_at=3.0, foot=LEFT, silent_for=2.0)
    assert len(shown([moved(0.5), stale, silent]).log.lines.items) == 1
    assert len(shown([moved(1.9), moved(2.5), silent, heard]).log.lines.items) == 2


def test_a_name_from_the_air_cannot_break_a_line() -> None:
    named = Connected(t=0.0, known_at=0.0, site=Site.LEFT_FOOT, device="", name="a\nb\x1b[2J" + 999 * "x", signal=None)
    _, text = sentence(named) or ("", "")
    assert "\n" not in text and "\x1b" not in text and len(text) <= 300


def test_a_plan_is_drawn_and_written_once_whoever_watches() -> None:
    plan = evolve(BUILDING, name="drawn once")
    scene = Scene("along a corridor", "default", plan=plan)
    first, _ = scene.whole()
    copied = deepcopy(scene)
    assert copied.plan is plan
    for one in (scene, copied):
        message, _ = one.whole()
        assert message["plan"] is first["plan"]
        assert json.loads(encode(message)) == json.loads(json.dumps(message))
        assert message["plan"].text is first["plan"].text


# --- protocol/page.md -------------------------------------------------------------------------------------------------

PAGE = (PROTOCOL / "page.md").read_text()


def keys(title: str) -> set[str]:
    """The first column of the table below this heading."""
    table = PAGE.split(f"### {title}\n", 1)[1].split("|---|---|\n", 1)[1].split("\n\n", 1)[0]
    return {name for row in table.splitlines() for name in re.findall(r"`([^`]+)`", row.split("|")[1])}


def test_messages_are_made_of_the_keys_that_the_protocol_names() -> None:
    events = [event for event in eventful() if not isinstance(event, PlaceLost)]
    scene = shown(events, Scene("a walk", "default", "recording", BUILDING, Playback(0.0, 1.0, 0.0)))
    for event in fed(insoles(Route().stand(1.5).walk(14.0, 1.3).stop(1.0)).packets)[1]:
        scene.take(None, [later(event, 100.0)])
    message = json.loads(encode(scene.whole()[0]))
    told = message["frame"]
    assert message.keys() == keys("`scene`")
    assert told.keys() == keys("`frame`")
    assert told["feet"]["left"].keys() == told["feet"]["right"].keys() == keys("foot")
    assert told["gait"].keys() == keys("gait")
    assert all(row.keys() == keys("row") for row in told["gait"]["rows"])
    assert all(link.keys() == keys("link") for link in told["links"].values())
    assert all(scale.keys() == keys("scale") for scale in told["scales"].values()) and told["scales"]
    for name in ("wearer", "place", "activity", "pace", "playback"):
        (row,) = re.findall(rf"^\| `{name}` \| (.*) \|$", PAGE, re.MULTILINE)
        assert told[name].keys() <= set(re.findall(r"`([a-z]+)`", row)), name
    prose = PAGE.replace("\n", " ")
    level, stop = message["plan"]["levels"][0], message["plan"]["connectors"][0]["stops"][0]
    known = {*level, *stop, *message["plan"], *message["plan"]["connectors"][0], *message["layouts"]["left"]}
    assert all(f"`{name}`" in prose for name in known)


def test_the_examples_of_the_protocol_are_what_is_sent() -> None:
    news, before = [json.loads(text) for text in re.findall(r"^```json\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)]
    assert json.loads(encode(Scene("left and right insole", "default").whole()[0])) == before
    assert news.keys() <= keys("`frame`")
    assert news["feet"]["left"].keys() == keys("foot")
    assert news["links"]["left foot"].keys() == keys("link")


def test_the_protocol_tells_the_bounds_of_the_speed() -> None:
    assert f"so many times real time, {SLOWEST:g} to {FASTEST:g} |" in PAGE


def test_the_commands_of_the_protocol_are_commands() -> None:
    table = PAGE.split("| message | meaning |\n", 1)[1].split("\n\n", 1)[0]
    commands = [parse_command(text) for text in re.findall(r"^\| `(.*?)` \|", table, re.MULTILINE)]
    assert [command.do for command in commands] == ["play", "pause", "speed", "seek"]
