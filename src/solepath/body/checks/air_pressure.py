"""Air pressure that changes although the wearer walks on the level, or does not change although they climb.

It is not compared with the height of a foot whose sensor has another defect, which is the likelier cause.

The height by air pressure minus the height of the foot's track should stay as it is while the wearer walks. It does not
behind a door of a pressurised room or stairwell, under ventilation that starts, with a barometer that drifts, and on
stairs with one that is stuck. It is compared while the wearer takes strides only: a foot that stands does not show the
height of an elevator."""

from __future__ import annotations

from math import exp

from ...events import Defect, DefectFound, StrideTaken
from ...foot.view import FootView
from ...types import Foot, PerFoot, Site, per_foot
from ...types.attrs import define, state, stateful
from ..altitude import DEGRADED_FACTOR, SCALE_HEIGHT, STANDARD_PRESSURE, height_above_track
from ..part import Inputs, Outputs, Part
from .stances import Finding

STRIDE_PAUSE = 2.5
"""Longest time since a stride of either foot in which the wearer is still walking, s: twice a slow stride."""
LEVEL_TIME = 5.0
"""Time constant of the mean of the difference, s, and the time of walking before it is known."""
LEAST_READINGS = 5
"""Least number of readings in `LEVEL_TIME`."""
MEMORY = 45.0
"""Time of walking after which a change of the difference counts for 1/e, s.

A slope of 3 %, which a track may take for level, changes the difference by less than `LARGEST_CHANGE` in that time."""
LARGEST_CHANGE = 2.0
"""Least change of the difference that is reported, m: 24 Pa.

The difference of stairwells that are pressurised against smoke is 50 Pa (EN 12101-6). The error of a barometer whose
readings have 0.5 m is 0.4 m over all ways on foot that `MEMORY` holds."""


@define
class Barometer:
    """The difference of one foot's barometer: height by air pressure minus height of the track, m."""

    mean: float = 0.0
    """Mean of the newest differences, m."""
    count: int = 0
    """Number of readings since the wearer set off."""
    since: float = 0.0
    """Time at which the wearer set off, s."""
    read_at: float = 0.0
    """Time of the newest reading, s."""
    change: float = 0.0
    """Change of the difference while walking, m; what is long ago counts less."""
    reported: bool = False

    def add(self, t: float, difference: float, largest_change: float) -> bool:
        """Add a difference, m, of a wearer who walks, at `t`, s; return whether it has changed by more, m."""
        if self.count == 0:
            self.since = self.read_at = t
        dt = max(0.0, t - self.read_at)
        self.read_at = t
        self.count += 1
        step = max(1.0 / self.count, min(1.0, dt / LEVEL_TIME)) * (difference - self.mean)
        self.mean += step
        if self.count > LEAST_READINGS and t - self.since > LEVEL_TIME:
            self.change = self.change * exp(-dt / MEMORY) + step
        return not self.reported and abs(self.change) > largest_change


@stateful
class AirPressure(Part):
    """Reports air pressure that contradicts the heights of strides, as DefectFound, once for the barometer of a foot.

    The parts after it no longer use that barometer. Latency: some seconds of walking."""

    needs_samples = True
    idle = True

    feet: PerFoot[Barometer] = state(factory=lambda: per_foot(Barometer))
    stride_at: float | None = None
    """End of the newest stride of either foot, s; None before any."""
    degraded: bool = False
    """Flag: that stride is degraded."""
    wrong_heights: list[Foot] = state(factory=list)
    """Feet whose height may be wrong, because of a defect of their sensor."""

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        """Add the reading of a foot's barometer, if the sample has one, and strides, which show that people walk."""
        outputs = () if view is None or view.sample.air_pressure is None else self._add_reading(view)
        for event in events:
            if isinstance(event, StrideTaken):
                self.stride_at, self.degraded = event.t, bool(event.flaws)
            elif (
                isinstance(event, DefectFound) and event.spoils and (foot := event.site.foot) not in self.wrong_heights
            ):
                self.wrong_heights += [] if foot is None else [foot]
        return outputs

    def _add_reading(self, view: FootView) -> Outputs:
        t, barometer = view.t, self.feet[view.foot]
        if view.foot in self.wrong_heights or self.stride_at is None or abs(t - self.stride_at) > STRIDE_PAUSE:
            barometer.count = 0
            return ()
        difference = height_above_track(view)
        largest = LARGEST_CHANGE * (DEGRADED_FACTOR if self.degraded else 1.0)
        if difference is None or not barometer.add(t, difference, largest):
            return ()
        barometer.reported = True
        return [_finding(barometer.change).event(view.foot, t, view.known_at)]

    def reset(self, site: Site) -> None:
        """Forget what was found at a site, where another device is worn or the clock has restarted."""
        if site.foot is not None:
            self.feet[site.foot] = Barometer()
            self.wrong_heights = [foot for foot in self.wrong_heights if foot is not site.foot]
        self.stride_at = None


def _finding(change: float) -> Finding:
    pascal = STANDARD_PRESSURE / SCALE_HEIGHT * abs(change)
    what = (
        f"the air pressure {'fell' if change > 0.0 else 'rose'} by {pascal:.0f} Pa against what the height of the "
        "strides explains, as behind the door of a pressurised stairwell, on an escalator, or by a barometer that "
        "drifts or is stuck; it is not used from now on. If nothing but the barometer explains it, replace the sensor"
    )
    return Finding(Defect.AIR_PRESSURE, what, spoils=False)
