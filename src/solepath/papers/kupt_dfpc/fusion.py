"""Double-foot position calibration: the strides of both feet calibrate each other (recipe kupt-dfpc).

"Smart insole-based indoor localization system for Internet of Things applications", IEEE Internet of Things Journal 6,
2019, section III.C.4: similarity of two steps (9), error index (10, from the corrector), coefficient (11), calibrated
stride length (12), choice of the foot (13).

What the paper leaves open is settled here:

- The other foot's step is its latest one that ended before this one did (fig. 9: L1, R1, L2, ... each by the one
  before). It is not used when it ended before this step began (the other foot left one out) or longer than `PATIENCE`
  before this foot left the ground (the wearer stood), nor when it was abnormal.
- A step that has nothing to be compared with, or is itself abnormal (no error index), keeps its own length:
  coefficient 1. So does one that is not similar at all, r = 0, or whose similarity is undefined because a path of the
  centre of pressure is constant or unknown: (11) tends to 1 as r goes to 0.
- A half stride and a whole one are not similar: fig. 11 has low similarities at the first and the last step of a walk.
  Our paths of the centre of pressure end at toe-off, before it shows that a step closes the walk; so strides of which
  one is shorter than `ALIKE` of the other have r = 0.
- (11) is computed as EI_other / (EI_other + r EI_own), which is the same and divides by zero only where both error
  indices are zero; there it is 1 / (1 + r), as for any two equal ones.
- (13) adds up pairs of steps. A pair is a step and the other foot's before it, each step in one pair at most: with feet
  that take turns that is the k-th left with the k-th right one, and a step that is missing on one side shifts nothing.
  While the sum is zero the foot that stepped first is the chosen one.
- An abnormal step has no error index, and left out of (13) it would speak for its foot. In a pair with a normal step it
  counts as `ABNORMAL` m/s worse than that, by the mean of both lengths as in (13): an absurd one weighs as much as it
  is long. A pair of two abnormal steps favours neither foot.
- A foot that took no step during `AWAY` steps of the other is not chosen, whatever (13) says, and when it steps again
  its path goes on from the other's end: what it did meanwhile is not known.
"""

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
"""Steps are compared at this many instants."""
KEPT = 3
"""Latest steps of each foot that are remembered: samples of one foot may arrive a step later than the other's."""
ABSENT = 1.0
"""A foot that was last heard this long before the other is absent, s."""
LEAST_WAY = 1e-6
"""A shorter step has no direction, m."""
LEAST_SPREAD = 1e-12
"""A path of the centre of pressure that varies less is constant but for rounding, m^2."""
PATIENCE, ALIKE, AWAY = 1.0, 0.75, 3
"""A step of the other foot that ended longer ago than this, s, is not used; of two steps of which one is shorter than
this share of the other r is 0; a foot that took no step during so many of the other's is not chosen."""
ABNORMAL = 1.0
"""An abnormal step counts as so much worse than a normal one, m/s: about what the error indices of normal steps on
recorded insoles come to."""


@define
class FusedStride:
    """What is kept of one step."""

    t_end: float
    length: float
    """As its own foot has it, m."""
    calibrated: float
    """D of (12), m."""
    error_index: float | None
    rhythm: tuple[float, ...]
    """Centre of pressure along the foot at POINTS instants, m; empty when it is not known."""
    paired: bool = False
    """Counted in (13)."""


@define
class CalibratedPath:
    """The calibrated path of one foot."""

    latest: list[FusedStride] = field(factory=list)
    end: Vec3 = ZERO
    """Where the last step ended, world frame, m."""
    distance: float = 0.0
    """Sum of the calibrated lengths, m."""
    shifted: tuple[float, float] = (0.0, 0.0)
    """By how much calibration has moved `end` against the foot's own track, m."""
    stood: Vec3 = ZERO
    """Where the foot's own track had it after its last step, world frame, m."""
    missed: int = 0
    """Steps that the other foot took since this one's last."""


@define
class DoubleFoot(TrackPart):
    """Both feet's steps in, one `StrideFused` for each out. Latency: none beyond the step's own; the choice of (13) is
    made anew after every step and is final for it. O(1) memory.

    The live position is that of the chosen foot on its calibrated path: the path's end, and what the foot's own track
    has moved by since; of the other foot while the chosen one is absent. So it stands while that foot does, and leaps
    by half a stride when the choice changes. Its covariance is that of the foot's own track, and over it the square of
    what calibration has moved the path by: either may be right.
    """

    needs_samples: ClassVar[bool] = True
    idle = True

    paths: dict[Foot, CalibratedPath] = field(init=False)
    weighted: float = field(default=0.0, init=False)
    """The sum of (13), m^2/s: positive when the left foot errs more."""
    chosen: Foot | None = field(default=None, init=False)

    def __attrs_post_init__(self) -> None:
        self.paths = {foot: CalibratedPath() for foot in Foot}

    def feed(self, view: FootView) -> Sequence[PartOutput]:
        strides = [event for event in view.events if isinstance(event, StrideTaken)] if view.events else []
        layout = view.after.layout
        middle = None if layout is None or not strides else centre(layout)
        return [self.step(stride, middle) for stride in strides]

    def reset(self, site: Site) -> None:
        """The foot's steps so far have times of another clock: nothing is compared with them."""
        if site.foot is not None:
            self.paths[site.foot].latest = []

    def step(self, taken: StrideTaken, centre: float | None) -> StrideFused:
        """One step. `centre`: x of the insole's centre in the foot frame, m, where the centre of pressure is taken to
        be while the foot is in the air (section III.C.2); None when there is no insole."""
        foot = taken.foot
        path, others = self.paths[foot], self.paths[OTHER[foot]]
        index = _sound(taken.features.error_index)
        rhythm = () if centre is None or index is None else resampled(taken, centre)
        similarity, coefficient, length = None, 1.0, taken.length
        partner = self._partner(taken, others)
        paired = False
        if index is not None and partner is not None and partner.error_index is not None:
            similarity = correlation(rhythm, partner.rhythm)
            shorter, longer = sorted((taken.length, partner.length))
            if similarity is not None and shorter < ALIKE * longer:
                similarity = 0.0
            coefficient = share(similarity, index, partner.error_index)
            length = coefficient * taken.length + (1.0 - coefficient) * partner.length  # (12)
        if partner is not None and not partner.paired:
            partner.paired = paired = True
            errs = self._errs(index, partner.error_index)
            mean = 0.5 * (abs(length) + abs(partner.calibrated))
            self.weighted += (errs if foot is Foot.LEFT else -errs) * mean  # (13)
        stepped = FusedStride(taken.t_end, taken.length, length, index, rhythm, paired)
        path.latest = [*path.latest[1 - KEPT :], stepped]
        self._extend(path, others, taken, length)
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

    def _errs(self, own: float | None, other: float | None) -> float:
        """By how much the one step errs more than the other, m/s."""
        if own is None:
            return 0.0 if other is None else ABNORMAL
        return -ABNORMAL if other is None else own - other

    def _partner(self, taken: StrideTaken, others: CalibratedPath) -> FusedStride | None:
        """The other foot's latest step before this one, unless it is too old."""
        left_at = taken.t_start if taken.t_toe_off is None else taken.t_toe_off
        for stepped in reversed(others.latest):
            if stepped.t_end <= taken.t_end:
                fresh = stepped.t_end > taken.t_start and left_at - stepped.t_end <= PATIENCE
                return stepped if fresh else None
        return None

    def _extend(self, path: CalibratedPath, others: CalibratedPath, taken: StrideTaken, length: float) -> None:
        """The path goes on in the step's own direction, by the calibrated length."""
        if path.missed >= AWAY:
            path.end, path.distance, path.shifted = others.end, others.distance, others.shifted
        dx, dy, dz = taken.displacement
        own = taken.length
        k = length / own if own > LEAST_WAY else 1.0
        x, y, z = path.end
        path.end = (x + k * dx, y + k * dy, z + dz)
        path.distance += abs(length)
        sx, sy = path.shifted
        path.shifted = (sx + (k - 1.0) * dx, sy + (k - 1.0) * dy)
        path.stood, path.missed = taken.position, 0
        others.missed = min(others.missed + 1, AWAY)

    def _choose(self, stepped: Foot) -> Foot:
        """Which path is the wearer's now, by the sign of (13)."""
        chosen = self.chosen or stepped
        if self.chosen is not None and self.weighted != 0.0:
            chosen = Foot.RIGHT if self.weighted > 0.0 else Foot.LEFT
        self.chosen = stepped if self.paths[chosen].missed >= AWAY else chosen
        return self.chosen

    def position(self, feet: Mapping[Foot, FootPose]) -> Position | None:
        if not feet:
            return None
        newest = max([pose.t for pose in feet.values()])
        present = [foot for foot, pose in feet.items() if newest - pose.t < ABSENT]
        chosen = self.chosen if self.chosen in present else present[0]
        path, foot = self.paths[chosen], feet[chosen]
        dx, dy, dz = sub(foot.position, path.stood)
        x, y, z = path.end
        xx, xy, xz, yy, yz, zz = foot.covariance
        sx, sy = path.shifted
        return Position(newest, (x + dx, y + dy, z + dz), (xx + sx * sx, xy + sx * sy, xz, yy + sy * sy, yz, zz))


def resampled(taken: StrideTaken, centre: float) -> tuple[float, ...]:
    """copY of a step (the centre of pressure along the foot, m) at POINTS instants evenly spaced over its time.

    Steps have unequal numbers of samples and (9) wants equal ones, so both are compared over the step's own time from
    foot-flat to heel-strike: first the path on the ground, as `StrideFeatures.cop` has it from foot-flat to toe-off,
    then `centre` while the foot is in the air, each in proportion to its time. The loading after heel-strike is not
    part of that path and is left out. Empty without a path, and for a step without a toe-off.
    """
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
    """r of (9), 0 to 1: how similar two paths of equally many points are. None when one of them is constant or there
    is none."""
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


def share(similarity: float | None, own_index: float, other_index: float) -> float:
    """Calicoef of (11), 0 to 1: the share of the foot's own length in its calibrated one."""
    if similarity is None or similarity <= 0.0:
        return 1.0
    against = other_index + similarity * own_index
    if against <= 0.0:
        return 1.0 / (1.0 + similarity)
    return other_index / against


def _sound(index: float | None) -> float | None:
    return None if index is None or not isfinite(index) or index < 0.0 else index
