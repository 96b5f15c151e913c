"""Tests that the messages to and from a page are those of protocol/page.md."""

from __future__ import annotations

import json
import re

from here import PROTOCOL
from page_events import events_of_all_kinds, feed_session
from shown import later, shown
from walks import insoles

from solepath import FeetSwapped, PlaceLost
from solepath.emulate.routes.building import BUILDING
from solepath.emulate.routes.route import Route
from solepath.show.page.messages import MAX_SPEED, MIN_SPEED, encode, parse_command
from solepath.show.page.player.playback import Playback
from solepath.show.page.scene.scene import Scene

PAGE = (PROTOCOL / "page.md").read_text()


def keys(title: str) -> set[str]:
    """Return the first column of the table below this heading."""
    table = PAGE.split(f"### {title}\n", 1)[1].split("|---|---|\n", 1)[1].split("\n\n", 1)[0]
    return {name for row in table.splitlines() for name in re.findall(r"`([^`]+)`", row.split("|")[1])}


def test_messages_are_made_of_the_keys_that_the_protocol_names() -> None:
    events = [event for event in events_of_all_kinds() if not isinstance(event, PlaceLost)]
    scene = shown(events, Scene("a walk", "default", "recording", BUILDING, Playback(0.0, 1.0, 0.0)))
    for event in feed_session(insoles(Route().stand(1.5).walk(14.0, 1.3)).packets)[1]:
        scene.take(None, [later(event, 100.0)])
    scene.take(None, [FeetSwapped(t=scene.now, known_at=scene.now)])
    message = json.loads(encode(scene.whole_message()))
    frame = message["frame"]
    assert message.keys() == keys("`scene`")
    assert frame.keys() == keys("`frame`")
    assert frame["feet"]["left"].keys() == frame["feet"]["right"].keys() == keys("foot")
    assert frame["gait"].keys() == keys("gait")
    assert all(row.keys() == keys("row") for row in frame["gait"]["rows"])
    assert all(one.keys() == keys("finding") for one in frame["findings"]) and frame["findings"]
    assert all(link.keys() == keys("link") for link in frame["links"].values())
    assert all(scale.keys() == keys("scale") for scale in frame["scales"].values()) and frame["scales"]
    for name in ("wearer", "place", "activity", "pace", "total", "playback"):
        (row,) = re.findall(rf"^\| `{name}` \| (.*) \|$", PAGE, re.MULTILINE)
        assert frame[name].keys() <= set(re.findall(r"`([a-z]+)`", row)), name
    prose = PAGE.replace("\n", " ")
    level, stop = message["plan"]["levels"][0], message["plan"]["connectors"][0]["stops"][0]
    known = {*level, *stop, *message["plan"], *message["plan"]["connectors"][0], *message["layouts"]["left"]}
    assert all(f"`{name}`" in prose for name in known)


def test_the_examples_of_the_protocol_are_what_is_sent() -> None:
    news, before = [json.loads(text) for text in re.findall(r"^```json\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)]
    assert json.loads(encode(Scene("left and right insole", "default").whole_message())) == before
    assert news.keys() <= keys("`frame`")
    assert news["feet"]["left"].keys() == keys("foot")
    assert news["links"]["left foot"].keys() == keys("link")


def test_the_protocol_states_the_bounds_of_the_speed() -> None:
    assert f"so many times real time, {MIN_SPEED:g} to {MAX_SPEED:g} |" in PAGE


def test_the_commands_of_the_protocol_are_commands() -> None:
    table = PAGE.split("| message | meaning |\n", 1)[1].split("\n\n", 1)[0]
    commands = [parse_command(text) for text in re.findall(r"^\| `(.*?)` \|", table, re.MULTILINE)]
    assert [command.do for command in commands] == ["play", "pause", "speed", "seek", "here", "here", "here"]
