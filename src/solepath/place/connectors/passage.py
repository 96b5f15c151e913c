"""Passage over stairs or by elevator: its times, height and direction, as far as they are known."""

from __future__ import annotations

from math import hypot

from ...floorplan.plan import ConnectorKind
from ...types import Foot, Vec3
from ...types.attrs import define, field

RISER_HEIGHT = 0.165
"""Height of one riser of stairs, m, used when neither the track gives a height nor the plan its risers'."""
MAX_LENGTH_RATIO, LANDING_LENGTH = 2.5, 4.0
"""Largest horizontal length of stairs as a multiple of their height, and additional length for landings, m."""
MIN_TRACK_SHARE = 0.5
"""Least height by the track that is used on stairs, as a share of the height by counted risers."""
MIN_TRACK_HEIGHT, MIN_RIDE_HEIGHT = 0.3, 1.0
"""Least heights by the track that are used on stairs and after a ride, m."""
MAX_REST, MAX_LANDING_WIDTH = 120.0, 6.0
"""Longest rest on a half-way landing, s, and largest distance between the flights that meet there, m (assumed)."""
MAX_SPANS = 6
"""Largest number of spans that are kept; the oldest two become one, which later reports revise together."""


@define
class StairSpan:
    """The strides of stairs that were reported in one direction, or reports without strides."""

    t: float
    """Time from which the activity was reported, s."""
    net_up: int = 0
    """Number of strides, or of reports without strides, upwards minus the number downwards."""
    left: int = 0
    """Number of strides of the left foot."""
    right: int = 0
    """Number of strides of the right foot."""


@define
class Passage:
    """A passage over stairs or by elevator."""

    kind: ConnectorKind
    t: float
    """Start of the passage, s."""
    start: Vec3
    """Position of the track at the start, m."""
    spans: list[StairSpan] = field(factory=list)
    """The stairs and flights that were reported of it, the oldest first."""
    flight_height: float = 0.0
    """Sum of the heights of the flights, m, positive upwards."""
    t_left: float | None = None
    """Time at which the wearer left the stairs or the elevator, s; None before."""
    end: Vec3 | None = None
    """Position of the track at `t_left`, m."""
    strides_since: int = 0
    """Number of strides since `t_left`."""
    riser: float = RISER_HEIGHT
    """Height of one riser of the stairs, m."""
    flights: int = 0
    """Number of flights upwards minus the number downwards."""
    height_before: float = 0.0
    """Height up to the half-way landing at which the passage starts, m, positive upwards; 0 from a level on."""

    def report(self, t: float, up: bool, revises: float | None) -> None:
        """Count further strides in the direction that is reported from `t`, s, on, and revise those reported before.

        The report replaces every one from `revises`, s, on (None: none), and is repeated whenever one before it is
        revised. So the direction is that of the whole stretch, whatever was reported of it at first."""
        since = t if revises is None else min(t, revises)
        for span in self.spans:
            if span.t >= since:
                strides = span.left + span.right
                span.net_up = strides if up else -strides
        self.spans = [*[span for span in self.spans if span.left + span.right], StairSpan(t)]
        if len(self.spans) > MAX_SPANS:
            old, one = self.spans[:2]
            merged = StairSpan(old.t, old.net_up + one.net_up, old.left + one.left, old.right + one.right)
            self.spans[:2] = [merged]

    def add_direction(self, up: bool, foot: Foot | None = None) -> None:
        """Add a stride of a foot to the newest report, or a report of the direction alone if there is no foot."""
        if not self.spans:
            self.spans.append(StairSpan(self.t))
        span = self.spans[-1]
        span.net_up += 1 if up else -1
        span.left, span.right = span.left + (foot is Foot.LEFT), span.right + (foot is Foot.RIGHT)

    @property
    def net_up(self) -> int:
        """Number of strides (stairs) or reports (elevator, lone flight) upwards minus the number downwards."""
        return sum([span.net_up for span in self.spans])  # whole numbers

    @property
    def strides(self) -> int:
        """Number of strides of both feet on the stairs."""
        return sum([span.left + span.right for span in self.spans])  # whole numbers

    @property
    def _risers_per_stride(self) -> float:
        # a stride of one foot climbs two risers; with both feet there is a stride for each riser
        left, right = any([span.left for span in self.spans]), any([span.right for span in self.spans])
        return 1.0 if left and right else 2.0

    def height(self, here: Vec3) -> float | None:
        """Return the height, m, not negative, by the track or else by flights or counted risers; None when unknown."""
        if self.kind is ConnectorKind.LIFT:
            track = self._track_height(here)
            return track if track > MIN_RIDE_HEIGHT else None
        return abs(self.height_signed(here))

    def height_signed(self, here: Vec3) -> float:
        """Return the height of stairs from the last level on, m, positive upwards."""
        own = self._track_height(here) if self.is_measured(here) else max(abs(self.flight_height), self._counted_height)
        return self.height_before + (own if self.net_up > 0 else -own)

    def is_continued(self, t: float, start: Vec3) -> bool:
        """Return whether stairs that start at `t`, s, and `start`, m, continue this passage from a half-way landing."""
        if self.t_left is None or self.end is None or not 0.0 <= t - self.t_left <= MAX_REST:
            return False
        return hypot(start[0] - self.end[0], start[1] - self.end[1]) <= MAX_LANDING_WIDTH

    def is_measured(self, here: Vec3) -> bool:
        """Return whether the height of the track can be used for stairs."""
        track = self._track_height(here)
        return track > MIN_TRACK_SHARE * self._counted_height and track > MIN_TRACK_HEIGHT

    def measured_up(self, here: Vec3) -> bool | None:
        """Return whether stairs lead up by the track and by what was reported; None if one of them does not say so."""
        rise = (here if self.end is None else self.end)[2] - self.start[2]
        return rise > 0.0 if self.is_measured(here) and (rise > 0.0) == (self.net_up > 0) else None

    def _track_height(self, here: Vec3) -> float:
        return abs((here if self.end is None else self.end)[2] - self.start[2])

    @property
    def _counted_height(self) -> float:
        # only strides in the direction of the majority count: the others may be wrong or not on stairs
        return self.riser * 0.5 * (self.strides + abs(self.net_up)) * self._risers_per_stride

    @property
    def height_one_way(self) -> float:
        """Height, m, if all strides had the same direction, whatever direction was reported."""
        return abs(self.height_before) + self.riser * self.strides * self._risers_per_stride

    @property
    def opposite_share(self) -> float:
        """Share of the strides whose reported direction differs from that of the majority."""
        strides, net_up = self.strides, abs(self.net_up)
        return 0.5 * (1.0 - net_up / strides) if self.kind is ConnectorKind.STAIRS and strides > net_up else 0.0

    def leads_away(self, here: Vec3) -> bool:
        """Return whether the passage is horizontally longer than stairs of its height can be."""
        if self.kind is ConnectorKind.LIFT:
            return False
        end = here if self.end is None else self.end
        distance = hypot(end[0] - self.start[0], end[1] - self.start[1])
        return distance > MAX_LENGTH_RATIO * (self.height(end) or 0.0) + LANDING_LENGTH
