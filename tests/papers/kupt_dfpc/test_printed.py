"""The recipe as printed: (8) on all three axes from heel-strike itself, and jumps of the CoP towards the heel."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest
from attrs import evolve
from walks import run_session

from solepath import recipes
from solepath.calibration import Calibration, InsoleCalibration
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.events import StrideTaken
from solepath.foot.phase import Cue
from solepath.foot.stance.stance import Stance
from solepath.papers.kupt_dfpc.cop_cues import CopCues
from solepath.papers.kupt_dfpc.recipe import KUPT_DFPC, KUPT_DFPC_PRINTED, ZUPT
from solepath.papers.kupt_dfpc.swing.dedrift import SwingDedrift
from solepath.papers.kupt_dfpc.swing.settings import PRINTED
from solepath.types import Foot, Phase
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


@pytest.mark.parametrize(("vertical", "rise"), [(True, 0.012 + 0.0765 + 0.15), (False, 0.0)])
def test_as_printed_equation_8_holds_for_heights_too_and_ours_takes_one_line_out_of_them(
    vertical: bool, rise: float
) -> None:
    # (8): 0.012 up to toe-off, 0.0765 in swing and 0.15 after heel-strike; one line: 0.8^2 / 2 - 0.8 x 0.8 / 2 = 0
    assert PRINTED.vertical and PRINTED.slide_time == 0.0
    corrector = SwingDedrift(evolve(PRINTED, vertical=vertical, tilt_rate=0.0))
    corrector.start(IDENTITY, 0.02)
    for k, (stance, cue) in enumerate(STEP):
        corrector.predict(0.1, (0.0, 0.0, GRAVITY + 1.0), ZERO)
        corrector.correct(0.1 * k, stance)
        if cue is not None:
            corrector.mark(0.1 * k, cue)
    assert corrector.position[2] == pytest.approx(rise, abs=1e-9)


def test_only_as_printed_do_jumps_of_the_centre_of_pressure_have_a_sign() -> None:
    for recipe, signed in ((KUPT_DFPC_PRINTED, True), (KUPT_DFPC, False), (ZUPT, False)):
        assert isinstance(recipe.cues, CopCues) and recipe.cues.settings.signed is signed


@pytest.mark.parametrize("seed", [331, 332])
def test_as_printed_a_walk_of_20_metres_has_its_length_and_stays_on_the_floor(seed: int) -> None:
    walker = Walker(Route().stand(2.0).walk(20.0, 1.3).stop(1.5), seed=seed)
    layouts = Calibration(insoles={foot: InsoleCalibration(layout=layout(96, foot)) for foot in Foot})
    for foot in Foot:
        walk = walker.samples(foot, 30.0, LSM6DSOX, layout=layout(96, foot))
        events = run_session(walk, recipes.by_name("kupt-dfpc-printed"), calibration=layouts)
        strides = [event for event in events if isinstance(event, StrideTaken)]
        true = walker.truth().strides(foot)
        assert np.array([one.length for one in strides]).sum() == pytest.approx(
            np.array([one.length for one in true]).sum(), abs=1.0
        )
        assert abs(strides[-1].position[2] - strides[0].position[2]) < 0.6
