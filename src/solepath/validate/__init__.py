"""What a session found against the truth: events matched one to one, tracks aligned, strides and places compared.

    from solepath.validate import compare_walks, read_truth
    comparison = compare_walks(read_truth("truth.csv"), {"S01": session.feed(samples) + session.finish()})

`comparison.agreement` has bias, limits of agreement and ICC of each parameter (agreement.py; extra `validate`)."""

from __future__ import annotations

from .agreement import NoMatch, WalkComparison, compare_walks
from .truth_table import TrueRow, read_truth

__all__ = ["NoMatch", "TrueRow", "WalkComparison", "compare_walks", "read_truth"]
