"""Insoles that fail: the same samples with a fault of one site from a given time on."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from math import inf, nan

from attrs import evolve

from solepath.types import Sample, Site


def missing(samples: Iterable[Sample], site: Site, cells: Collection[int], since: float = -inf) -> list[Sample]:
    """Return samples in which the values of some cells are not a number."""
    return _pressed(samples, site, since, lambda loads: [nan if k in cells else load for k, load in enumerate(loads)])


def cut_off(samples: Iterable[Sample], site: Site, count: int, since: float = -inf) -> list[Sample]:
    """Return samples in which an insole has only the first `count` cells; with 0 no pressure at all."""
    return _pressed(samples, site, since, lambda loads: loads[:count])


def never_unloads(samples: Iterable[Sample], site: Site, load: float) -> list[Sample]:
    """Return samples in which every cell bears `load` more, in the samples' unit, as in a shoe laced too tightly."""
    return _pressed(samples, site, -inf, lambda loads: [one + load for one in loads])


def silent(samples: Iterable[Sample], site: Site, t_start: float, end: float = inf) -> list[Sample]:
    """Return samples without those of a site from `t_start` s until `end`."""
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
