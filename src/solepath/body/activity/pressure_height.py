"""Height from air pressure in blocks (half seconds), and what it says for and against stairs and elevators.

The barometers of two feet drift apart by metres while a session lasts, so each has an offset from their common height,
which follows the difference of their readings. The noise of a reading is measured, because it is 0.1 m with one
barometer and 0.5 m with another: the second difference of three readings has six times its variance, whatever the
wearer's vertical velocity."""

from __future__ import annotations

from math import fsum, log

from ...types import OTHER, Floats, Foot
from ...types.attrs import define, field
from ..altitude import height_of, measured_noise
from .chain import ELEVATOR_CREEPS_DOWN, ELEVATOR_CREEPS_UP, STAND
from .hypotheses import BLOCKS_AFTER, BLOCKS_BEFORE, NO_EVIDENCE, Height

AIR_NOISE = 0.2
"""Standard deviation of the height over a block by doors and wind, m: 2.4 Pa (assumed)."""
FIRST_READING_NOISE, LEAST_READING_NOISE = 0.3, 0.02
"""Standard deviation of the height of one reading before any is known, and the least one, m."""
MAX_NOISE_RATIO = 9.0
"""Largest square that one reading adds to the measured noise, as a ratio to the noise.

A door that opens, or a ride that starts, has a limited effect."""
OFFSET_WEIGHT = 0.05
"""Least weight of a difference of both barometers in their offsets: twenty readings, while they drift by 0.01 m/s."""
MAX_AGE = 3
"""Age of the other barometer's newest reading up to which both are compared, blocks."""
MOST_BLOCKS = BLOCKS_BEFORE + BLOCKS_AFTER + 5
"""Number of blocks that are kept: those of a slope, and some that wait until both feet have sent theirs."""
MIN_SLOPE_SPAN = 1.0
"""Least time between the first and the last of these blocks with air pressure, s."""
SLOPE_WEIGHT = 1.0 / 3.0
"""Weight of one slope's log-likelihood; it is below 1 because neighbouring slopes share samples."""
MAX_SLOPE_PENALTY = 0.6
"""Largest penalty by a slope (natural logarithm).

A door that opens changes five slopes. Together they may say as much as a change over a whole stretch (`DOOR_SHARE`)."""

_RIDE_SLOPES = ((0.6, 0.6), (1.3, 0.8), (0.6, 0.6), (0.2, 0.2), (0.1, 0.2))
_SLOPE_OF_STATE = (
    *((0.0, 0.05), (0.0, 0.15), (0.0, 0.25), (0.3, 0.15), (-0.3, 0.15), (0.0, 1.0)),
    *_RIDE_SLOPES,
    *[(-mean, deviation) for mean, deviation in _RIDE_SLOPES],
)
"""Mean and standard deviation of the vertical velocity in each state, m/s, positive upwards.

Stairs are climbed at two treads per second; elevators move at 0.5 to 2.5 m/s."""


@define
class BarometerReadings:
    """The newest readings of one barometer and its offset."""

    offset: float
    """Height by this barometer minus the common height, m."""
    index: int
    """Number of the block of the newest reading."""
    newest: float
    """Height of the newest reading, m above standard pressure."""
    previous: float | None = None
    """Height of the reading before it, m; None before any."""


@define
class PressureHeight:
    """The mean heights of the newest blocks (the last few seconds), by the barometers of both feet."""

    barometers: dict[Foot, BarometerReadings] = field(factory=dict)
    noise: float = FIRST_READING_NOISE * FIRST_READING_NOISE
    """Variance of the height of one reading, m^2."""
    compared: int = 0
    """Number of readings that were compared with the other barometer's, at most 1 / `OFFSET_WEIGHT`."""
    newest: float = 0.0
    """Newest height, m above the first reading."""
    blocks: list[tuple[int, float, int]] = field(factory=list)
    """Number, mean height, m, and number of readings of each of the newest blocks, in the order of their numbers."""
    faulty: list[Foot] = field(factory=list)
    """Feet whose barometers contradict the strides, and are left out."""

    def add(self, foot: Foot, index: int, pressure: float) -> None:
        """Add a foot's air pressure, Pa, to the block number `index`."""
        height = height_of(pressure)
        if height is None or foot in self.faulty:
            return
        barometer = self.barometers.get(foot)
        if barometer is None:
            # a barometer that is read later starts at the height of the other one
            self.barometers[foot] = BarometerReadings(height - self.newest, index, height)
        else:
            if barometer.previous is not None:
                bend = height - 2.0 * barometer.newest + barometer.previous
                noise = measured_noise(self.noise, bend * bend / 6.0, MAX_NOISE_RATIO)
                self.noise = max(noise, LEAST_READING_NOISE * LEAST_READING_NOISE)
            barometer.index, barometer.newest, barometer.previous = index, height, barometer.newest
            self._compare(foot, barometer)
            self.newest = height - barometer.offset
        self._add_to_block(index)

    def _compare(self, foot: Foot, barometer: BarometerReadings) -> None:
        """Move the offsets of both barometers so that their heights come closer; their mean stays."""
        other = self.barometers.get(OTHER[foot])
        if other is not None and 0 <= barometer.index - other.index <= MAX_AGE:
            self.compared = min(self.compared + 1, round(1.0 / OFFSET_WEIGHT))
            difference = barometer.newest - barometer.offset - other.newest + other.offset
            barometer.offset += 0.5 * difference / self.compared
            other.offset -= 0.5 * difference / self.compared

    def leave_out(self, foot: Foot) -> None:
        """Stop to use a foot's barometer, and forget the heights to which it has contributed."""
        self.restart(foot)
        self.faulty.append(foot)
        self.blocks.clear()

    def restart(self, foot: Foot) -> None:
        """Forget what is known of a foot's barometer, in whose place another one may be."""
        self.barometers.pop(foot, None)
        if foot in self.faulty:
            self.faulty.remove(foot)

    def _add_to_block(self, index: int) -> None:
        """Add the newest height to its block; a foot whose samples come later adds to blocks before the last one."""
        blocks, k = self.blocks, len(self.blocks)
        while k > 0 and blocks[k - 1][0] > index:
            k -= 1
        if k > 0 and blocks[k - 1][0] == index:
            _, mean, count = blocks[k - 1]
            blocks[k - 1] = (index, mean + (self.newest - mean) / (count + 1), count + 1)
        else:
            blocks.insert(k, (index, self.newest, 1))
            del blocks[:-MOST_BLOCKS]

    def height(self, first: int, last: int) -> Height | None:
        """Return the mean height over the blocks `first` to `last`; None when they have no pressure."""
        near = [(height, count) for index, height, count in self.blocks if first <= index <= last]
        readings = sum([count for _, count in near])  # whole numbers
        if not readings:
            return None
        mean = fsum([height * count for height, count in near]) / readings
        return mean, AIR_NOISE * AIR_NOISE + self.noise / readings

    def score_slope(self, index: int, block: float) -> Floats:
        """Return the log-likelihood of the slope around block number `index` for each state, relative to the best.

        `block` is the duration of a block, s."""
        air = AIR_NOISE * AIR_NOISE
        near = [
            (i * block, height, 1.0 / (air + self.noise / count))
            for i, height, count in self.blocks
            if index - BLOCKS_BEFORE <= i <= index + BLOCKS_AFTER
        ]
        if len(near) < 3 or near[-1][0] - near[0][0] < MIN_SLOPE_SPAN:
            return NO_EVIDENCE
        weights = fsum([weight for _, _, weight in near])
        middle = fsum([weight * t for t, _, weight in near]) / weights
        spread = fsum([weight * (t - middle) ** 2 for t, _, weight in near])
        slope = fsum([weight * (t - middle) * height for t, height, weight in near]) / spread
        variance = 1.0 / spread
        scores = []
        for mean, deviation in _SLOPE_OF_STATE:
            total = variance + deviation * deviation
            scores.append(-0.5 * (min((slope - mean) ** 2 / total, 1e3) + log(total)))
        # an escalator carries a standing wearer no faster than an elevator creeps
        scores[STAND] = max(scores[STAND], scores[ELEVATOR_CREEPS_UP], scores[ELEVATOR_CREEPS_DOWN])
        best = max(scores)
        return tuple([max(SLOPE_WEIGHT * (score - best), -MAX_SLOPE_PENALTY) for score in scores])
