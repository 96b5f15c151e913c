"""Figures 11 and 14 of Chen et al. 2019, and the share of a gait cycle in which a velocity is known."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from attrs import frozen

from solepath.calibration import Calibration
from solepath.events import Event, StrideFused
from solepath.foot.stance.stance import Stance
from solepath.papers.kupt_dfpc.recipe import KUPT_DFPC_PRINTED
from solepath.papers.kupt_dfpc.swing.dedrift import LARGEST_ROLLING_SIGMA, SwingDedrift
from solepath.papers.kupt_dfpc.swing.settings import PRINTED
from solepath.session import Session
from solepath.types import Foot, Phase, Sample
from solepath.types.attrs import define, evolve, field

from ..tables import DrawStyle, PictureTrack, Plot
from ..walks import final_strides

LEAST_MOTION_TIME = 0.3
"""Shortest time between two stances that is a stride, s."""
SHOWN_STRIDES = 3
"""Number of strides of fig. 14."""


@frozen
class KnownSample:
    """The velocities of one sample, along the direction of the walk, which is x."""

    t: float
    """Time of the sample, s."""
    raw: float
    """Raw velocity, m/s; 0 in stance."""
    reference: float | None
    """Velocity of the rolling shoe, m/s; None where there is none."""
    stands: bool
    """True in the stationary epoch."""


@define
class WatchedSwing(SwingDedrift):
    """Corrector as printed that keeps the velocities of all samples; it is for figures only."""

    seen: list[KnownSample] = field(factory=list, init=False)
    """Samples of the session so far."""

    def correct(self, t: float, stance: Stance) -> bool:
        raw = self.raw_velocity[0]
        stands = SwingDedrift.correct(self, t, stance)
        rolls = stance.hint in (Phase.PUSH_OFF, Phase.LOADING) and stance.sigma <= LARGEST_ROLLING_SIGMA
        reference = 0.0 if stands else stance.v_ref[0] if rolls else None
        self.seen.append(KnownSample(t, 0.0 if stands else raw, reference, stands))
        return stands


def watch(samples: Sequence[Sample], calibration: Calibration) -> dict[Foot, tuple[KnownSample, ...]]:
    """Return the velocities of both feet, as fig. 11 (a) and (b) and fig. 14 have them."""
    session = Session(evolve(KUPT_DFPC_PRINTED, corrector=WatchedSwing(PRINTED)), calibration=calibration)
    session.feed(samples)
    session.finish()
    seen = {}
    for foot in Foot:
        corrector = session.feet[foot].corrector
        assert isinstance(corrector, WatchedSwing)
        seen[foot] = tuple(corrector.seen)
    return seen


def coverage(seen: Sequence[KnownSample]) -> tuple[float, float]:
    """Return the shares of whole gait cycles, %, in which ZUPT and KUPT know the velocity.

    A cycle lasts from the end of one stance to the end of the next; the first and the last are left out."""
    ends = _stance_ends(seen)
    strides = [(a, b) for a, b in pairwise(ends) if seen[b].t - seen[a].t > LEAST_MOTION_TIME][1:-1]
    samples = [one for a, b in strides for one in seen[a + 1 : b + 1]]
    if not samples:
        return 0.0, 0.0
    stands = sum(one.stands for one in samples)
    known = sum(one.reference is not None for one in samples)
    return 100.0 * stands / len(samples), 100.0 * known / len(samples)


def _stance_ends(seen: Sequence[KnownSample]) -> list[int]:
    """Return the indices of the last samples of the stances that a motion follows."""
    return [k for k, (one, following) in enumerate(pairwise(seen)) if one.stands and not following.stands]


def panels(
    seen: dict[Foot, tuple[KnownSample, ...]], events: dict[str, list[Event]], by_index: list[Event]
) -> tuple[Plot, ...]:
    """Return the panels of fig. 11, for the left foot, and fig. 14.

    `events` are those of ZUPT and KUPT+DFPC; `by_index` are those of the recipe whose coefficients are (11)."""
    left = seen[Foot.LEFT]
    fused = [event for event in events["KUPT+DFPC"] if isinstance(event, StrideFused) and event.foot is Foot.LEFT]
    weighed = [event for event in by_index if isinstance(event, StrideFused) and event.foot is Foot.LEFT]
    indices = [
        PictureTrack("similarity (9)", [(e.t, e.similarity) for e in weighed if e.similarity is not None]),
        PictureTrack("EI (10), m/s", [(e.t, e.error_index) for e in weighed if e.error_index is not None]),
        PictureTrack("coefficient (11)", [(e.t, e.coefficient) for e in weighed]),
    ]
    walked = [
        PictureTrack(name, _sums(events[key], Foot.LEFT), DrawStyle.DOTS)
        for name, key in (("ZUPT", "ZUPT"), ("KUPT", "KUPT+DFPC"))
    ]
    total, calibrated = 0.0, []
    for event in fused:
        total += event.stride_length
        calibrated.append((event.t, total))
    walked.append(PictureTrack("KUPT + 1st stage DFPC", calibrated, DrawStyle.DOTS))
    walked.append(PictureTrack("KUPT+DFPC", [(e.t, e.distance) for e in fused], DrawStyle.DOTS))
    ends = _stance_ends(left)
    middle = len(ends) // 2
    shown = left[ends[middle] : ends[min(middle + SHOWN_STRIDES, len(ends) - 1)] + 1] if ends else left
    return (
        Plot("velocity, left foot (fig. 11 a)", _velocities(left), "time, s", "velocity, m/s"),
        Plot("weights, left foot (fig. 11 c)", indices, "time, s", "no unit or m/s"),
        Plot("distance, left foot (fig. 11 e)", walked, "time, s", "distance, m"),
        Plot("drift in three strides (fig. 14)", _velocities(shown), "time, s", "velocity, m/s"),
    )


def _velocities(seen: Sequence[KnownSample]) -> tuple[PictureTrack, ...]:
    raw = PictureTrack("V-raw", [(one.t, one.raw) for one in seen])
    reference = [(one.t, one.reference) for one in seen if one.reference is not None]
    zupt, kupt = without_drift(seen, knows_rolling=False), without_drift(seen, knows_rolling=True)
    dots = PictureTrack("V-ref", reference, DrawStyle.DOTS)
    return raw, dots, PictureTrack("ZUPT", zupt), PictureTrack("KUPT", kupt)


def without_drift(seen: Sequence[KnownSample], knows_rolling: bool) -> tuple[tuple[float, float], ...]:
    """Return the velocity at each sample but those of an unfinished motion: times, s, and velocities, m/s.

    Between samples whose velocity is known the error of the raw one is taken for linear, as in (8). Known are zero
    velocities and, with `knows_rolling`, those of the rolling shoe; so the curve is that of ZUPT or of KUPT."""
    knots = []
    for one, following in pairwise(seen):
        if one.stands:
            knots.append((one.t, 0.0))
        elif knows_rolling and one.reference is not None:
            knots.append((one.t, one.raw - one.reference))
        elif following.stands:
            knots.append((one.t, one.raw))
    if not knots:
        return ()
    samples = [one for one in seen if one.t <= knots[-1][0]]
    times, known_errors = [t for t, _ in knots], [error for _, error in knots]
    errors = np.interp([one.t for one in samples], times, known_errors).tolist()
    return tuple([(one.t, one.raw - error) for one, error in zip(samples, errors, strict=True)])


def _sums(events: Sequence[Event], foot: Foot) -> tuple[tuple[float, float], ...]:
    total, points = 0.0, []
    for stride in final_strides(events, foot):
        total += stride.length
        points.append((stride.t, total))
    return tuple(points)
