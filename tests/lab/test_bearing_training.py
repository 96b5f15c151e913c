"""The weights that tell strides from other motions: how they are fitted, and that the released ones are fitted."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from solepath.foot import bearing
from solepath_lab.train.bearing import collected, fit, released


def test_a_logistic_regression_finds_the_weights_from_which_answers_were_drawn() -> None:
    rng = np.random.default_rng(5)
    rows = rng.normal(2.0, 3.0, (40_000, 2))
    chance = 1.0 / (1.0 + np.exp(-(rows @ [0.8, -0.3] + 0.5)))
    weights, offset = fit(rows, (rng.uniform(size=len(rows)) < chance).astype(float), np.full(len(rows), 1 / len(rows)))
    assert weights == pytest.approx([0.8, -0.3], abs=0.03) and offset == pytest.approx(0.5, abs=0.06)


@pytest.mark.long
def test_the_released_weights_are_those_of_the_command(data_dir: Path) -> None:
    weights, offset = released(collected(data_dir, processes=2))
    assert (tuple(weights), offset) == (bearing.WEIGHTS, bearing.OFFSET)
