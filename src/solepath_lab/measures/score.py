"""Scores of one recording, and their summary over several."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from operator import add

import numpy as np
from attrs import field, frozen

from solepath.validate.matching import Errors, Matching

from .confusion import ActivityScore
from .strides import StrideScore

Figures = dict[str, float | None]
"""Figures by name, in SI units; None for a figure that could not be measured."""


@frozen
class Scored:
    """The scores of one recording. `figures` are averaged over recordings; the other scores are pooled."""

    recording: str
    figures: Figures = field(factory=dict)
    events: dict[str, Matching] = field(factory=dict)
    """Matched events by kind: heel_strike, toe_off."""
    strides: StrideScore | None = None
    activity: ActivityScore | None = None
    errors: dict[str, Errors] = field(factory=dict)
    """Errors by kind: leg of the feet and body_leg of the wearer (relative), stride_time (s)."""
    groups: tuple[str, ...] = ("all",)
    """Names of the groups that this recording belongs to."""
    samples: int = 0
    """Number of samples."""
    seconds: float = 0.0
    """Wall time that the session took, s."""

    def flat(self) -> Figures:
        """Return every figure of this recording by its name in tables and JSON."""
        flat = dict(self.figures)
        for kind, matching in self.events.items():
            flat |= {
                f"{kind}_true": matching.n_true,
                f"{kind}_found": matching.n_found,
                f"{kind}_f1": matching.f1,
                f"{kind}_bias": matching.bias,
                f"{kind}_mad": matching.mad,
                f"{kind}_scatter": matching.scatter,
                f"{kind}_off": matching.median_magnitude,
            }
        if self.strides is not None:
            flat |= {
                "strides_true": self.strides.n_true,
                "strides_found": self.strides.n_found,
                "strides_invented": self.strides.n_invented,
                "stride_error": self.strides.errors.mean,
                "stride_error_median": self.strides.errors.median,
                "stride_error_track": self.strides.track_errors.mean,
                "stride_longest": self.strides.longest,
            }
        if self.activity is not None:
            flat |= self.activity.figures
        for kind, pooled in self.errors.items():
            flat |= {
                f"{kind}_count": len(pooled.values),
                f"{kind}_error": pooled.mean,
                f"{kind}_error_median": pooled.median,
                f"{kind}_bias": pooled.bias,
            }
        return flat


@frozen
class Summary:
    """Averages and pooled figures of one group of recordings."""

    group: str
    count: int
    mean: Figures
    median: Figures
    together: Figures
    """Figures of the pooled events, strides, activities and errors."""
    confusion: dict[str, dict[str, int]] | None = None
    """Confusion matrix {true activity: {reported activity: samples}}, when activities were scored."""


def summarise(scores: Sequence[Scored], group: str) -> Summary:
    """Return the summary of the recordings of one group."""
    members = [score for score in scores if group in score.groups]
    keys = list(dict.fromkeys(key for score in members for key in score.figures))
    values = {key: [v for s in members if (v := s.figures.get(key)) is not None] for key in keys}
    kinds = list(dict.fromkeys(kind for score in members for kind in score.events))
    events = {kind: reduce(add, [s.events[kind] for s in members if kind in s.events]) for kind in kinds}
    strides = [score.strides for score in members if score.strides is not None]
    activities = [score.activity for score in members if score.activity is not None]
    activity = reduce(add, activities) if activities else None
    pools = list(dict.fromkeys(kind for score in members for kind in score.errors))
    errors = {kind: reduce(add, [s.errors[kind] for s in members if kind in s.errors]) for kind in pools}
    return Summary(
        group=group,
        count=len(members),
        mean={key: float(np.mean(v)) for key, v in values.items() if v},
        median={key: float(np.median(v)) for key, v in values.items() if v},
        together=Scored(group, {}, events, reduce(add, strides) if strides else None, activity, errors).flat(),
        confusion=None if activity is None else activity.table,
    )
