"""Known velocity as evidence and as correction: two areas, equations (8) and (10); expected values by hand."""

from __future__ import annotations

from itertools import product
from math import inf, isinf

import pytest

from solepath.calibration import Calibration, ShoeGeometry
from solepath.foot.navigate.dedrift import LinearDedrift
from solepath.foot.phase import Cue
from solepath.foot.settings import DedriftSettings
from solepath.foot.stance.stance import Load, Stance
from solepath.papers.kupt_dfpc.kinematics import Sagittal
from solepath.papers.kupt_dfpc.known_velocity import KnownVelocity
from solepath.papers.kupt_dfpc.swing_drift import SwingDedrift
from solepath.types import Cell, Foot, Layout, Phase, Quat, Vec3
from solepath.types.vector import GRAVITY, IDENTITY, ZERO, from_rotation_vector

CELLS = (0.0,) * 96
BOTH_LOADED = Load(1.0, 0.5, 0.5, False, CELLS, (0.13, 0.0))
FOREFOOT_LOADED = Load(0.6, 0.0, 0.6, False, CELLS, (0.20, 0.0))
HEEL_LOADED = Load(0.5, 0.5, 0.0, False, CELLS, (0.03, 0.0))
UNLOADED = Load(0.0, 0.0, 0.0, True, CELLS)
STILL: Vec3 = (0.0, 0.0, GRAVITY)


def heel_up(pitch: float) -> Quat:
    return from_rotation_vector((0.0, pitch, 0.0))


def ready_detector() -> KnownVelocity:
    """Return a detector that knows that the sensor's axes are the foot's, and whose cells are reliable."""
    known = KnownVelocity(sagittal=Sagittal())
    known.sagittal.up, known.sagittal.toe = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)
    known.touch.trusted, known.touch.load_unknown = True, False
    return known


def stances_of(known: KnownVelocity, *samples: tuple[Load | None, float]) -> list[Stance]:
    """Return the evidence of samples at 100 Hz: the load and the heel-up pitch, rad."""
    stances = []
    for k, (load, pitch) in enumerate(samples):
        # a foot that turns: no inertial detector takes it for still
        stances.append(known.update(0.01 * k, 0.01, STILL, (0.0, 0.4, 0.0), load, heel_up(pitch)))
    return stances


def test_both_areas_loaded_is_a_zero_velocity() -> None:
    stance = stances_of(ready_detector(), (BOTH_LOADED, 0.0))[0]
    assert stance.hint is Phase.STATIONARY and stance.v_ref == ZERO and stance.statistic == 0.5


def test_then_the_forefoot_alone_is_a_rolling_shoe_with_the_velocity_of_its_pitch() -> None:
    stances = stances_of(ready_detector(), (BOTH_LOADED, 0.0), (FOREFOOT_LOADED, 0.02), (FOREFOOT_LOADED, 0.06))
    assert [stance.hint for stance in stances] == [Phase.STATIONARY, Phase.PUSH_OFF, Phase.PUSH_OFF]
    # a height of 0.029 to 0.033 m above a pivot times 4 rad/s
    assert stances[2].v_ref[0] == pytest.approx(4.0 * 0.0315, rel=0.03)
    assert stances[2].v_ref[1] == 0.0 and stances[2].v_ref[2] > 0.2
    assert stances[2].sigma < inf


def test_the_heel_after_a_swing_is_a_foot_that_rolls_down_over_its_heel() -> None:
    stances = stances_of(ready_detector(), (UNLOADED, -0.35), (HEEL_LOADED, -0.33), (HEEL_LOADED, -0.30))
    assert [stance.hint for stance in stances] == [Phase.SWING, Phase.LOADING, Phase.LOADING]
    assert isinf(stances[1].sigma)  # the sample before was in the air
    # (4): P_z at 0.315 rad = 0.125 x 0.310 + 0.029 x 0.951 = 0.0663, times 3 rad/s
    assert stances[2].v_ref[0] == pytest.approx(3.0 * 0.0663, rel=0.01)
    assert stances[2].v_ref[2] < 0.0


def expected(last: Load | None, before: Load | None, load: Load) -> tuple[Phase | None, bool]:
    """Return phase and whether the shoe rolls; `last` was the newest load of none or both of the areas."""
    if load is last:
        return (Phase.SWING if load is UNLOADED else Phase.STATIONARY), False
    if last is UNLOADED:  # it lands
        return Phase.LOADING, load is before is HEEL_LOADED
    if last is BOTH_LOADED and load is FOREFOOT_LOADED:
        return Phase.PUSH_OFF, before in (FOREFOOT_LOADED, BOTH_LOADED)
    return None, False


def test_a_shoe_rolls_over_what_bears_it_from_one_sample_to_the_next_and_is_evidence_of_nothing_else() -> None:
    """A heel that bears after standing, or a forefoot that lands first, rolls over neither end of the shoe."""
    for loads in product((UNLOADED, HEEL_LOADED, FOREFOOT_LOADED, BOTH_LOADED), repeat=5):
        stances, last = stances_of(ready_detector(), *[(load, -0.02 * k) for k, load in enumerate(loads)]), None
        for before, load, stance in zip((None, *loads), loads, stances, strict=False):
            last = load if load in (UNLOADED, BOTH_LOADED) else last
            phase, rolls = expected(last, before, load)
            assert stance.hint is phase and (stance.sigma < inf) is (rolls or load is BOTH_LOADED), loads
            assert (stance.v_ref != ZERO) is rolls, loads


def test_the_wearers_own_shoe_is_taken_from_the_calibration() -> None:
    shoe = ShoeGeometry(height=0.04)
    known = KnownVelocity().calibrated(Foot.LEFT, Calibration(shoe=shoe))
    assert known.settings.shoe == shoe
    assert KnownVelocity().calibrated(Foot.LEFT, Calibration()).settings == KnownVelocity().settings


def test_a_shoe_that_nobody_measured_is_as_long_as_its_insole() -> None:
    known = ready_detector()
    known.set_layout(Layout(2, Foot.LEFT, (Cell(0.03, 0.0), Cell(0.2, 0.0)), 0.228))
    stances = stances_of(known, (UNLOADED, -0.35), (HEEL_LOADED, -0.33), (HEEL_LOADED, -0.30))
    # 22.8 cm are four fifths of 28.5: (4) with L_r = 0.100: P_z at 0.315 rad = 0.0310 + 0.0276, times 3 rad/s
    assert stances[2].v_ref[0] == pytest.approx(3.0 * 0.0586, rel=0.01)
    known = KnownVelocity().calibrated(Foot.LEFT, Calibration(shoe=ShoeGeometry(height=0.04)))
    known.set_layout(Layout(2, Foot.LEFT, (Cell(0.03, 0.0), Cell(0.2, 0.0)), 0.228))
    assert known.shoe_in_use == ShoeGeometry(height=0.04)


ZERO_VELOCITY = Stance(ZERO, 0.01, 0.5, Phase.STATIONARY)
SWING = Stance(ZERO, inf, 0.0, Phase.SWING)
LANDED = Stance(ZERO, inf, 0.0, Phase.LOADING)
DRIFTING: Vec3 = (1.0, 0.0, GRAVITY)
"""The acceleration is 1 m/s^2 forward, so the raw velocity in m/s equals the time since motion start in s."""


def rolling_stance(v: float, phase: Phase) -> Stance:
    return Stance((v, 0.0, 0.0), 0.1, 0.0, phase)


STEP: tuple[tuple[Stance, Cue | None], ...] = (
    (rolling_stance(0.01, Phase.PUSH_OFF), None),  # raw mean 0.05: error 0.04
    (rolling_stance(0.11, Phase.PUSH_OFF), None),  # raw mean 0.15: error 0.04, belongs to 0.15 s
    (SWING, Cue.CLEAR),  # toe-off is the sample before, at 0.2 s
    (SWING, None),
    (LANDED, Cue.CONTACT),  # heel-strike, at 0.5 s
    (rolling_stance(0.40, Phase.LOADING), None),  # raw mean 0.55: error 0.15, belongs to 0.55 s
    (rolling_stance(0.50, Phase.LOADING), None),
    (ZERO_VELOCITY, None),  # at 0.8 s; raw mean of this interval 0.75
)


def corrector_after(corrector: LinearDedrift, step: tuple[tuple[Stance, Cue | None], ...] = STEP) -> LinearDedrift:
    """Return the corrector after standing and one stride, in samples of 0.1 s."""
    corrector.start(IDENTITY, 0.02)
    for k, (stance, cue) in enumerate(((ZERO_VELOCITY, None), *step)):
        corrector.predict(0.1, DRIFTING, ZERO)
        corrector.correct(0.1 * k, stance)
        if cue is not None:
            corrector.mark(0.1 * k, cue)
    return corrector


class SlidingSwing(SwingDedrift):
    """Corrector of a heel that slides for 0.1 s."""

    slide_time = 0.1


NO_TILT = DedriftSettings(tilt_rate=0.0)


def test_only_the_swing_loses_a_line_as_in_equation_8_and_the_error_index_is_that_of_equation_10() -> None:
    # drift rate (0.15 - 0.04) / (0.55 - 0.15) = 0.275 m/s^2
    # up to toe-off     (0.01 + 0.11) x 0.1 = 0.012
    # swing 0.2 to 0.5  raw 0.35 x 0.3 = 0.105, less 0.04 x 0.3 + 0.275 (0.35^2 - 0.05^2) / 2 = 0.012 + 0.0165
    # from heel-strike  0.40 x 0.1 + 0.50 x 0.1, and the last 0.1 s with the same error: (0.75 - 0.15) x 0.1 = 0.06
    corrector = corrector_after(SwingDedrift(NO_TILT))
    assert corrector.position[0] == pytest.approx(0.012 + 0.0765 + 0.15)
    assert corrector.velocity == ZERO
    assert corrector.error_index == pytest.approx(0.04 + 0.15)


def test_a_heel_that_never_rolls_leaves_the_line_to_run_to_motion_end() -> None:
    step = tuple((LANDED if stance.hint is Phase.LOADING else stance, cue) for stance, cue in STEP)
    # error 0.8 at 0.8 s; drift rate (0.8 - 0.04) / (0.8 - 0.15) = 1.1692; swing 0.2 to 0.8:
    # raw 0.32 - 0.02 = 0.30, less 0.04 x 0.6 + 1.1692 (0.65^2 - 0.05^2) / 2 = 0.024 + 0.2455
    corrector = corrector_after(SwingDedrift(NO_TILT), step)
    assert corrector.position[0] == pytest.approx(0.012 + 0.0305, abs=1e-4)
    assert corrector.error_index == pytest.approx(0.84)


def test_a_heel_that_slides_first_is_compared_once_it_rolls() -> None:
    # with slide 0.1 s the first interval that counts is the second: k_h at 0.6 s, error 0.65 - 0.50 = 0.15 there too
    corrector = corrector_after(SlidingSwing(NO_TILT))
    assert corrector.error_index == pytest.approx(0.19)
    # rate 0.11 / 0.5; swing 0.2 to 0.6: 0.40 x 0.4 - 0.04 x 0.4 - 0.22 (0.45^2 - 0.05^2) / 2 = 0.16 - 0.016 - 0.022
    assert corrector.position[0] == pytest.approx(0.012 + 0.122 + 0.05 + 0.06)
