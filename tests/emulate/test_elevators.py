"""An elevator car keeps its limits, moves the wearer, and changes the load under the feet by its acceleration."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from solepath.emulate.routes.elevator import CarRide, Elevator, ride
from solepath.emulate.routes.route import Route
from solepath.emulate.wearers.shoe import ON_INSTEP
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot
from solepath.types.vector import GRAVITY


@pytest.fixture(scope="module")
def up_and_down() -> Walker:
    route = Route().stand(2.0).walk(3.0).lift(7.0, 1.6, 1.0, 1.2).walk(3.0).stop(1.0).lift(-3.5, creep=0.15)
    return Walker(route.walk(3.0).stop(2.0), seed=5)


elevators = st.builds(
    Elevator,
    height=st.floats(0.5, 60.0) | st.floats(-60.0, -0.5),
    speed=st.floats(0.4, 4.0),
    acceleration=st.floats(0.3, 1.5),
    jerk=st.floats(0.4, 3.0),
    creep=st.sampled_from([0.0, 0.1]),
)


def moved(car: CarRide, t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return height, speed and acceleration without the vibration of the car."""
    smooth_car = CarRide(car.start, car.end, car.height, car.knots, car.state, np.zeros((3, 1, 3)) + (0.0, 1.0, 0.0))
    position, velocity, acceleration = smooth_car.at(t)
    return position[:, 2], velocity[:, 2], acceleration[:, 2]


@settings(max_examples=30)
@given(elevators)
def test_a_car_keeps_its_limits_and_stops_at_its_floor(elevator: Elevator) -> None:
    car = ride(elevator, 3.0, np.random.default_rng(1))
    t = np.linspace(car.start - 1.0, car.end + 1.0, 4001)
    height, speed, acceleration = moved(car, t)
    assert height[0] == 0.0 and height[-1] == elevator.height
    before, _, _ = moved(car, np.array([car.end - 1e-9]))
    assert before[0] == pytest.approx(elevator.height, abs=1e-6)
    assert np.abs(speed).max() <= elevator.speed + 1e-9
    assert np.abs(acceleration).max() <= elevator.acceleration + 1e-9
    assert np.abs(np.diff(acceleration)).max() <= elevator.jerk * (t[1] - t[0]) + 1e-9
    assert np.all(np.sign(speed[np.abs(speed) > 1e-9]) == np.sign(elevator.height))


@settings(max_examples=20)
@given(elevators)
def test_the_acceleration_of_an_elevator_integrates_to_its_height(elevator: Elevator) -> None:
    car = ride(elevator, 0.0, np.random.default_rng(1))
    t = np.linspace(0.0, car.end, 20001)
    h = t[1] - t[0]
    acceleration = car.at(t)[2][:, 2]
    speed = np.concatenate(([0.0], np.cumsum(0.5 * h * (acceleration[1:] + acceleration[:-1]))))
    assert speed[-1] == pytest.approx(0.0, abs=2e-3)
    assert np.sum(0.5 * h * (speed[1:] + speed[:-1])) == pytest.approx(elevator.height, rel=1e-2, abs=2e-2)


@pytest.mark.parametrize("foot", list(Foot))
def test_the_elevator_moves_the_wearer_to_the_floor_and_stops_there(up_and_down: Walker, foot: Foot) -> None:
    truth = up_and_down.truth()
    assert [car.height for car in truth.rides] == [7.0, -3.5]
    for start, end in ((truth.rides[0], 7.0), (truth.rides[1], 3.5)):
        t = np.array([start.end + 0.5])
        assert truth.pose(foot, t).position[0, 2] == pytest.approx(end, abs=1e-9)
        assert np.linalg.norm(truth.pose(foot, t).velocity) == pytest.approx(0.0, abs=1e-9)
    assert truth.elevation(up_and_down.duration)[0] == pytest.approx(3.5)


def test_specific_force_in_an_elevator_first_grows_on_the_way_up_and_falls_on_the_way_down(up_and_down: Walker) -> None:
    for car in up_and_down.truth().rides:
        t = np.linspace(car.start, car.end, 2000)
        net_force = np.linalg.norm(up_and_down.kinematics(Foot.LEFT, t, ON_INSTEP).force, axis=1) - GRAVITY
        sign = np.sign(car.height)
        first, last = sign * net_force[:600], sign * net_force[-900:]
        assert first.max() > 0.6 and last.min() < -0.6
        assert np.argmax(sign * net_force) < np.argmin(sign * net_force)


def test_the_load_goes_with_the_acceleration_of_the_car(up_and_down: Walker) -> None:
    for car in up_and_down.plan.rides:
        t = np.linspace(car.start - 1.0, car.end + 1.0, 500)
        total = sum(up_and_down.loads.total(foot, t) for foot in Foot)
        assert total == pytest.approx(up_and_down.loads.weight * (1.0 + car.at(t)[2][:, 2] / GRAVITY))
        assert np.ptp(total) > 0.1 * up_and_down.loads.weight


@pytest.mark.parametrize("limits", [{"height": 0.1}, {"height": 3.0, "speed": 0.0}, {"height": 3.0, "creep": 0.9}])
def test_an_elevator_that_does_not_move_is_rejected(limits: dict[str, float]) -> None:
    with pytest.raises(ValueError, match="lift"):
        Route().lift(**limits)
