"""What is as printed and what is ours in footstep-tracker; expected values by hand."""

from __future__ import annotations

from math import hypot, radians

import pytest
from floors import indexed_office
from walks import of, run_session

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.parts import Imu, TriadErrors
from solepath.emulate.wearers.walker import Walker
from solepath.events import StrideTaken
from solepath.foot.stance.stance import Stance
from solepath.papers.footstep_tracker.critical_times import CriticalTimes, Row
from solepath.papers.footstep_tracker.projection import PRINTED, Projection, ProjectionSettings
from solepath.papers.footstep_tracker.recipe import FOOTSTEP_TRACKER
from solepath.papers.footstep_tracker.segment import FootAxes, StrideSegment
from solepath.papers.footstep_tracker.snake import PrintedSnake
from solepath.papers.footstep_tracker.static_zones import PRINTED_ZONES, StaticZones, StaticZonesSettings
from solepath.place.particles import Particle
from solepath.types import Foot, Phase, Sample, Vec3
from solepath.types.attrs import evolve
from solepath.types.vector import GRAVITY, ZERO

G = GRAVITY


def first_zone(settings: StaticZonesSettings, acc_of: list[Vec3], gyro: Vec3 = ZERO) -> int | None:
    """Return the number of the sample, from 1, at which a zone is detected at 20 Hz."""
    zones = StaticZones(settings)
    for k, acc in enumerate(acc_of):
        if zones.update(0.05 * k, 0.05, acc, gyro, None).hint is Phase.STATIONARY:
            return k + 1
    return None


def test_as_printed_only_six_samples_within_half_a_metre_per_second_squared_are_a_zone() -> None:
    at_rest = [(0.0, 0.0, G)] * 8
    assert first_zone(StaticZonesSettings(), at_rest) == 3
    assert first_zone(PRINTED_ZONES, at_rest) == 6
    uneven = [(0.8 * (k % 2), 0.0, G + 0.01 * k) for k in range(12)]  # 0.8 is within 1.0 and not within 0.5
    assert first_zone(StaticZonesSettings(), uneven) is not None
    assert first_zone(PRINTED_ZONES, uneven) is None


def test_as_printed_a_zone_ends_by_the_printed_tolerance() -> None:
    # a difference of 1.2 is less than 1.0 and half of a count of 0.7, and more than 0.5 and half of a count
    for settings, hint in ((PRINTED_ZONES, None), (StaticZonesSettings(), Phase.STATIONARY)):
        zones = StaticZones(settings)
        hints = [zones.update(0.05 * k, 0.05, (0.0 if k < 8 else 1.2, 0.0, G), ZERO, None).hint for k in range(9)]
        assert hints[-2:] == [Phase.STATIONARY, hint]


def moved_by(settings: ProjectionSettings) -> float:
    """Return the length of a stride whose foot speeds up from uplift at 0 s to 0.4 s, and slows down to 0.8 s."""
    push = [(0.01 * k, 0.0, 4.0 if k < 40 else -4.0 if k > 40 else 0.0, -G, 0.0, 0.0, 0.0) for k in range(101)]
    rows = tuple(row if row[0] <= 0.8 else (*row[:2], 0.0, *row[3:]) for row in push)
    projection = Projection(settings)
    projection.start((1.0, 0.0, 0.0, 0.0), 0.0)
    projection.predict(0.01, (0.0, 0.0, G), ZERO)
    segment = StrideSegment(rows, CriticalTimes(0.0, 0.2, 0.6, 0.8), (1.0, 0.0, 0.0), 0.01)
    projection.correct(1.0, Stance(ZERO, 0.01, 0.0, Phase.STATIONARY, segment))
    return hypot(projection.position[0], projection.position[1])


def test_equation_5_as_printed_lacks_the_velocity_that_the_foot_has_at_liftoff() -> None:
    # speed 1.6 m/s at 0.4 s; 0.64 m in all, of which 0.48 m from liftoff at 0.2 s to landing at 0.6 s
    assert moved_by(ProjectionSettings()) == pytest.approx(0.64, abs=0.01)
    assert moved_by(PRINTED) == pytest.approx(0.5 * 4.0 * 0.2**2 + 0.8 * 0.2 - 0.5 * 4.0 * 0.2**2, abs=0.01)


def test_the_axis_of_the_foot_is_read_before_the_shoe_leaves_the_ground() -> None:
    # the heel rises by 1 rad about y in 0.2 s, then the foot in the air rolls about x and the toe rises again
    rates = [(0.0, 5.0)] * 20 + [(3.0, 0.5)] * 10 + [(0.0, -5.0)] * 20
    rows: list[Row] = [(0.01 * k, 0.0, 0.0, G, x, y, 0.0) for k, (x, y) in enumerate(rates)]
    axes = FootAxes()
    axes.add_segment(rows, (0.0, 0.0, 1.0))
    assert axes.right == pytest.approx((0.0, -1.0, 0.0), abs=1e-6)


def test_as_printed_a_wall_drops_a_candidate_and_changes_no_weight() -> None:
    # two candidates in the corridor at the bottom of the office: one walks along it, the other into a room's wall
    along, across = Particle(10.0, 6.2, 1.0, 0.0, 0.25, 0), Particle(10.0, 6.2, 0.0, 1.0, 0.75, 0)
    game = PrintedSnake()
    assert game.extend(indexed_office(), [along, across], (2.0, 0.0), 1.0, 0.0) == [along._replace(x=12.0)]
    assert game.thin([along, across], 1) == [along, across]


LOW_PASSED = TriadErrors(density=1e-6, bias=0.0, drift=0.0, scale=0.0, cross=0.0, bandwidth=10.0)
"""Errors of a sensor that has none, but a low pass at half of 20 Hz."""


def clipped(sample: Sample) -> Sample:
    end = radians(250.0)
    assert sample.gyro is not None
    x, y, z = (min(max(rate, -end), end) for rate in sample.gyro)
    return evolve(sample, gyro=(x, y, z), saturated=(x, y, z) != sample.gyro)


@pytest.mark.parametrize("foot", list(Foot))
def test_a_gyroscope_that_clips_and_has_no_other_error_leaves_lengths_right(foot: Foot) -> None:
    walker = Walker(Route().stand(3.0).walk(30.0, 1.3).stop(2.0), seed=7201)
    samples = [clipped(one) for one in walker.samples(foot, 20.0, Imu("exact", LOW_PASSED, LOW_PASSED))]
    assert sum(one.saturated for one in samples) > 50
    strides = of(StrideTaken, run_session(samples, FOOTSTEP_TRACKER))
    assert sum(one.length for one in strides) == pytest.approx(30.0, rel=0.015)
