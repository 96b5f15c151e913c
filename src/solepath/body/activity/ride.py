"""Elevator rides: the motion of an elevator, integrated from its acceleration, in one hypothesis.

elevator_evidence.py has the acceleration. Velocities and heights are positive upwards."""

from __future__ import annotations

from ...types.attrs import define
from .elevator_evidence import RestLevels
from .pressure_height import Height

DWELL_TIME = 5.0
"""Least usual time between two rides, s: an elevator opens and closes its doors before it sets off again."""
PULSE_HEIGHT_ERROR = 0.1
"""Standard deviation of a ride's height that is integrated from its pulses, as a share of the height."""
SLOWEST_ELEVATOR_SPEED, SPEED_DEVIATION = 0.4, 0.03
"""Speed of the slowest elevator, m/s, and the standard deviation of the speed that its pulses show, m/s.

An escalator at 0.5 m/s (EN 115-1) rises by 0.25 m/s, in bends whose pulses look like an elevator's. Emulated escalators
show 0.20 to 0.27 m/s, emulated elevators of 0.4 m/s 0.36 to 0.41; the 53 rides of hugadb have 0.76 or more."""
STOP_ERROR_SHARE, STOP_ERROR = 0.3, 0.1
"""Standard deviation of the integrated velocity at a stop: share of the top speed, and constant part, m/s."""
MAX_STOP_PENALTY, MAX_SPEED_PENALTY = 4.0, 16.0
"""Largest penalties (minus log-likelihood) for the velocity at a stop, and for a speed that no elevator has."""
SHORT_DWELL_COST = 6.0
"""Penalty (minus log-likelihood) for less than `DWELL_TIME` between two rides."""


@define
class ElevatorRide:
    """The motion of an elevator in one hypothesis, positive upwards."""

    levels: RestLevels
    velocity: float = 0.0
    """Velocity of the elevator, m/s."""
    top_speed: float = 0.0
    """Largest speed in this ride so far, m/s."""
    height: float = 0.0
    """Height gained since the elevator set off, integrated from its acceleration, m."""
    duration: float = 0.0
    """Duration of the ride so far, s."""
    has_first_pulse: bool = False
    """Flag: the first pulse was measured."""
    start_height: Height | None = None
    """Height when the elevator set off, or at the start of stairs, by the air pressure."""
    standing_time: float = 1e3
    """Time since the last ride ended, s."""

    @staticmethod
    def start(
        has_first_pulse: bool, start_height: Height | None, levels: RestLevels, acceleration: float, block: float
    ) -> ElevatorRide:
        """Return a ride after its first block, which lasts `block` s.

        `start_height` is by air pressure; see `move` for `levels` and `acceleration`."""
        velocity = round(0.0 + acceleration * block, 6)
        height = round(0.0 + 0.5 * velocity * block, 6)
        return ElevatorRide(levels, velocity, abs(velocity), height, block, has_first_pulse, start_height)

    def move(self, levels: RestLevels, acceleration: float, block: float) -> ElevatorRide:
        """Return the ride after `block` s more with this elevator acceleration, m/s^2, and with new levels."""
        old_velocity = self.velocity
        velocity = round(old_velocity + acceleration * block, 6)
        speed = abs(velocity)
        return ElevatorRide(
            levels,
            velocity,
            speed if speed > self.top_speed else self.top_speed,
            round(self.height + 0.5 * (old_velocity + velocity) * block, 6),
            self.duration + block,
            self.has_first_pulse,
            self.start_height,
            self.standing_time,
        )

    def wait(self, levels: RestLevels, block: float) -> ElevatorRide:
        """Return the state after `block` s outside a ride, with new levels and the values of the last ride."""
        standing_time = self.standing_time
        if standing_time < DWELL_TIME:
            standing_time += block
        elif levels is self.levels:
            return self
        return ElevatorRide(
            levels,
            self.velocity,
            self.top_speed,
            self.height,
            self.duration,
            self.has_first_pulse,
            self.start_height,
            standing_time,
        )

    def end(self) -> ElevatorRide:
        """Return the state just after a ride ends: nothing but the levels is kept."""
        return ElevatorRide(self.levels, standing_time=0.0)

    def score_speed(self) -> float:
        """Return the log-likelihood of the largest speed so far, when the elevator does not become faster."""
        lack = max(0.0, SLOWEST_ELEVATOR_SPEED - self.top_speed) / SPEED_DEVIATION
        return -min(0.5 * lack * lack, MAX_SPEED_PENALTY)

    def score_stop(self) -> float:
        """Return the log-likelihood that the elevator stands now, after the motion of this ride."""
        if not self.has_first_pulse:
            return self.score_speed()
        velocity_error = STOP_ERROR_SHARE * self.top_speed + STOP_ERROR
        return -min(MAX_STOP_PENALTY, 0.5 * (self.velocity / velocity_error) ** 2)

    def height_gain(self, height: Height | None) -> float | None:
        """Return the height of the ride, m; None when neither the first pulse nor air pressure gives it.

        `height` is the height by air pressure now. With both sources the result is their mean, weighted by the
        inverse variances. The height by the pulses is corrected so that the final velocity is zero."""
        start = self.start_height
        by_pressure = None if height is None or start is None else height[0] - start[0]
        if not self.has_first_pulse:
            return by_pressure
        by_pulses = self.height - 0.5 * self.velocity * self.duration
        if by_pressure is None or height is None or start is None:
            return by_pulses
        air_variance = height[1] + start[1]
        share = air_variance / (air_variance + (PULSE_HEIGHT_ERROR * by_pressure) ** 2)
        return by_pressure + share * (by_pulses - by_pressure)
