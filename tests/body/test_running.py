"""Contact and flight time, strike angle and vertical oscillation of runners."""

from __future__ import annotations

from math import radians, sin

import numpy as np
import pytest

from solepath.show.report.running import vertical_oscillation
from solepath.types.vector import GRAVITY
from solepath_lab.emulated.runs import errors_of, run_of, score_run


@pytest.mark.parametrize(("contact", "flight"), [(0.25, 0.12)])
def test_the_oscillation_is_that_of_a_mass_on_half_a_sine_wave(contact: float, flight: float) -> None:
    step, height, speed, heights = 1e-5, 0.0, -0.5 * GRAVITY * flight, []
    force = 0.5 * np.pi * GRAVITY * (flight / contact + 1.0)
    for k in range(round((contact + flight) / step)):
        t = k * step
        speed += step * ((force * sin(np.pi * t / contact) if t < contact else 0.0) - GRAVITY)
        height += step * speed
        heights.append(height)
    assert vertical_oscillation(contact, flight) == pytest.approx(max(heights) - min(heights), rel=1e-3)


@pytest.mark.parametrize("speed", [3.4])
def test_insoles_measure_emulated_runs(speed: float) -> None:
    cycles = score_run(run_of(51, speed), with_cells=True)
    assert len(cycles) > 15
    for name, limit in (("contact_time", 0.01), ("flight_time", 0.01), ("vertical_oscillation", 0.005)):
        errors, _ = errors_of(cycles, name)
        assert len(errors) == len(cycles)
        assert abs(np.mean(errors)) < limit, name
    angles, _ = errors_of(cycles, "strike_angle")
    assert abs(np.mean(angles)) < radians(3.0)
