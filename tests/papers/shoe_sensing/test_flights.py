"""Flights of stairs are counted from strides that go up, down or neither."""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from hypothesis import strategies as st
from strides import stride

from solepath.body.activity.flights import Flights, FlightStride
from solepath.events import Flaw, FlightClimbed, StrideTaken
from solepath.types import Foot

RISER = 0.16
FEET = (Foot.LEFT, Foot.RIGHT)


def stride_of(foot: Foot, t: float, height: float, degraded: bool = False) -> StrideTaken:
    return stride(foot, t, (0.6, 0.0, height), flaws=(Flaw.GAP,) * degraded)


def added(flights: Flights, taken: StrideTaken, way: int | None) -> list[FlightClimbed]:
    return flights.add_stride(FlightStride.of(taken), way, taken.known_at)


def flights_of(risers: list[int], *, feet: tuple[Foot, ...] = FEET, last: bool = True) -> list[FlightClimbed]:
    """Footfalls of alternating feet: `risers` is how far up each comes down, in risers. Each foot has stood at 0. A
    foot that rises by one riser takes it with a long stride, which is judged level."""
    flights = Flights()
    found: list[FlightClimbed] = []
    stood = dict.fromkeys(FEET, 0)
    for k, riser in enumerate(risers):
        foot = FEET[k % 2]
        rise, stood[foot] = riser - stood[foot], riser
        if foot in feet:
            way = 0 if abs(rise) < 2 else (1 if rise > 0 else -1)
            found += added(flights, stride_of(foot, 0.6 * k, RISER * rise), way)
    if last:
        found += flights.advance(0.6 * len(risers) + 5.0, 0.6 * len(risers) + 5.0)
    return found


UP_10 = [0, 0, *range(1, 11), 10, 10, 10]


def test_a_flight_of_ten_risers_is_one_flight_of_their_height() -> None:
    (flight,) = flights_of(UP_10)
    assert flight.up
    assert flight.height == pytest.approx(1.6)
    assert flight.steps == 9
    assert flight.t_start == pytest.approx(0.6 * 3 - 1.0)
    assert flight.t == pytest.approx(0.6 * 11)
    assert flight.known_at == pytest.approx(0.6 * 13)


def test_a_landing_parts_two_flights_and_one_foot_alone_sees_it_too() -> None:
    landing = [*UP_10[:-1], *range(11, 21), 20, 20, 20]
    assert [f.up for f in flights_of(landing)] == [True, True]
    for foot in FEET:
        alone = flights_of(landing, feet=(foot,))
        assert [f.up for f in alone] == [True, True]
        assert sum(f.height for f in alone) == pytest.approx(3.2)


def test_a_kerb_is_no_flight() -> None:
    assert flights_of([0, 0, 1, 1, 1, 1, 0, 0, 0]) == []


def flights_of_strides(strides: Iterable[tuple[float, int | None]], degraded: bool = False) -> list[FlightClimbed]:
    """Return the flights of alternate strides, each with its height, m, and direction, and of a rest at the end."""
    flights, found = Flights(), list[FlightClimbed]()
    for k, (height, way) in enumerate(strides):
        found += added(flights, stride_of(FEET[k % 2], 0.6 * k, height, degraded=degraded), way)
    return found + flights.finish(60.0)


def flights_upstairs(heights: list[float], *, degraded: bool = False) -> list[FlightClimbed]:
    """Return the flights of strides upstairs with these heights, m."""
    return flights_of_strides([(height, 1) for height in heights], degraded)


def test_a_stride_higher_than_any_stairs_rises_by_what_the_others_do() -> None:
    (flight,) = flights_upstairs([0.32, 0.32, 11.5, 0.32, 0.32, 0.32])
    assert flight.steps == 6
    assert flight.height == pytest.approx(6 * 0.16)
    # also when it is the first one, before anybody knows what the others will do
    assert flights_upstairs([2.3, 0.32, 0.32, 0.32])[0].height == pytest.approx(4 * 0.16)


strides = st.lists(
    st.tuples(
        st.sampled_from(FEET),
        st.floats(0.0, 20.0, allow_nan=False),
        st.one_of(st.floats(-1e6, 1e6, allow_nan=False), st.floats(-1.0, 1.0)),
        st.sampled_from((-1, 0, 1, None)),
    ),
    max_size=40,
)
