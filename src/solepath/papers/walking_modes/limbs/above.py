"""Samples of the sensors above the ankles: which can be used, and the attitudes that they bring to the chain."""

from __future__ import annotations

from ....events import Rejection
from ....foot.rejection import RejectionReason, rejection_reason
from ....types import Sample, Site
from ....types.attrs import define, field
from .inclination import Inclination
from .limbs import LowerLimbs

AHEAD = 60.0
"""A sample that is this far ahead of everything else is from another time, s, until the next one of its site is too."""


@define
class Above:
    """Pelvis, thighs and shanks, of which samples come."""

    leaning: dict[Site, Inclination] = field(factory=dict, init=False)
    times: dict[Site, float] = field(factory=dict, init=False)
    """Newest sample that was used, s."""
    newest: float | None = field(default=None, init=False)
    """Of any site, feet too, s."""
    strange: dict[Site, float] = field(factory=dict, init=False)
    """Time of the site's last sample, where that was too far ahead, s."""

    def passed(self, t: float) -> None:
        """A sample of a foot came, of `t` s."""
        if self.newest is None or t > self.newest:
            self.newest = t

    def take(self, sample: Sample, chain: LowerLimbs) -> RejectionReason | None:
        """One sample; why it cannot be used, None when it could."""
        site, t = sample.site, sample.t
        wrong = rejection_reason(sample, self.times.get(site))
        if wrong is None and self.newest is not None and t - self.newest > AHEAD:
            before = self.strange.get(site)
            self.strange[site] = t
            if before is None or not before < t <= before + AHEAD:
                wrong = Rejection.ABSURD, f"{t - self.newest:.4g} s ahead of everything before"
        if wrong is not None:
            return wrong
        self.strange.pop(site, None)
        self.times[site] = t
        self.passed(t)
        if sample.quat is not None:
            chain.told(site, t, sample.quat)
        elif sample.acc is not None and sample.gyro is not None:
            leaning = self.leaning.get(site)
            if leaning is None:
                leaning = self.leaning[site] = Inclination()
            attitude = leaning.update(t, sample.acc, sample.gyro)
            if attitude is not None:
                chain.told_own(site, t, attitude, leaning.heading)
        return None

    def reset(self, site: Site) -> None:
        """The clock of a site begins anew, and with it perhaps what is newest."""
        self.times.pop(site, None)
        self.strange.pop(site, None)
        self.newest = max(self.times.values(), default=None)
