"""Sums the load of each sole over its contacts, in memory that does not grow with their number.

A contact is the time from heel-strike to toe-off. Samples are kept because a gait cycle is reported up to a second
after its end. Numbers without a source were chosen by hand and not swept."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import deque

from attrs import define, field

from ..events import FootPressed, GaitCycleMeasured
from ..types import Layout

MAX_SAMPLES = 2000
"""Largest number of samples of a foot that are kept: 5 s at 400 Hz, more than a gait cycle and that second."""
MAX_CONTACT_TIME = 2.5
"""Longest contact that is counted, s; in a longer one the wearer stands."""
STATIONS = 51
"""Number of stations, the evenly spaced moments of a contact at which force and centre of pressure are summed."""
MIN_CONTACT_SAMPLES = 3
MAX_PATHS = 20
"""Largest number of paths of the centre of pressure that are kept, each of one contact: the newest ones."""

Pair = tuple[float, float]


@define
class SoleLoads:
    """The load of one foot's sole; loads are in the unit of the samples, positions in the foot frame, m."""

    layout: Layout | None = None
    samples: int = 0
    contacts: int = 0
    """Number of contacts in the sums."""
    mean_sums: list[float] = field(factory=list)
    """Sum over contacts of each cell's mean over the contact."""
    peak_sums: list[float] = field(factory=list)
    """Sum over contacts of each cell's highest value."""
    force_sums: list[float] = field(factory=list)
    """Sum over contacts of the force at each station."""
    path_sums: list[tuple[float, float, int]] = field(factory=list)
    """Sums of x and y of the centre of pressure at each station, m, and number of contacts in which it was known."""
    paths: deque[list[Pair]] = field(factory=lambda: deque(maxlen=MAX_PATHS))
    cell_sums: list[float] = field(factory=list)
    """Sum of each cell over all samples, from which the mean load is shown when no contact was counted."""
    newest: deque[FootPressed] = field(factory=lambda: deque(maxlen=MAX_SAMPLES))

    def add_sample(self, event: FootPressed) -> None:
        """Add one sample; when the number of cells changes, all sums restart."""
        if len(self.cell_sums) != len(event.values):
            self._reset(len(event.values))
        self.samples += 1
        self.cell_sums = [a + b for a, b in zip(self.cell_sums, event.values, strict=True)]
        if self.newest and event.t <= self.newest[-1].t:
            self.newest.clear()
        self.newest.append(event)

    def _reset(self, cells: int) -> None:
        self.cell_sums, self.mean_sums, self.peak_sums = [0.0] * cells, [0.0] * cells, [0.0] * cells
        self.force_sums, self.path_sums = [0.0] * STATIONS, [(0.0, 0.0, 0)] * STATIONS
        self.samples = self.contacts = 0
        self.newest.clear()
        self.paths.clear()

    def add_cycle(self, event: GaitCycleMeasured) -> None:
        """Add the contact of a gait cycle of walking, unless it is degraded or longer than MAX_CONTACT_TIME."""
        if event.degraded or event.running or not 0.0 < event.t_toe_off - event.t_start <= MAX_CONTACT_TIME:
            return
        samples = list(self.newest)
        times = [sample.t for sample in samples]
        first, last = bisect_left(times, event.t_start), bisect_right(times, event.t_toe_off)
        contact = samples[first:last]
        if len(contact) < MIN_CONTACT_SAMPLES or first == 0:  # at 0, earlier samples of the contact may be lost
            return
        count = len(contact)
        columns = list(zip(*[sample.values for sample in contact], strict=True))
        self.mean_sums = [a + sum(column) / count for a, column in zip(self.mean_sums, columns, strict=True)]
        self.peak_sums = [a + max(column) for a, column in zip(self.peak_sums, columns, strict=True)]
        self.contacts += 1
        path = []
        for k in range(STATIONS):
            sample = contact[round(k * (count - 1) / (STATIONS - 1))]
            self.force_sums[k] += sample.force
            if sample.centre is not None:
                (x, y, n), (a, b) = self.path_sums[k], sample.centre
                self.path_sums[k] = (x + a, y + b, n + 1)
                path.append(sample.centre)
        self.paths.append(path)

    @property
    def mean_path(self) -> list[Pair]:
        """Mean path of the centre of pressure, foot frame, m, where it was known in at least half of the contacts."""
        return [(x / n, y / n) for x, y, n in self.path_sums if n > 0 and 2 * n >= self.contacts]

    @property
    def unit(self) -> str:
        """Unit of the loads."""
        return "N" if self.layout is not None and self.layout.scale is not None else "counts"

    @property
    def drawable_layout(self) -> Layout | None:
        """Layout of the cells; None if it is not known or has another number of cells than the samples."""
        return self.layout if self.layout is not None and len(self.layout.cells) == len(self.cell_sums) > 0 else None
