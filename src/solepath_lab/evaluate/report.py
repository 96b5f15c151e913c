"""Scores of one recipe on one data set, and all scores as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import attrs
from attrs import frozen

from ..measures.score import Scored, Summary, summarise
from .datasets import DataSet


@frozen
class Result:
    """Scores of one recipe on one data set."""

    data_set: DataSet
    recipe: str
    scores: tuple[Scored, ...]
    failures: tuple[str, ...] = ()
    """One sentence for each recording that could not be run."""

    @property
    def summaries(self) -> list[Summary]:
        """Summary of each group of recordings, in the order in which the groups first appear."""
        groups = dict.fromkeys(group for score in self.scores for group in score.groups)
        return [summarise(self.scores, group) for group in groups]


def as_json(results: Sequence[Result]) -> dict[str, Any]:
    """Return {recipe: {data set: {"recordings": {name: figures}, "summary": {group: ...}, "failures": [...]}}}.

    Figures are in SI units, and shares are fractions of one. Null stands for a figure that could not be measured."""
    document: dict[str, Any] = {}
    for result in results:
        document.setdefault(result.recipe, {})[result.data_set.name] = {
            "recordings": {score.recording: score.flat() for score in result.scores},
            "summary": {s.group: attrs.asdict(s, filter=attrs.filters.exclude("group")) for s in result.summaries},
            "failures": list(result.failures),
        }
    return document
