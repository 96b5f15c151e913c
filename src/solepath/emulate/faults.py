"""Insoles that fail and feet that are mixed up: the same samples, as they come when something is wrong.

Each takes samples of any sites in the order of time and returns new ones in that order; those of other sites are left
as they are.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from math import inf, nan

from attrs import evolve

from ..types import Sample, Site

_SWAPPED = {
    Site.LEFT_FOOT: Site.RIGHT_FOOT,
    Site.RIGHT_FOOT: Site.LEFT_FOOT,
    Site.LEFT_SHANK: Site.RIGHT_SHANK,
    Site.RIGHT_SHANK: Site.LEFT_SHANK,
    Site.LEFT_THIGH: Site.RIGHT_THIGH,
    Site.RIGHT_THIGH: Site.LEFT_THIGH,
}
FEET = frozenset((Site.LEFT_FOOT, Site.RIGHT_FOOT))


def dead(samples: Iterable[Sample], site: Site, cells: Collection[int], since: float = -inf) -> list[Sample]:
    """Cells that say 0 whatever presses, from `since` s on."""
    return _cells(samples, site, cells, since, lambda value: 0.0)


def stuck(
    samples: Iterable[Sample], site: Site, cells: Collection[int], value: float | None = None, since: float = -inf
) -> list[Sample]:
    """Cells that always say `value`, or what each said first from `since` s on."""
    held: dict[int, float] = {}
    found = []
    for sample in samples:
        if sample.site is site and sample.pressure is not None and sample.t >= since:
            said = list(sample.pressure)
            for k in cells:
                said[k] = held.setdefault(k, said[k] if value is None else value)
            sample = evolve(sample, pressure=tuple(said))
        found.append(sample)
    return found


def saturated(
    samples: Iterable[Sample], site: Site, cells: Collection[int], full_scale: float, since: float = -inf
) -> list[Sample]:
    """Cells that say the most that they can, in the unit of the samples."""
    return _cells(samples, site, cells, since, lambda value: full_scale)


def missing(samples: Iterable[Sample], site: Site, cells: Collection[int], since: float = -inf) -> list[Sample]:
    """Cells of which nothing comes: not a number."""
    return _cells(samples, site, cells, since, lambda value: nan)


def cut_off(samples: Iterable[Sample], site: Site, count: int, since: float = -inf) -> list[Sample]:
    """An insole of which only the first `count` cells come; with 0 no pressure at all."""
    return [
        evolve(sample, pressure=sample.pressure[:count] or None)
        if sample.site is site and sample.pressure is not None and sample.t >= since
        else sample
        for sample in samples
    ]


def never_unloads(samples: Iterable[Sample], site: Site, load: float, since: float = -inf) -> list[Sample]:
    """A shoe laced so tightly, or something in it, that every cell bears `load` more, in the unit of the samples."""
    every = range(max((len(s.pressure) for s in samples if s.site is site and s.pressure is not None), default=0))
    return _cells(samples, site, every, since, lambda value: value + load)


def swapped(samples: Iterable[Sample], since: float = -inf, *, whole_legs: bool = False) -> list[Sample]:
    """Left for right: the feet, or with `whole_legs` everything below the pelvis."""
    return [
        evolve(sample, site=_SWAPPED[sample.site])
        if sample.t >= since and (sample.site in FEET or (whole_legs and sample.site in _SWAPPED))
        else sample
        for sample in samples
    ]


def silent(samples: Iterable[Sample], site: Site, begin: float, end: float = inf) -> list[Sample]:
    """Nothing comes of a site from `begin` s until `end`."""
    return [sample for sample in samples if sample.site is not site or not begin <= sample.t < end]


def _cells(
    samples: Iterable[Sample], site: Site, cells: Collection[int], since: float, said: Callable[[float], float]
) -> list[Sample]:
    wrong = frozenset(cells)
    found = []
    for sample in samples:
        if sample.site is site and sample.pressure is not None and sample.t >= since:
            loads = tuple([said(value) if k in wrong else value for k, value in enumerate(sample.pressure)])
            sample = evolve(sample, pressure=loads)
        found.append(sample)
    return found
