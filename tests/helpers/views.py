"""Feeding of body parts in the same way as a wearer feeds them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from solepath.body.part import Part, PartInput
from solepath.events import Event, StrideTaken
from solepath.foot.tracker import FootTracker
from solepath.foot.view import FootView
from solepath.types import Sample


def seen(tracker: FootTracker, sample: Sample, events: Iterable[Event], other: float | None = None) -> FootView:
    """Return the view after a sample with its events; `other` is the time of the other foot's newest sample, s."""
    known_at = sample.t if sample.known_at is None else max(sample.t, sample.known_at)
    event_tuple = tuple(events)
    stride = any(isinstance(event, StrideTaken) for event in event_tuple)
    return tracker.view(sample, known_at, bool(event_tuple), stride, other)


def fed(
    part: Part, tracker: FootTracker, sample: Sample, events: Sequence[Event], other: float | None = None
) -> list[Any]:
    """Return the outputs of a part for a sample of a foot and its events."""
    return [*part.feed(events, seen(tracker, sample, events, other))] if events or part.needs_samples else []


def told(part: Part, *events: PartInput) -> list[Any]:
    """Return the outputs of a part for events that no sample brought."""
    return [*part.feed(events, None)]
