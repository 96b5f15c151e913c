"""Double-foot position calibration: the strides of both feet calibrate each other (recipe kupt-dfpc).

"Smart insole-based indoor localization system for Internet of Things applications", IEEE Internet of Things Journal 6,
2019, section III.C.4: similarity r of two strides (9), error index EI (10, from the corrector), coefficient (11),
calibrated stride length (12), choice of the foot (13). The paper's step of one foot is called a stride here.

The paper leaves these points open:

- A stride's partner is the other foot's latest stride that ended before this one did (fig. 9: L1, R1, L2, ...). There
  is no partner if that stride ended before this one started (the other foot skipped a stride), or more than
  `LONGEST_WAIT` before this foot left the ground (the wearer stood). An abnormal partner does not calibrate a length.
- A stride without a normal partner keeps its own length: the coefficient is 1. So does an abnormal stride (which has no
  error index). The same holds for r = 0 and for an undefined r, when a path of the centre of pressure is constant or
  unknown: (11) tends to 1 as r goes to 0.
- A half stride and a whole one are not similar: fig. 11 has low similarities at both ends of a walk.
  Paths of the centre of pressure here end at toe-off, too early to show that a stride is the last one of a walk. So
  r = 0 if one stride is shorter than `LENGTH_RATIO` of the other.
- (11) is computed in the equivalent form EI_other / (EI_other + r EI_own). Its denominator is zero only if both error
  indices are zero; then 1 / (1 + r) is used, as for any two equal error indices.
- (13) is a sum over pairs of a stride and its partner. A stride is in one pair at most. If the feet alternate, the k-th
  left stride is paired with the k-th right one, and a missing stride does not shift later pairs. While the sum is zero,
  the foot of the first stride is chosen.
- A pair with an abnormal stride, which has no error index, is left out of (13).
- A foot that took no stride during `ABSENT_STRIDES` strides of the other is not chosen, whatever (13) gives. When it
  moves again, its path continues from the end of the other foot's path, since its own movement is not known.

Weights by the variance of the lengths in place of EI were tried; they gain nothing.

Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Mapping
from math import fsum, isfinite, sqrt
from typing import ClassVar

from ...body.part import Inputs, Outputs, Position, TrackPart
from ...events import StrideFused, StrideTaken
from ...foot.pressure.insole import centre
from ...foot.view import FootPose, FootView
from ...types import OTHER, Floats, Foot, PerFoot, Site, Vec3, per_foot
from ...types.attrs import define, field, state, stateful
from ...types.vector import ZERO, add, sub

KEPT_STRIDES = 3
"""Number of latest strides kept of each foot: samples of one foot may arrive a stride later than the other's."""
ABSENT_AFTER = 1.0
"""Time by which a foot's last sample must be older than the other foot's for it to be absent, s."""
LONGEST_WAIT, LENGTH_RATIO, ABSENT_STRIDES = 1.0, 0.75, 3
"""Longest time from the partner's end to toe-off, s; least ratio of lengths; number of strides.

If the shorter stride is less than this ratio of the longer one, r is 0. A foot that takes no stride during that number
of strides of the other foot is absent, and is not chosen."""
POINTS = 64
"""Number of instants at which two strides are compared."""
LEAST_LENGTH = 1e-6
"""Length below which a stride has no direction, m."""
LEAST_SPREAD = 1e-12
"""Sum of squared deviations, m^2, below which a path of the centre of pressure counts as constant."""


@define
class FusedStride:
    """A stride of one foot after fusion."""

    t_end: float
    """End of the stride, s."""
    length: float
    """Length by the foot's own track, m."""
    calibrated_length: float
    """Calibrated length D of (12), m."""
    error_index: float | None
    """Error index (10), m/s; None for an abnormal stride."""
    cop_path: Floats
    """Centre of pressure along the foot at POINTS instants, m; empty when it is not known."""
    paired: bool = False
    """Flag: the stride has been counted in (13)."""


@define
class CalibratedPath:
    """The calibrated path of one foot."""

    strides: list[FusedStride] = field(factory=list)
    """Latest `KEPT_STRIDES` strides, oldest first."""
    end: Vec3 = ZERO
    """End of the last stride, world frame, m."""
    distance: float = 0.0
    """Sum of the calibrated lengths, m."""
    foot_position: Vec3 = ZERO
    """Position of the foot's own track after its last stride, world frame, m."""
    other_strides: int = 0
    """Number of strides of the other foot since this foot's last stride."""


@stateful
class DoubleFoot(TrackPart):
    """Fuses the strides of both feet, and reports one `StrideFused` for each stride.

    Latency: that of the stride. The foot is chosen again after every stride by (13). A choice is never revised. Memory
    is constant.

    The live position is the end of the chosen foot's calibrated path plus the motion of that foot's own track since
    then. While the chosen foot is absent, the other foot is used. So the live position stands still with that foot, and
    jumps by half a stride when the choice changes. The covariance is that of the foot's own track."""

    needs_samples: ClassVar[bool] = True
    idle = True

    paths: PerFoot[CalibratedPath] = state(factory=lambda: per_foot(CalibratedPath))
    error_balance: float = 0.0
    """Sum of (13), m^2/s: positive when the left foot errs more."""
    chosen: Foot | None = None
    """Chosen foot by (13); None before the first stride."""

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        if view is None or view.after is None:
            return ()
        layout = view.after.layout
        middle = None if layout is None else centre(layout)
        return [self.add_stride(event, middle) for event in events if isinstance(event, StrideTaken)]

    def reset(self, site: Site) -> None:
        """Discard the foot's strides so far, because their times are on another clock."""
        if site.foot is not None:
            self.paths[site.foot].strides = []

    def add_stride(self, taken: StrideTaken, foot_centre: float | None) -> StrideFused:
        """Add one stride and return its fusion with the other foot's.

        `foot_centre` is the x coordinate of the insole's centre, foot frame, m; None without an insole. While the foot
        is in the air, the centre of pressure is set to it (section III.C.2)."""
        foot = taken.foot
        path, other_path = self.paths[foot], self.paths[OTHER[foot]]
        index = taken.features.error_index
        cop_path = () if foot_centre is None or index is None else resample_cop(taken, foot_centre)
        similarity, coefficient, length = None, 1.0, taken.length
        partner = self._partner(taken, other_path)
        paired = False
        if index is not None and partner is not None and partner.error_index is not None:
            similarity = correlation(cop_path, partner.cop_path)
            shorter, longer = sorted((taken.length, partner.length))
            if similarity is not None and shorter < LENGTH_RATIO * longer:
                similarity = 0.0
            coefficient = own_share(similarity, index, partner.error_index)
            length = coefficient * taken.length + (1.0 - coefficient) * partner.length  # (12)
        if partner is not None and not partner.paired:
            partner.paired = paired = True
            if index is not None and partner.error_index is not None:
                excess = index - partner.error_index
                mean_length = 0.5 * (abs(length) + abs(partner.calibrated_length))
                self.error_balance += (excess if foot is Foot.LEFT else -excess) * mean_length  # (13)
        fused = FusedStride(taken.t_end, taken.length, length, index, cop_path, paired)
        path.strides = [*path.strides[1 - KEPT_STRIDES :], fused]
        self._extend(path, other_path, taken, length)
        chosen = self._choose(foot)
        wearer = self.paths[chosen]
        return StrideFused(
            t=taken.t,
            known_at=taken.known_at,
            foot=foot,
            number=taken.number,
            stride_length=length,
            own_length=taken.length,
            similarity=similarity,
            error_index=index,
            coefficient=coefficient,
            chosen=chosen,
            distance=wearer.distance,
            position=wearer.end,
        )

    def _partner(self, taken: StrideTaken, other_path: CalibratedPath) -> FusedStride | None:
        """Return the partner: the other foot's latest stride that ended before this one; None if it is too old."""
        toe_off_t = taken.t_start if taken.t_toe_off is None else taken.t_toe_off
        for fused in reversed(other_path.strides):
            if fused.t_end <= taken.t_end:
                is_recent = fused.t_end > taken.t_start and toe_off_t - fused.t_end <= LONGEST_WAIT
                return fused if is_recent else None
        return None

    def _extend(self, path: CalibratedPath, other_path: CalibratedPath, taken: StrideTaken, length: float) -> None:
        """Extend the path in the direction of the stride by the calibrated length, m."""
        if path.other_strides >= ABSENT_STRIDES:
            path.end, path.distance = other_path.end, other_path.distance
        dx, dy, dz = taken.displacement
        k = length / taken.length if taken.length > LEAST_LENGTH else 1.0
        path.end = add(path.end, (k * dx, k * dy, dz))
        path.distance += abs(length)
        path.foot_position, path.other_strides = taken.position, 0
        other_path.other_strides = min(other_path.other_strides + 1, ABSENT_STRIDES)

    def _choose(self, foot: Foot) -> Foot:
        """Choose the foot whose path is the wearer's now: by the sign of (13), unless that foot is absent."""
        chosen = self.chosen or foot
        if self.chosen is not None and self.error_balance != 0.0:
            chosen = Foot.RIGHT if self.error_balance > 0.0 else Foot.LEFT
        self.chosen = foot if self.paths[chosen].other_strides >= ABSENT_STRIDES else chosen
        return self.chosen

    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        if not feet:
            return None
        newest = max([pose.t for pose in feet.values()])
        present = [foot for foot, pose in feet.items() if newest - pose.t < ABSENT_AFTER]
        chosen = self.chosen if self.chosen in present else present[0]
        path, pose = self.paths[chosen], feet[chosen]
        return Position(newest, add(path.end, sub(pose.position, path.foot_position)), pose.covariance)


def resample_cop(taken: StrideTaken, foot_centre: float) -> Floats:
    """Return the centre of pressure along the foot (copY of (9)), m, at POINTS instants evenly spaced in time.

    Strides have unequal numbers of samples, but (9) needs equal numbers. So each stride is resampled from foot-flat to
    heel-strike. Until toe-off the values are those of `StrideFeatures.cop`, then they are `foot_centre`. The phase
    after heel-strike is left out. The result is empty for a stride without a path or a toe-off."""
    cop, start, toe_off = taken.features.cop, taken.t_start, taken.t_toe_off
    end = taken.t_end if taken.t_heel_strike is None else taken.t_heel_strike
    if not cop or toe_off is None or not start <= toe_off <= end or not end > start:
        return ()
    cop_x = [x for x, _ in cop]
    last = len(cop_x) - 1
    path = []
    for k in range(POINTS):
        t = start + (k + 0.5) / POINTS * (end - start)
        if t >= toe_off:
            path.append(foot_centre)
            continue
        index = (t - start) / (toe_off - start) * last
        i = min(int(index), last)
        next_x = cop_x[min(i + 1, last)]
        path.append(cop_x[i] + (index - i) * (next_x - cop_x[i]))
    return tuple(path)


def correlation(one: Floats, other: Floats) -> float | None:
    """Return the similarity r (9) of two paths with equal numbers of points, 0 to 1.

    It is None if one path is constant or empty."""
    n = len(one)
    if n == 0 or n != len(other):
        return None
    one_mean, other_mean = fsum(one) / n, fsum(other) / n
    xs = [x - one_mean for x in one]
    ys = [y - other_mean for y in other]
    xx, yy = fsum([x * x for x in xs]), fsum([y * y for y in ys])
    if not (xx > LEAST_SPREAD and yy > LEAST_SPREAD):
        return None
    r = abs(fsum([x * y for x, y in zip(xs, ys, strict=True)])) / (sqrt(xx) * sqrt(yy))
    return min(r, 1.0) if isfinite(r) else None


def own_share(similarity: float | None, own_index: float, other_index: float) -> float:
    """Return the coefficient (11), Calicoef: the weight of a stride's own length in its calibrated length, 0 to 1."""
    if similarity is None or similarity <= 0.0:
        return 1.0
    sum_of_errors = other_index + similarity * own_index
    if sum_of_errors <= 0.0:
        return 1.0 / (1.0 + similarity)
    return other_index / sum_of_errors
