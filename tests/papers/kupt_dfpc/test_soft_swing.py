"""Soft evidence of a rolling shoe: each velocity weighs what its error allows."""

from __future__ import annotations

from math import inf

import pytest

from solepath.foot.phase import Cue
from solepath.foot.settings import DedriftSettings
from solepath.foot.stance.stance import Stance
from solepath.papers.kupt_dfpc.soft_swing import DriftParts, SoftSwing
from solepath.types import Phase
from solepath.types.vector import GRAVITY, IDENTITY, ZERO

PUSH_OFF, LOADING = Phase.PUSH_OFF, Phase.LOADING


def test_parts_that_are_measured_exactly_are_those_of_equation_8() -> None:
    """Velocity errors of 0.1 m/s at toe-off, 0.3 at heel-strike and 0.35 at motion end, in a motion of 1 s."""
    parts = DriftParts((0.01, 0.04, 0.001))
    for count, error in ((1, 0.1), (2, 0.3), (3, 0.35)):
        parts.measure(count, (error, -error, 0.0), 1e-12)
    assert parts.parts == pytest.approx([0.1 - 0.1j, 0.2 - 0.2j, 0.05 - 0.05j], abs=1e-6)
    assert parts.displacement((0.8, 0.5, 0.1)).real == pytest.approx(0.08 + 0.1 + 0.005, abs=1e-6)


def test_the_error_index_of_ours_is_the_sum_of_the_errors_at_toe_off_and_heel_strike() -> None:
    """Raw velocities of 0.15 and 0.65 m/s in the middle of the last interval of push-off and the first that counts."""
    stands, flies = Stance(ZERO, 0.01, 0.5, Phase.STATIONARY), Stance(ZERO, inf, 0.0, Phase.SWING)
    leaves, lands = (Stance((v, 0.0, 0.0), 0.1, 0.0, phase) for v, phase in ((0.11, PUSH_OFF), (0.50, LOADING)))
    touches = Stance(ZERO, inf, 0.0, LOADING)
    corrector = SoftSwing(DedriftSettings(tilt_rate=0.0))
    corrector.start(IDENTITY, 0.02)
    marks = {3: Cue.CLEAR, 5: Cue.CONTACT}
    for k, stance in enumerate((stands, leaves, leaves, flies, flies, touches, touches, lands, stands)):
        corrector.predict(0.1, (1.0, 0.0, GRAVITY), ZERO)
        corrector.correct(0.1 * k, stance)
        if k in marks:
            corrector.mark(0.1 * k, marks[k])
    # (10): |(0.15 - 0.11) + (0.65 - 0.50)|
    assert corrector.error_index == pytest.approx(0.04 + 0.15)
