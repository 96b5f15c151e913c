"""Soft evidence of a rolling shoe: what a foot learns from walking, and strides weighted by their variance."""

from __future__ import annotations

from math import inf

import pytest
from attrs import evolve
from strides import stride

from solepath.calibration import Calibration, InsoleCalibration
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.events import StrideFeatures, StrideTaken
from solepath.foot.phase import Cue
from solepath.foot.stance.stance import Stance
from solepath.papers.kupt_dfpc.fusion import DoubleFoot, FusionSettings
from solepath.papers.kupt_dfpc.swing.drift_parts import DriftParts
from solepath.papers.kupt_dfpc.swing.settings import SoftSwingSettings
from solepath.papers.kupt_dfpc.swing.soft import SoftSwing
from solepath.types import Foot, Phase
from solepath.types.vector import GRAVITY, IDENTITY, ZERO

ROUTE = Route().stand(2.0).walk(20.0, 1.3).stop(1.5)
LAYOUTS = Calibration(insoles={foot: InsoleCalibration(layout=layout(96, foot)) for foot in Foot})
PUSH_OFF, LOADING = Phase.PUSH_OFF, Phase.LOADING
SEEDS = (321, 322, 323, 324)


def test_parts_that_are_measured_exactly_are_those_of_equation_8() -> None:
    """Velocity errors of 0.1 m/s at toe-off, 0.3 at heel-strike and 0.35 at motion end, in a motion of 1 s."""
    parts = DriftParts((0.01, 0.04, 0.001))
    for count, error in ((1, 0.1), (2, 0.3), (3, 0.35)):
        parts.measure(count, (error, -error), 1e-12)
    assert parts.x == pytest.approx([0.1, 0.2, 0.05], abs=1e-6)
    assert parts.y == pytest.approx([-0.1, -0.2, -0.05], abs=1e-6)
    (x, _), variance = parts.displacement((0.8, 0.5, 0.1))
    assert x == pytest.approx(0.08 + 0.1 + 0.005, abs=1e-6)
    assert variance == pytest.approx(0.0, abs=1e-9)


def test_the_error_index_of_ours_is_the_sum_of_the_errors_at_toe_off_and_heel_strike() -> None:
    """Raw velocities of 0.15 and 0.55 m/s in the middle of the last interval of push-off and the first of landing."""
    stands, flies = Stance(ZERO, 0.01, 0.5, Phase.STATIONARY), Stance(ZERO, inf, 0.0, Phase.SWING)
    leaves, lands = (Stance((v, 0.0, 0.0), 0.1, 0.0, phase) for v, phase in ((0.11, PUSH_OFF), (0.40, LOADING)))
    touches = Stance(ZERO, inf, 0.0, LOADING)
    corrector = SoftSwing(SoftSwingSettings(slide_time=0.0, tilt_rate=0.0))
    corrector.start(IDENTITY, 0.02)
    marks = {3: Cue.CLEAR, 5: Cue.CONTACT}
    for k, stance in enumerate((stands, leaves, leaves, flies, flies, touches, lands, stands)):
        corrector.predict(0.1, (1.0, 0.0, GRAVITY), ZERO)
        corrector.correct(0.1 * k, stance)
        if k in marks:
            corrector.mark(0.1 * k, marks[k])
    # (10): |(0.15 - 0.11) + (0.55 - 0.40)|
    assert corrector.error_index == pytest.approx(0.04 + 0.15)


def stride_of(foot: Foot, end: float, length: float, sigma: float, index: float) -> StrideTaken:
    cop = tuple((0.09 + 0.13 * k / 15, 0.0) for k in range(16))
    made = stride(foot, end, (length, 0.0, 0.0), t_start=end - 1.1, t_toe_off=end - 0.55, t_heel_strike=end - 0.11)
    covariance = (sigma**2, 0.0, 0.0, 1.0, 0.0, 1.0)
    return evolve(made, covariance=covariance, features=StrideFeatures(0.1, 4.0, 1.0, 400.0, cop, index))


def test_the_foot_whose_strides_are_more_accurate_weighs_more_whatever_this_one_drifted() -> None:
    body = DoubleFoot()
    body.add_stride(stride_of(Foot.LEFT, 2.0, 1.2, sigma=0.01, index=0.5), 0.14)
    fused = body.add_stride(stride_of(Foot.RIGHT, 2.55, 1.4, sigma=0.03, index=0.1), 0.14)
    # (11) with variances: 0.0001 / (0.0001 + 0.0009)
    assert fused.coefficient == pytest.approx(0.1)
    assert fused.stride_length == pytest.approx(0.1 * 1.4 + 0.9 * 1.2)
    assert fused.chosen is Foot.LEFT
    printed = DoubleFoot(FusionSettings(by_variance=False, compares_lengths=False))
    printed.add_stride(stride_of(Foot.LEFT, 2.0, 1.2, sigma=0.01, index=0.5), 0.14)
    by_index = printed.add_stride(stride_of(Foot.RIGHT, 2.55, 1.4, sigma=0.03, index=0.1), 0.14)
    assert by_index.coefficient == pytest.approx(0.5 / 0.6)
    assert by_index.chosen is Foot.RIGHT
