"""Fault scripts: their syntax, and their effect on an emulated device."""

from __future__ import annotations

from math import inf

import pytest
from benches import LEFT, RIGHT, Received, error_code, played, set_up, worn

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
        ("5 hand hang", "no site 'hand'"),
        ("5 left_foot explode", "no fault 'explode'"),
        ("5 left_foot drop 0", "at least 1"),
        ("5 left_foot mtu 22", "from 23 to 517"),
        ("5 left_foot refuse", "needs a channel"),
        ("5 left_foot hang 3", "too many words"),
        ('5 left_foot name "open', "quotation"),
    ],
)
def test_a_line_that_cannot_be_understood_is_named(line: str, reason: str) -> None:
    with pytest.raises(ValueError, match=f"^line 2: .*{reason}"):
        parse_faults(f"1 * drop\n{line}\n")


# its effect


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
