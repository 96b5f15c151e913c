"""Flights of stairs: consecutive stair strides of both feet between level strides.

`Flights` works with any method that judges single strides (1 upstairs, -1 downstairs, 0 level, None: not known):

    flights = Flights()
    for each StrideTaken of either foot:  events += flights.add_stride(FlightStride.of(stride), direction, judged_at)
    now and then, with the time:          events += flights.advance(t, known_at)

A flight ends after as many consecutive level strides as there are feet with sensors: a landing gives each foot at least
one level stride, while a misjudged stride in the middle of the stairs stands alone. (With one sensor a misjudged stride
splits the flight.) A flight also ends with the first stride in the other direction, and when both feet stand at one
height for `END_PAUSE` s, because a wearer need not walk on at the top. A wearer who rests on the stairs with a foot on
each tread has not arrived. Flights lower than `MIN_FLIGHT_HEIGHT` are kerbs and are not reported. Latency: that of the
level strides, about a second, or `END_PAUSE`.

A height change that is impossible on stairs (`is_stair_rise`), or of the wrong sign, is an error of the track and is
not trusted. Such a stride is counted with the mean height of the trusted strides of the flight. When less than half of
the strides are trusted, the height is unknown and no flight is reported. A stride that cannot be judged counts as level
for the end of a flight; when a stair stride follows, the unjudged stride belongs to the flight."""

from __future__ import annotations

from math import fsum
from typing import NamedTuple

from ...events import FlightClimbed, StrideTaken
from ...types import Foot, PerFoot, per_foot
from ...types.attrs import define, state, stateful

LEAST_RISE = 0.08
"""Least height change of a stair stride, m: half of a riser."""
HIGHEST_RISE = 0.88
"""Largest height change of a stair stride, m: four risers of 0.22 m, for a wearer who takes two treads at a time.

The Building Regulations 2010, Approved Document K (2013), table 1.1, allow no higher riser."""
HIGHEST_DEGRADED_RISE = 0.6
"""Largest height change of a stair stride that has a flaw, m.

A stride of one tread at a time gains 0.44 m; a third of that is added for the gap. Above that limit, a stride of two
treads at a time cannot be distinguished from a height that has drifted."""


def is_stair_rise(height: float, degraded: bool = False) -> bool:
    """Return whether a stride on stairs can have the height change `height`, m; otherwise it is an error."""
    return abs(height) <= (HIGHEST_DEGRADED_RISE if degraded else HIGHEST_RISE)


def integrated_rise(stride: StrideTaken) -> float:
    """Return the height change of a stride as it was integrated, m, whether or not the way was found to be level."""
    return stride.height_change if stride.features.rise is None else stride.features.rise


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


class FlightStride(NamedTuple):
    """What flights need of a stride."""

    foot: Foot
    """Foot that made the stride."""
    t_start: float
    """Start of the stride, s."""
    t_end: float
    """End of the stride, s."""
    height_change: float
    """Height at the end above that at the start, m."""
    known_at: float
    """Time at which the stride was known, s."""
    is_flawed: bool
    """Flag: the stride has flaws."""

    @classmethod
    def of(cls, stride: StrideTaken) -> FlightStride:
        """Return what flights need of `stride`."""
        return cls(stride.foot, stride.t_start, stride.t_end, stride.height_change, stride.known_at, bool(stride.flaws))


@define
class FootClimb:
    """The strides of one foot, as far as flights need them."""

    stride_at: float | None = None
    """Time of the last stride, s; None before any."""
    height: float | None = None
    """Height above the last level on which both feet stood, m; None while the foot has not left it."""
    level_rise: float = 0.0
    """Height gained by the last stride, m, if that was a level stride; 0 if it is not trusted."""
    rise: float | None = None
    """Height gained in the flight under way, m, negative downstairs; None without any trusted stride."""
    untrusted: int = 0
    """Number of strides in the flight under way whose height is not trusted."""
    unjudged: int = 0
    """Number of strides that could not be judged, since the last stair stride."""

    def add(self, height: float) -> None:
        """Add the height change of a stride of the flight, m."""
        self.rise = (self.rise or 0.0) + height
        self.height = (self.height or 0.0) + height


@stateful
class Flights:
    """Detects flights and returns a final `FlightClimbed` for each flight when it has ended."""

    direction: int = 0
    """Direction of the flight under way: 1 up, -1 down, 0 when there is none."""
    t_start: float = 0.0
    """Start of the flight under way, s."""
    t_end: float = 0.0
    """End of the newest stair stride of the flight under way, s."""
    stride_count: int = 0
    """Number of strides of the flight under way."""
    level_stride_count: int = 0
    """Number of level strides since the last stair stride."""
    trusted_rise: float = 0.0
    """Sum of the height changes of the trusted stair strides of the flight under way, m."""
    feet: PerFoot[FootClimb] = state(factory=lambda: per_foot(FootClimb))

    def reset(self) -> None:
        """Discard the flight under way, because the clock restarts or another device is worn."""
        self.direction, self.feet = 0, per_foot(FootClimb)

    def add_stride(self, stride: FlightStride, direction: int | None, judged_at: float) -> list[FlightClimbed]:
        """Add a stride of either foot that is judged at `judged_at`, s, and return the flights that it ends.

        `direction` is 1 upstairs, -1 downstairs, 0 level, None when it could not be judged."""
        known_at = max(judged_at, stride.known_at)
        foot, height = self.feet[stride.foot], stride.height_change
        trusted = direction is not None and is_stair_rise(height, stride.is_flawed)
        events: list[FlightClimbed] = []
        if direction:
            if self.direction == -direction:
                events = self.finish(known_at)
            if self.direction == 0:
                self._start(stride, direction)
            self._add_stair_stride(stride, direction, trusted and direction * height > -LEAST_RISE)
        else:
            if trusted and self.direction * height > MIN_END_RISE and foot.rise is not None:
                foot.add(height)
            else:
                foot.level_rise = height if trusted else 0.0
            if self.direction != 0:
                self.level_stride_count += 1
                foot.unjudged += direction is None
                others = [one.stride_at for one in self.feet.values() if one is not foot and one.stride_at is not None]
                active = 1 + sum([abs(stride.t_end - at) < ACTIVE_TIME for at in others])  # with a stride just now
                if self.level_stride_count >= active:
                    events = self._arrive(known_at)
        foot.stride_at = stride.t_end
        return events

    def _add_stair_stride(self, stride: FlightStride, direction: int, trusted: bool) -> None:
        foot, height = self.feet[stride.foot], stride.height_change
        self.t_end = max(self.t_end, stride.t_end)
        self.level_stride_count = 0
        self.stride_count += 1
        level_rise, foot.level_rise = foot.level_rise, 0.0
        if trusted:
            self.trusted_rise += height
            foot.add(height + (level_rise if direction * level_rise > MIN_END_RISE else 0.0))
        else:
            foot.untrusted += 1
        for each in self.feet.values():
            self.stride_count += each.unjudged
            each.untrusted, each.unjudged = each.untrusted + each.unjudged, 0

    def advance(self, t: float, known_at: float) -> list[FlightClimbed]:
        """Return the flight that has ended at `t`, s, because no stride came for `END_PAUSE` s."""
        feet = self.feet.values()
        strides_at = [foot.stride_at for foot in feet if foot.stride_at is not None]
        if self.direction == 0 or t - max(strides_at) <= END_PAUSE:
            return []
        heights = [foot.height for foot in feet if foot.height is not None]
        # without the heights of all strides, the heights of the feet cannot show a rest on the stairs
        are_known = not any([foot.untrusted or foot.unjudged for foot in feet])
        if are_known and max(heights) - min(heights) >= LEVEL_TOLERANCE:
            return []
        return self._arrive(known_at)

    def _start(self, stride: FlightStride, direction: int) -> None:
        self.direction = direction
        self.t_start, self.t_end = stride.t_start, stride.t_end
        self.stride_count = self.level_stride_count = 0
        self.trusted_rise = 0.0
        for foot in self.feet.values():
            foot.rise, foot.untrusted, foot.unjudged = None, 0, 0

    def _arrive(self, known_at: float) -> list[FlightClimbed]:
        """Return the flight under way, after which both feet stand on one level."""
        events = self.finish(known_at)
        for foot in self.feet.values():
            foot.height = None
        return events

    def finish(self, known_at: float) -> list[FlightClimbed]:
        """Return the flight under way, because no more strides come."""
        if self.direction == 0:
            return []
        feet = self.feet.values()
        untrusted = sum([foot.untrusted for foot in feet])  # whole numbers
        trusted_count = self.stride_count - untrusted
        height = 0.0
        if 0 < trusted_count >= untrusted:
            rises = [foot.rise or 0.0 for foot in feet if foot.rise is not None or foot.untrusted]
            height = (fsum(rises) + untrusted * self.trusted_rise / trusted_count) / len(rises)
        up, self.direction = self.direction > 0, 0
        for foot in feet:
            foot.level_rise = 0.0
            if untrusted:
                foot.height, foot.untrusted = None, 0
        if (height if up else -height) < MIN_FLIGHT_HEIGHT or self.stride_count < 2:
            return []
        return [
            FlightClimbed(
                t=self.t_end,
                known_at=max(known_at, self.t_end),
                t_start=min(self.t_start, self.t_end),
                up=up,
                steps=self.stride_count,
                height=height,
            )
        ]
