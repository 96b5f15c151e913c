"""Tables of the phases of a foot and of the support of a body."""

from __future__ import annotations

import ast
from itertools import product
from pathlib import Path

import pytest
from walks import SHORT, insoles

from solepath import Foot, Phase, Session, Support
from solepath.foot import phase
from solepath.foot.cues import inertial
from solepath.foot.cues.inertial import MOVING_SIGNS, STILL_SIGNS
from solepath.foot.phase import PHASES, SUPPORT, Cue, describe


def test_a_step_goes_through_the_four_phases_in_order() -> None:
    now, phases = Phase.STATIONARY, []
    for cue in (Cue.LIFT, Cue.CLEAR, Cue.CONTACT, Cue.FLAT):
        now = PHASES[now][cue]
        phases.append(now)
    assert phases == [Phase.PUSH_OFF, Phase.SWING, Phase.LOADING, Phase.STATIONARY]


@pytest.mark.parametrize(("left", "right"), list(product(Phase, Phase)))
def test_a_body_stands_on_the_feet_that_do_not_swing(left: Phase, right: Phase) -> None:
    on_ground = (left is not Phase.SWING, right is not Phase.SWING)
    expected = {
        (True, True): Support.DOUBLE,
        (True, False): Support.LEFT,
        (False, True): Support.RIGHT,
        (False, False): Support.FLIGHT,
    }
    assert SUPPORT[left][right] is expected[on_ground]


def test_the_tables_can_be_printed() -> None:
    text = describe()
    rows = {line.split()[0]: line.split()[1:] for line in text.splitlines()[1:5]}
    assert rows == {one.name: [PHASES[one][cue].name for cue in Cue] for one in Phase}
    assert text.splitlines()[0].split() == ["phase", "contact", "flat", "lift", "clear", "ground", "air"]
    assert "PUSH_OFF    clear       contact     flat" in text
    joint = [line.split() for line in text.splitlines()[-4:]]
    assert joint == [[left.name, *(SUPPORT[left][right].name for right in Phase)] for left in Phase]
    assert all(line == line.rstrip() for line in text.splitlines())


def test_only_the_look_up_in_the_table_sets_a_phase() -> None:
    setters, readers = [], []
    for path in Path(phase.__file__).parent.rglob("*.py"):
        for function in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(function, ast.FunctionDef):
                inside = [
                    ast.unparse(node)
                    for node in ast.walk(function)
                    if isinstance(node, ast.Attribute | ast.Subscript)
                    and (isinstance(node.ctx, ast.Store) or isinstance(node, ast.Subscript))
                ]
                setters += [function.name for text in inside if text.endswith(".phase")]
                readers += [function.name for text in inside if text.startswith("PHASES[") and text.count("[") == 2]
    assert setters == readers == ["_change_phase"]


def test_each_sign_of_the_inertial_sensor_has_a_cue_that_changes_its_phase() -> None:
    tables = (STILL_SIGNS, MOVING_SIGNS)
    assert all(set(table) == set(Phase) for table in tables)
    assert all(PHASES[now][cue] is not now for table in tables for now, signs in table.items() for _, cue in signs)
    rows = [line.split() for line in inertial.describe().splitlines()[1:]]
    assert ["SWING", "still", "stopped", "contact"] in rows and ["SWING", "moving", "landed", "contact"] in rows
    assert len(rows) == sum(len(signs) for table in tables for signs in table.values())


def test_walking_is_single_and_double_support_in_turn_and_never_flight() -> None:
    session, supports = Session(), []
    for packet in insoles(SHORT).packets:
        session.feed(packet)
        if packet.t > 2.0 and (not supports or session.support is not supports[-1]):
            supports.append(session.support)
    assert Support.FLIGHT not in supports
    assert supports.count(Support.LEFT) >= 4 and supports.count(Support.RIGHT) >= 4
    singles = [support for support in supports if support is not Support.DOUBLE]
    assert all(a is not b for a, b in zip(singles, singles[1:], strict=False))
    assert session.phase(Foot.LEFT) is session.phase(Foot.RIGHT) is Phase.STATIONARY
