"""Scores of one recording, and their summary over several."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import reduce
from operator import add
from typing import Any

import numpy as np
from attrs import field, frozen

from solepath.validate.matching import Errors, Matching

from .confusion import ActivityScore
from .not_walking import NotWalking
from .strides import StrideScore

Figures = dict[str, float | None]
"""Figures by name, in SI units; None for a figure that could not be measured."""


EVENT_FIGURES = {
    "true": "n_true", "found": "n_found", "f1": "f1", "bias": "bias", "mad": "mad", "scatter": "scatter",
    "off": "median_magnitude",
}  # fmt: skip
"""Attribute of matched events by the end of the figure's name."""


@frozen
class Scored:
    """The scores of one recording. `figures` are averaged over recordings; the other scores are pooled."""

    recording: str
    figures: Figures = field(factory=dict)
    events: dict[str, Matching] = field(factory=dict)
    """Matched events by kind: heel_strike, toe_off."""
    strides: StrideScore | None = None
    activity: ActivityScore | None = None
    idle: NotWalking | None = None
    """What is reported of a wearer who takes no step."""
    errors: dict[str, Errors] = field(factory=dict)
    """Errors by kind: leg of the feet and body_leg of the wearer (relative), stride_time (s)."""
    groups: tuple[str, ...] = ("all",)
    """Names of the groups that this recording belongs to."""

    def flat(self) -> Figures:
        """Return every figure of this recording by its name in tables and JSON."""
        flat = dict(self.figures)
        for kind, matching in self.events.items():
            flat |= {f"{kind}_{name}": getattr(matching, of) for name, of in EVENT_FIGURES.items()}
        for score in (self.strides, self.activity, self.idle):
            if score is not None:
                flat |= score.figures
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
    events, errors = (_pooled([getattr(one, name) for one in members]) for name in ("events", "errors"))
    strides, activity, idle = (
        reduce(add, found) if (found := [of for one in members if (of := getattr(one, name)) is not None]) else None
        for name in ("strides", "activity", "idle")
    )
    return Summary(
        group=group,
        count=len(members),
        mean={key: float(np.mean(v)) for key, v in values.items() if v},
        median={key: float(np.median(v)) for key, v in values.items() if v},
        together=Scored(group, {}, events, strides, activity, idle, errors).flat(),
        confusion=None if activity is None else activity.table,
    )


def _pooled(scores: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return the sums of what recordings have of each kind."""
    kinds = dict.fromkeys(kind for one in scores for kind in one)
    return {kind: reduce(add, [one[kind] for one in scores if kind in one]) for kind in kinds}
