"""Flights of stairs: stair strides of the feet that follow each other between level ones.

For whoever judges strides one by one, whatever the method:

    flights = Flights()
    for each StrideTaken of either foot:  events += flights.stepped(step, 1 upstairs, -1 downstairs, 0 on the level,
                                                                        None: its judge cannot tell)
    now and then, with the time:        events += flights.waited(t, known_at)

A flight is over when as many level strides follow each other as feet are heard: a landing gives each foot at least one,
while a stride that is misjudged in the middle of the stairs stands alone (with one foot it parts the flight). It is
over as well with the first stride the other way, and when both feet stand at one height for `PATIENCE` s: at the top
nobody need walk on, and who rests on the stairs with a foot on each tread is not there yet. What is lower than
`LEAST_HEIGHT` is a kerb. Latency: that of the level strides, about a second, or `PATIENCE`.

What no stride of stairs gains (body/activity/steepness.py), or one the other way, is an error of the track and is not
believed: such a stride is taken to rise by the mean of those of the flight that are, and where these are not even half
of them there is no height to tell, and no flight is told. A stride that nobody can judge parts flights as level ones
do, and is one of the flight when a stair stride follows it.
"""

from __future__ import annotations

from ...events import FlightClimbed, StrideTaken
from ...types import Foot
from ...types.attrs import define, field
from .steepness import LEAST_RISE, of_stairs

LEAST_HEIGHT = 0.4
"""m: less than three risers."""
PATIENCE = 3.0
"""A flight without another step up or down for so long is over, s."""
EVEN = 0.08
"""Feet whose heights differ by less stand on one level, m."""
HEARD_WITHIN = 4.0
"""A foot that has not stepped for longer than this is not heard, s."""
END_RISE = 0.08
"""A level stride that rises more than this beside a flight's stair strides is the flight's first or last riser, taken
with a long stride, m."""


@define
class Flights:
    """Counts flights; emits a final `FlightClimbed` for each as soon as it is over."""

    way: int = field(default=0, init=False)
    """1 up, -1 down, 0 when no flight is under way."""
    t_start: float = field(default=0.0, init=False)
    t_end: float = field(default=0.0, init=False)
    strides: int = field(default=0, init=False)
    level: int = field(default=0, init=False)
    """Level strides since the last stair stride."""
    climbed: dict[Foot, float] = field(factory=dict, init=False)
    """By each foot in this flight, m."""
    unbelieved: dict[Foot, int] = field(factory=dict, init=False)
    """Strides of each foot in this flight whose height is not believed."""
    unjudged: dict[Foot, int] = field(factory=dict, init=False)
    """Strides of each foot since the last stair stride that nobody could judge."""
    believed: float = field(default=0.0, init=False)
    """What the other stair strides of this flight gained together, m."""
    stood: dict[Foot, float] = field(factory=dict, init=False)
    """Height of each foot above where both were last known to be on one level, m."""
    before: dict[Foot, float] = field(factory=dict, init=False)
    """What each foot's last stride rose, when that was a level one, m."""
    stepped_at: dict[Foot, float] = field(factory=dict, init=False)

    def reset(self) -> None:
        """The clock begins anew: the flight under way is given up."""
        self.way = 0
        self.stood, self.before, self.stepped_at = {}, {}, {}

    def stepped(self, step: StrideTaken, way: int | None) -> list[FlightClimbed]:
        """A step of either foot that goes upstairs (1), downstairs (-1), neither (0), or nobody knows (None)."""
        foot, height = step.foot, step.height_change
        believed = way is not None and of_stairs(height, step.degraded)
        events: list[FlightClimbed] = []
        if way and self.way not in (0, way):
            self._over(step.known_at, events)
        if way:
            if self.way == 0:
                self._begin(step, way)
            self._stair(step, way, believed and way * height > -LEAST_RISE)
        elif self.way != 0:
            self.level += 1
            if way is None:
                self.unjudged[foot] = self.unjudged.get(foot, 0) + 1
            if believed and self.way * height > END_RISE and foot in self.climbed:
                self._climb(foot, height)
            else:
                self.before[foot] = height if believed else 0.0
            if self.level >= self._heard(foot, step.t):
                self._over(step.known_at, events)
                self.stood = {}
        else:
            self.before[foot] = height if believed else 0.0
        self.stepped_at[foot] = step.t
        return events

    def _stair(self, step: StrideTaken, way: int, believed: bool) -> None:
        foot, height = step.foot, step.height_change
        self.t_end = max(self.t_end, step.t)
        self.level = 0
        self.strides += 1
        first = self.before.pop(foot, 0.0)
        if believed:
            self.believed += height
            self._climb(foot, height + (first if way * first > END_RISE else 0.0))
        else:
            self.unbelieved[foot] = self.unbelieved.get(foot, 0) + 1
        for other, strides in self.unjudged.items():
            self.strides += strides
            self.unbelieved[other] = self.unbelieved.get(other, 0) + strides
        self.unjudged = {}

    def waited(self, t: float, known_at: float) -> list[FlightClimbed]:
        """It is `t` s, and no step has come since the last one told."""
        events: list[FlightClimbed] = []
        if self.way != 0 and t - max(self.stepped_at.values(), default=t) > PATIENCE:
            heights = list(self.stood.values())
            # once a stride's height is not known, nor is whether the feet stand on one level
            if self.unbelieved or self.unjudged or max(heights) - min(heights) < EVEN:
                self._over(known_at, events)
                self.stood = {}
        return events

    def finish(self, known_at: float) -> list[FlightClimbed]:
        """Nobody steps any more: the flight under way is over."""
        events: list[FlightClimbed] = []
        if self.way != 0:
            self._over(known_at, events)
        return events

    def _begin(self, step: StrideTaken, way: int) -> None:
        self.way = way
        self.t_start, self.t_end = step.t_start, step.t
        self.strides = self.level = 0
        self.climbed, self.unbelieved, self.unjudged = {}, {}, {}
        self.believed = 0.0

    def _climb(self, foot: Foot, height: float) -> None:
        self.climbed[foot] = self.climbed.get(foot, 0.0) + height
        self.stood[foot] = self.stood.get(foot, 0.0) + height

    def _heard(self, foot: Foot, t: float) -> int:
        """How many feet are."""
        others = [at for other, at in self.stepped_at.items() if other is not foot]
        return 1 + sum([abs(t - at) < HEARD_WITHIN for at in others])

    def _over(self, known_at: float, events: list[FlightClimbed]) -> None:
        unbelieved = sum(self.unbelieved.values())
        known = self.strides - unbelieved
        height = 0.0
        if 0 < known >= unbelieved:
            feet = len(self.climbed | self.unbelieved)
            height = (sum(self.climbed.values()) + unbelieved * self.believed / known) / feet
        if self.way * height >= LEAST_HEIGHT and self.strides > 1:
            events.append(
                FlightClimbed(
                    t=self.t_end,
                    known_at=max(known_at, self.t_end),
                    t_start=min(self.t_start, self.t_end),
                    up=self.way > 0,
                    steps=self.strides,
                    height=height,
                )
            )
        self.way = 0
        self.before = {}
        if unbelieved:
            self.stood, self.unbelieved = {}, {}
