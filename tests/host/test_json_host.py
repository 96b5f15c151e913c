"""A session behind JSON texts, as an app in another language uses it (protocol/host.md)."""

from __future__ import annotations

import json
import runpy
from base64 import b64decode
from functools import cache
from math import dist
from typing import Any

import pytest
from benches import LEFT, RIGHT, ROUTE
from here import EXAMPLES, PROTOCOL
from shell import Shell, shell

from solepath import Packet, Session, Site
from solepath.emulate.devices.bench import Bench
from solepath.emulate.devices.faults import parse_faults
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2650
from solepath.session.json_host import HANDLERS, JsonHost

WALK = 20.0
"""Duration of a walk, s."""


@cache
def whole_walk() -> Shell:
    """Return a shell after a whole walk, which nobody may change."""
    return walked()


def walked(faults: str = "", until: float = WALK) -> Shell:
    """Return a shell after a walk with two insoles, which report their feet."""
    one = shell(JsonHost(packets=True).receive, Bench(ROUTE, seed=3, faults=parse_faults(faults)).peripherals)
    one.use(None, None)
    one.run(until)
    return one


def replayed(messages: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the events of a new session that is fed the packets of the messages."""
    session, events = Session(), []
    for one in messages:
        if one["type"] == "packet":
            site, data = Site(one["site"]), bytes.fromhex(one["data"])
            events += session.feed(Packet(one["t"], site, one["channel"], data, one.get("device", "")))
    return [event.to_dict() for event in events]


def test_two_insoles_walk_through_texts_alone_and_the_packets_replay_the_same_events() -> None:
    one = whole_walk()
    assert not [message for message in one.messages if message["type"] == "error"]
    assert {event["site"] for event in one.events("Connected")} == {"left_foot", "right_foot"}
    assert len(one.events("BatteryLevel")) >= 2, "its UUID came in four digits"
    strides = one.events("StrideTaken")
    assert {event["foot"] for event in strides} == {"left", "right"} and len(strides) >= 8
    events = [message for message in one.messages if message["type"] == "event"]
    assert [{key: event[key] for key in event if key != "type"} for event in events] == replayed(one.messages)


@pytest.mark.soak
def test_a_lost_insole_comes_back_at_its_foot() -> None:
    one = walked("5 left_foot disconnect")
    left = [event["event"] for event in one.events("Connected", "Disconnected") if event["site"] == "left_foot"]
    assert left == ["Connected", "Disconnected", "Connected"]
    assert [event["t"] for event in one.events("StrideTaken") if event["foot"] == "left"][-1] > 8.0


@pytest.mark.soak
def test_another_insole_at_the_same_foot_continues_the_walk() -> None:
    host = JsonHost(packets=True)
    for device, seed, now in (("A", 3, 0.0), ("B", 4, 10.0)):
        emulated = Bench(ROUTE, devices={LEFT: Insole()}, seed=seed, started_at=now)[LEFT]
        one = Shell(host.receive, {device: emulated}, now)
        one.send({"type": "bind", "site": "left_foot"}, {"type": "add", "device": device, "site": None})
        one.use(None)
        one.run(now + 9.0)
        one.lose(device)
        one.send({"type": "remove", "device": device})
        assert one.events("StrideTaken") and not one.events("PacketRejected")
        assert device in {message.get("device", "") for message in one.messages if message["type"] == "packet"}


@pytest.mark.parametrize("new_clock", [-1e5, 1000.0])
def test_after_its_clock_restarted_a_host_neither_forgets_a_frozen_sensor_nor_takes_one_for_frozen(
    new_clock: float,
) -> None:
    one = shell(JsonHost().receive, Bench(ROUTE, devices={RIGHT: CC2650()}, seed=3).peripherals)
    one.use("right_foot")
    one.run(2.0)
    one.send({"type": "restart", "t": new_clock}, {"type": "time", "t": new_clock + 0.2})
    assert not one.events("StreamRestarted")
    one.send(*({"type": "time", "t": new_clock + 0.2 * tick} for tick in range(100)))
    assert one.events("StreamRestarted")


def test_the_last_values_of_a_sensor_that_was_removed_cost_no_other_sensor_its_values() -> None:
    one = shell(JsonHost(packets=True).receive, Bench(ROUTE, seed=3).peripherals)
    one.use(None, None)
    one.run(2.0)
    left, right = one.devices
    one.lose(left)
    one.send({"type": "remove", "device": left})
    frame = next(m["data"] for m in reversed(one.messages) if m["type"] == "packet" and m["channel"] == "insole/frame")
    del one.messages[:]
    one.send({"type": "values", "values": [[2.1, left, "insole/frame", frame], [2.1, right, "insole/frame", frame]]})
    assert [message["type"] for message in one.messages if message["type"] != "event"] == ["packet", "error"]


def test_a_connection_that_nobody_ended_is_ended_by_the_next() -> None:
    one = walked(until=3.0)
    device = next(iter(one.devices))
    one.send({"type": "connected", "device": device, "t": 3.0, "characteristics": [], "connection": 99})
    assert [event["event"] for event in one.events("Connected", "Disconnected")][-1] == "Disconnected"
    one.send({"type": "remove", "device": device})
    assert one.messages[-1]["type"] != "error"


def test_after_the_end_everything_but_another_start_is_an_error() -> None:
    one = walked(until=4.0)
    device = next(iter(one.devices))
    one.send({"type": "save"}, {"type": "finish"})
    saved = next(message["state"] for message in reversed(one.messages) if message["type"] == "saved")
    del one.messages[:]
    one.send({"type": "time", "t": 5.0}, {"type": "disconnected", "device": device, "t": 5.0})
    assert [message["reason"] for message in one.messages] == ["the walk is finished"] * 2
    del one.messages[:]
    one.send({"type": "start", "state": saved, "packets": True}, {"type": "save"})
    assert [message["type"] for message in one.messages] == ["saved"] and one.messages[0]["state"] == saved


def test_a_second_left_insole_is_disconnected_with_a_reason() -> None:
    benches = [Bench(ROUTE, devices={LEFT: Insole()}, seed=seed) for seed in (3, 4)]
    first, second = benches[0][LEFT], benches[1][LEFT]
    one = Shell(JsonHost().receive, {"A": first, "B": second})
    one.use(None, None)
    one.run(3.0)
    [ended] = [message for message in one.messages if message["type"] == "disconnect"]
    assert ended == {
        "type": "disconnect",
        "device": "B",
        "connection": 2,
        "reason": f"{second.name} is one more for the left foot",
        "wrong": True,
    }
    assert [event["what"] for event in one.events("LinkTrouble")] == [ended["reason"]]


def test_a_saved_state_goes_on_in_another_host() -> None:
    bench = Bench(ROUTE, seed=3)
    one = shell(JsonHost(packets=True).receive, bench.peripherals)
    one.use(None, None)
    one.run(5.0)
    one.send({"type": "save"})
    assert one.messages[-1]["type"] == "saved"
    other = JsonHost()
    assert other.receive(json.dumps({"type": "start", "state": one.messages[-1]["state"], "packets": True})) == "[]"
    assert other.host.session.pack() == b64decode(one.messages[-1]["state"])
    for device in bench.peripherals:
        device.disconnected(one.now)
    again = Shell(other.receive, one.devices, one.now)
    again.use(None, None)
    again.run(WALK)
    at_save, at_end = one.events("StrideTaken")[-1]["position"], again.events("StrideTaken")[-1]["position"]
    whole = whole_walk().events("StrideTaken")[-1]["position"]
    assert at_end[0] > at_save[0] + 3.0
    assert dist(at_end[:2], whole[:2]) < 1.0  # no sample was received while the insoles connected again


def test_the_document_names_every_message_of_both_directions() -> None:
    from_app, to_app = (PROTOCOL / "host.md").read_text("utf-8").split("## To the app")
    assert table(from_app) == {*HANDLERS}
    one = walked("5 left_foot freeze", 12.0)
    one.send({"type": "scan"}, {"type": "save"}, {"type": "no such"})
    assert {message["type"] for message in one.messages} | {"disconnect"} == table(to_app)


def table(text: str) -> set[str]:
    """Return the words in the first column of the tables of a document."""
    return {line.split("`")[1] for line in text.splitlines() if line.startswith("| `")}


def test_a_right_insole_that_fails_at_first_does_not_take_the_place_of_the_left_one() -> None:
    bench = Bench(ROUTE, seed=3)
    one = shell(JsonHost().receive, [bench[RIGHT], bench[LEFT]])
    for device in one.devices:
        one.send({"type": "add", "device": device})
    one.send({"type": "failed", "device": bench[RIGHT].address, "t": 0.0, "reason": "cannot connect"})
    one.use(None, None)
    one.run(WALK)
    assert not one.events("PacketRejected")
    assert {event["foot"] for event in one.events("StrideTaken")} == {"left", "right"}


def test_devices_of_the_sessions_own_are_known_by_name_by_services_and_by_what_they_can_send() -> None:
    own = runpy.run_path(str(EXAMPLES / "own_device.py"))
    profile, driver = own["PROFILE"], own["DRIVER"]
    host = JsonHost(Session(profiles=[driver]), packets=True)

    def answers(**message: Any) -> list[dict[str, Any]]:
        return json.loads(host.receive(json.dumps(message)))

    [found] = answers(type="scan")
    assert own["UUID"](1) in found["services"] and {"name": "My shoe", "prefix": "", "service": ""} in found["filters"]
    assert len(found["services"]) == 1 + len(json.loads(JsonHost().receive('{"type": "scan"}'))[0]["services"])
    there = [[one.service, one.characteristic, one.access.value == "notify"] for one in profile.channels]
    for device, more in (("A", {"site": "left_foot"}), ("B", {"site": "right_foot", "profile": "shoe"})):
        assert answers(type="add", device=device, **more) == []
        sent = answers(type="connected", t=1.0, device=device, characteristics=there)
        assert [one["type"] for one in sent][-1] == "subscribe"
        [written] = answers(type="done", t=1.1, device=device)
        assert (written["type"], written["channel"], written["value"]) == ("write", "shoe/start", "c2")
        answers(type="done", t=1.2, device=device)
    value = driver.write("shoe/motion", {"number": 0, "ticks": 0, "acc": [0, 0, 2048], "gyro": [0, 0, 0]}).hex()
    events = answers(type="values", values=[[1.3, "A", "shoe/motion", value]])
    assert events[0]["type"] == "packet" and "PacketRejected" not in [one.get("event") for one in events]
    [error] = answers(type="add", device="C", site="pelvis", profile="heelbox")
    assert error == {"type": "error", "of": "add", "device": "C", "reason": "there is no profile 'heelbox'"}
