"""Contact and flight time, strike angle and vertical oscillation of runners."""

from __future__ import annotations

from math import radians, sin

import numpy as np
import pytest
from attrs import evolve

from solepath import GaitCycleMeasured, Sample, Session
from solepath.body.gait.running import MAX_SLOPE, running_cycle, running_means, vertical_oscillation
from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.walker import Walker
from solepath.lab.emulated.runs import errors_of, main, run_of, score_run
from solepath.types import Foot
from solepath.types.vector import GRAVITY


@pytest.mark.parametrize(("contact", "flight"), [(0.30, 0.05), (0.25, 0.12), (0.20, 0.15), (0.25, 0.0)])
def test_the_oscillation_is_that_of_a_mass_on_half_a_sine_wave(contact: float, flight: float) -> None:
    step, height, speed, heights = 1e-5, 0.0, -0.5 * GRAVITY * flight, []
    force = 0.5 * np.pi * GRAVITY * (flight / contact + 1.0)
    for k in range(round((contact + flight) / step)):
        t = k * step
        speed += step * ((force * sin(np.pi * t / contact) if t < contact else 0.0) - GRAVITY)
        height += step * speed
        heights.append(height)
    assert vertical_oscillation(contact, flight) == pytest.approx(max(heights) - min(heights), rel=1e-3)


def test_a_usual_runner_rises_by_6_to_11_cm() -> None:
    """Novacheck 1998: the centre of mass; contact 0.25 s and flight 0.12 s are those of a runner at 3 m/s."""
    assert 0.06 < vertical_oscillation(0.25, 0.12) < 0.11


@pytest.mark.parametrize("speed", [2.4, 3.4])
def test_insoles_measure_emulated_runs(speed: float) -> None:
    score = score_run(run_of(51, speed), with_cells=True)
    assert len(score.measured) > 15
    for name, limit in (("contact_time", 0.01), ("flight_time", 0.01), ("vertical_oscillation", 0.005)):
        errors, _ = errors_of([score], name)
        assert len(errors) == len(score.measured)
        assert abs(np.mean(errors)) < limit, name
    angles, _ = errors_of([score], "strike_angle")
    assert abs(np.mean(angles)) < radians(3.0)


def cycles_of(route: Route, feet: tuple[Foot, ...] = tuple(Foot)) -> tuple[Session, list[GaitCycleMeasured]]:
    """Return the finished session of a route, and its gait cycles."""
    walker, session = Walker(route, seed=9), Session()
    samples: list[Sample] = [sample for foot in feet for sample in walker.samples(foot, 100.0)]
    events = session.feed(sorted(samples, key=lambda one: one.t)) + session.finish()
    return session, [event for event in events if isinstance(event, GaitCycleMeasured)]


def test_a_walker_has_none_of_it() -> None:
    session, cycles = cycles_of(Route().stand(2.0).walk(12.0, 1.3).stop(1.0))
    assert len(cycles) > 5 and all(running_cycle(one) is None for one in cycles)
    assert session.gait is not None and running_means(session.gait) is None


def test_means_are_those_of_the_cycles() -> None:
    session, cycles = cycles_of(Route().stand(2.0).jog(40.0, 2.8).stop(1.0))
    runs = [run for one in cycles if one.steady and (run := running_cycle(one)) is not None]
    assert session.gait is not None
    means = running_means(session.gait)
    assert means is not None and means.flight_time is not None and means.vertical_oscillation is not None
    assert means.contact_time == pytest.approx(np.mean([one.contact_time for one in runs]), abs=0.005)
    assert means.flight_time == pytest.approx(np.mean([one.flight_time for one in runs]), abs=0.005)
    assert means.strike_angle == pytest.approx(np.mean([one.strike_angle for one in runs]), abs=0.02)


def test_what_needs_the_other_foot_or_the_level_is_none() -> None:
    _, alone = cycles_of(Route().stand(2.0).jog(40.0, 2.8).stop(1.0), (Foot.LEFT,))
    runs = [run for one in alone if (run := running_cycle(one)) is not None]
    assert runs and all(one.flight_time is None and one.vertical_oscillation is None for one in runs)
    _, both = cycles_of(Route().stand(2.0).jog(20.0, 2.8).stop(1.0))
    level = next(one for one in both if one.steady and one.running and one.stride_length is not None)
    assert level.stride_length is not None
    for sign in (-1.0, 1.0):
        uphill = running_cycle(evolve(level, rise=sign * 1.5 * MAX_SLOPE * level.stride_length))
        assert uphill is not None and uphill.flight_time is not None and uphill.vertical_oscillation is None


def test_the_command_prints_a_row_for_each_measure(capsys: pytest.CaptureFixture[str]) -> None:
    main(["--runs", "1", "--seed", "52"])
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 10 and all(line.count("|") == lines[0].count("|") for line in lines)
