"""The recipe as printed: (8) on all three axes from heel-strike itself; ours takes one line out of heights."""

from __future__ import annotations

from math import inf

import pytest

from solepath.foot.phase import Cue
from solepath.foot.settings import DedriftSettings
from solepath.foot.stance.stance import Stance
from solepath.papers.kupt_dfpc.soft_swing import SoftSwing
from solepath.papers.kupt_dfpc.swing_drift import SwingDedrift
from solepath.types import Phase
from solepath.types.vector import GRAVITY, IDENTITY, ZERO


def rolls(v: float, phase: Phase) -> Stance:
    """Return the evidence of a shoe whose sensor moves upwards with `v` m/s."""
    return Stance((0.0, 0.0, v), 0.1, 0.0, phase)


STANDS, FLIES = Stance(ZERO, 0.01, 0.5, Phase.STATIONARY), Stance(ZERO, inf, 0.0, Phase.SWING)
STEP = (
    (STANDS, None),
    (rolls(0.01, Phase.PUSH_OFF), None),  # raw mean 0.05: error 0.04
    (rolls(0.11, Phase.PUSH_OFF), None),  # raw mean 0.15: error 0.04
    (FLIES, Cue.CLEAR),  # toe-off is the sample before, at 0.2 s
    (FLIES, None),
    (Stance(ZERO, inf, 0.0, Phase.LOADING), Cue.CONTACT),  # heel-strike, at 0.5 s
    (rolls(0.40, Phase.LOADING), None),  # raw mean 0.55: error 0.15
    (rolls(0.50, Phase.LOADING), None),
    (STANDS, None),
)
"""Evidence and mark of samples of 0.1 s; the raw velocity upwards in m/s equals the time since motion start in s."""


@pytest.mark.parametrize(("corrector_class", "rise"), [(SwingDedrift, 0.012 + 0.0765 + 0.15), (SoftSwing, 0.0)])
def test_as_printed_equation_8_holds_for_heights_too_and_ours_takes_one_line_out_of_them(
    corrector_class: type[SwingDedrift], rise: float
) -> None:
    # (8): 0.012 up to toe-off, 0.0765 in swing and 0.15 after heel-strike; one line: 0.8^2 / 2 - 0.8 x 0.8 / 2 = 0
    corrector = corrector_class(DedriftSettings(tilt_rate=0.0))
    corrector.start(IDENTITY, 0.02)
    for k, (stance, cue) in enumerate(STEP):
        corrector.predict(0.1, (0.0, 0.0, GRAVITY + 1.0), ZERO)
        corrector.correct(0.1 * k, stance)
        if cue is not None:
            corrector.mark(0.1 * k, cue)
    assert corrector.position[2] == pytest.approx(rise, abs=1e-9)
