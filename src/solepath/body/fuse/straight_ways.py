"""The heading by straight ways: its drift (straightness.py) and whether its calibration fits (calibration_fit.py)."""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees, fsum, sqrt

from ...calibration import HeadingCalibration
from ...events import Defect, DefectFound, StrideTaken
from ...types import SITE_OF_FOOT, Foot
from ...types.attrs import define, evolve, field
from .calibration_fit import CalibrationFit, DriftHypothesis
from .common_error import DRIFT, MAX_TURN_BACK, NO_MOVE, TURNING, CommonError, Move
from .straightness import Straightness

LONGEST_STRIDE_TIME = 2.0
"""Longest duration of a stride that walks, s; in a longer one the wearer stood first."""


@define
class StraightWays:
    """Learns the drift of the heading from straight ways, and drops a calibration that they contradict."""

    straightness: Straightness = field(factory=Straightness, init=False)
    calibrated: tuple[tuple[float, float], tuple[float, float]] | None = field(default=None, init=False)
    """Drift, rad a stride, and turning, no unit, of the left and the right foot that a calibration says and the feet
    remove; None without one, and once it was dropped."""
    fit: CalibrationFit | None = field(default=None, init=False)
    """Test of the calibration; None before the first stretch."""
    moved: list[list[float]] = field(factory=list, init=False)
    """Derivatives of x and y, m, and of the heading, rad, over the whole walk by the drift and the turning of the left
    foot, then of the right one; empty without a calibration."""
    devices: tuple[int, ...] = field(default=(0, 0), init=False)
    """Number of times that another device may have been connected to the left and to the right foot."""
    spoiled: tuple[Foot, ...] = field(default=(), init=False)
    """Feet whose rates are wrong by another defect, for example because the sensor came loose."""

    def use_calibration(self, headings: Mapping[Foot, HeadingCalibration]) -> None:
        """Test this calibration from the first stretch on."""
        left, right = [(0.0, 0.0) if one is None else (one.drift, one.turning) for one in map(headings.get, Foot)]
        self.calibrated, self.moved = (left, right), [[0.0, 0.0, 0.0] for _ in range(4)]

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
        self, foot: int, event: StrideTaken, strides: float, displacement: tuple[float, float], common: CommonError
    ) -> tuple[Move, DefectFound | None]:
        """Add a stride of foot 0 (left) or 1; correct the `common` errors by what a straight stretch shows.

        It counts as `strides` usual ones, and its `displacement` is in m. Returns the correction of the tracks, and the
        event if the calibration was dropped. A stride of a foot with a defect ends the stretch, and nothing is learnt
        from it."""
        share, turn = common.shares[foot], event.heading_change
        devices = tuple([0 if one is None else one.device for one in common.foot_biases])
        if devices != self.devices:  # a calibration of the old one neither fits nor misfits any longer
            self.devices, self.calibrated, self.fit, self.moved = devices, None, None, []
        self._move(2 * foot, share, (strides, turn), displacement)
        if event.foot in self.spoiled:
            self.straightness.reset()
            return NO_MOVE, None
        stretch = self.straightness.add_stride(event.t_end, displacement, share, strides, turn)
        if stretch is None:
            return NO_MOVE, None
        sigma = sqrt(common.drift_variance(min(event.t_end - event.t_start, LONGEST_STRIDE_TIME)))
        found = self.straightness.drift_of(stretch, sigma)
        if found is None:
            return NO_MOVE, None
        t = found.stride_time
        if self.calibrated is not None:
            fit = self.fit = self.fit or _first_fit(self.calibrated, common)
            bias_known = evolve(found, variance=found.variance + t * t * common.bias_variance())
            if fit.add(bias_known, found.drift + common.drift_with_bias(t)):
                return self._drop(self.calibrated, fit.other, common), _misfit(event, fit.other.drift, t)
        return common.correct_drift(found.drift, found.variance, found.weight, t), None

    def _move(self, first: int, share: float, counts: tuple[float, float], displacement: tuple[float, float]) -> None:
        """Add a stride to the derivatives, of which `counts` are those of its own turn by drift and turning."""
        dx, dy = share * displacement[0], share * displacement[1]
        for number, one in enumerate(self.moved):
            more = share * counts[number - first] if 0 <= number - first < 2 else 0.0
            middle = one[2] + 0.5 * more
            one[0] -= dy * middle
            one[1] += dx * middle
            one[2] += more

    def _drop(
        self, calibrated: tuple[tuple[float, float], tuple[float, float]], other: DriftHypothesis, common: CommonError
    ) -> Move:
        """Take the calibration back from the whole track; both feet drift as the `other` hypothesis says."""
        shares, x, y, heading = common.shares, 0.0, 0.0, 0.0
        mean = fsum([share * drift for share, (drift, _) in zip(shares, calibrated, strict=True)])
        variance = other.variance / fsum([share * share for share in shares])
        for foot, (drift, turning) in enumerate(calibrated):
            new = ((other.drift + mean - drift, variance), (-turning, TURNING * TURNING))
            for error, (value, its_variance) in enumerate(new):
                move = common.replace(foot, error, value, its_variance, self.moved[2 * foot + error])
                x, y, heading = x + move[0], y + move[1], heading + move[2]
        self.calibrated, self.fit, self.moved = None, None, []
        if abs(heading) > MAX_TURN_BACK:  # the derivatives do not hold so far: say only how wrong the track may be
            common.inflate(x * x + y * y, heading)
            return NO_MOVE
        return (x, y, heading)


def _first_fit(calibrated: tuple[tuple[float, float], tuple[float, float]], common: CommonError) -> CalibrationFit:
    drift = fsum([share * one for share, (one, _) in zip(common.shares, calibrated, strict=True)])
    usual = fsum([share * share for share in common.shares]) * DRIFT * DRIFT
    known = common.drift_variance(0.0)
    return CalibrationFit(DriftHypothesis(0.0, known), DriftHypothesis(-drift, usual + known))


def _misfit(event: StrideTaken, drift: float, stride_time: float) -> DefectFound:
    rate = drift / stride_time if stride_time > 0.0 else 0.0  # feet whose clocks are apart may show no time
    what = (
        "the calibration of the heading does not fit this walk: with it, straight ways bend by "
        f"{abs(degrees(60.0 * rate)):.0f} degrees a minute. It is not used any longer. Walk there and back again with "
        "these shoes and sensors (solepath calibrate walk)"
    )
    return DefectFound(
        t=event.t, known_at=event.known_at, site=SITE_OF_FOOT[event.foot], defect=Defect.CALIBRATION, what=what,
        spoils=False,
    )  # fmt: skip
