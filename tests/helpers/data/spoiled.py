"""Insoles that fail: the same samples, as they come when something is wrong with one site from some time on."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from math import inf, nan

from attrs import evolve

from solepath.types import Sample, Site


def missing(samples: Iterable[Sample], site: Site, cells: Collection[int], since: float = -inf) -> list[Sample]:
    """Cells of which nothing comes: not a number."""
    return _pressed(samples, site, since, lambda loads: [nan if k in cells else load for k, load in enumerate(loads)])


def cut_off(samples: Iterable[Sample], site: Site, count: int, since: float = -inf) -> list[Sample]:
    """An insole of which only the first `count` cells come; with 0 no pressure at all."""
    return _pressed(samples, site, since, lambda loads: loads[:count])


def never_unloads(samples: Iterable[Sample], site: Site, load: float, since: float = -inf) -> list[Sample]:
    """A shoe laced so tightly, or something in it, that every cell bears `load` more, in the unit of the samples."""
    return _pressed(samples, site, since, lambda loads: [one + load for one in loads])


def silent(samples: Iterable[Sample], site: Site, t_start: float, end: float = inf) -> list[Sample]:
    """Nothing comes of a site from `t_start` s until `end`."""
    return [sample for sample in samples if sample.site is not site or not t_start <= sample.t < end]


def _pressed(
    samples: Iterable[Sample], site: Site, since: float, loads: Callable[[list[float]], list[float]]
) -> list[Sample]:
    return [
        evolve(sample, pressure=tuple(loads(list(sample.pressure))) or None)
        if sample.site is site and sample.pressure is not None and sample.t >= since
        else sample
        for sample in samples
    ]
