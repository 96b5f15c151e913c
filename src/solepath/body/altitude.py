"""Height of the wearer: a correction of the feet's heights for elevator rides, by air pressure.

The tracks of the feet contain the height of stairs and slopes, but not that of an elevator, in which a foot stands
still. Therefore a correction is added to their heights. A Kalman filter estimates the correction together with the
offset of each foot's barometer (weather, wind, doors and the device's own offset). Readings are averaged over half a
second or more:

    height by air pressure  -  height of the foot's track  =  correction + offset of that barometer + noise

    after a stride with height change h   the correction's variance grows by the variance of h (not on level ground)
    after an elevator ride of height h    the correction grows by h, and its variance by the variance of h
    with time                             the variance of each offset grows by `OFFSET_DRIFT`^2 per second

On level ground the variance of the correction does not grow, so changes of pressure are attributed to the offsets. On
stairs, strides give the height of each tread and air pressure gives the sum. In an elevator, only air pressure gives
the height, if there is a barometer. A ride is reported after it has ended; the readings since its start are then
processed again, if it started in the last `KEPT_TIME`. Readings after a ride improve its height while the offsets are
known well enough."""

from __future__ import annotations

from math import log

from ..events import Defect, DefectFound, LiftRidden, StrideTaken
from ..events.activity import Ride
from ..foot.view import FootView
from ..types import Foot, Site
from ..types.attrs import ROW_SIZE, define, evolve, field, state, stateful
from ..types.doubles import Doubles, doubles, pairs
from ..types.vector import to_float32
from .part import HeightShift, Inputs, Outputs, Part, PartOutput, Replacement

# Height by the pressure of the air.

SCALE_HEIGHT = 8578.0
"""Height over which the pressure of air at 20 degrees Celsius falls to 1/e, m: R T / (M g)."""
STANDARD_PRESSURE = 101325.0
"""Standard air pressure, Pa."""
MIN_PRESSURE, MAX_PRESSURE = 2e4, 2e5
"""Limits of a plausible air pressure, Pa."""


def height_of(pressure: float) -> float | None:
    """Return the height above standard pressure, m, at an air pressure, Pa; None when that is not plausible."""
    return SCALE_HEIGHT * log(STANDARD_PRESSURE / pressure) if MIN_PRESSURE < pressure < MAX_PRESSURE else None


MAX_TRACK_HEIGHT = 1e5
"""Largest height of a track, and of a ride, that is used, m; also the largest variance of a stride's height, m^2."""


NOISE_WEIGHT = 0.05
"""Weight of one reading in the measured noise, which follows twenty readings."""


def measured_noise(noise: float, square: float, largest_ratio: float) -> float:
    """Return the variance of a reading, m^2, after one that deviates by the root of `square`, m^2.

    A square counts up to `largest_ratio` times the noise before."""
    return noise + NOISE_WEIGHT * (min(square, largest_ratio * noise) - noise)


def height_above_track(view: FootView) -> float | None:
    """Return the height by a sample's air pressure minus that of the foot's track, m; None without plausible ones."""
    pressure, z = view.sample.air_pressure, view.position[2]
    height = None if pressure is None else height_of(pressure)
    return None if height is None or not abs(z) < MAX_TRACK_HEIGHT else height - z


# The height filter: its estimate of three values, and its recent inputs.
#
# An elevator ride is known only after it has ended; all inputs since its start are then processed again.

JUMP_LIMIT = 25.0
"""Squared innovation, divided by its variance, above which the offset has changed suddenly: a door or a gust."""
UNKNOWN_VARIANCE = 1e4
"""Variance of an unknown height, m^2."""

HeightInput = tuple[float, int, float, float]
"""Time, s; source (`LEFT`, `RIGHT`, `MOVE`); value, m; its variance, m^2."""

PackedInput = tuple[int, int, int, float]
"""A `HeightInput` in compact form: ticks, source, value in units of 1/`PARTS_PER_M` m, variance as float32."""
TICKS_PER_S = 100.0
"""Number of ticks in a second."""
PARTS_PER_M = 10_000.0
"""Number of units of the value in a metre."""


@define
class HeightEstimate:
    """The filter's estimate of the correction and the two offsets."""

    values: list[float] = field(factory=lambda: [0.0, 0.0, 0.0])
    """The correction and the offsets of the left and the right barometer, m."""
    covariance: list[float] = field(factory=lambda: [0.0] * 9)
    """Covariance of the three values, row by row, m^2."""
    read_at: list[float | None] = field(factory=lambda: [None, None])
    """Time of the newest reading of each barometer, s; None: the next reading gives an offset that fits."""

    def apply(self, entry: HeightInput) -> None:
        """Process an input."""
        t, source, value, variance = entry
        if source == MOVE:
            self.values[0] += value
            self.covariance[0] = min(self.covariance[0] + variance, UNKNOWN_VARIANCE)
        elif source >= FORGET:
            self.read_at[source - FORGET] = None
        else:
            self._read(t, source, value, variance)

    def _read(self, t: float, source: int, height: float, noise: float) -> None:
        """Correct the estimate with `height`, m: the height by the barometer minus the height of the track.

        `noise` is the variance of the reading, m^2."""
        x, p, i = self.values, self.covariance, 1 + source
        previous = self.read_at[source]
        self.read_at[source] = t
        if previous is None:
            # the offset is unknown: set it so that the reading fits the correction
            x[i] = height - x[0]
            for j in range(3):
                p[3 * i + j] = p[3 * j + i] = -p[j]
            p[4 * i] = p[0] + noise
            return
        p[4 * i] = min(p[4 * i] + OFFSET_DRIFT * OFFSET_DRIFT * max(0.0, t - previous), UNKNOWN_VARIANCE)
        innovation = height - x[0] - x[i]
        if innovation * innovation > JUMP_LIMIT * (p[0] + 2.0 * p[i] + p[4 * i] + noise):
            p[4 * i] = min(p[4 * i] + innovation * innovation, UNKNOWN_VARIANCE)
        innovation_variance = p[0] + 2.0 * p[i] + p[4 * i] + noise
        covariances = [p[3 * j] + p[3 * j + i] for j in range(3)]
        for j, covariance in enumerate(covariances):
            x[j] += covariance / innovation_variance * innovation
            for k, other in enumerate(covariances):
                p[3 * j + k] -= covariance * other / innovation_variance
            p[4 * j] = max(p[4 * j], 0.0)

    def copy(self) -> HeightEstimate:
        """Return a copy of the estimate."""
        return HeightEstimate(list(self.values), list(self.covariance), list(self.read_at))


def _unpack(row: PackedInput) -> HeightInput:
    """Return the input in s, m and m^2."""
    ticks, source, parts, variance = row
    return ticks / TICKS_PER_S, source, parts / PARTS_PER_M, variance


READING_INTERVAL = 0.5
"""Shortest interval between two readings of the filter, s; all pressures in between are averaged into one reading."""
KEPT_TIME = 90.0
"""Time for which inputs are kept, s."""
MOST_INPUTS = 720
"""Largest number of inputs that are kept: 8 a second."""
MAX_NOISE_RATIO = 3.0
"""Largest ratio of a value to `Altitude.noise` that counts."""
MIN_NOISE = 1e-4
"""Least variance of a reading, m^2."""
LEFT, RIGHT, MOVE = 0, 1, 2
"""Sources of an input: left barometer, right barometer, or a change of the correction by a stride or ride."""
SOURCES = {Foot.LEFT: LEFT, Foot.RIGHT: RIGHT}
FORGET = 3
"""Added to `LEFT` or `RIGHT`: from this input on, the offset of that barometer is not known."""
RIDE_MARGIN = 0.7
"""Time before the start of a ride and after its end in which the wearer does not stand still, s."""
LEVEL_LIMIT = 0.02
"""Largest height change of a level stride, m."""
MAX_STRIDES = 64
"""Number of newest strides that are kept; a ride with two strides in it is not plausible."""
MIN_STRIDE_LENGTH = 0.3
"""Length of the shortest stride that is kept, m; a shorter one may be a shift of weight."""
OFFSET_DRIFT = 0.03
"""Random walk of a barometer's offset, m/sqrt(s): 0.35 Pa indoors; weather alone changes it by less."""
STRIDE_ERROR, DEGRADED_FACTOR = 0.05, 3.0
"""Standard deviation of a stride's height, as a share of the height, and its factor for a degraded stride.

The stride's own variance is added to it."""
RIDE_ERROR = 0.1
"""Standard deviation of a reported ride's height, as a share of the height."""
MIN_RIDE_HEIGHT, MIN_RIDE_SPEED, MAX_RIDE_SPEED = 1.8, 0.25, 4.0
"""Limits for a ride without air pressure: least height, m, least mean speed and largest mean speed, m/s."""
MIN_ESCALATOR_HEIGHT, MIN_ESCALATOR_SPEED = 1.0, 0.1
"""Least height, m, and least mean speed, m/s, of a ride on an escalator without air pressure (assumed)."""


@define
class PendingReadings:
    """The heights of one barometer that wait for the next reading, and the newest reading."""

    faulty: bool = False
    """Flag: the barometer was reported as wrong, and is not used."""
    read_at: float | None = None
    """Time of the newest reading, s; None before any."""
    total: float = 0.0
    """Sum of the pending heights, m."""
    count: int = 0
    """Number of pending heights."""
    previous_height: float | None = None
    """Height of the newest reading, m; None before any."""


@stateful
class Altitude(Part):
    """Estimates the correction of the wearer's height from air pressure, strides and elevator rides.

    Latency: none for air pressure; a ride is known after its end."""

    needs_samples = True
    idle = True

    now: HeightEstimate = state(factory=HeightEstimate)
    """Estimate after all inputs."""
    base: HeightEstimate = state(factory=HeightEstimate)
    """Estimate before the oldest input that is kept."""
    inputs: list[PackedInput] = state(factory=list)
    """Recent inputs, in the order in which they were processed: readings of both barometers and changes of the
    correction."""
    sides: list[PendingReadings] = state(factory=lambda: [PendingReadings(), PendingReadings()])
    """Pending readings of the left and the right barometer."""
    noise: float = 0.04
    """Variance of a reading, estimated from consecutive readings, m^2."""
    ride_variance: float = 0.0
    """Variance of the height of all rides together, m^2."""
    strides: Doubles = state(factory=doubles, metadata={ROW_SIZE: 2})
    """Start and end of each of the newest strides in turn, in whole hundredths of a second."""

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        """Add the reading of a foot's barometer, if the sample has one, and strides and rides."""
        outputs: list[PartOutput] = []
        if view is not None and view.sample.air_pressure is not None:
            height = height_above_track(view)
            if height is not None:
                outputs += self._add_reading(view.t, SOURCES[view.foot], height)
        for event in events:
            if isinstance(event, StrideTaken):
                outputs += self._add_stride(event)
            elif isinstance(event, Ride):
                outputs += [Replacement(event, self._corrected_ride(event)), *self._height_shift()]
            elif isinstance(event, DefectFound) and event.defect is Defect.AIR_PRESSURE and event.site.foot is not None:
                source = SOURCES[event.site.foot]
                self.sides[source].faulty = True
                self._replace_inputs([entry for entry in map(_unpack, self.inputs) if entry[1] != source])
                outputs += self._height_shift()
        return outputs

    def _add_reading(self, t: float, source: int, height: float) -> Outputs:
        """Add a height by a barometer above the track, m."""
        side = self.sides[source]
        if side.faulty:
            return ()
        side.total += height
        side.count += 1
        if side.read_at is not None and 0.0 <= t - side.read_at < READING_INTERVAL:
            return ()
        height = side.total / side.count
        if side.previous_height is not None:
            # the variance of consecutive differences is 2 noise + drift^2; a ride or a gust has a limited effect
            square = 0.5 * (height - side.previous_height) ** 2
            self.noise = max(measured_noise(self.noise, square, MAX_NOISE_RATIO), MIN_NOISE)
        side.read_at, side.total, side.count, side.previous_height = t, 0.0, 0, height
        return self._add_input((t, source, height, self.noise))

    def _replace_inputs(self, inputs: list[HeightInput]) -> None:
        """Process other inputs than those that are kept, and keep them instead."""
        self.inputs, self.now = [], self.base.copy()
        for entry in inputs:
            self._process(entry)

    def _height_shift(self) -> list[PartOutput]:
        return [HeightShift(self.now.values[0], self.ride_variance)]

    def reset(self, site: Site) -> None:
        """Forget the offset of a foot's barometer, because its clock restarts or another device is worn.

        What the other foot has measured is kept: a ride under way still has its start."""
        if site.foot is None:
            return
        source = SOURCES[site.foot]
        self.sides[source] = PendingReadings()
        newest = _unpack(self.inputs[-1]) if self.inputs else None
        if newest is not None and newest[1] != FORGET + 1 - source:
            self._add_input((newest[0], FORGET + source, 0.0, 0.0))
            return
        if newest is not None:
            # the clocks of both feet restart: no time that is kept can be compared with those to come
            self.inputs.clear()
            self.strides = doubles()
        self.now.read_at[source] = None
        self.base = self.now.copy()

    def _add_stride(self, stride: StrideTaken) -> Outputs:
        if stride.length >= MIN_STRIDE_LENGTH:
            self.strides.extend((round(100.0 * stride.t_start), round(100.0 * stride.t_end)))
            del self.strides[: -2 * MAX_STRIDES]
        if self.now.read_at == [None, None]:
            return ()
        height, variance = abs(stride.height_change), stride.covariance[5]
        if not LEVEL_LIMIT < height < MAX_TRACK_HEIGHT or not variance < MAX_TRACK_HEIGHT:
            return ()
        error_variance = (STRIDE_ERROR * height) ** 2 + max(0.0, variance)
        if stride.flaws:
            error_variance *= DEGRADED_FACTOR * DEGRADED_FACTOR
        # a stride moves the mean of both feet by half of its height
        return self._add_input((stride.t, MOVE, 0.0, 0.25 * error_variance))

    def _corrected_ride(self, ride: Ride) -> Ride:
        """Process the inputs since the ride's start again, and return the ride with its likeliest height."""
        start, end = ride.t_start, ride.t
        inputs = [
            entry
            for entry in map(_unpack, self.inputs)
            if entry[1] >= MOVE or not start - RIDE_MARGIN < entry[0] < end + RIDE_MARGIN
        ]
        readings = [entry for entry in inputs if entry[1] < MOVE]
        enclosed = any([entry[0] < start for entry in readings]) and any([entry[0] > end for entry in readings])
        if not enclosed and not self._is_plausible(ride):
            return evolve(ride, height=None)
        by = 0.0 if ride.height is None or not abs(ride.height) < MAX_TRACK_HEIGHT else ride.height
        variance = (RIDE_ERROR * by) ** 2 if by else UNKNOWN_VARIANCE
        previous = self.now.values[0]
        first = [entry for entry in inputs if entry[0] <= end]
        later = [entry for entry in inputs if entry[0] > end]
        self._replace_inputs([*first, (end, MOVE, by, variance), *later])
        height_gain = self.now.values[0] - previous
        self.ride_variance = min(self.ride_variance + min(variance, self.now.covariance[0]), UNKNOWN_VARIANCE)
        return evolve(ride, height=height_gain) if (height_gain > 0.0) is ride.up else ride

    def _is_plausible(self, ride: Ride) -> bool:
        """Return whether the height of a ride that only the feet's accelerometers have measured is possible."""
        height, duration = ride.height, ride.t - ride.t_start
        if height is None or not duration > 0.0 or (height > 0.0) is not ride.up:
            return False
        t_start, t_end = 100.0 * ride.t_start, 100.0 * ride.t
        is_lift = isinstance(ride, LiftRidden)
        least_height = MIN_RIDE_HEIGHT if is_lift else MIN_ESCALATOR_HEIGHT
        least_speed = MIN_RIDE_SPEED if is_lift else MIN_ESCALATOR_SPEED
        stride_count = sum([start > t_start and end < t_end for start, end in pairs(self.strides)])
        return (
            stride_count < 2 and abs(height) >= least_height and least_speed <= abs(height) / duration <= MAX_RIDE_SPEED
        )

    def _add_input(self, entry: HeightInput) -> Outputs:
        inputs = self.inputs
        while inputs and (entry[0] - inputs[0][0] / TICKS_PER_S > KEPT_TIME or len(inputs) >= MOST_INPUTS):
            self.base.apply(_unpack(inputs.pop(0)))
        self._process(entry)
        return self._height_shift()

    def _process(self, entry: HeightInput) -> None:
        """Keep an input, and process it as it is kept, which is rounded."""
        t, source, value, variance = entry
        kept = round(t * TICKS_PER_S), source, round(value * PARTS_PER_M), to_float32(variance)
        self.inputs.append(kept)
        self.now.apply(_unpack(kept))
