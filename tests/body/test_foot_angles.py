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
from solepath.emulate.wearers.shoe import IN_SOLE, ON_HEEL, ON_INSTEP, Mounting
from solepath.foot.stride import StrideBuilder
from solepath.foot.world import World
from solepath.recording import read_samples
from solepath.types.vector import IDENTITY, ZERO, from_rotation_vector

TILTED = Mounting(ON_INSTEP.position, from_rotation_vector((0.5, -2.2, 0.9)))


STRIDE_TIME, CONTACT_TIME, FLAT_AT, STILL_UNTIL = 1.1, 0.7, 0.05, 0.5
"""Duration of a gait cycle and of its contact; foot-flat and the end of stillness after heel-strike, s."""
SHANK_RATE = 1.2
"""Rate at which the sensor turns with the shank while the sole is flat, rad/s."""


def steady_cycles(samples: Iterable[Sample]) -> list[GaitCycleMeasured]:
    session = Session()
    events = [event for sample in samples for event in session.feed(sample)] + session.finish()
    return [event for event in events if isinstance(event, GaitCycleMeasured) and event.steady]


@pytest.mark.parametrize("mounting", [IN_SOLE, ON_HEEL, ON_INSTEP, TILTED])
def test_angles_at_contact_are_the_true_pitch_at_any_mounting(mounting: Mounting) -> None:
    walker = Walker(Route().stand(1.5).walk(20.0, 1.3).stop(1.0), seed=7)
    samples = walker.samples(Foot.LEFT, 100.0, LSM6DSOX, mounting=mounting)
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

    Heel-strike at 15 to 30 degrees and toe-off at 55 to 75 are healthy (Perry 1992); 10 degrees are left to the strap.
    """
    samples = read_samples(data_dir / "gaitmap_examples" / "walk_4x10m_ic.npz")
    measured = [cycle for cycle in steady_cycles(samples) if cycle.foot is foot]
    assert len(measured) >= 12
    strike = degrees(median(cycle.heel_strike_angle for cycle in measured if cycle.heel_strike_angle is not None))
    off = degrees(median(cycle.toe_off_angle for cycle in measured if cycle.toe_off_angle is not None))
    assert 5.0 <= strike <= 40.0
    assert 45.0 <= off <= 75.0


def test_a_sensor_that_turns_with_the_shank_is_measured_from_mid_stance() -> None:
    """Each stride the foot swings back by what the sensor has turned forward, and lands with the toe up."""
    builder, interval, found = StrideBuilder(Foot.LEFT), 0.01, []
    builder.start_stride(0.0, ZERO, IDENTITY)
    contact_samples, cycle_samples = round(CONTACT_TIME / interval), round(STRIDE_TIME / interval)
    swing_rate = -SHANK_RATE * CONTACT_TIME / (STRIDE_TIME - CONTACT_TIME)
    for k in range(13 * cycle_samples):
        t, phase = k * interval, k % cycle_samples
        in_contact = 0 < phase <= contact_samples
        builder.add_motion(
            t, interval, 0.0, 0.0, SHANK_RATE if in_contact else swing_rate,
            FLAT_AT <= phase * interval <= STILL_UNTIL,
        )  # fmt: skip
        if phase == 0:
            builder.add_heel_strike(t, interval)
        elif phase == round(FLAT_AT / interval):
            stride = builder.finish(t, t, (k * interval, 0.0, 0.0), IDENTITY, (0.0,) * 7, World())
            found += [] if stride is None else [stride.features]
            builder.start_stride(t, (k * interval, 0.0, 0.0), IDENTITY)
        elif phase == contact_samples:
            builder.add_toe_off(t, interval)
    assert len(found) == 12
    assert found[0].heel_strike_angle is None, "no stance has shown yet how far the sensor turns"
    for features in found[8:]:
        # half of the turn in contact lies before mid-stance, half of it behind
        assert features.heel_strike_angle == pytest.approx(0.5 * CONTACT_TIME * SHANK_RATE, abs=0.02)
        assert features.toe_off_angle == pytest.approx(0.5 * CONTACT_TIME * SHANK_RATE, abs=0.02)
