"""The heading by straight ways: its drift (straightness.py) and whether its calibration fits (calibration_fit.py)."""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees, sqrt

from ...calibration import HeadingCalibration
from ...events import Defect, DefectFound, StrideTaken
from ...types import SITE_OF_FOOT, Foot
from ...types.attrs import define, evolve, field
from .calibration_fit import CalibrationFit, DriftHypothesis
from .common_error import DRIFT, NO_MOVE, CommonError, Move
from .straightness import Straightness

LONGEST_STRIDE_TIME = 2.0
"""Longest duration of a stride that walks, s; in a longer one the wearer stood first."""


@define
class StraightWays:
    """Learns the drift of the heading from straight ways, and drops a calibration that they contradict."""

    straightness: Straightness = field(factory=Straightness, init=False)
    calibrated: tuple[float, float] | None = field(default=None, init=False)
    """Drift of the left and the right foot that a calibration says and the feet remove, rad a stride; None without."""
    fit: CalibrationFit | None = field(default=None, init=False)
    """Test of the calibration; None without one, and once it was dropped."""
    strides: float = field(default=0.0, init=False)
    """Number of usual strides of the mean of both feet so far."""
    moves: tuple[float, float] = field(default=(0.0, 0.0), init=False)
    """Derivative of the position by the drift so far, m for each rad a stride."""
    spoiled: tuple[Foot, ...] = field(default=(), init=False)
    """Feet whose rates are wrong by another defect, for example because the sensor came loose."""

    def use_calibration(self, headings: Mapping[Foot, HeadingCalibration]) -> None:
        """Test this calibration from the first stretch on."""
        left, right = headings.get(Foot.LEFT), headings.get(Foot.RIGHT)
        self.calibrated = (0.0 if left is None else left.drift, 0.0 if right is None else right.drift)

    def reset(self, foot: Foot | None = None) -> None:
        """Discard the stretch that has begun; a `foot` that is given has another device or clock."""
        self.straightness.reset()
        self.spoiled = tuple([one for one in self.spoiled if one is not foot])

    def add_defect(self, event: DefectFound) -> None:
        """Learn nothing from a foot whose data a defect spoils; peaks that are cut off (CLIPPED) add to the drift."""
        foot = event.site.foot
        if foot is not None and event.spoils and event.defect is not Defect.CLIPPED and foot not in self.spoiled:
            self.spoiled = (*self.spoiled, foot)

    def add_stride(
        self, event: StrideTaken, share: float, strides: float, displacement: tuple[float, float], common: CommonError
    ) -> tuple[Move, DefectFound | None]:
        """Add a stride to the stretch; correct the `common` errors by what a straight stretch shows.

        The mean of both feet moves by `share` of its `displacement`, m, and it counts as `strides` usual ones. Returns
        the correction of the tracks, and the event if the calibration was dropped. A stride of a foot with a defect
        ends the stretch, and nothing is learnt from it."""
        turned, (x, y), (dx, dy) = share * (self.strides + 0.5 * share * strides), self.moves, displacement
        self.strides, self.moves = self.strides + share * strides, (x - turned * dy, y + turned * dx)
        if event.foot in self.spoiled:
            self.straightness.reset()
            return NO_MOVE, None
        sigma = sqrt(common.drift_variance(min(event.t_end - event.t_start, LONGEST_STRIDE_TIME)))
        found = self.straightness.add_stride(event.t_end, displacement, share, strides, event.heading_change, sigma)
        if found is None:
            return NO_MOVE, None
        t = found.stride_time
        if self.calibrated is not None:
            fit = self.fit = self.fit or self._first_fit(event.foot, self.calibrated, common)
            bias_known = evolve(found, variance=found.variance + t * t * common.bb)
            if fit.add(bias_known, found.drift + common.drift + t * common.bias):
                move = common.replace_drift(fit.other.drift, fit.other.variance, self.strides, self.moves)
                self.calibrated = self.fit = None
                return move, _misfit(event, fit.other.drift / t if t > 0.0 else 0.0)
        return common.correct_drift(found.drift, found.variance, found.weight, t), None

    def _first_fit(self, foot: Foot, drifts: tuple[float, float], common: CommonError) -> CalibrationFit:
        left, right = drifts
        drift = (left if foot is Foot.LEFT else right) if common.alone else 0.5 * (left + right)
        share = 1.0 if common.alone else 0.5
        return CalibrationFit(
            DriftHypothesis(0.0, common.rr), DriftHypothesis(-drift, share * DRIFT * DRIFT + common.rr)
        )


def _misfit(event: StrideTaken, rate: float) -> DefectFound:
    what = (
        "the calibration of the heading does not fit this walk: with it, straight ways bend by "
        f"{abs(degrees(60.0 * rate)):.0f} degrees a minute. It is not used any longer. Walk there and back again with "
        "these shoes and sensors (solepath calibrate walk)"
    )
    return DefectFound(
        t=event.t, known_at=event.known_at, site=SITE_OF_FOOT[event.foot], defect=Defect.CALIBRATION, what=what,
        spoils=False,
    )  # fmt: skip
