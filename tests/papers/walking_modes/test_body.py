"""Both feet by touchdowns, on emulated walks with seven sensors and insoles of 99 cells."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from math import hypot, pi

import pytest
from attrs import evolve
from hypothesis import strategies as st
from soak import soaked
from walks import of

from solepath.body.part import TrackPart
from solepath.calibration import Calibration, InsoleCalibration
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.wearers.gait import LoadLaw, Wearer
from solepath.emulate.wearers.walker import Walker
from solepath.events import Event, TouchedDown, WalkingModeChanged
from solepath.foot.world import Covariance3
from solepath.papers.walking_modes.compensation import TABLE_1
from solepath.papers.walking_modes.modes import Modes
from solepath.papers.walking_modes.recipe import WALKING_MODES, WALKING_MODES_PRINTED
from solepath.papers.walking_modes.settings import ModesSettings
from solepath.papers.walking_modes.touchdown import PressureTouchdown
from solepath.recipes import DEFAULT
from solepath.session import Session
from solepath.types import SITE_OF_FOOT, Foot, Sample, WalkingMode
from solepath.types.vector import sub
from solepath_lab.emulated.laps import MARK_SPEED, marked
from solepath_lab.emulated.limb_samples import limb_samples

LAYOUTS = {SITE_OF_FOOT[foot]: layout(99, foot) for foot in Foot}
KNOWN = Calibration(insoles={foot: InsoleCalibration(layout=layout(99, foot)) for foot in Foot})
BEND_ROUTE = Route().stand(2.0).walk(4.0, MARK_SPEED).turn(pi / 2, 2.0).walk(3.0).stop(1.0)
METHOD_III = WALKING_MODES.replace_part(TrackPart, Modes(PressureTouchdown()))
KNOWN_HEADING = ModesSettings(heading=0.0)


@cache
def walker_on(route: Route = BEND_ROUTE, seed: int = 101) -> Walker:
    return Walker(route, seed=seed)


@cache
def suit_samples(route: Route = BEND_ROUTE, north: float = 0.0, seed: int = 101) -> tuple[Sample, ...]:
    """Return samples of seven sensors at 50 Hz with the errors of a data sheet."""
    return tuple(limb_samples(walker_on(route, seed), 50.0, seed=seed, layouts=LAYOUTS, north=north))


@cache
def run_walk(heading: float | None = None, north: float = 0.0) -> list[Event]:
    session = Session(
        METHOD_III.replace_part(TrackPart, Modes(PressureTouchdown(), ModesSettings(heading=heading))),
        calibration=KNOWN,
    )
    return [*session.feed(suit_samples(north=north)), *session.finish()]


def end_error(modes: Modes, samples: Sequence[Sample]) -> tuple[tuple[float, float], Covariance3]:
    """Return the distance of the last position from the end of the route, m, and its covariance."""
    session = Session(METHOD_III.replace_part(TrackPart, modes), calibration=KNOWN)
    session.feed(samples)
    position, end = session.position, walker_on().route.end
    assert position is not None
    return (position.position[0] - end.x, position.position[1] - end.y), position.covariance


def test_every_step_is_a_touchdown_where_the_foot_came_down() -> None:
    downs = of(TouchedDown, run_walk(0.0))
    for foot in Foot:
        mine, true = [down for down in downs if down.foot is foot], walker_on().plan.strides[foot]
        assert len(mine) == len(true)
        for down, stride in zip(mine, true, strict=True):
            assert down.t == pytest.approx(stride.heel_strike, abs=0.06)
            x, y, _ = down.position
            assert hypot(x - stride.end.x, y - stride.end.y) < 0.15


def test_the_legs_at_a_touchdown_reach_down_and_as_far_apart_as_the_feet() -> None:
    before = None
    for down in of(TouchedDown, run_walk(0.0)):
        assert down.legs is not None
        left, right = down.legs
        for hip, knee, ankle, _ in down.legs:
            assert hip[2] > knee[2] > ankle[2]
        apart = hypot(left[3][0] - right[3][0], left[3][1] - right[3][1])
        if before is not None:
            x, y, _ = sub(down.position, before.position)
            assert apart == pytest.approx(hypot(x, y), abs=0.1)
        before = down
    assert before is not None


@pytest.mark.soak
def test_the_position_is_midway_between_the_feet_and_has_a_covariance() -> None:
    (dx, dy), (xx, xy, _, yy, _, _) = end_error(Modes(PressureTouchdown(), KNOWN_HEADING), suit_samples())
    assert hypot(dx, dy) < 0.15
    assert (yy * dx * dx - 2.0 * xy * dx * dy + xx * dy * dy) / (xx * yy - xy * xy) < 9.2  # 99 % of a normal pair


SLOWLY = soaked(WalkingMode.STRAIGHT, WalkingMode.RIGHT_WIDE)
VARIED_AS_MEASURED = Wearer(load_law=LoadLaw.HEEL_OUT_FOREFOOT_IN, load_variation=0.004)


@pytest.mark.parametrize("mode", [WalkingMode.LEFT_TIGHT, *SLOWLY])
def test_a_bend_is_known_by_how_the_feet_turn_wherever_the_load_moves(mode: WalkingMode) -> None:
    assert share_of_contacts(mode, VARIED_AS_MEASURED) >= 0.95


def share_of_contacts(mode: WalkingMode, wearer: Wearer) -> float:
    """Return the share of contacts on 20 steps in a mode whose mode is recognised, in the order of the contacts."""
    walker = Walker(marked(mode, steps=20), wearer, seed=101)
    session = Session(METHOD_III, calibration=KNOWN)
    changes = of(WalkingModeChanged, session.feed(limb_samples(walker, 50.0, seed=101, layouts=LAYOUTS)))
    right = whole = 0
    for foot in Foot:
        for left in walker.plan.strides[foot][2:]:
            then = [change.mode for change in changes if change.foot is foot and change.t < left.toe_off + 0.1]
            right += bool(then) and then[-1] is mode
            whole += 1
    assert whole >= 15
    return right / whole


def test_the_compensation_of_the_mode_is_added_along_the_way() -> None:
    straight = {foot: {WalkingMode.STRAIGHT: (0.02, 0.0)} for foot in Foot}
    compensated = Modes(PressureTouchdown(), evolve(KNOWN_HEADING, compensation=straight))
    session = Session(METHOD_III.replace_part(TrackPart, compensated), calibration=KNOWN)
    downs = of(TouchedDown, session.feed(suit_samples()))
    ahead = [down for down in downs if down.mode is WalkingMode.STRAIGHT and down.t < 6.0]
    assert ahead and all(down.compensation[0] == pytest.approx(0.02, abs=0.002) for down in ahead[:-1])
    bare = of(TouchedDown, run_walk(0.0))
    assert downs[3].position[0] - bare[3].position[0] == pytest.approx(4 * 0.02, abs=0.01)


def test_a_wearers_own_compensation_takes_the_place_of_table_1_mode_by_mode() -> None:
    own = Calibration(modes={Foot.LEFT: {WalkingMode.STRAIGHT: (0.5, 0.25)}})
    table = Modes(PressureTouchdown(), ModesSettings(TABLE_1)).calibrated(own).settings.compensation
    assert table is not None
    assert table[Foot.LEFT][WalkingMode.STRAIGHT] == (0.5, 0.25)
    assert table[Foot.LEFT][WalkingMode.LEFT_WIDE] == TABLE_1[Foot.LEFT][WalkingMode.LEFT_WIDE]
    assert table[Foot.RIGHT] == TABLE_1[Foot.RIGHT]
    assert Modes(PressureTouchdown()).calibrated(own).settings.compensation is None
    printed = next(part for part in WALKING_MODES_PRINTED.parts if isinstance(part, Modes))
    assert printed.calibrated(own).settings.compensation == TABLE_1


def test_a_first_heading_is_taken_by_the_recipes_with_body_sensors_and_by_no_other() -> None:
    modes = next(part for part in WALKING_MODES.with_heading(1.5).parts if isinstance(part, Modes))
    assert modes.settings.heading == 1.5
    with pytest.raises(LookupError, match="recipe default finds the first heading by itself"):
        DEFAULT.with_heading(1.5)
    for wrong in (float("nan"), float("inf"), 7.0):
        with pytest.raises(ValueError, match="a heading is an angle"):
            WALKING_MODES.with_heading(wrong)


NUMBERS = st.floats() | st.sampled_from((0.0, 1.0, -9.8, 1e300))
