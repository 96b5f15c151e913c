"""Limitations of one foot: data that a foot lacks, each reported once."""

from __future__ import annotations

from ..events import Event, Limitation
from ..types import SITE_OF_FOOT, Foot, Layout
from ..types.attrs import define, field

LACKING_TIME = 1.0
"""Time for which samples lack data before this is reported, s."""
MISMATCH_TIME = 0.5
"""Time for which the number of cells differs from the calibration before the insole counts as another one, s."""


@define
class Limitations:
    """The limitations that were reported, and those that wait for the next sample."""

    foot: Foot
    reported: list[str] = field(factory=list, init=False)
    """Sentences that were reported."""
    pending: list[str] = field(factory=list, init=False)
    """Sentences that the next sample reports."""
    lacking_since: float | None = field(default=None, init=False)
    """Time since which samples lack data, s; None when they do not."""
    mismatch_since: float | None = field(default=None, init=False)
    """Time since which the number of cells differs from the calibration, s; None before that."""

    def queue(self, what: str | None) -> None:
        """Report `what` with the next sample; None is ignored."""
        if what is not None and what not in self.reported and what not in self.pending:
            self.pending.append(what)

    def flush(self, t: float, known_at: float, events: list[Event]) -> None:
        """Report the pending sentences with the sample at `t`, s."""
        for what in self.pending:
            self.report(what, t, known_at, events)
        self.pending = []

    def report(self, what: str, t: float, known_at: float, events: list[Event]) -> None:
        """Append a `Limitation` to `events`, unless `what` was reported before."""
        if what not in self.reported:
            self.reported.append(what)
            events.append(Limitation(t=t, known_at=known_at, site=SITE_OF_FOOT[self.foot], what=what))

    def report_lacking(self, what: str, t: float, known_at: float, events: list[Event]) -> None:
        """Report `what` once samples have lacked it for `LACKING_TIME`; call for each such sample."""
        if self.lacking_since is None:
            self.lacking_since = t
        if t - self.lacking_since >= LACKING_TIME:
            self.report(what, t, known_at, events)

    def check_cell_count(
        self,
        layout: Layout | None,
        noise: tuple[float, ...],
        count: int,
        t: float,
        known_at: float,
        events: list[Event],
    ) -> bool:
        """Return whether a mismatch between calibration and number of cells has lasted for `MISMATCH_TIME`.

        Call for each sample whose `count` cells do not match `layout` or `noise` of the calibration. When the result is
        True, the mismatch is reported and this part of the calibration must not be used."""
        if self.mismatch_since is None or t < self.mismatch_since:
            self.mismatch_since = t
        if t - self.mismatch_since < MISMATCH_TIME:
            return False
        has = f"the {self.foot.value} insole has {count}: it is not used"
        if layout is not None and len(layout.cells) != count:
            self.report(f"the calibration's layout has {_cells(len(layout.cells))}, {has}", t, known_at, events)
        if noise and len(noise) != count:
            self.report(f"the calibration's noise is of {_cells(len(noise))}, {has}", t, known_at, events)
        return True


def _cells(count: int) -> str:
    return "1 cell" if count == 1 else f"{count} cells"
