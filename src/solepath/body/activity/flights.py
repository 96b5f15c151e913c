"""Flights of stairs: consecutive stair strides of the feet between level ones.

It serves any method that judges strides one by one (1 upstairs, -1 downstairs, 0 on the level, None: not known):

    flights = Flights()
    for each StrideTaken of either foot:  events += flights.add_stride(stride, direction)
    now and then, with the time:          events += flights.advance(t, known_at)

A flight ends when as many level strides follow each other as feet give strides: a landing gives each foot at least one,
while a stride that is misjudged in the middle of the stairs stands alone (with one foot it splits the flight). It also
ends with the first stride in the other direction, and when both feet stand at one height for `END_PAUSE` s: at the top
nobody need walk on, and a wearer who rests on the stairs with a foot on each tread is not there yet. Flights lower than
`LEAST_HEIGHT` are kerbs. Latency: that of the level strides, about a second, or `END_PAUSE`.

A height that no stair stride has (body/activity/steepness.py), or one in the other direction, is an error of the track
and is not trusted: such a stride is taken to rise by the mean of the trusted strides of the flight. Where less than
half of the strides are trusted the height is unknown, and no flight is reported. A stride that cannot be judged ends
flights as level ones do, and belongs to the flight when a stair stride follows it."""

from __future__ import annotations

from ...events import FlightClimbed, StrideTaken
from ...types import Foot
from ...types.attrs import define, field
from .steepness import LEAST_RISE, is_stair_rise

LEAST_HEIGHT = 0.4
"""Least height of a flight, m: less than three risers."""
END_PAUSE = 3.0
"""Time without another stair stride that ends a flight, s."""
LEVEL_TOLERANCE = 0.08
"""Largest difference in height of two feet that stand on one level, m."""
ACTIVE_WITHIN = 4.0
"""Time since a foot's last stride in which it counts as active, s."""
END_RISE = 0.08
"""Least rise of a level stride beside stair strides that belongs to the flight, m.

It is the flight's first or last riser, taken with a long stride."""


@define
class Flights:
    """Detects flights and returns a final `FlightClimbed` for each as soon as it is over."""

    direction: int = field(default=0, init=False)
    """Direction of the flight under way: 1 up, -1 down, 0 when there is none."""
    t_start: float = field(default=0.0, init=False)
    """Start of the flight under way, s."""
    t_end: float = field(default=0.0, init=False)
    """End of its newest stair stride, s."""
    strides: int = field(default=0, init=False)
    """Number of strides of the flight under way."""
    level: int = field(default=0, init=False)
    """Number of level strides since the last stair stride."""
    rises: dict[Foot, float] = field(factory=dict, init=False)
    """Height gained by each foot in this flight, m."""
    untrusted: dict[Foot, int] = field(factory=dict, init=False)
    """Number of strides of each foot in this flight whose height is not trusted."""
    unjudged: dict[Foot, int] = field(factory=dict, init=False)
    """Number of strides of each foot since the last stair stride that could not be judged."""
    trusted_rise: float = field(default=0.0, init=False)
    """Sum of the heights of the trusted stair strides of this flight, m."""
    heights: dict[Foot, float] = field(factory=dict, init=False)
    """Height of each foot above the last level on which both stood, m."""
    level_rises: dict[Foot, float] = field(factory=dict, init=False)
    """Height gained by each foot's last stride, when that was a level one, m."""
    stride_at: dict[Foot, float] = field(factory=dict, init=False)
    """Time of each foot's last stride, s."""

    def reset(self) -> None:
        """Discard the flight under way: the clock restarts."""
        self.direction = 0
        self.heights, self.level_rises, self.stride_at = {}, {}, {}

    def add_stride(self, stride: StrideTaken, direction: int | None) -> list[FlightClimbed]:
        """Add a stride of either foot that goes upstairs (1), downstairs (-1), neither (0), or is not judged (None)."""
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
            self.level += 1
            if direction is None:
                self.unjudged[foot] = self.unjudged.get(foot, 0) + 1
            if trusted and self.direction * height > END_RISE and foot in self.rises:
                self._add_rise(foot, height)
            else:
                self.level_rises[foot] = height if trusted else 0.0
            if self.level >= self._active_feet(foot, stride.t):
                self._end(stride.known_at, events)
                self.heights = {}
        else:
            self.level_rises[foot] = height if trusted else 0.0
        self.stride_at[foot] = stride.t
        return events

    def _add_stair_stride(self, stride: StrideTaken, direction: int, trusted: bool) -> None:
        foot, height = stride.foot, stride.height_change
        self.t_end = max(self.t_end, stride.t)
        self.level = 0
        self.strides += 1
        first = self.level_rises.pop(foot, 0.0)
        if trusted:
            self.trusted_rise += height
            self._add_rise(foot, height + (first if direction * first > END_RISE else 0.0))
        else:
            self.untrusted[foot] = self.untrusted.get(foot, 0) + 1
        for other, strides in self.unjudged.items():
            self.strides += strides
            self.untrusted[other] = self.untrusted.get(other, 0) + strides
        self.unjudged = {}

    def advance(self, t: float, known_at: float) -> list[FlightClimbed]:
        """Return the flight that is over at `t` s because no stride has come since."""
        events: list[FlightClimbed] = []
        if self.direction != 0 and t - max(self.stride_at.values(), default=t) > END_PAUSE:
            feet_heights = list(self.heights.values())
            # when a stride's height is not known, it is not known either whether the feet stand on one level
            if self.untrusted or self.unjudged or max(feet_heights) - min(feet_heights) < LEVEL_TOLERANCE:
                self._end(known_at, events)
                self.heights = {}
        return events

    def finish(self, known_at: float) -> list[FlightClimbed]:
        """Return the flight under way: no more strides come."""
        events: list[FlightClimbed] = []
        if self.direction != 0:
            self._end(known_at, events)
        return events

    def _start(self, stride: StrideTaken, direction: int) -> None:
        self.direction = direction
        self.t_start, self.t_end = stride.t_start, stride.t
        self.strides = self.level = 0
        self.rises, self.untrusted, self.unjudged = {}, {}, {}
        self.trusted_rise = 0.0

    def _add_rise(self, foot: Foot, height: float) -> None:
        self.rises[foot] = self.rises.get(foot, 0.0) + height
        self.heights[foot] = self.heights.get(foot, 0.0) + height

    def _active_feet(self, foot: Foot, t: float) -> int:
        """Return the number of feet that give strides."""
        others = [at for other, at in self.stride_at.items() if other is not foot]
        return 1 + sum([abs(t - at) < ACTIVE_WITHIN for at in others])

    def _end(self, known_at: float, events: list[FlightClimbed]) -> None:
        untrusted = sum(self.untrusted.values())
        known = self.strides - untrusted
        height = 0.0
        if 0 < known >= untrusted:
            feet = len(self.rises | self.untrusted)
            height = (sum(self.rises.values()) + untrusted * self.trusted_rise / known) / feet
        if self.direction * height >= LEAST_HEIGHT and self.strides > 1:
            events.append(
                FlightClimbed(
                    t=self.t_end,
                    known_at=max(known_at, self.t_end),
                    t_start=min(self.t_start, self.t_end),
                    up=self.direction > 0,
                    steps=self.strides,
                    height=height,
                )
            )
        self.direction = 0
        self.level_rises = {}
        if untrusted:
            self.heights, self.untrusted = {}, {}
