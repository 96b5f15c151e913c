"""Fault scripts: their syntax, and their effect on an emulated device."""

from __future__ import annotations

from math import inf

import pytest
from benches import LEFT, RIGHT, Received, error_code, played, set_up, worn
from hypothesis import given
from hypothesis import strategies as st

from solepath.emulate.devices.faults import Fault, FaultKind, parse_faults
from solepath.emulate.devices.peripheral import Peripheral
from solepath.emulate.sensors.sensortags import CC2650
from solepath.link.devices import cc2650

MOVEMENT = "cc2650/movement"


def tag(faults: str = "") -> Peripheral:
    return set_up(worn(CC2650(), faults=faults), cc2650.PROFILE)


def movements(device: Peripheral, until: float) -> Received:
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
        Fault(12.5, LEFT, FaultKind.DISCONNECT),
        Fault(20.0, RIGHT, FaultKind.VANISH, 60.0),
        Fault(5.0, None, FaultKind.DROP, 3.0),
        Fault(15.0, LEFT, FaultKind.FREEZE, inf),
        Fault(0.0, LEFT, FaultKind.MTU, 23.0),
        Fault(0.0, LEFT, FaultKind.REJECT, 2.0, "cc2650/movement-config"),
        Fault(0.0, None, FaultKind.NAME, 1.0, "Sensor #2 Tag"),
        Fault(0.0, LEFT, FaultKind.PAIRING),
        Fault(3.0, LEFT, FaultKind.REJECT, 1.0, "pairing"),
    )
    assert parse_faults("") == parse_faults("# nothing\n\n;") == ()


@pytest.mark.parametrize(
    ("line", "reason"),
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
def test_a_line_that_cannot_be_understood_is_named(line: str, reason: str) -> None:
    with pytest.raises(ValueError, match=f"^line 2: .*{reason}"):
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


def test_the_same_script_damages_the_same_bits() -> None:
    script = "1 * flip 9; 1 * truncate 9"
    assert movements(tag(script), 5.0) == movements(tag(script), 5.0)


def test_nothing_is_sent_after_a_loss_that_is_noticed_late() -> None:
    device = tag("2 left_foot disconnect")
    assert len([o for o in device.poll(10.0) if o.channel == MOVEMENT]) == pytest.approx(20, abs=1)
    assert device.must_hang_up(10.0)
    assert not device.must_hang_up(10.0)


def test_a_loss_while_there_is_no_link_ends_no_later_one() -> None:
    device = worn(CC2650(), faults="2 left_foot disconnect")
    set_up(device, cc2650.PROFILE, now=5.0)
    assert len(movements(device, 9.0)) > 30
    assert device.is_connected


def test_a_frozen_stream_thaws_by_itself_or_when_it_is_set_up_again() -> None:
    received = movements(tag("2 left_foot freeze 3"), 9.0)
    assert max(b - a for (a, _), (b, _) in zip(received, received[1:], strict=False)) == pytest.approx(3.1, abs=0.11)
    device = tag("2 left_foot freeze")
    assert all(t <= 2.1 for t, _ in movements(device, 9.0))
    assert device.is_connected
    assert error_code(device, "cc2650/movement-config", b"\x7f", 9.0), "what is refused thaws nothing"
    assert not movements(device, 10.0)
    device.write("cc2650/movement-config", b"\x7f\x02", 10.0)
    assert len(movements(device, 12.0)) == pytest.approx(20, abs=1)


def test_a_name_may_be_another_one() -> None:
    device = worn(CC2650(), faults='0 * name "SensorTag"; 9 * name "SensorTag 2.0"')
    device.visible(0.0)
    assert device.name == "SensorTag"
    device.visible(9.0)
    assert device.name == "SensorTag 2.0"


def test_seconds_count_from_the_walks_start() -> None:
    device = worn(CC2650(), faults="2 left_foot disconnect", started_at=100.0)
    set_up(device, cc2650.PROFILE, now=90.0)
    assert played(device, 200.0)[-1][0] == pytest.approx(102.0, abs=0.11)


def test_a_restarted_walk_has_the_faults_of_its_script_again() -> None:
    device = tag("1 left_foot drop 3; 2 left_foot disconnect")
    assert sum(t < 2.0 for t, _ in movements(device, 5.0)) > 5
    assert device.fault_count == 2 and not device.is_connected
    device.walk_from(10.0)
    assert device.fault_count == 0
    set_up(device, cc2650.PROFILE, now=9.0)
    again = movements(device, 20.0)
    assert device.fault_count == 2 and not device.is_connected
    assert max(t for t, _ in again) < 12.0
    assert max(b - a for (a, _), (b, _) in zip(again, again[1:], strict=False)) > 0.35, "three were dropped again"


def test_lasting_faults_of_an_earlier_walk_end_with_it() -> None:
    device = tag("1 left_foot vanish 1000; 3 left_foot freeze; 2 left_foot name gone; 2 left_foot pairing")
    assert not device.visible(5.0) and device.name == "gone" and device.needs_pairing
    device.disconnected(5.0)
    device.walk_from(10.0)
    assert device.visible(9.0) and device.name != "gone" and not device.needs_pairing
    set_up(device, cc2650.PROFILE, now=9.0)
    assert movements(device, 9.9)
