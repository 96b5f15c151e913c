"""The estimate of the height from two barometers treats both alike."""

from __future__ import annotations

from solepath.body.altitude import LEFT, MOVE, RIGHT, HeightEstimate


def test_readings_of_the_right_barometer_count_as_those_of_the_left_do() -> None:
    left, right = HeightEstimate(), HeightEstimate()
    readings = [(1.0, 12.0, 0.25), (2.0, 12.3, 0.25), (3.0, 11.8, 0.25), (40.0, 12.9, 0.25), (41.0, 30.0, 0.25)]
    for estimate, source in ((left, LEFT), (right, RIGHT)):
        estimate.apply((0.0, source, 12.0, 0.25))
        estimate.apply((0.5, MOVE, 0.4, 0.09))
    for t, height, variance in readings:
        left.apply((t, LEFT, height, variance))
        right.apply((t, RIGHT, height, variance))
    assert left.values[0] == right.values[0] != 0.4
    assert left.values[1] == right.values[2]
    p, q = left.covariance, right.covariance
    assert (p[0], p[1], p[4]) == (q[0], q[2], q[8]) and q[4] == p[8] == 0.0
