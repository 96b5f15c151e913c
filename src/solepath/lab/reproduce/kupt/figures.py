"""Figures 11 and 14 of Chen et al. 2019, and the share of a gait cycle in which a velocity is known."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from attrs import frozen

from ....calibration import Calibration
from ....events import Event, StrideFused, StrideTaken
from ....foot.stance.stance import Stance
from ....papers.kupt_dfpc.moment import PRINTED
from ....papers.kupt_dfpc.recipe import KUPT_DFPC_PRINTED
from ....papers.kupt_dfpc.swing_dedrift import LARGEST_ROLLING_SIGMA, SwingDedrift
from ....session import Session
from ....types import Foot, Phase, Sample
from ....types.attrs import define, evolve, field
from ..tables import Curves, DrawStyle, PictureTrack

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
        if isinstance(corrector, WatchedSwing):
            seen[foot] = tuple(corrector.seen)
    return seen


def coverage(seen: Sequence[KnownSample]) -> tuple[float, float]:
    """Return the shares of whole gait cycles, %, in which ZUPT and KUPT know the velocity.

    A cycle lasts from the end of one stance to the end of the next; the first and the last are left out."""
    ends = [k for k, (one, following) in enumerate(pairwise(seen)) if one.stands and not following.stands]
    strides = [(a, b) for a, b in pairwise(ends) if seen[b].t - seen[a].t > LEAST_MOTION_TIME][1:-1]
    samples = [one for a, b in strides for one in seen[a + 1 : b + 1]]
    if not samples:
        return 0.0, 0.0
    stands = sum(one.stands for one in samples)
    known = sum(one.reference is not None for one in samples)
    return 100.0 * stands / len(samples), 100.0 * known / len(samples)


def panels(seen: dict[Foot, tuple[KnownSample, ...]], events: dict[str, list[Event]]) -> tuple[Curves, ...]:
    """Return the panels of fig. 11, for the left foot, and fig. 14."""
    left = seen[Foot.LEFT]
    fused = [event for event in events["KUPT+DFPC"] if isinstance(event, StrideFused) and event.foot is Foot.LEFT]
    indices = [
        PictureTrack("similarity (9)", tuple([(e.t, e.similarity) for e in fused if e.similarity is not None])),
        PictureTrack("EI (10), m/s", tuple([(e.t, e.error_index) for e in fused if e.error_index is not None])),
        PictureTrack("coefficient (11)", tuple([(e.t, e.coefficient) for e in fused])),
    ]
    walked = [
        PictureTrack(name, _sums(events[key], Foot.LEFT), DrawStyle.DOTS)
        for name, key in (("ZUPT", "ZUPT"), ("KUPT", "KUPT+DFPC"))
    ]
    total, calibrated = 0.0, []
    for event in fused:
        total += event.stride_length
        calibrated.append((event.t, total))
    walked.append(PictureTrack("KUPT + 1st stage DFPC", tuple(calibrated), DrawStyle.DOTS))
    walked.append(PictureTrack("KUPT+DFPC", tuple([(e.t, e.distance) for e in fused]), DrawStyle.DOTS))
    ends = [k for k, (one, following) in enumerate(pairwise(left)) if one.stands and not following.stands]
    middle = len(ends) // 2
    shown = left[ends[middle] : ends[min(middle + SHOWN_STRIDES, len(ends) - 1)] + 1] if ends else left
    return (
        Curves("velocity, left foot (fig. 11 a)", _velocities(left), "time, s", "velocity, m/s"),
        Curves("weights, left foot (fig. 11 c)", tuple(indices), "time, s", "no unit or m/s"),
        Curves("distance, left foot (fig. 11 e)", tuple(walked), "time, s", "distance, m"),
        Curves("drift in three strides (fig. 14)", _velocities(shown), "time, s", "velocity, m/s"),
    )


def _velocities(seen: Sequence[KnownSample]) -> tuple[PictureTrack, ...]:
    raw = PictureTrack("V-raw", tuple([(one.t, one.raw) for one in seen]))
    reference = [(one.t, one.reference) for one in seen if one.reference is not None]
    return raw, PictureTrack("V-ref", tuple(reference), DrawStyle.DOTS), PictureTrack("ZUPT", _without_drift(seen))


def _without_drift(seen: Sequence[KnownSample]) -> tuple[tuple[float, float], ...]:
    """Return the raw velocity without the linear drift of each motion, as ZUPT has it."""
    points: list[tuple[float, float]] = []
    motion: list[KnownSample] = []
    for one, following in pairwise(seen):
        if one.stands:
            points.append((one.t, 0.0))
            continue
        motion.append(one)
        if following.stands:
            start = points[-1][0] if points else motion[0].t
            rate = motion[-1].raw / max(motion[-1].t - start, 1e-6)
            points += [(of.t, of.raw - rate * (of.t - start)) for of in motion]
            motion = []
    return tuple(points)


def _sums(events: Sequence[Event], foot: Foot) -> tuple[tuple[float, float], ...]:
    total, points = 0.0, []
    for event in events:
        if isinstance(event, StrideTaken) and event.final and event.foot is foot:
            total += event.length
            points.append((event.t, total))
    return tuple(points)
