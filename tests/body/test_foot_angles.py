"""Foot angles at contact: those of emulated feet, of sensors that turn with the shank, and of a real walk with such."""

from __future__ import annotations

from collections.abc import Iterable
from math import degrees
from pathlib import Path
from statistics import median

import numpy as np
import pytest

from solepath import Foot, GaitCycleMeasured, Sample, Session
from solepath.emulate import Route, Walker
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.shoe import ON_HEEL, ON_INSTEP, Mounting
from solepath.recording import read_samples
from solepath.types.vector import from_rotation_vector

TILTED = Mounting(ON_INSTEP.position, from_rotation_vector((0.5, -2.2, 0.9)))


def steady_cycles(samples: Iterable[Sample]) -> list[GaitCycleMeasured]:
    session = Session()
    events = [event for sample in samples for event in session.feed(sample)] + session.finish()
    return [event for event in events if isinstance(event, GaitCycleMeasured) and event.steady]


@pytest.mark.parametrize("mounting", [ON_HEEL, TILTED])
def test_angles_at_contact_are_the_true_pitch_at_any_mounting(mounting: Mounting) -> None:
    walker = Walker(Route().stand(1.5).walk(20.0, 1.3).stop(1.0), seed=7)
    samples = walker.samples(Foot.LEFT, 50.0, LSM6DSOX, mounting=mounting)
    pitch = walker.motions[Foot.LEFT].pitch
    measured = steady_cycles(samples)
    assert len(measured) >= 8
    for cycle in measured:
        assert cycle.heel_strike_angle is not None and cycle.toe_off_angle is not None
        # pitch is positive toe up, the angle at toe-off positive heel up
        strike, off = (float(pitch(np.array([t]))[0]) for t in (cycle.t, cycle.t_toe_off))
        assert degrees(cycle.heel_strike_angle - strike) == pytest.approx(0.0, abs=2.0)
        assert degrees(cycle.toe_off_angle + off) == pytest.approx(0.0, abs=2.0)


@pytest.mark.parametrize("foot", Foot)
def test_a_healthy_walk_with_sensors_near_the_ankle_has_the_angles_of_a_healthy_walk(
    foot: Foot, data_dir: Path
) -> None:
    """These sensors turn by 20 degrees with the shank while the sole is flat, so a foot-flat is no reference.

    Heel-strike at 15 to 30 degrees and toe-off at 55 to 75 are healthy (Perry 1992); of a sensor that turns with the
    shank, 15 degrees are left at heel-strike, where it turns fast, and 10 at toe-off.
    """
    samples = read_samples(data_dir / "gaitmap_examples" / "walk_4x10m_ic.npz")
    measured = [cycle for cycle in steady_cycles(samples) if cycle.foot is foot]
    assert len(measured) >= 12
    strike = degrees(median(cycle.heel_strike_angle for cycle in measured if cycle.heel_strike_angle is not None))
    off = degrees(median(cycle.toe_off_angle for cycle in measured if cycle.toe_off_angle is not None))
    assert 0.0 <= strike <= 40.0
    assert 45.0 <= off <= 75.0
