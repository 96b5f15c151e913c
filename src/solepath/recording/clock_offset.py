"""Correction of the clock of one foot in a recording, when both feet were recorded with separate clocks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from heapq import heappop, heappush

from ..types import Foot, Packet, Sample
from ..types.attrs import evolve
from .errors import RecordingError


def shift_clock(items: Iterable[Packet | Sample], offset: float, foot: Foot = Foot.RIGHT) -> Iterator[Packet | Sample]:
    """Yield the items in order of time after `offset`, s, is added to the times of one foot.

    The offset is that of a DefectFound of the clocks, or is known from an event that both feet felt at the same time.
    An error of `items` is raised after the items before it. Items of |offset| s are held back."""
    held: list[tuple[float, int, Packet | Sample]] = []
    earliest, flaw = min(0.0, offset), None
    source = enumerate(items)
    while flaw is None:
        try:
            number, item = next(source)
        except StopIteration:
            break
        except RecordingError as error:
            flaw = error
            break
        newest = item.t + earliest  # no later item can have an earlier time than this
        if item.site.foot is foot:
            item = _shifted(item, offset)
        heappush(held, (item.t, number, item))
        while held and held[0][0] <= newest:
            yield heappop(held)[2]
    while held:
        yield heappop(held)[2]
    if flaw is not None:
        raise flaw


def _shifted(item: Packet | Sample, offset: float) -> Packet | Sample:
    if isinstance(item, Packet):
        return evolve(item, t=item.t + offset)
    return evolve(item, t=item.t + offset, known_at=item.known_at + offset)
