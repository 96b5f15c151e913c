"""What one foot must do without: each is said once."""

from __future__ import annotations

from ..events import Event, Limitation
from ..types import SITE_OF_FOOT, Foot, Layout
from ..types.attrs import define, field

LACKING_TIME = 1.0
"""For this long samples may lack something before the foot is said to have none, s."""
MISMATCH_TIME = 0.5
"""For this long samples may have another number of cells than the calibration before it is of another insole, s."""


@define
class Limitations:
    """Sentences that were said, and that wait for a sample to be said with."""

    foot: Foot
    reported: list[str] = field(factory=list, init=False)
    pending: list[str] = field(factory=list, init=False)
    lacking_since: float | None = field(default=None, init=False)
    """Since when samples lack something, s."""
    mismatch_since: float | None = field(default=None, init=False)
    """Since when samples have another number of cells than the calibration says, s."""

    def queue(self, what: str | None) -> None:
        """To be said with the next sample; None is nothing."""
        if what is not None and what not in self.reported and what not in self.pending:
            self.pending.append(what)

    def flush(self, t: float, known_at: float, events: list[Event]) -> None:
        """A sample came: say what waits."""
        for what in self.pending:
            self.report(what, t, known_at, events)
        self.pending = []

    def report(self, what: str, t: float, known_at: float, events: list[Event]) -> None:
        """Now, unless it was said before."""
        if what not in self.reported:
            self.reported.append(what)
            events.append(Limitation(t=t, known_at=known_at, site=SITE_OF_FOOT[self.foot], what=what))

    def report_lacking(self, what: str, t: float, known_at: float, events: list[Event]) -> None:
        """This sample lacks something, as those before it did; it is said when that has lasted."""
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
        """This sample has `count` cells, and what the calibration says of them, layout or noise, is of another number;
        True when that has lasted: it is said and not to be used."""
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
