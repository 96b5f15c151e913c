"""Parts of the body, fed as a wearer feeds them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from solepath.body.part import Part
from solepath.events import Event, StrideTaken
from solepath.foot.tracker import FootTracker
from solepath.foot.view import FootView
from solepath.types import Sample


def seen(tracker: FootTracker, sample: Sample, events: Iterable[Event], other: float | None = None) -> FootView:
    """The foot after a sample of which `events` came. `other`: the newest sample of the other foot, s."""
    known_at = sample.t if sample.known_at is None else max(sample.t, sample.known_at)
    found = tuple(events)
    stride = any(isinstance(event, StrideTaken) for event in found)
    return tracker.view(sample, known_at, found, stride, other)


def fed(
    part: Part, tracker: FootTracker, sample: Sample, events: Sequence[Event], other: float | None = None
) -> list[Any]:
    """Return the outputs of a part for a sample of a foot and its events."""
    outputs = [*part.feed(seen(tracker, sample, events, other))] if part.needs_samples else []
    for event in events:
        outputs += part.receive(event)
    return outputs
