"""Sums the load of the soles over the strides that were measured, whatever their number.

A sample is kept until its stride is reported, which is up to a second after the stride has ended."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import deque

from attrs import define, field

from ...events import FootPressed, GaitCycleMeasured
from ...types import Layout

MAX_SAMPLES = 2000
"""Samples of a foot that are kept: 5 s at 400 Hz, and more than a stride of a walker."""
MAX_CONTACT_TIME = 2.5
"""Longest contact that counts as that of a step, s."""
STATIONS = 51
"""Stations over a contact from heel-strike to toe-off, evenly spaced."""
MAX_PATHS = 20
"""Single paths of the centre of pressure that are kept, the newest."""

Pair = tuple[float, float]


@define
class ReportSole:
    """Load of one foot's sole; loads in the unit of the samples, places in the foot frame, m."""

    layout: Layout | None = None
    samples: int = 0
    contacts: int = 0
    """Number of strides in the sums."""
    mean_sums: list[float] = field(factory=list)
    """Sum over contacts of each cell's mean over the contact."""
    peak_sums: list[float] = field(factory=list)
    """Sum over contacts of each cell's highest value."""
    force_sums: list[float] = field(factory=list)
    """Sum over contacts of the force at each station."""
    path: list[tuple[float, float, int]] = field(factory=list)
    """Sums over contacts of x and y of the centre of pressure at each station, and in how many it was known."""
    paths: deque[list[Pair]] = field(factory=lambda: deque(maxlen=MAX_PATHS))
    cell_sums: list[float] = field(factory=list)
    """Sum of each cell over all samples, for a wearer who takes no stride."""
    newest: deque[FootPressed] = field(factory=lambda: deque(maxlen=MAX_SAMPLES))

    def add_sample(self, event: FootPressed) -> None:
        """Add one sample; one with another number of cells than before restarts the sums."""
        if len(self.cell_sums) != len(event.values):
            self._reset(len(event.values))
        self.samples += 1
        self.cell_sums = [a + b for a, b in zip(self.cell_sums, event.values, strict=True)]
        if self.newest and event.t <= self.newest[-1].t:
            self.newest.clear()
        self.newest.append(event)

    def _reset(self, cells: int) -> None:
        self.cell_sums, self.mean_sums, self.peak_sums = [0.0] * cells, [0.0] * cells, [0.0] * cells
        self.force_sums, self.path = [0.0] * STATIONS, [(0.0, 0.0, 0)] * STATIONS
        self.samples = self.contacts = 0
        self.newest.clear()
        self.paths.clear()

    def stride(self, event: GaitCycleMeasured) -> None:
        """Add the contact of a stride, if it was walked and hardly any of its samples are missing."""
        missing = event.degraded and not event.steady
        if missing or event.running or not 0.0 < event.t_toe_off - event.t_start <= MAX_CONTACT_TIME:
            return
        kept = list(self.newest)
        times = [one.t for one in kept]
        first, last = bisect_left(times, event.t_start), bisect_right(times, event.t_toe_off)
        contact = kept[first:last]
        if len(contact) < 3 or first == 0:
            return
        count = len(contact)
        columns = list(zip(*[one.values for one in contact], strict=True))
        self.mean_sums = [a + sum(column) / count for a, column in zip(self.mean_sums, columns, strict=True)]
        self.peak_sums = [a + max(column) for a, column in zip(self.peak_sums, columns, strict=True)]
        self.contacts += 1
        path = []
        for k in range(STATIONS):
            one = contact[round(k * (count - 1) / (STATIONS - 1))]
            self.force_sums[k] += one.force
            if one.centre is not None:
                (x, y, n), (a, b) = self.path[k], one.centre
                self.path[k] = (x + a, y + b, n + 1)
                path.append(one.centre)
        self.paths.append(path)

    @property
    def mean_path(self) -> list[Pair]:
        """Mean path of the centre of pressure, where it was known in at least half of the contacts."""
        return [(x / n, y / n) for x, y, n in self.path if n > 0 and 2 * n >= self.contacts]

    @property
    def unit(self) -> str:
        """Unit of the loads."""
        return "N" if self.layout is not None and self.layout.scale is not None else "counts"

    @property
    def drawable_layout(self) -> Layout | None:
        """Layout of the cells; None when it is not known or does not fit their number."""
        return self.layout if self.layout is not None and len(self.layout.cells) == len(self.cell_sums) > 0 else None
