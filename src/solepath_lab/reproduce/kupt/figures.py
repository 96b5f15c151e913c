"""Figures 10, 11 and 14 of Chen et al. 2019, and the share of a gait cycle in which a velocity is known."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, pairwise

import numpy as np
from attrs import frozen

from solepath.calibration import Calibration
from solepath.events import Event, HeelStrike, StrideFused, ToeOff
from solepath.papers.kupt_dfpc.cop_cues import CopCues
from solepath.papers.kupt_dfpc.known_velocity import KnownVelocity
from solepath.papers.kupt_dfpc.recipe import KUPT_DFPC_PRINTED
from solepath.papers.kupt_dfpc.swing_drift import SwingDedrift
from solepath.session import Session
from solepath.types import Foot, Sample

from ..tables import DrawStyle, PictureTrack, Plot
from ..walks import final_strides

LEAST_MOTION_TIME = 0.3
"""Shortest time between two stances that is a stride, s."""
SHOWN_STRIDES = 3
"""Number of strides of fig. 14."""
STATIONARY_LEVEL = 0.25
"""Height of the line of fig. 10 in a stationary epoch, m."""


@frozen
class KnownSample:
    """What is known at one sample: velocities along the direction of the walk, which is x, and the pressure."""

    t: float
    """Time of the sample, s."""
    raw: float
    """Raw velocity, m/s; 0 in stance."""
    reference: float | None
    """Velocity of the rolling shoe, m/s; None where there is none."""
    stands: bool
    """True in the stationary epoch."""
    cop: float | None = None
    """Centre of pressure along the foot from the heel, m; that of the foot in the air."""


Seen = dict[Foot, list[KnownSample]]


def watch(samples: Sequence[Sample], calibration: Calibration) -> tuple[Seen, list[Event]]:
    """Return what the printed recipe knows at each sample of both feet, and its events."""
    session = Session(KUPT_DFPC_PRINTED, calibration=calibration)
    seen: Seen = {foot: [] for foot in Foot}
    events: list[Event] = []
    for sample in samples:
        events += session.feed(sample)
        foot = sample.site.foot
        assert foot is not None
        tracker = session.feet[foot]
        corrector, detector, cues = tracker.corrector, tracker.detector, tracker.cues
        assert isinstance(corrector, SwingDedrift) and isinstance(detector, KnownVelocity) and isinstance(cues, CopCues)
        stands, now = corrector.standing, corrector.current
        reference = 0.0 if stands else None
        if not stands and now is not None and now.error is not None and detector.position is not None:
            reference = corrector.interval_velocity[0] - now.error[0]
        raw = 0.0 if stands else corrector.raw_velocity[0]
        seen[foot].append(KnownSample(sample.t, raw, reference, stands, cues.cop))
    return seen, events + session.finish()


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


def panels(seen: Seen, printed: list[Event], zupt: list[Event], known: list[Event]) -> tuple[Plot, ...]:
    """Return the panels of figs. 10 and 11, each for both feet, and fig. 14 for the left one.

    `printed` are the events of the printed recipe, which fig. 10 and the weights are of; `zupt` and `known` are those
    of ZUPT and of ours, whose distances are shown."""
    plots = [_events_panel(seen[foot], printed, foot) for foot in Foot]
    for foot, (velocity, weight, distance) in zip(Foot, (("a", "c", "e"), ("b", "d", "f")), strict=True):
        plots += [
            Plot(f"velocity (fig. 11 {velocity})", _velocities(seen[foot]), "time, s", "velocity, m/s"),
            Plot(f"weights (fig. 11 {weight})", _weights(printed, foot), "time, s", "no unit or m/s"),
            Plot(f"distance (fig. 11 {distance})", _distances(zupt, known, foot), "time, s", "distance, m"),
        ]
    left = seen[Foot.LEFT]
    ends = _stance_ends(left)
    middle = len(ends) // 2
    shown = left[ends[middle] : ends[min(middle + SHOWN_STRIDES, len(ends) - 1)] + 1] if ends else left
    return (*plots, Plot("drift in three strides (fig. 14)", _velocities(shown), "time, s", "velocity, m/s"))


def _events_panel(seen: Sequence[KnownSample], printed: list[Event], foot: Foot) -> Plot:
    """Return fig. 10 for one foot: the centre of pressure, the stationary epochs and the events found from it."""
    cop = [(one.t, one.cop) for one in seen if one.cop is not None]
    tracks = [
        PictureTrack("stationary", [(one.t, STATIONARY_LEVEL if one.stands else 0.0) for one in seen], DrawStyle.TRUTH),
        PictureTrack("CoP along the foot", cop),
    ]
    for kind in (HeelStrike, ToeOff):
        times = [one.t for one in printed if isinstance(one, kind) and one.foot is foot]
        places = np.interp(times, [t for t, _ in cop], [x for _, x in cop]).tolist()
        tracks.append(PictureTrack(kind.__name__, zip(times, places, strict=True), DrawStyle.DOTS))
    return Plot(
        f"{foot.value} foot (fig. 10 {'a' if foot is Foot.LEFT else 'b'})", tracks, "time, s", "from the heel, m"
    )


def _weights(events: list[Event], foot: Foot) -> list[PictureTrack]:
    fused = [event for event in events if isinstance(event, StrideFused) and event.foot is foot]
    columns = {"similarity (9)": "similarity", "EI (10), m/s": "error_index", "coefficient (11)": "coefficient"}
    return [
        PictureTrack(name, [(one.t, value) for one in fused if (value := getattr(one, key)) is not None])
        for name, key in columns.items()
    ]


def _distances(zupt: list[Event], known: list[Event], foot: Foot) -> list[PictureTrack]:
    """Return the sums of stride lengths over time, and after each stride the distance of the foot chosen by (13)."""
    fused = [event for event in known if isinstance(event, StrideFused)]
    own = [event for event in fused if event.foot is foot]
    lengths = {
        "ZUPT": [(one.t, one.length) for one in final_strides(zupt, foot)],
        "KUPT": [(one.t, one.length) for one in final_strides(known, foot)],
        "KUPT + 1st stage DFPC": [(one.t, one.stride_length) for one in own],
    }
    sums = {name: list(accumulate([length for _, length in of])) for name, of in lengths.items()}
    tracks = [
        PictureTrack(name, zip([t for t, _ in of], sums[name], strict=True), DrawStyle.DOTS)
        for name, of in lengths.items()
    ]
    return [*tracks, PictureTrack("KUPT+DFPC", [(one.t, one.distance) for one in fused], DrawStyle.DOTS)]


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
    errors = np.interp([one.t for one in samples], [t for t, _ in knots], [error for _, error in knots]).tolist()
    return tuple([(one.t, one.raw - error) for one, error in zip(samples, errors, strict=True)])
