"""Toe-off and heel-strike from the centre of pressure, fig. 4 of the paper, and the phases that follow."""

from __future__ import annotations

from math import inf

import pytest

from solepath.emulate.routes.route import Route
from solepath.foot.cues.cues import TimedCue
from solepath.foot.phase import PHASES, Cue
from solepath.foot.pressure.insole import InsoleLoads
from solepath.foot.stance.stance import Load, Stance
from solepath.papers.kupt_dfpc.cop_cues import CopCues, StrideStage
from solepath.types import Cell, Foot, Layout, Phase, Vec3
from solepath.types.vector import GRAVITY, ZERO

FOUR_CELLS = Layout(4, Foot.LEFT, (Cell(0.034, 0.0), Cell(0.07, 0.0), Cell(0.12, 0.0), Cell(0.166, 0.0)), 0.2)
"""The paper's cells lie from 34 to 166 mm: its foot centre is 100 mm."""
CELLS = (0.0,) * 96
UP: Vec3 = (0.0, 0.0, GRAVITY)
STANDS, MOVES = Stance(ZERO, 0.01, 0.5, Phase.STATIONARY), Stance(ZERO, inf, 0.0, None)

Row = tuple[float | None, bool]
"""x of the centre of pressure (None in the air), and whether the detector calls the sample stationary."""
STANCE: list[Row] = [(0.10, True), (0.11, True)]
PUSH: list[Row] = [(0.13, False), (0.15, False), (0.16, False)]
FLIGHT: list[Row] = [(None, False)] * 12
LANDING: list[Row] = [(0.05, False), (0.06, False), (0.08, False)]


def cues_with_load() -> CopCues:
    """Return the cues of a standing foot whose cells are reliable."""
    cues = CopCues()
    cues.set_layout(FOUR_CELLS)
    cues.touch.trusted, cues.touch.load_unknown = True, False
    cues.stage = StrideStage.STANDING
    return cues


def watch(
    rows: list[Row], cues: CopCues | None = None, speed: float = 0.0
) -> tuple[list[tuple[TimedCue, int]], list[Cue | None]]:
    """Return the cues, each with the number of the sample at which it was reported, and the marks; 100 Hz."""
    cues = cues or cues_with_load()
    seen: list[tuple[TimedCue, int]] = []
    marks: list[Cue | None] = []
    phase = Phase.STATIONARY
    gyro: Vec3 = (0.0, 0.5, 0.0)
    for k, (x, stands) in enumerate(rows):
        cop = None if x is None or cues.foot_centre is None else (x, 0.0)  # a layout is needed for both
        load = Load(0.0 if x is None else 0.5, 0.0, 0.0, x is None, CELLS, cop)
        stance = STANDS if stands else MOVES
        for one in cues.update(0.01 * k, 0.01, UP, gyro, stands, 0.0 if stands else speed, phase, load, stance):
            seen.append((one, k))
            phase = PHASES[phase][one.cue]
        marks.append(cues.mark)
    return seen, marks


def cues_of(rows: list[Row]) -> list[tuple[Cue, int, int]]:
    """Return (cue, number of the sample that it names, number of the sample at which it was reported)."""
    return [(one.cue, round(one.t / 0.01), k) for one, k in watch(rows)[0]]


def test_the_centre_of_pressure_is_the_mean_of_places_weighted_by_pressure() -> None:
    # our x, along the foot, is copY (3): (0.05 x 10 + 0.05 x 30 + 0.20 x 40) / 80 = 10 / 80
    # our y, across it, is copX (2): (0.01 x 10 - 0.01 x 30 + 0.02 x 40) / 80 = 0.6 / 80
    cells = (Cell(0.05, 0.01), Cell(0.05, -0.01), Cell(0.20, 0.02))
    insole = InsoleLoads()
    insole.set_layout(Layout(3, Foot.LEFT, cells, 0.26))
    for k, total in enumerate((0.0, 90.0, 0.0, 90.0)):
        insole.update(0.01 * k, (total, total, total))
    load = insole.update(0.04, (10.0, 30.0, 40.0))
    assert load is not None and load.centre == pytest.approx((0.125, 0.0075))


def test_toe_off_is_the_sample_before_the_jump_to_the_foots_centre_and_known_at_the_first_of_swing() -> None:
    # samples 0 and 1 stand, 2 to 4 push off; A is 4, B is 5: from 0.16 to 0.10 is the largest jump
    assert cues_of(STANCE + PUSH + FLIGHT) == [(Cue.LIFT, 2, 2), (Cue.CLEAR, 4, 5)]


def test_heel_strike_is_the_sample_after_the_jump_from_the_foots_centre_and_known_at_foot_flat() -> None:
    # B to C are 5 to 16, D is 17: from 0.10 to 0.05; 20 is the first that stands
    cues = cues_of(STANCE + PUSH + FLIGHT + LANDING + STANCE)
    assert cues[2:] == [(Cue.CONTACT, 17, 20), (Cue.FLAT, 20, 20)]


def test_a_heel_strike_is_the_largest_jump_towards_the_heel() -> None:
    # from the centre 0.10 to the heel 0.07 at sample 17, then a larger jump back towards the toes, 0.125
    landing: list[Row] = [(0.07, False), (0.125, False), (0.12, False)]
    rows = STANCE + PUSH + FLIGHT + landing + STANCE
    assert cues_of(rows)[2] == (Cue.CONTACT, 17, 20)


def test_a_toe_off_is_not_where_the_load_moves_quickly_to_the_toes() -> None:
    # from heel to toe in one sample, 0.06 to 0.14, a jump of 0.08; from 0.15 to the centre a jump of 0.05 only
    rows = [(0.06, True), (0.06, True), (0.14, False), (0.15, False), (0.15, False), *FLIGHT]
    assert cues_of(rows) == [(Cue.LIFT, 2, 2), (Cue.CLEAR, 4, 5)]


WALK = Route().stand(2.0).walk(12.0, 1.2).stop(1.5)
