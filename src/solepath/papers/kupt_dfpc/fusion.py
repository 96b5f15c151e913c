"""Double-foot position calibration: the strides of both feet calibrate each other (recipe kupt-dfpc).

"Smart insole-based indoor localization system for Internet of Things applications", IEEE Internet of Things Journal 6,
2019, section III.C.4: similarity of two steps (9), error index (10, from the corrector), coefficient (11), calibrated
stride length (12), choice of the foot (13). The paper's step of a foot is called a stride here.

Settled here, because the paper leaves it open:

- The other foot's stride is its latest one that ended before this one did (fig. 9: L1, R1, L2, ... each by the one
  before). It is not used when it ended before this stride started (the other foot left one out) or longer than
  `LONGEST_WAIT` before this foot left the ground (the wearer stood), nor when it was abnormal.
- A stride that has nothing to be compared with, or is itself abnormal (no error index), keeps its own length:
  coefficient 1. So does one that is not similar at all, r = 0, or whose similarity is undefined because a path of the
  centre of pressure is constant or unknown: (11) tends to 1 as r goes to 0.
- A half stride and a whole one are not similar: fig. 11 has low similarities at the first and the last step of a walk.
  Our paths of the centre of pressure end at toe-off, before it shows that a stride closes the walk; so strides of which
  one is shorter than `LENGTH_RATIO` of the other have r = 0.
- (11) is computed as EI_other / (EI_other + r EI_own), which is the same and divides by zero only where both error
  indices are zero; there it is 1 / (1 + r), as for any two equal ones.
- (13) adds up pairs of strides. A pair is a stride and the other foot's before it, each stride in one pair at most:
  with feet that take turns that is the k-th left with the k-th right one, and a stride missing on one side shifts
  nothing. While the sum is zero the foot that stepped first is the chosen one.
- An abnormal stride has no error index. If (13) left it out, it would count in favour of its foot. In a pair with a
  normal stride it counts as `ABNORMAL_EXCESS` m/s worse than that, by the mean of both lengths as in (13), so the
  weight of an absurd stride is its length. A pair of two abnormal strides favours neither foot.
- A foot that took no stride during `ABSENT_STRIDES` strides of the other is not chosen, whatever (13) gives. When it
  steps again its path continues from the other's end, since its way in between is not known."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isfinite, sqrt
from typing import ClassVar

from ...body.part import PartOutput, Position, TrackPart
from ...events import StrideFused, StrideTaken
from ...foot.pressure.cells import centre
from ...foot.view import FootPose, FootView
from ...types import OTHER, Foot, Site, Vec3
from ...types.attrs import define, field
from ...types.vector import ZERO, sub

POINTS = 64
"""Number of instants at which two strides are compared."""
KEPT_STRIDES = 3
"""Number of latest strides kept of each foot: samples of one foot may arrive a stride later than the other's."""
ABSENT_AFTER = 1.0
"""Time by which a foot's last sample must be older than the other foot's for it to be absent, s."""
LEAST_LENGTH = 1e-6
"""Length below which a stride has no direction, m."""
LEAST_SPREAD = 1e-12
"""Variation of a path of the centre of pressure below which it is constant but for rounding, m^2."""
LONGEST_WAIT, LENGTH_RATIO, ABSENT_STRIDES = 1.0, 0.75, 3
"""Oldest end of a stride of the other foot that is used, s, a ratio of lengths, and a number of strides.

If one stride is shorter than this ratio of the other, r is 0. A foot without a stride during so many of the other's is
not chosen."""
ABNORMAL_EXCESS = 1.0
"""Excess error of an abnormal stride over a normal one, m/s.

It is about the sum of the error indices of normal strides on recorded insoles."""


@define
class FusedStride:
    """A stride of one foot as the fusion keeps it."""

    t_end: float
    length: float
    """Length by the foot's own track, m."""
    calibrated_length: float
    """Calibrated length D of (12), m."""
    error_index: float | None
    cop_path: tuple[float, ...]
    """Centre of pressure along the foot at POINTS instants, m; empty when it is not known."""
    paired: bool = False
    """Flag: the stride has been counted in (13)."""


@define
class CalibratedPath:
    """The calibrated path of one foot."""

    strides: list[FusedStride] = field(factory=list)
    end: Vec3 = ZERO
    """End of the last stride, world frame, m."""
    distance: float = 0.0
    """Sum of the calibrated lengths, m."""
    offset: tuple[float, float] = (0.0, 0.0)
    """Shift of `end` by calibration against the foot's own track, m."""
    foot_position: Vec3 = ZERO
    """Position of the foot's own track after its last stride, world frame, m."""
    other_strides: int = 0
    """Number of strides of the other foot since this one's last."""


@define
class DoubleFoot(TrackPart):
    """Fuses both feet: takes their strides and reports one `StrideFused` for each.

    Latency: none beyond the stride's own. The choice of (13) is repeated after every stride and is final for it. O(1)
    memory.

    The live position is that of the chosen foot on its calibrated path: the path's end, plus the motion of the foot's
    own track since; it is the other foot's while the chosen one is absent. So it stands while that foot stands, and
    jumps by half a stride when the choice changes. Its covariance is that of the foot's own track plus the square of
    the shift by calibration, because either may be right."""

    needs_samples: ClassVar[bool] = True
    idle = True

    paths: dict[Foot, CalibratedPath] = field(init=False)
    error_balance: float = field(default=0.0, init=False)
    """Sum of (13), m^2/s: positive when the left foot errs more."""
    chosen: Foot | None = field(default=None, init=False)
    """Chosen foot by (13); None before the first stride."""

    def __attrs_post_init__(self) -> None:
        self.paths = {foot: CalibratedPath() for foot in Foot}

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        strides = [event for event in view.events if isinstance(event, StrideTaken)] if view.events else []
        layout = view.after.layout
        middle = None if layout is None or not strides else centre(layout)
        return [self.add_stride(stride, middle) for stride in strides]

    def reset(self, site: Site) -> None:
        """Discard the foot's strides so far, whose times are on another clock."""
        if site.foot is not None:
            self.paths[site.foot].strides = []

    def add_stride(self, taken: StrideTaken, centre: float | None) -> StrideFused:
        """Add one stride and return its fusion with the other foot's.

        `centre`: x of the insole's centre in the foot frame, m, where the centre of pressure is taken to be while the
        foot is in the air (section III.C.2); None when there is no insole."""
        foot = taken.foot
        path, other_path = self.paths[foot], self.paths[OTHER[foot]]
        index = _valid_index(taken.features.error_index)
        cop_path = () if centre is None or index is None else resample_cop(taken, centre)
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
            excess = self._excess_error(index, partner.error_index)
            mean = 0.5 * (abs(length) + abs(partner.calibrated_length))
            self.error_balance += (excess if foot is Foot.LEFT else -excess) * mean  # (13)
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

    def _excess_error(self, own: float | None, other: float | None) -> float:
        """Return by how much the one stride errs more than the other, m/s."""
        if own is None:
            return 0.0 if other is None else ABNORMAL_EXCESS
        return -ABNORMAL_EXCESS if other is None else own - other

    def _partner(self, taken: StrideTaken, other_path: CalibratedPath) -> FusedStride | None:
        """Return the other foot's latest stride before this one; None if it is too old."""
        left_at = taken.t_start if taken.t_toe_off is None else taken.t_toe_off
        for fused in reversed(other_path.strides):
            if fused.t_end <= taken.t_end:
                fresh = fused.t_end > taken.t_start and left_at - fused.t_end <= LONGEST_WAIT
                return fused if fresh else None
        return None

    def _extend(self, path: CalibratedPath, other_path: CalibratedPath, taken: StrideTaken, length: float) -> None:
        """Extend the path in the stride's own direction, by the calibrated length."""
        if path.other_strides >= ABSENT_STRIDES:
            path.end, path.distance, path.offset = other_path.end, other_path.distance, other_path.offset
        dx, dy, dz = taken.displacement
        own = taken.length
        k = length / own if own > LEAST_LENGTH else 1.0
        x, y, z = path.end
        path.end = (x + k * dx, y + k * dy, z + dz)
        path.distance += abs(length)
        sx, sy = path.offset
        path.offset = (sx + (k - 1.0) * dx, sy + (k - 1.0) * dy)
        path.foot_position, path.other_strides = taken.position, 0
        other_path.other_strides = min(other_path.other_strides + 1, ABSENT_STRIDES)

    def _choose(self, foot: Foot) -> Foot:
        """Choose the foot whose path is the wearer's now, by the sign of (13)."""
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
        path, foot = self.paths[chosen], feet[chosen]
        dx, dy, dz = sub(foot.position, path.foot_position)
        x, y, z = path.end
        xx, xy, xz, yy, yz, zz = foot.covariance
        sx, sy = path.offset
        return Position(newest, (x + dx, y + dy, z + dz), (xx + sx * sx, xy + sx * sy, xz, yy + sy * sy, yz, zz))


def resample_cop(taken: StrideTaken, centre: float) -> tuple[float, ...]:
    """Return copY of a stride, the centre of pressure along the foot, m, at POINTS instants evenly spaced in time.

    Strides have unequal numbers of samples and (9) needs equal ones, so both are compared over the stride's own time
    from foot-flat to heel-strike: first the path on the ground, as `StrideFeatures.cop` has it from foot-flat to toe-
    off, then `centre` while the foot is in the air, each in proportion to its time. The loading after heel-strike is
    not part of that path and is left out. Empty without a path, and for a stride without a toe-off."""
    cop, start, off = taken.features.cop, taken.t_start, taken.t_toe_off
    end = taken.t_end if taken.t_heel_strike is None else taken.t_heel_strike
    if not cop or off is None or not start <= off <= end or not end > start:
        return ()
    along = [x for x, _ in cop]
    last = len(along) - 1
    found = []
    for k in range(POINTS):
        t = start + (k + 0.5) / POINTS * (end - start)
        if t >= off:
            found.append(centre)
            continue
        at = (t - start) / (off - start) * last
        i = min(int(at), last)
        ahead = along[min(i + 1, last)]
        found.append(along[i] + (at - i) * (ahead - along[i]))
    return tuple(found)


def correlation(one: tuple[float, ...], other: tuple[float, ...]) -> float | None:
    """Return r of (9), the similarity of two paths of equally many points, 0 to 1.

    None when one of them is constant or empty."""
    n = len(one)
    if n == 0 or n != len(other):
        return None
    one_mean, other_mean = sum(one) / n, sum(other) / n
    xs = [x - one_mean for x in one]
    ys = [y - other_mean for y in other]
    xx, yy = sum([x * x for x in xs]), sum([y * y for y in ys])
    if not (xx > LEAST_SPREAD and yy > LEAST_SPREAD):
        return None
    r = abs(sum([x * y for x, y in zip(xs, ys, strict=True)])) / (sqrt(xx) * sqrt(yy))
    return min(r, 1.0) if isfinite(r) else None


def own_share(similarity: float | None, own_index: float, other_index: float) -> float:
    """Return Calicoef of (11), the share of the foot's own length in its calibrated one, 0 to 1."""
    if similarity is None or similarity <= 0.0:
        return 1.0
    against = other_index + similarity * own_index
    if against <= 0.0:
        return 1.0 / (1.0 + similarity)
    return other_index / against


def _valid_index(index: float | None) -> float | None:
    return None if index is None or not isfinite(index) or index < 0.0 else index
