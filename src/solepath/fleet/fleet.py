"""The step that a stream engine calls for every wearer, with the state that the engine keeps."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from attrs import frozen

from .step.keyed import Keyed
from .step.sent import NumberedEvent, Sent, Unreadable
from .step.sessions import Sessions
from .step.state import StateHead, StateRest, write_state


@frozen(eq=False)
class Fleet(Sessions):
    """The configuration of a job, the same for all wearers and on every worker; it holds no wearer's state.

    Recipe, floor plan, profiles, poses and pressures are arguments of Session, parts of Session.restore. The mapping
    "calibrations" has the calibration of each wearer. The window is the largest number of rows that may overtake a
    missing row before that row is given up. The app must keep new versions of its own code in recipe, profiles and
    parts compatible. Raises TypeError and ValueError as Session does.

    A Fleet can be pickled when its arguments can; the readers of a driver cannot. For an engine that pickles its job,
    define a class in a module that the workers can import, so that only its name is pickled:

        class Ours(Fleet):
            def __init__(self) -> None:
                super().__init__(profiles=[STRAP])

            def __reduce__(self) -> tuple[type, tuple[()]]:
                return Ours, ()"""

    def step(
        self, wearer: str, state: bytes | None, sent: Iterable[Sent | Unreadable]
    ) -> tuple[bytes, list[NumberedEvent]]:
        """Return the state and the events of `wearer` after `sent`, from the previous state; None for a new wearer.

        The step is pure: the same input gives the same output, on every machine and however the input is divided among
        calls, if the app's parts can be saved at any moment. A part that cannot be saved when a state is taken (since
        it holds an infinity) ends its wearer's session with WearerFailed.

        No row makes it raise. A state that cannot be used gives StateRejected and a new session. Errors of the job
        itself, a state that is neither bytes nor None or a `sent` that cannot be iterated, raise TypeError. Raises
        MemoryError when memory runs out."""
        keyed = self.open(wearer, state)
        events = keyed.feed(sent)
        return keyed.state(), events

    def open(self, wearer: str, state: bytes | None) -> Keyed:
        """Return the wearer as an object, for engines that keep objects between snapshots; raises as `step` does."""
        return Keyed(self, wearer, state)

    def adopt(self, snapshot: Any) -> bytes:
        """Return a state that continues a Session.snapshot taken elsewhere.

        With it a phone hands its wearer over to the fleet; the next row of the phone is number 0 of a run. Events are
        numbered from 0. From now on the settings of the job's recipe are used, not those in the snapshot. Raises
        SnapshotError when the session cannot continue here (Session.unpack) or is finished."""
        session = self.restore_session(snapshot)
        now = session.now
        head = StateHead(-1, 0, 0, 0.0 if now is None else now)
        return write_state(head, StateRest(session=session.pack()))
