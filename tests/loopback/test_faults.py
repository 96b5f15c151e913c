"""What a fault script says, and what it does to an emulated device."""

from __future__ import annotations

from math import inf

import pytest
from benches import LEFT, RIGHT, Heard, begin, played, refusal, set_up, worn
from hypothesis import given
from hypothesis import strategies as st

from solepath.emulate.devices.faults import Fault, What, parse_faults
from solepath.emulate.devices.peripheral import Peripheral
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.sensortags import CC2650
from solepath.link.devices import cc2650, insole
from solepath.wire.error import WireError
from solepath.wire.insole import parse_frame

MOVEMENT = "cc2650/movement"


def tag(faults: str = "") -> Peripheral:
    return set_up(worn(CC2650(), faults=faults), cc2650.PROFILE)


def movements(device: Peripheral, until: float) -> Heard:
    return played(device, until, MOVEMENT)


# the script


def test_a_script_is_read_line_by_line_in_its_order() -> None:
    script = """
    # what happens on the way
    12.5 left_foot disconnect        # in the corridor
    20 right_foot vanish 60; 5 * drop 3
    15 left_foot freeze
    0 left_foot mtu 23
    0 left_foot refuse cc2650/movement-config 2
    0 * name "Sensor #2 Tag"
    0 left_foot pairing; 3 left_foot refuse pairing
    """
    assert parse_faults(script) == (
        Fault(12.5, LEFT, What.DISCONNECT),
        Fault(20.0, RIGHT, What.VANISH, 60.0),
        Fault(5.0, None, What.DROP, 3.0),
        Fault(15.0, LEFT, What.FREEZE, inf),
        Fault(0.0, LEFT, What.MTU, 23.0),
        Fault(0.0, LEFT, What.REFUSE, 2.0, "cc2650/movement-config"),
        Fault(0.0, None, What.NAME, 1.0, "Sensor #2 Tag"),
        Fault(0.0, LEFT, What.PAIRING),
        Fault(3.0, LEFT, What.REFUSE, 1.0, "pairing"),
    )
    assert parse_faults("") == parse_faults("# nothing\n\n;") == ()


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("5 left_foot", "SECONDS SITE WHAT"),
        ("soon left_foot hang", "'soon' is not a number"),
        ("-1 left_foot hang", "out of range"),
        ("nan left_foot hang", "out of range"),
        ("inf left_foot hang", "out of range"),
        ("5 hand hang", "no site 'hand'"),
        ("5 left_foot explode", "no fault 'explode'"),
        ("5 left_foot drop many", "'many' is not a number"),
        ("5 left_foot drop 0", "at least 1"),
        ("5 left_foot drop 1.5", "whole number"),
        ("5 left_foot mtu", "from 23 to 517"),
        ("5 left_foot mtu 22", "from 23 to 517"),
        ("5 left_foot refuse", "needs a channel"),
        ("5 left_foot name", "needs a name"),
        ("5 left_foot hang 3", "too many words"),
        ("5 left_foot restart 3", "too many words"),
        ("5 left_foot pairing 3", "too many words"),
        ("5 left_foot drop 3 4", "too many words"),
        ('5 left_foot name "open', "quotation"),
    ],
)
def test_a_line_that_cannot_be_understood_is_named(line: str, why: str) -> None:
    with pytest.raises(ValueError, match=f"^line 2: .*{why}"):
        parse_faults(f"1 * drop\n{line}\n")


@given(st.text(max_size=60))
def test_no_text_does_anything_but_parse_or_raise_a_value_error(text: str) -> None:
    try:
        found = parse_faults(text)
    except ValueError as error:
        assert str(error).startswith("line ")
    else:
        assert all(isinstance(fault, Fault) for fault in found)


# its effect


def test_faults_of_another_site_do_nothing() -> None:
    assert movements(tag("1 right_foot drop 50; 2 right_foot disconnect"), 5.0) == movements(tag(), 5.0)


def test_dropped_notifications_are_missing_and_the_rest_is_as_it_was() -> None:
    plain = played(tag(), 5.0)
    dropped = played(tag("2 * drop 3"), 5.0)
    k = next(i for i, (t, _) in enumerate(plain) if t >= 2.0)
    assert dropped == plain[:k] + plain[k + 3 :]


def test_duplicated_notifications_come_twice() -> None:
    plain, heard = movements(tag(), 5.0), movements(tag("2 left_foot duplicate 2"), 5.0)
    assert len(heard) >= len(plain) + 1
    assert [one for one, following in zip(heard, heard[1:], strict=False) if one == following]
    assert sorted(set(heard), key=heard.index) == plain


def test_truncated_notifications_are_shorter_and_turned_bits_are_seen_by_the_checksum() -> None:
    short = movements(tag("2 * truncate 4"), 5.0)
    assert sum(len(outgoing.value) < 18 for _, outgoing in short) in (3, 4)
    device = set_up(worn(Insole(), faults="1 * flip 5"), insole.PROFILE)
    bad = []
    for t, outgoing in played(device, 3.0, "insole/frame"):
        try:
            parse_frame(outgoing.value)
        except WireError:
            bad.append(t)
    assert len(bad) == 5
    assert 1.0 <= bad[0] < bad[-1] < 1.1


def test_the_same_script_damages_the_same_bits() -> None:
    script = "1 * flip 9; 1 * truncate 9"
    assert movements(tag(script), 5.0) == movements(tag(script), 5.0)


def test_a_lost_link_is_lost_once_and_at_its_time() -> None:
    device = tag("2 left_foot disconnect")
    assert not device.hang_up(1.99)
    assert device.next_due() is not None and device.next_due() <= 2.0  # type: ignore[operator]
    assert all(t <= 2.0 for t, _ in played(device, 9.0))
    assert not device.is_connected
    assert device.visible(2.0)
    set_up(device, cc2650.PROFILE, now=3.0)
    assert len(movements(device, 9.0)) == pytest.approx(60, abs=2)


def test_nothing_is_sent_after_a_loss_that_is_noticed_late() -> None:
    device = tag("2 left_foot disconnect")
    assert len([o for o in device.poll(10.0) if o.channel == MOVEMENT]) == pytest.approx(20, abs=1)
    assert device.hang_up(10.0)
    assert not device.hang_up(10.0)


def test_a_loss_while_there_is_no_link_ends_no_later_one() -> None:
    device = worn(CC2650(), faults="2 left_foot disconnect")
    set_up(device, cc2650.PROFILE, now=5.0)
    assert len(movements(device, 9.0)) > 30
    assert device.is_connected


def test_a_device_that_vanishes_is_not_to_be_seen_until_it_is_back() -> None:
    device = tag("2 left_foot vanish 60")
    assert all(t <= 2.0 for t, _ in played(device, 9.0))
    assert [device.visible(t) for t in (2.5, 61.9, 62.1)] == [False, False, True]


def test_a_frozen_stream_thaws_by_itself_or_when_it_is_set_up_again() -> None:
    heard = movements(tag("2 left_foot freeze 3"), 9.0)
    assert max(b - a for (a, _), (b, _) in zip(heard, heard[1:], strict=False)) == pytest.approx(3.1, abs=0.11)
    device = tag("2 left_foot freeze")
    assert all(t <= 2.1 for t, _ in movements(device, 9.0))
    assert device.is_connected
    assert refusal(device, "cc2650/movement-config", b"\x7f", 9.0), "what is refused thaws nothing"
    assert not movements(device, 10.0)
    device.write("cc2650/movement-config", b"\x7f\x02", 10.0)
    assert len(movements(device, 12.0)) == pytest.approx(20, abs=1)


def test_a_frozen_insole_thaws_by_start() -> None:
    device = set_up(worn(Insole(), faults="2 left_foot freeze"), insole.PROFILE)
    assert played(device, 5.0)[-1][0] < 2.0
    device.write("insole/control", b"\x01", 5.0)
    assert played(device, 6.0)


def test_a_smaller_mtu_holds_from_the_next_connection_on() -> None:
    device = worn(Insole(), faults="1 left_foot mtu 23")
    assert (device.visible(0.0), device.mtu) == (True, 247)
    assert (device.visible(1.5), device.mtu) == (True, 23)


def test_a_refused_channel_refuses_so_many_requests_and_others_none() -> None:
    device = begin(worn(CC2650(), faults="0 left_foot refuse cc2650/movement-config 2"))
    config = b"\x7f\x02"
    assert refusal(device, "cc2650/movement-period", b"\x0a") == 0
    assert [refusal(device, "cc2650/movement-config", config) for _ in range(3)] == [0x80, 0x80, 0]
    assert device.read("cc2650/movement-config", 0.0) == config


def test_a_request_that_hangs_is_never_answered_and_then_the_link_is_lost() -> None:
    device = tag("3 left_foot hang")
    assert device.read("device/battery", 2.9) is not None
    played(device, 3.5)
    assert device.read("device/battery", 3.5) is None
    assert device.write("cc2650/movement-period", b"\x64", 3.6) is False
    assert device.value("cc2650/movement-period", 3.6) == b"\x0a"
    heard = played(device, 9.0)
    assert heard and all(t <= 4.5 for t, _ in heard)
    assert not device.is_connected
    begin(device, now=6.0)
    assert device.read("device/battery", 6.0) is not None


def test_a_device_that_restarts_counts_from_the_beginning_again() -> None:
    device = set_up(worn(Insole(), faults="3 left_foot restart"), insole.PROFILE)
    before = [parse_frame(outgoing.value) for _, outgoing in played(device, 9.0, "insole/frame")]
    assert not device.is_connected
    set_up(device, insole.PROFILE, now=5.0)
    after = [parse_frame(outgoing.value) for _, outgoing in played(device, 6.0, "insole/frame")]
    assert [frame.sequence for frame in after] == list(range(len(after)))
    assert after[0].ticks == pytest.approx(2.0 * 32768, abs=400)
    assert before[0].sequence > 1000, "so the two cannot be taken for one count"
    assert {frame.samples for frame in after}.isdisjoint({frame.samples for frame in before})


def test_a_name_may_be_another_one() -> None:
    device = worn(CC2650(), faults='0 * name "SensorTag"; 9 * name "SensorTag 2.0"')
    device.visible(0.0)
    assert device.name == "SensorTag"
    device.visible(9.0)
    assert device.name == "SensorTag 2.0"


def test_seconds_count_from_the_walks_beginning() -> None:
    device = worn(CC2650(), faults="2 left_foot disconnect", began=100.0)
    set_up(device, cc2650.PROFILE, now=90.0)
    assert played(device, 200.0)[-1][0] == pytest.approx(102.0, abs=0.11)


def test_what_was_handed_over_is_counted_and_kept_on_request() -> None:
    device = worn(CC2650(), faults="1 * drop 4; 2 * duplicate 1")
    device.log = []
    set_up(device, cc2650.PROFILE)
    heard = played(device, 5.0)
    assert device.log == [outgoing for _, outgoing in heard]
    assert sum(device.sent.values()) == len(heard)


def test_a_walk_that_begins_anew_has_the_faults_of_its_script_again() -> None:
    device = tag("1 left_foot drop 3; 2 left_foot disconnect")
    assert sum(t < 2.0 for t, _ in movements(device, 5.0)) > 5
    assert device.suffered == 2 and not device.is_connected
    device.began = 10.0
    assert device.suffered == 0
    set_up(device, cc2650.PROFILE, now=9.0)
    again = movements(device, 20.0)
    assert device.suffered == 2 and not device.is_connected
    assert max(t for t, _ in again) < 12.0
    assert max(b - a for (a, _), (b, _) in zip(again, again[1:], strict=False)) > 0.35, "three were dropped again"


def test_what_was_to_last_in_an_earlier_walk_does_not_last_in_the_next() -> None:
    device = tag("1 left_foot vanish 1000; 3 left_foot freeze; 2 left_foot name gone; 2 left_foot pairing")
    assert not device.visible(5.0) and device.name == "gone" and device.needs_pairing
    device.disconnected(5.0)
    device.began = 10.0
    assert device.visible(9.0) and device.name != "gone" and not device.needs_pairing
    set_up(device, cc2650.PROFILE, now=9.0)
    assert movements(device, 9.9)
