"""Flights of stairs: consecutive stair strides of both feet between level strides.

`Flights` works with any method that judges single strides (1 upstairs, -1 downstairs, 0 level, None: not known):

    flights = Flights()
    for each StrideTaken of either foot:  events += flights.add_stride(stride, direction)
    now and then, with the time:          events += flights.advance(t, known_at)

A flight ends after as many consecutive level strides as there are feet with sensors: a landing gives each foot at least
one level stride, while a misjudged stride in the middle of the stairs stands alone. (With one sensor a misjudged stride
splits the flight.) A flight also ends with the first stride in the other direction, and when both feet stand at one
height for `END_PAUSE` s, because a wearer need not walk on at the top. A wearer who rests on the stairs with a foot on
each tread has not arrived. Flights lower than `MIN_FLIGHT_HEIGHT` are kerbs and are not reported. Latency: that of the
level strides, about a second, or `END_PAUSE`.

A height change that is impossible on stairs (steepness.py), or that has the wrong sign, is an error of the track and is
not trusted. Such a stride is counted with the mean height of the trusted strides of the flight. When less than half of
the strides are trusted, the height is unknown and no flight is reported. A stride that cannot be judged counts as level
for the end of a flight; when a stair stride follows, the unjudged stride belongs to the flight."""

from __future__ import annotations

from math import atan2, fsum, radians

from ...events import FlightClimbed, StrideTaken
from ...types import Foot
from ...types.attrs import define, field

# Steepness of a stride, as angle per metre.
#
# Li, Liu, Liu, Chen, Ma, "3D tracking via shoe sensing" (Sensors 16, 1809, 2016), section 3.4.1 and table 1.
#
# theta' = theta / |H|: the inclination theta of a step divided by its horizontal length H. The paper's definition
# contradicts its table 1 in two points: - theta is given as arccos(Z / |S|), the angle from the vertical. That is 90
# degrees on level ground, where table 1 has
#   an average of 3.9 degrees.
# - With H as the length of a stride, 0.60 m along and 0.32 m up (section 4.2.4, fig. 28), theta' is 47 degrees per
# metre,
#   where table 1 has 107.9 upstairs and -89.5 downstairs.
#
# Both points agree with the table when theta is the angle from the horizontal, positive upwards, and H is the length of
# one tread, half a stride ("we can regard alternating feet once as one step"; a tread is 0.30 m by 0.16 m). Then theta
# is atan(0.32 / 0.60), 28.1 degrees, and theta' is 93.6 degrees per metre. Its size lies between those of both
# averages, and differs from each by at most 0.4 of its standard deviation.

LEVEL_ANGLE = radians(3.935)
"""Average angle per metre of table 1 on level ground, rad/m."""
UPSTAIRS_ANGLE = radians(107.904)
"""Average angle per metre of table 1 upstairs, rad/m."""
DOWNSTAIRS_ANGLE = radians(-89.464)
"""Average angle per metre of table 1 downstairs, rad/m."""

UPSTAIRS_THRESHOLD = 0.5 * (LEVEL_ANGLE + UPSTAIRS_ANGLE)
"""Threshold of stairs upwards: 55.9 degrees/m, half way between the averages.

The paper: "by using a threshold of the average theta'"."""
DOWNSTAIRS_THRESHOLD = 0.5 * (LEVEL_ANGLE + DOWNSTAIRS_ANGLE)
"""Threshold of stairs downwards: -42.8 degrees/m, half way between the averages."""

LEAST_RISE = 0.08
"""Least height change of a stair stride, m: half of a riser.

A foot that hardly moves always has a large angle per metre, which the paper does not mention."""
HIGHEST_RISE = 0.88
"""Largest height change of a stair stride, m: four risers of 0.22 m, for a wearer who takes two treads at a time.

The Building Regulations 2010, Approved Document K (2013), table 1.1, allow no higher riser."""
HIGHEST_DEGRADED_RISE = 0.6
"""Largest height change of a stair stride in which samples are missing, m.

A stride of one tread at a time gains 0.44 m; a third of that is added for the gap. Above that limit, a stride of two
treads at a time cannot be distinguished from a height that has drifted."""
_MIN_GROUND = 1e-3
"""Least horizontal length by which an angle is divided, m."""


def angle_per_metre(ground: float, height: float) -> float:
    """Return theta' of a stride, rad/m, with horizontal length `ground`, m, and height change `height`, m."""
    return atan2(height, ground) / max(0.5 * ground, _MIN_GROUND)


def steepness(ground: float, height: float) -> int:
    """Return 1 for a stride upstairs, -1 downstairs, 0 on the level; arguments as for `angle_per_metre`."""
    if -LEAST_RISE < height < LEAST_RISE:
        return 0
    angle = angle_per_metre(ground, height)
    return 1 if angle > UPSTAIRS_THRESHOLD else -1 if angle < DOWNSTAIRS_THRESHOLD else 0


def is_stair_rise(height: float, degraded: bool = False) -> bool:
    """Return whether a stride on stairs can have the height change `height`, m; otherwise its angle means nothing."""
    return abs(height) <= (HIGHEST_DEGRADED_RISE if degraded else HIGHEST_RISE)


MIN_FLIGHT_HEIGHT = 0.4
"""Least height of a flight, m: a little less than three risers."""
END_PAUSE = 3.0
"""Time without a stride that ends a flight when both feet stand at one height, s."""
LEVEL_TOLERANCE = 0.08
"""Largest difference in height of two feet that stand on one level, m."""
ACTIVE_TIME = 4.0
"""Longest time since a foot's last stride for which the foot counts as active, s."""
MIN_END_RISE = 0.08
"""Least rise of a level stride before or after stair strides that counts into the flight's height, m.

Such a stride takes the first or last riser of the flight."""


@define
class Flights:
    """Detects flights and returns a final `FlightClimbed` for each flight when it has ended."""

    direction: int = field(default=0, init=False)
    """Direction of the flight under way: 1 up, -1 down, 0 when there is none."""
    t_start: float = field(default=0.0, init=False)
    """Start of the flight under way, s."""
    t_end: float = field(default=0.0, init=False)
    """End of the newest stair stride of the flight under way, s."""
    stride_count: int = field(default=0, init=False)
    """Number of strides of the flight under way."""
    level_stride_count: int = field(default=0, init=False)
    """Number of level strides since the last stair stride."""
    rises: dict[Foot, float] = field(factory=dict, init=False)
    """Height gained by each foot in the flight under way, m, negative downstairs."""
    untrusted: dict[Foot, int] = field(factory=dict, init=False)
    """Number of strides of each foot in the flight under way whose height is not trusted."""
    unjudged: dict[Foot, int] = field(factory=dict, init=False)
    """Number of strides of each foot that could not be judged, since the last stair stride."""
    trusted_rise: float = field(default=0.0, init=False)
    """Sum of the height changes of the trusted stair strides of the flight under way, m."""
    heights: dict[Foot, float] = field(factory=dict, init=False)
    """Height of each foot above the last level on which both feet stood, m."""
    last_level_rise: dict[Foot, float] = field(factory=dict, init=False)
    """Height gained by each foot's last stride, m, if that was a level stride; 0 if it is not trusted."""
    last_stride_at: dict[Foot, float] = field(factory=dict, init=False)
    """Time of each foot's last stride, s."""

    def reset(self) -> None:
        """Discard the flight under way, because the clock restarts."""
        self.direction = 0
        self.heights, self.last_level_rise, self.last_stride_at = {}, {}, {}

    def add_stride(self, stride: StrideTaken, direction: int | None) -> list[FlightClimbed]:
        """Add a stride of either foot and return the flights that it ends.

        `direction` is 1 upstairs, -1 downstairs, 0 level, None when it could not be judged."""
        foot, height = stride.foot, stride.height_change
        trusted = direction is not None and is_stair_rise(height, stride.degraded)
        events: list[FlightClimbed] = []
        if direction and self.direction not in (0, direction):
            self._end(stride.known_at, events)
        if direction:
            if self.direction == 0:
                self._start(stride, direction)
            self._add_stair_stride(stride, direction, trusted and direction * height > -LEAST_RISE)
        elif self.direction != 0:
            self.level_stride_count += 1
            if direction is None:
                self.unjudged[foot] = self.unjudged.get(foot, 0) + 1
            if trusted and self.direction * height > MIN_END_RISE and foot in self.rises:
                self._add_rise(foot, height)
            else:
                self.last_level_rise[foot] = height if trusted else 0.0
            if self.level_stride_count >= self._count_active_feet(foot, stride.t):
                self._end(stride.known_at, events)
                self.heights = {}
        else:
            self.last_level_rise[foot] = height if trusted else 0.0
        self.last_stride_at[foot] = stride.t
        return events

    def _add_stair_stride(self, stride: StrideTaken, direction: int, trusted: bool) -> None:
        foot, height = stride.foot, stride.height_change
        self.t_end = max(self.t_end, stride.t)
        self.level_stride_count = 0
        self.stride_count += 1
        level_rise = self.last_level_rise.pop(foot, 0.0)
        if trusted:
            self.trusted_rise += height
            self._add_rise(foot, height + (level_rise if direction * level_rise > MIN_END_RISE else 0.0))
        else:
            self.untrusted[foot] = self.untrusted.get(foot, 0) + 1
        for other, stride_count in self.unjudged.items():
            self.stride_count += stride_count
            self.untrusted[other] = self.untrusted.get(other, 0) + stride_count
        self.unjudged = {}

    def advance(self, t: float, known_at: float) -> list[FlightClimbed]:
        """Return the flight that has ended at `t`, s, because no stride came for `END_PAUSE` s."""
        events: list[FlightClimbed] = []
        if self.direction != 0 and t - max(self.last_stride_at.values(), default=t) > END_PAUSE:
            feet_heights = list(self.heights.values())
            # without the heights of all strides, the heights of the feet cannot show a rest on the stairs
            if self.untrusted or self.unjudged or max(feet_heights) - min(feet_heights) < LEVEL_TOLERANCE:
                self._end(known_at, events)
                self.heights = {}
        return events

    def finish(self, known_at: float) -> list[FlightClimbed]:
        """Return the flight under way, because no more strides come."""
        events: list[FlightClimbed] = []
        if self.direction != 0:
            self._end(known_at, events)
        return events

    def _start(self, stride: StrideTaken, direction: int) -> None:
        self.direction = direction
        self.t_start, self.t_end = stride.t_start, stride.t
        self.stride_count = self.level_stride_count = 0
        self.rises, self.untrusted, self.unjudged = {}, {}, {}
        self.trusted_rise = 0.0

    def _add_rise(self, foot: Foot, height: float) -> None:
        self.rises[foot] = self.rises.get(foot, 0.0) + height
        self.heights[foot] = self.heights.get(foot, 0.0) + height

    def _count_active_feet(self, foot: Foot, t: float) -> int:
        """Return the number of feet with a stride shortly before `t`, s, including `foot`."""
        others = [at for other, at in self.last_stride_at.items() if other is not foot]
        return 1 + sum([abs(t - at) < ACTIVE_TIME for at in others])

    def _end(self, known_at: float, events: list[FlightClimbed]) -> None:
        untrusted = sum(self.untrusted.values())  # whole numbers
        trusted_count = self.stride_count - untrusted
        height = 0.0
        if 0 < trusted_count >= untrusted:
            feet = len(self.rises | self.untrusted)
            height = (fsum(self.rises.values()) + untrusted * self.trusted_rise / trusted_count) / feet
        if self.direction * height >= MIN_FLIGHT_HEIGHT and self.stride_count > 1:
            events.append(
                FlightClimbed(
                    t=self.t_end,
                    known_at=max(known_at, self.t_end),
                    t_start=min(self.t_start, self.t_end),
                    up=self.direction > 0,
                    steps=self.stride_count,
                    height=height,
                )
            )
        self.direction = 0
        self.last_level_rise = {}
        if untrusted:
            self.heights, self.untrusted = {}, {}
