"""Evidence that a foot carries its walker, from each of its strides and from how alike they are.

A foot on a pedal, in a vehicle or below a chair comes to what looks like a foot-flat, too. Then the stride between two
of them is not what a walk makes of it: in a walk the foot comes back to lie as flat as before, feels nothing but
gravity while it rests, and is struck when it lands; its greatest speed is 1.2 times the mean speed of its swing, its
height returns to the floor or to a tread, and the next stride is like it. Each of these adds to the logarithm of the
likelihood ratio of a foot that carries to one that does not. The sum over strides decides, so that an odd stride of a
walk counts and an odd one on a bicycle does not."""

from __future__ import annotations

from math import log
from typing import NamedTuple

from ..events import Flaw, StrideTaken
from ..types.attrs import define, evolve, field
from ..types.vector import GRAVITY, TIME_EPSILON

USUAL_SPEED_RATIO = 1.2
"""Greatest speed of a swing divided by its length over its time, no unit; chosen by hand, walks have 1.0 to 1.4."""
GRAVITY_RATES = (6.0, 10.0)
"""Peak rates, rad/s, up to which the force at rest counts and from which on it does not: a runner pushes off in it."""
SHORT_LENGTH = 0.4
"""Length below which a stride is a shuffle or no stride, m."""
LEAST_LIFT = 0.01
"""Smallest height of a swing whose ratio to the length counts, m."""
FASTEST_SWING = 6.0
"""Speed of a foot that only runners exceed, m/s; chosen by hand. What is faster is an integral that runs away."""
SWING_TIMES = (0.2, 1.2)
"""Times of a swing that walkers and runners have, from the fastest to patients, s."""
USUAL_SWING = 0.4
"""Time of a swing of which toe-off or heel-strike is not known, s."""
MOST_OFF_GRAVITY = 4.0
"""Largest distance of the force at rest from gravity that counts, m/s^2; it stands for a foot that did not rest."""
TREADS_RISE = 0.34
"""Rise of a stride over two treads, m: risers of 0.14 to 0.20 m (Approved Document K of the Building Regulations 2010
allows 0.15 to 0.22 m)."""
RISE_ERROR, RISE_ERROR_SHARE = 0.05, 0.08
"""Standard deviation of a measured rise, m, and its growth with the length, no unit.

Level strides of an accelerometer that clips at 2 g (hugadb) rise by 0.10 m over 0.9 m. Chosen of three pairs there, all
wearers in view (0.04 and 0.06 have 1.3 points less, 0.06 and 0.1 as many), and on emulated walks backwards."""
USUAL_TILT = 0.3
"""Tilt from one foot-flat to the next that does not count, rad.

95 % of the strides of each data set have less than 0.3, of insoles at 35 Hz 0.31 and of slow patients 0.37. Sensors
that a hand puts down elsewhere have 0.4 to 1.1 in half of what looks like strides."""
LEAST_LENGTH, LEAST_FORCE_RANGE, LEAST_SWING = 0.03, 0.3, 0.02
"""Smallest length, m, range of the specific force, m/s^2, and swing, s, whose logarithm counts."""

OFFSET = 2.2
"""Evidence of a stride whose features are all 0, a logarithm of a likelihood ratio.

The weights and the offset are a logistic regression over strides of recordings and of made motions, which
`solepath-lab train bearing` prints. The offset is 0.75 above the fitted one, because the sum over strides decides."""
WEIGHTS = (-2.6, 1.3, -1.3, -2.3, -0.82, -0.97, -1.1, -5.7, -14.0, -1.0, -2.8)
"""Weight of each of `features`."""

MOST_FOR, MOST_AGAINST = 3.0, -3.0
"""Limits of the evidence of one stride, so that none decides alone against those before it."""
MOST_OF_FIRST = 1.5
"""Largest size of the evidence of the first stride of a bout, which is below `KNOWN`: a bout has two strides at least
(Kluge et al., "Consensus based framework for digital mobility monitoring", PLoS ONE 16, 2021)."""
IMPOSSIBLE = -4.0
"""Evidence of a stride by itself below which its displacement is none, so that the foot is moved back.

A lone step, or one of somebody who crawls, is no bout but moves the foot. Of 353 strides on a bicycle 80 % are below
(hugadb_daily)."""
KNOWN, SUREST = 2.0, 5.0
"""Evidence from which on a foot is known to carry its walker, and its largest value."""
AFTER_PAUSE = 0.4
"""Largest evidence that is left after a pause: with `MOST_OF_FIRST` of a stride, less than `KNOWN`; chosen by hand."""
LEAST_PROGRESS = 0.15
"""Length of a stride below which it goes nowhere and speaks for no walk, m, as steps on the spot do; chosen by hand,
below the strides of patients who shuffle."""
MOST_SHAKING = 3.0
"""Largest standard deviation of the specific force in the rest of a stride that speaks for a walk, m/s^2.

It is smaller in 99 of 100 strides of recordings, and 5 (2 to 7) in those of emulated skates. It counts less and less
between the `GRAVITY_RATES`, because a runner pushes off in this rest."""
MOST_MISSING = 0.1
"""Largest share of missing samples of a stride that can be evidence against a foot that carries, if none is a flaw."""
MOST_WAITING = 4
"""Number of strides that wait until it is known whether the foot carries, the newest included."""
FARTHEST = 1e6
"""Largest distance, m, by which a foot is moved back; values beyond it are those of a sensor that fails."""
LONGEST_WAIT = 5.0
"""Longest time between two strides of one bout, s, and longest time for which a stride waits."""


class StrideBefore(NamedTuple):
    """What a stride is compared with of the one before it in the same bout."""

    t_end: float
    """End of the stride, s."""
    length: float
    """Length, m."""
    swing: float | None
    """Time from toe-off to heel-strike, s; None when one of them is not known."""
    is_flawed: bool
    """Flag: the stride has flaws."""

    @classmethod
    def of(cls, stride: StrideTaken) -> StrideBefore:
        """Return what is kept of a stride."""
        return cls(stride.t_end, stride.length, _swing(stride), bool(stride.flaws))


def features(stride: StrideTaken, previous: StrideBefore | None) -> tuple[float, ...]:
    """Return what tells a stride of a walk from another motion, in the order of `WEIGHTS`.

    `previous` is the stride before it in the same bout, if any. The features are: how far the force in the longest
    rest is from gravity; the logarithm of the range of the specific force; how far the greatest speed differs from that
    of a swing of this length and time; shortness; the rise beyond the error of a floor or a tread; how much higher than
    far the foot goes; the time of the swing beyond usual ones; the speed beyond that of a walk; the tilt beyond a usual
    one; and the change of length and of swing since the stride before."""
    measured, length, swing = stride.features, max(stride.length, LEAST_LENGTH), _swing(stride)
    off_gravity = MOST_OFF_GRAVITY
    if measured.rest_force is not None:
        off_gravity = min(off_gravity, abs(measured.rest_force - GRAVITY))
    ratio = measured.peak_speed * (USUAL_SWING if swing is None else swing) / max(length, 0.05) / USUAL_SPEED_RATIO
    rise = abs(stride.height_change if measured.rise is None else measured.rise)
    off_floor = min(rise, abs(rise - TREADS_RISE)) / (RISE_ERROR + RISE_ERROR_SHARE * stride.length)
    short, long = SWING_TIMES
    change = (1.0, 1.0)
    if previous is not None:
        change = (
            min(abs(log(length / max(previous.length, LEAST_LENGTH))), 1.0),
            1.0 if swing is None or previous.swing is None else min(abs(log(swing / previous.swing)), 1.0),
        )
    return (
        off_gravity * _rest_share(measured.peak_rate),
        log(min(max(measured.force_range, LEAST_FORCE_RANGE), 20.0)),
        min(abs(log(max(ratio, 0.05))), 2.0),
        min(max(0.0, log(SHORT_LENGTH / length)), 1.5),
        log(1.0 + min(off_floor, 10.0)),
        min(max(0.0, log(max(measured.clearance + rise, LEAST_LIFT) / length)), 1.5),
        0.0 if swing is None else 5.0 * max(0.0, short - swing) + min(max(0.0, swing - long), 2.0),
        min(max(0.0, log(max(measured.peak_speed, 0.1) / FASTEST_SWING)), 2.0),
        min(max(0.0, measured.tilt - USUAL_TILT), 1.0),
        *change,
    )


def _rest_share(peak_rate: float) -> float:
    """Return how much the force at rest counts at a peak rate, rad/s, from 0 to 1."""
    least, most = GRAVITY_RATES
    return 1.0 - max(0.0, min(1.0, (peak_rate - least) / (most - least)))


def _swing(stride: StrideTaken) -> float | None:
    """Return the time from toe-off to heel-strike, s; None when one of them is not known."""
    if stride.t_toe_off is None or stride.t_heel_strike is None:
        return None
    return max(LEAST_SWING, stride.t_heel_strike - stride.t_toe_off)


def evidence_of(stride: StrideTaken, previous: StrideBefore | None) -> float:
    """Return the logarithm of the likelihood ratio of a foot that carries its walker to one that does not."""
    total = OFFSET
    for weight, value in zip(WEIGHTS, features(stride, previous), strict=True):
        total += weight * value
    return total


@define
class Bearing:
    """Whether a foot carries its walker, and its strides for as long as that is not known.

    Latency: none once it is known; else at most `MOST_WAITING` strides and `LONGEST_WAIT` s."""

    evidence: float = 0.0
    """Logarithm of the likelihood ratio over the strides so far, from -KNOWN to SUREST."""
    waiting: list[StrideTaken] = field(factory=list)
    """Strides of which it is not known yet whether the foot carried its walker, oldest first."""
    previous: StrideBefore | None = None
    """Newest stride of the bout; None before any."""
    alone: bool = False
    """Flag: the other foot is known not to carry."""

    @property
    def is_none(self) -> bool:
        """Whether the foot is known not to carry, by more than strides with flaws."""
        return self.evidence <= -KNOWN and self.previous is not None and not self.previous.is_flawed

    def add(self, stride: StrideTaken, shaking: float = 0.0) -> tuple[list[StrideTaken], list[StrideTaken]]:
        """Add a stride; return the strides that are known now, and those that were none.

        `shaking` is the standard deviation of the size of the specific force in its longest rest, m/s^2."""
        previous, ended = self.previous, list[StrideTaken]()
        if previous is not None and stride.t_end - previous.t_end > LONGEST_WAIT + TIME_EPSILON:
            # whoever has walked walks again sooner than they get on a bicycle, but the first stride does not decide,
            # and what comes after a pause says nothing of what came before it
            previous, self.evidence = None, min(self.evidence, AFTER_PAUSE)
            ended, self.waiting = self.waiting, []
        least, most = (-MOST_OF_FIRST, MOST_OF_FIRST) if previous is None else (MOST_AGAINST, MOST_FOR)
        # nobody walks on one foot, but a sensor that fails may hide that the other foot carries
        one = evidence_of(stride, previous) - (KNOWN if self.alone else 0.0)
        one = max(least, min(most, one))
        if stride.missing > MOST_MISSING or Flaw.GAP in stride.flaws:
            one = max(0.0, one)  # what a gap hides speaks against nobody
        turning = stride.t_end - stride.t_start - stride.features.longest_rest
        shaking *= _rest_share(stride.features.peak_rate)
        if stride.length < LEAST_PROGRESS or turning < SWING_TIMES[0] - TIME_EPSILON or shaking > MOST_SHAKING:
            one = min(0.0, one)  # on the spot, without a turn, or rolling
        self.evidence = max(-KNOWN, min(SUREST, self.evidence + one))
        self.previous = StrideBefore.of(stride)
        waiting = [*self.waiting, stride]
        if self.evidence >= KNOWN:
            self.waiting = []
            known = [each if each is stride else evolve(each, known_at=stride.known_at) for each in waiting]
            return known, ended
        is_none = self.evidence <= -KNOWN
        since = stride.t_end - LONGEST_WAIT + TIME_EPSILON
        kept = [] if is_none else [each for each in waiting[-MOST_WAITING:] if each.t_end > since]
        self.waiting = kept
        return [], [*ended, *waiting[: len(waiting) - len(kept)]]
