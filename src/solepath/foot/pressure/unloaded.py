"""The unloaded level of an insole: the sum of its cells while the foot is in the air, learnt from the sums alone.

A cell without load may show any value: that of its voltage divider, of its amplifier, or of the shoe that presses on
it, and it drifts with temperature and supply. In walking the sum falls once a stride into a valley with a flat ground,
the swing. A wearer who stands and sways makes valleys, too, but they have no flat ground: what falls rises again.

It is a module because `InsoleLoads` has two: one for cells that rise under load, one for cells that fall.
The numbers were chosen by hand on the recordings of fsr_treadmill, smart_insole_35, moticon_opengo, gaitpdb_vgrf and
marpino_heel_toe, of which the last four come to the same figures as before there was a level."""

from __future__ import annotations

from itertools import pairwise

from ...types import Floats
from ...types.attrs import define, evolve, field
from ...types.vector import TIME_EPSILON

VALLEY_DEPTH = 0.35
"""Fall of the sum that starts a valley, and rise that ends it, as a share of the range of the last 8 to 10 s.

Half of it would take mid-stance for a valley, where the load of few cells lies between them."""
FLAT_BAND = 0.02
"""Half the width of the band in which the ground of a valley is flat, as a share of that range."""
FLAT_SHARE = 0.33
"""Smallest share of its samples that a valley with a flat ground has in that band.

A sine has 0.21, so that a wearer who sways shows none. Of the valleys of recorded soles, half have 0.25 to 0.7."""
SHORTEST_FLAT = 0.1
"""Shortest time that a flat ground lasts, s."""
AGREEMENT = 0.1
"""Largest difference between the grounds of two valleys in a row that show the same level, as a share of that range."""
MOVED_SHARE = 0.05
"""Smallest change of the level that is reported, as a share of that range: a contact is seen at 5 % of the load."""
LEAST_DRIFT = 0.01
"""Smallest drift that is reported, as a share of that range in a second."""
GROUNDS = 4
"""Number of valleys that are kept. Their highest ground is the level, because cells creep back slowly after a stance.

Of the contacts on soles of two cells, 4 and 5 find 99 % (F1), 3 find 98 %. Four that rise or fall by chance are one in
twelve, and show a drift."""
LONGEST_DRIFT = 3.0
"""Time after a valley for which the level is expected to drift on, s."""


def moved_alike(before: Floats, now: Floats) -> bool:
    """Return whether all cells have moved by about the same amount from `before` to `now`."""
    if len(before) != len(now) or not now:
        return False
    changes = [b - a for a, b in zip(before, now, strict=True)]
    return min(changes) > 0.5 * max(changes) > 0.0 or max(changes) < 0.5 * min(changes) < 0.0


@define
class UnloadedLevel:
    """Follows the unloaded level of a sum of cells. Latency: a valley is known when it has ended, at heel-strike."""

    grounds: list[tuple[float, float]] = field(factory=list)
    """End, s, and ground of the last flat valleys that show one level, the newest last."""
    level: float | None = None
    """Level at `level_t`; None before two valleys agreed."""
    level_t: float = 0.0
    """Time of the level, s."""
    drift: float = 0.0
    """Drift of the level, 1/s."""
    moved: bool = False
    """The level of all cells has moved, and this was not reported yet."""
    top: float = 0.0
    """Highest sum since the last valley; in a valley, that at its start."""
    cells: Floats = ()
    """Cells at the ground of the last valley."""
    sure_ground: float | None = None
    """Ground of the last valley of which all that are kept showed one level; None before any."""
    sure_cells: Floats = ()
    """Cells at that ground."""
    bottom: float | None = None
    """Lowest sum of the current valley; None outside of a valley."""
    base: float = 0.0
    """Sum at which the band of the current ground was laid."""
    base_t: float = 0.0
    """Time of the first sample in that band, s."""
    flat_t: float = 0.0
    """Time of the last sample in that band, s."""
    flat: int = 0
    """Number of samples in that band."""
    count: int = 0
    """Number of samples in the current valley."""

    def update(self, t: float, total: float, cells: Floats, load_range: float) -> float | None:
        """Add the sum of a sample and return the level without load; None while it is unknown.

        `load_range` is the range of the sums of the last 8 to 10 s."""
        depth = VALLEY_DEPTH * load_range
        if self.bottom is None:
            if total > self.top:
                self.top = total
            elif self.top - total > depth:
                self.bottom, self.count = total, 0
                self._lay_band(t, total)
        elif total > self.bottom + depth:
            self._end_valley(t, self.bottom, load_range)
            self.bottom, self.top = None, total
        else:
            self.count += 1
            band = FLAT_BAND * load_range
            if total < self.bottom:
                self.bottom = total
                self.cells = cells
            if total < self.base - band:
                self._lay_band(t, total)
            elif total <= self.base + band:
                self.flat += 1
                self.flat_t = t
        if self.level is None:
            return None
        level = self.level + self.drift * min(t - self.level_t, LONGEST_DRIFT)
        if self.bottom is not None and level > self.bottom + AGREEMENT * load_range:
            return self.bottom + AGREEMENT * load_range
        return level

    def restart(self) -> None:
        """Discard what depends on times, because times restart; the level stays."""
        self.grounds, self.drift, self.bottom = [], 0.0, None

    def shift(self, by: float) -> None:
        """Add `by` to all sums."""
        self.grounds = [(at, value + by) for at, value in self.grounds]
        self.level = None if self.level is None else self.level + by
        self.bottom = None if self.bottom is None else self.bottom + by
        self.top, self.base = self.top + by, self.base + by

    def turned(self) -> UnloadedLevel:
        """Return this level of sums with another sign as that of cells whose values change their signs from now on."""
        cells, sure_cells = [tuple([-value for value in values]) for values in (self.cells, self.sure_cells)]
        return evolve(self, cells=cells, sure_cells=sure_cells)

    def _lay_band(self, t: float, total: float) -> None:
        self.base, self.base_t, self.flat_t, self.flat = total, t, t, 1

    def _end_valley(self, t: float, ground: float, load_range: float) -> None:
        """Learn from the valley that ends at `t`, s, if its ground is flat."""
        if self.flat_t - self.base_t < SHORTEST_FLAT - TIME_EPSILON or self.flat < FLAT_SHARE * self.count:
            return
        grounds = self.grounds = [*self.grounds[1 - GROUNDS :], (self.base_t, ground)]
        slopes = [(b - a) / (t_b - t_a) for (t_a, a), (t_b, b) in pairwise(grounds)]
        drift = 0.0
        if len(grounds) == GROUNDS:  # the smallest slope, if all have one sign
            drift = max(min(slopes), 0.0) + min(max(slopes), 0.0)
        drifted = [value + drift * (self.base_t - at) for at, value in grounds]
        agreeing = [value for value in drifted if abs(value - ground) <= AGREEMENT * load_range]
        if len(agreeing) > 1:
            self.level, self.level_t, self.drift = max(agreeing), self.base_t, drift
        if len(agreeing) == GROUNDS:
            moved = self.sure_ground is not None and abs(ground - self.sure_ground) > MOVED_SHARE * load_range
            drifts = abs(drift) > LEAST_DRIFT * load_range
            self.moved = (moved or drifts) and moved_alike(self.sure_cells, self.cells)
            self.sure_ground, self.sure_cells = ground, self.cells
