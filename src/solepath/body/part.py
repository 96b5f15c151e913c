"""What a session asks of the part that puts both feet together."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from ..events import Event
from ..foot.tracker import FootTracker
from ..types import Foot, Sample, Site
from .position import Position


class Body(Protocol):
    """Samples and steps of both feet in, what the wearer does out. A plain record, as every machine is.

    A body with a method `calibrated(calibration) -> Self` is replaced by what that returns before it is used.
    """

    @property
    def sites(self) -> tuple[Site, ...]:
        """The sites above the ankle that it has a use for."""

    def foot_moved(self, foot: FootTracker, sample: Sample, events: list[Event]) -> list[Event]:
        """A foot has used `sample`, and `events` are what came of it; returns what follows for the body."""

    def limb_moved(self, sample: Sample) -> list[Event]:
        """A sample of one of `sites`."""

    def interrupt(self, site: Site) -> None:
        """The clock of the samples of a site begins anew."""

    def position(self, feet: Mapping[Foot, FootTracker]) -> Position | None:
        """Where the wearer is, of all feet that were heard of; None before any sample."""
