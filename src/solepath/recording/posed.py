"""The samples that a session uses, each with the pose of its foot, for exports to other formats."""

from __future__ import annotations

from collections.abc import Iterable

from ..events import Event, FootMoved
from ..session import Session
from ..session.state import SessionState
from ..types import Phase, Quat, Sample, Site, Vec3
from ..types.attrs import define, field, fields, frozen


@frozen
class PoseState:
    """Position, velocity, attitude and phase of a foot after a sample, as the session knew them with that sample."""

    position: Vec3
    """Position of the sensor, world frame, m."""
    velocity: Vec3
    """Velocity of the sensor, world frame, m/s."""
    attitude: Quat
    """Attitude, sensor to world frame, as a unit quaternion (w, x, y, z)."""
    phase: Phase


@frozen
class PosedSample:
    """A sample of a session, with the state of its foot after it.

    `state` is None for a sensor that is not on a foot, before the first attitude is known, and for a sample that the
    foot did not use."""

    sample: Sample
    state: PoseState | None


@define
class PoseKeepingState(SessionState):
    """State of a session that adds every sample to `posed`, which the caller empties."""

    posed: list[PosedSample] = field(factory=list, init=False)

    def feed_sample(self, sample: Sample) -> list[Event]:
        events = super().feed_sample(sample)
        self._keep(sample, events)
        return events

    def use_items(self, site: Site, items: Iterable[Sample | Event], events: list[Event]) -> None:
        for item in items:
            found: list[Event] = []
            super().use_items(site, (item,), found)
            if isinstance(item, Sample):
                self._keep(item, found)
            events += found

    def _keep(self, sample: Sample, events: list[Event]) -> None:
        tracker = None if sample.site.foot is None else self.feet.get(sample.site.foot)
        state = None
        if tracker is not None and tracker.levelled:
            for event in events:
                if isinstance(event, FootMoved) and event.foot is tracker.foot and event.t == sample.t:
                    state = PoseState(event.position, event.velocity, tracker.attitude, event.phase)
        self.posed.append(PosedSample(sample, state))


class PosedSession:
    """A session, made with `poses=True`, whose samples can be taken after each call with the poses of their feet.

        posed = PosedSession(Session(recipe, poses=True))
        for item in source:
            events = posed.session.feed(item)
            samples = posed.take()

    ValueError is raised for a session that was fed already."""

    def __init__(self, session: Session) -> None:
        if session.now is not None:
            raise ValueError("the samples of a session are kept from its start")
        self.session = session
        old, self._state = session._state, PoseKeepingState(session._state.settings)
        for one in fields(SessionState):
            setattr(self._state, one.name, getattr(old, one.name))
        session._state = self._state

    def take(self) -> list[PosedSample]:
        """Return the samples since the last call, in the order in which the session used them."""
        taken, self._state.posed = self._state.posed, []
        return taken
