"""The pitch of a shoe that is held in static postures, as its accelerometer shows it."""

from math import cos, degrees, radians, sin

import numpy as np
import pytest

from solepath.emulate.routes.postures import MOVING_TIME, PITCHES, held_shoe, held_time
from solepath.emulate.wearers.shoe import IN_SOLE, Mounting
from solepath.papers.kupt_dfpc.shoe.gauge import PitchGauge
from solepath.types.vector import GRAVITY, from_rotation_vector

HOLD = 3.0
TURNED = Mounting((0.10, 0.0, 0.04), from_rotation_vector((0.4, -1.1, 2.0)))


def forces(mounting: Mounting) -> list[tuple[float, tuple[float, float, float]]]:
    """Return times, s, and specific forces, m/s^2, of a shoe that is held flat and in all postures."""
    t = np.arange(0.0, held_time(HOLD), 0.02)
    force = held_shoe(PITCHES, HOLD).at(t, mounting).force
    return [(a, (x, y, z)) for a, (x, y, z) in zip(t.tolist(), force.tolist(), strict=True)]


@pytest.mark.parametrize("mounting", [IN_SOLE, TURNED])
def test_each_posture_is_taken_with_its_pitch_however_the_sensor_is_mounted(mounting: Mounting) -> None:
    gauge, taken, due = PitchGauge(), [], HOLD - 0.1
    for t, acc in forces(mounting):
        gauge.add_sample(t, acc)
        if t >= due:
            taken.append(gauge.take())
            due += MOVING_TIME + HOLD
    assert taken == pytest.approx([0.0, *PITCHES], abs=1e-6)


def test_a_shoe_is_unsteady_while_it_goes_from_one_posture_to_the_next_and_is_not_taken() -> None:
    gauge = PitchGauge()
    for t, acc in forces(IN_SOLE):
        gauge.add_sample(t, acc)
        if t >= HOLD + 0.6:
            break
    reading = gauge.read()
    assert reading is not None and not reading.is_still and gauge.take() is None and gauge.flat is None


def test_the_pitch_that_is_shown_follows_the_hand_within_a_quarter_of_a_second() -> None:
    gauge, reached = PitchGauge(), HOLD + MOVING_TIME
    for t, acc in forces(IN_SOLE):
        gauge.add_sample(t, acc)
        if gauge.flat is None:
            gauge.take()
        if t >= reached + 0.25:
            break
    reading = gauge.read()
    assert reading is not None and degrees(reading.pitch) == pytest.approx(degrees(PITCHES[0]), abs=0.1)


def tilted(pitch: float, roll: float) -> tuple[float, float, float]:
    """Return the specific force of a shoe with its heel up by `pitch` that then leans by `roll`, rad, to a side."""
    x, z = sin(pitch) * cos(roll), cos(pitch) * cos(roll)
    return (GRAVITY * x, GRAVITY * sin(roll), GRAVITY * z)


def hold(gauge: PitchGauge, start: float, force: tuple[float, float, float]) -> None:
    for k in range(60):
        gauge.add_sample(start + 0.02 * k, force)


def test_a_lean_sideways_is_no_pitch_once_the_way_of_the_heel_is_known() -> None:
    gauge = PitchGauge()
    hold(gauge, 0.0, tilted(0.0, 0.0))
    gauge.take()
    hold(gauge, 2.0, tilted(radians(50.0), 0.0))
    assert gauge.take() == pytest.approx(radians(50.0))
    hold(gauge, 4.0, tilted(radians(30.0), radians(8.0)))
    reading = gauge.read()
    assert reading is not None and abs(reading.sideways) == pytest.approx(radians(8.0))
    assert gauge.take() == pytest.approx(radians(30.0))


def test_a_sensor_that_measures_nothing_shows_no_pitch() -> None:
    gauge = PitchGauge()
    assert gauge.read() is None and gauge.take() is None
    hold(gauge, 0.0, (0.0, 0.0, 0.0))
    assert gauge.read() is None and gauge.take() is None


def test_a_second_with_a_gap_at_10_hz_is_not_yet_still() -> None:
    gauge = PitchGauge()
    for t in (0.0, 0.1, 1.0, 1.1):
        gauge.add_sample(t, (0.0, 0.0, GRAVITY))
    assert gauge.take() is None
    for k in range(12):
        gauge.add_sample(1.2 + 0.1 * k, (0.0, 0.0, GRAVITY))
    assert gauge.take() == 0.0
