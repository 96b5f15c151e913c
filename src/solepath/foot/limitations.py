"""Limitations of one foot: data that a foot lacks, each reported once."""

from __future__ import annotations

from ..events import Event, Limitation
from ..types import SITE_OF_FOOT, Floats, Foot, Layout
from ..types.attrs import define, field

LACKING_TIME = 1.0
"""Time for which samples lack data before this is reported, s."""
MISMATCH_TIME = 0.5
"""Time for which the number of cells differs from the calibration before the calibration is given up, s."""


@define
class Limitations:
    """The limitations of one foot that were reported, and those that the next sample reports."""

    foot: Foot
    reported: list[str] = field(factory=list)
    """Sentences that were reported and are not reported again."""
    pending: list[str] = field(factory=list)
    """Sentences that the next sample reports."""
    lacking_since: float | None = None
    """Time since which samples lack data, s; None while they lack none."""
    mismatch_since: float | None = None
    """Time since which the number of cells differs from the calibration, s; None before that."""

    def queue(self, text: str | None) -> None:
        """Report `text` with the next sample; None is ignored."""
        if text is not None and text not in self.reported and text not in self.pending:
            self.pending.append(text)

    def flush(self, t: float, known_at: float, events: list[Event]) -> None:
        """Report the pending sentences with the sample at `t`, s."""
        for text in self.pending:
            self.report(text, t, known_at, events)
        self.pending = []

    def report(self, text: str, t: float, known_at: float, events: list[Event]) -> None:
        """Append a `Limitation` to `events`, unless `text` was reported before."""
        if text not in self.reported:
            self.reported.append(text)
            events.append(Limitation(t=t, known_at=known_at, site=SITE_OF_FOOT[self.foot], what=text))

    def report_lacking(self, text: str, t: float, known_at: float, events: list[Event]) -> None:
        """Report `text` once samples have lacked data for `LACKING_TIME`; call it for each such sample."""
        if self.is_lacking(t):
            self.report(text, t, known_at, events)

    def is_lacking(self, t: float) -> bool:
        """Return whether samples have lacked data for `LACKING_TIME`; call it only for a sample that lacks some."""
        if self.lacking_since is None:
            self.lacking_since = t
        return t - self.lacking_since >= LACKING_TIME

    def rejects_calibration(
        self, layout: Layout | None, noise: Floats, count: int, t: float, known_at: float, events: list[Event]
    ) -> bool:
        """Return whether the calibration is rejected, as its number of cells has been wrong for `MISMATCH_TIME`.

        Call it for each sample whose `count` cells do not match `layout` or `noise` of the calibration. When the result
        is True, the mismatch was reported, and this layout or noise must not be used."""
        if self.mismatch_since is None or t < self.mismatch_since:
            self.mismatch_since = t
        if t - self.mismatch_since < MISMATCH_TIME:
            return False
        count_text = f"the {self.foot.value} insole has {count}: it is not used"
        if layout is not None and len(layout.cells) != count:
            self.report(f"the calibration's layout has {_cells(len(layout.cells))}, {count_text}", t, known_at, events)
        if noise and len(noise) != count:
            self.report(f"the calibration's noise is of {_cells(len(noise))}, {count_text}", t, known_at, events)
        return True


def _cells(count: int) -> str:
    return "1 cell" if count == 1 else f"{count} cells"
