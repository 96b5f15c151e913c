"""What a report shows: a walk, its plan, its outcomes, and the words that a caller adds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import fmean
from typing import TYPE_CHECKING, Any

from attrs import define, evolve, field, frozen

from ...events import Event, FootMoved, StrideTaken, WearerMoved
from ...floorplan.plan import FloorPlan
from ...saving.provenance import installed_version
from ...types import Packet, Sample, Vec3
from ...walk.walk import Walk
from .bands import Band
from .clock import ReportClock

if TYPE_CHECKING:
    from ..outcomes.clinic import OutcomeRequest

TimedPosition = FootMoved | StrideTaken | WearerMoved
"""Event with the position of a foot or the wearer, world frame, m."""


@frozen
class ReportDetails:
    """Texts that a person gives for the head of a report; all may be empty."""

    title: str = ""
    subject: str = ""
    """Person, code or test."""
    date: str = ""
    """Date of the walk; one such as 2026-11-26 is shown in words."""
    device: str = ""


@define
class ReportContent:
    """The content of the report of a session with `poses` and `pressures`.

    `source` is the recording's name. `plan` is the session's floor plan. `recipe` is the name of the recipe. `when` is
    the date and time of the walk, as in "2026-11-26 09:40 UTC". `version` is that of solepath."""

    source: str = ""
    plan: FloorPlan | None = None
    recipe: str = ""
    when: str = ""
    version: str = field(factory=installed_version)
    walk: Walk = field(factory=Walk)
    made_by: Mapping[str, Any] = field(factory=dict)
    """How the walk was computed, with hashes of the recipe and of the inputs (saving/provenance.py)."""
    details: ReportDetails = field(factory=ReportDetails)
    bands: Mapping[str, Band] = field(factory=dict)
    """Bands of reference by the names of the measures (measures.py)."""
    calibrated: bool = False
    """True if the session has a calibration."""
    before: ReportContent | None = None
    """Content of the report of the earlier walk with which this one is compared."""
    outcomes: OutcomeRequest | None = None
    """Clinical outcomes, which the report shows before the gait; None without any."""

    def take(self, item: Packet | Sample | None, events: Sequence[Event]) -> None:
        """Add a packet or sample that the session was fed, and the events that it returned, to the walk."""
        self.walk.take(item, events)

    @property
    def clock(self) -> ReportClock:
        """Clock from the first to the last sample, or from the first to the last event if there are no samples."""
        return ReportClock(*(self.walk.sample_span or self.walk.event_span or (0.0, 0.0)))

    @property
    def track(self) -> Sequence[TimedPosition]:
        """Track of the wearer or, if it is not known, of the foot with the most strides, from the first step on."""
        strides, moved = {foot: list(kept) for foot, kept in self.walk.strides.items()}, list(self.walk.wearer_track)
        if moved:
            return [*_first_steps([own for own in strides.values() if own], moved[0]), *moved]
        most = max(strides.values(), key=len)
        return [evolve(most[0], t=_start_of(most[0]), position=_before(most[0])), *most] if most else []


def _first_steps(strides: Sequence[Sequence[StrideTaken]], first: WearerMoved) -> list[WearerMoved]:
    """Return where the wearer was before the `first` position that a session gives: in the middle of the feet.

    A session gives it once the feet are known to carry a walker."""
    early = sorted([one for own in strides for one in own if one.t_end < first.t], key=lambda one: one.t_end)
    places = {own[0].foot: _before(own[0]) for own in strides}
    found = []
    for t, stride in [(min(map(_start_of, early), default=first.t), None), *[(one.t_end, one) for one in early]]:
        if stride is not None:
            places[stride.foot] = stride.position
        x, y, z = [fmean(values) for values in zip(*places.values(), strict=True)] if places else first.position
        found.append(evolve(first, t=t, position=(x, y, z)))
    return found if early else []


def _start_of(stride: StrideTaken) -> float:
    """Return when the foot left the ground, s, or the start of the stride if that is not known."""
    return stride.t_start if stride.t_toe_off is None else stride.t_toe_off


def _before(stride: StrideTaken) -> Vec3:
    """Return where a stride began, m."""
    x, y, z = [end - way for end, way in zip(stride.position, stride.displacement, strict=True)]
    return x, y, z
