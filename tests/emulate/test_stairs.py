"""Stairs foot over foot: the feet stand on treads, clear the edges, and rise exactly by the height of the flight."""

from math import radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strides import in_order

from solepath.emulate.routes.path import Flight
from solepath.emulate.routes.route import Route
from solepath.emulate.routes.styles import StrideKind
from solepath.emulate.sensors.sensortags import CC2541, CC2650
from solepath.emulate.walk import emulate
from solepath.emulate.wearers.gait import SUBJECTS, PlannedStride, Wearer
from solepath.emulate.wearers.shoe import IN_SOLE, Mounting
from solepath.emulate.wearers.walker import Walker
from solepath.link.decoder import Decoder
from solepath.types import SITE_OF_FOOT, Activity, Foot, Sample, Site


@pytest.fixture(scope="module")
def storey() -> Walker:
    """Return a walker who climbs two flights with a landing between them and walks down again."""
    route = Route().stand(1.0).walk(3.0).stairs(10).walk(0.4).turn(radians(180), 0.7).stairs(10).walk(3.0).stop(1.0)
    route = route.stairs(10, up=False).walk(0.4).turn(radians(-180), 0.7).stairs(10, up=False).walk(3.0).stop(1.0)
    return Walker(route, seed=4)


def climbing(walker: Walker, foot: Foot) -> list[PlannedStride]:
    return [stride for stride in walker.plan.strides[foot] if stride.flight is not None]


def room_below(walker: Walker, foot: Foot, flight: Flight, t: np.ndarray) -> np.ndarray:
    """Return the distance from the sole to the nearest tread or edge below it, m; the sole is the hull of its arcs."""
    shoe, motion = walker.wearer.shoe, walker.motions[foot]
    room = np.full(len(t), np.inf)
    for share in np.linspace(0.0, 1.0, 9):
        radius = shoe.heel.radius + (shoe.forefoot.radius - shoe.heel.radius) * share
        x = shoe.heel.x + (shoe.forefoot.x - shoe.heel.x) * share
        centre = motion.at(t, Mounting((x, 0.0, radius))).position
        room = np.minimum(room, centre[:, 2] - flight.clear_height(centre[:, 0], centre[:, 1], np.full(len(t), radius)))
    return room


@pytest.mark.parametrize("foot", list(Foot))
def test_both_feet_go_up_exactly_as_high_as_the_flights_and_come_down_again(storey: Walker, foot: Foot) -> None:
    truth = storey.truth()
    assert [flight.up for flight in truth.flights] == [True, True, False, False]
    climbed = [step.displacement[2] for step in truth.strides(foot)]
    assert sum(rise for rise in climbed if rise > 0.0) == pytest.approx(20 * 0.16, abs=1e-9)
    assert sum(climbed) == pytest.approx(0.0, abs=1e-9)
    assert truth.pose(foot, storey.duration).position[0, 2] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("foot", list(Foot))
def test_a_foot_skips_every_other_tread(storey: Walker, foot: Foot) -> None:
    """The width of a step is 0.3 m and the height 0.16 m: each foot goes 0.60 m and 0.32 m (Sensors 2016, 16, 1809)."""
    inside = [stride for stride in climbing(storey, foot) if abs(stride.end.z - stride.start.z) > 0.2]
    assert len(inside) >= 16
    for stride in inside:
        assert abs(stride.end.z - stride.start.z) == pytest.approx(0.32)
        assert np.hypot(stride.end.x - stride.start.x, stride.end.y - stride.start.y) == pytest.approx(0.60, abs=0.09)


@pytest.mark.parametrize("foot", list(Foot))
def test_a_foot_never_goes_into_a_tread_nor_through_an_edge(storey: Walker, foot: Foot) -> None:
    for stride in climbing(storey, foot):
        assert stride.flight is not None
        t = np.linspace(stride.heel_off + 1e-6, stride.foot_flat - 1e-6, 300)
        room = room_below(storey, foot, stride.flight, t)
        assert room.min() > -1e-3
        swing = stride.heel_strike - stride.toe_off
        middle = (t > stride.toe_off + 0.4 * swing) & (t < stride.toe_off + 0.7 * swing)
        assert 0.005 < room[middle].min() < (0.10 if abs(stride.end.z - stride.start.z) > 0.2 else 0.25)


flights = st.tuples(st.integers(1, 6), st.booleans(), st.floats(0.12, 0.2), st.floats(0.25, 0.36), st.floats(0.4, 0.7))


@settings(max_examples=25)
@given(flights, st.sampled_from([Wearer(), *SUBJECTS]), st.integers(0, 2**16))
def test_every_walker_on_every_flight_clears_its_edges_and_ends_level(
    flight: tuple[int, bool, float, float, float], wearer: Wearer, seed: int
) -> None:
    steps, up, rise, going, speed = flight
    route = Route().stand(1.0).walk(2.0).stairs(steps, up, rise, going, speed).walk(2.0).stop(1.0)
    walker = Walker(route, wearer, seed)
    height = steps * rise if up else -steps * rise
    in_order(walker)
    for foot in Foot:
        for stride in climbing(walker, foot):
            t = np.linspace(stride.heel_off + 1e-6, stride.foot_flat - 1e-6, 80)
            assert stride.flight is not None and room_below(walker, foot, stride.flight, t).min() > -4e-3
        assert walker.truth().pose(foot, walker.duration).position[0, 2] == pytest.approx(height, abs=1e-9)


def test_a_foot_in_stationary_is_still_at_the_height_of_its_tread(storey: Walker) -> None:
    for foot in Foot:
        for stride in climbing(storey, foot):
            assert stride.flight is not None
            t = np.array([stride.foot_flat + 0.01])
            found = storey.kinematics(foot, t, IN_SOLE)
            tread = stride.flight.ground_height(np.array([stride.end.x]), np.array([stride.end.y]))
            assert found.position[0, 2] - IN_SOLE.position[2] == pytest.approx(float(tread[0]), abs=2e-4)
            assert np.linalg.norm(found.velocity) < 1e-2


def test_the_load_of_a_descending_foot_starts_under_the_forefoot(storey: Walker) -> None:
    stride = next(s for s in climbing(storey, Foot.LEFT) if s.kind is StrideKind.DOWN and s.number > 20)
    heel, _, front, toes = storey.loads.zone_shares(Foot.LEFT, np.array([stride.heel_strike + 0.01]))
    assert front[0] + toes[0] > 0.6 > heel[0] + 0.3


def test_stairs_last_from_the_first_foot_up_to_both_feet_above(storey: Walker) -> None:
    truth = storey.truth()
    kinds = [what for _, _, what in truth.activities]
    up, down = Activity.STAIRS_UP, Activity.STAIRS_DOWN
    assert [what for what in kinds if what in (up, down)] == [up, up, down, down]
    for flight in truth.flights:
        before, after = truth.elevation(np.array([flight.start, flight.end]))
        assert after - before == pytest.approx(flight.height, abs=1e-9)
        assert truth.activity(flight.start + 0.1) is (up if flight.up else down)


@pytest.mark.parametrize("device", [CC2650(), CC2541(rate=20.0)])
def test_the_barometer_of_a_tag_follows_the_stairs(device: CC2650 | CC2541) -> None:
    """At 12 Pa a metre 4.8 m of stairs are 57 Pa, more than a barometer's noise and variation."""
    route = Route().stand(4.0).walk(2.0).stairs(15).walk(1.5).stairs(15).walk(2.0).stop(4.0)
    walk = emulate(route, devices={SITE_OF_FOOT[foot]: device for foot in Foot}, seed=6)
    for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT):
        decoder = Decoder(site)
        decoded = [one for packet in walk.packets if packet.site is site for one in decoder.feed(packet)]
        air = [(one.t, one.air_pressure) for one in decoded if isinstance(one, Sample) and one.air_pressure is not None]
        low = np.mean([pascal for t, pascal in air if t < 3.5])
        high = np.mean([pascal for t, pascal in air if t > walk.truth.duration - 3.5])
        assert low - high == pytest.approx(57.0, abs=15.0)


@pytest.mark.parametrize(("steps", "rise", "going"), [(0, 0.16, 0.3), (4, 0.0, 0.3), (4, 0.4, 0.3), (4, 0.16, 0.2)])
def test_impossible_stairs_are_rejected(steps: int, rise: float, going: float) -> None:
    with pytest.raises(ValueError, match="stairs"):
        Route().stairs(steps, rise=rise, going=going)


def test_two_flights_without_a_landing_are_rejected() -> None:
    with pytest.raises(ValueError, match="landing"):
        Route().stairs(4).stairs(4)
