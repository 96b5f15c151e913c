"""Samples of the sensors above the ankles: rejection, and attitudes for the chain."""

from __future__ import annotations

from ....events import Rejection
from ....foot.rejection import RejectionReason, rejection_reason
from ....types import Sample, Site
from ....types.attrs import define, field
from .inclination import Inclination
from .limbs import LowerLimbs

FARTHEST_AHEAD = 60.0
"""Largest time ahead of all earlier samples, s. Later ones are rejected, unless the site's last one was, too."""


@define
class LimbSensors:
    """The sensors of pelvis, thighs and shanks."""

    inclinations: dict[Site, Inclination] = field(factory=dict, init=False)
    """Attitude filter by site, for sensors that send no attitude."""
    times: dict[Site, float] = field(factory=dict, init=False)
    """Time of the newest used sample by site, s."""
    newest: float | None = field(default=None, init=False)
    """Time of the newest sample of any site, including the feet, s."""
    ahead_t: dict[Site, float] = field(factory=dict, init=False)
    """Time of a site's last sample, s, if it was rejected for being too far ahead."""

    def add_time(self, t: float) -> None:
        """Add the time of a sample of a foot, s."""
        if self.newest is None or t > self.newest:
            self.newest = t

    def add_sample(self, sample: Sample, chain: LowerLimbs) -> RejectionReason | None:
        """Add one sample; return the reason for its rejection, or None if it is used."""
        site, t = sample.site, sample.t
        reason = rejection_reason(sample, self.times.get(site))
        if reason is None and self.newest is not None and t - self.newest > FARTHEST_AHEAD:
            last_ahead_t = self.ahead_t.get(site)
            self.ahead_t[site] = t
            if last_ahead_t is None or not last_ahead_t < t <= last_ahead_t + FARTHEST_AHEAD:
                reason = RejectionReason(Rejection.ABSURD, f"{t - self.newest:.4g} s ahead of everything before")
        if reason is not None:
            return reason
        self.ahead_t.pop(site, None)
        self.times[site] = t
        self.add_time(t)
        if sample.quat is not None:
            chain.set_attitude(site, t, sample.quat)
        elif sample.acc is not None and sample.gyro is not None:
            inclination = self.inclinations.get(site)
            if inclination is None:
                inclination = self.inclinations[site] = Inclination()
            attitude = inclination.update(t, sample.acc, sample.gyro)
            if attitude is not None:
                chain.set_own_attitude(site, t, attitude, inclination.heading)
        return None

    def reset(self, site: Site) -> None:
        """Discard the times of a site whose clock restarts."""
        self.times.pop(site, None)
        self.ahead_t.pop(site, None)
        self.newest = max(self.times.values(), default=None)
