"""The keyed step: what a stream engine calls for every wearer, with the state that it keeps."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from ..calibration import Calibration
from ..floorplan.index import IndexedPlan
from ..floorplan.plan import FloorPlan
from ..link.driver import Driver
from ..recipes import DEFAULT, Recipe
from .step.keyed import Keyed
from .step.sent import NumberedEvent, Sent, Unreadable
from .step.sessions import Sessions
from .step.state import Identity, OtherState, write_state


class Fleet:
    """The configuration of a job, the same for all wearers and on every worker; it holds nothing of any of them.

    `recipe`, `floorplan`, `profiles`, `poses`, `pressures`: as for Session. `calibrations`: what is known of a wearer,
    looked up when a session of that wearer begins. `parts`: as for Session.restore. `window`: so many rows may overtake
    one that is late, before it is given up. A new version of the app's own code in `recipe`, `profiles` and `parts` is
    for the app to keep compatible. TypeError and ValueError as Session raises them.

    It can be pickled when what it is given can, which the constructs of a driver cannot: an engine that sends its job
    to the workers by pickle takes a class of the app's own, in a module that the workers can import, by name:

        class Ours(Fleet):
            def __init__(self) -> None:
                super().__init__(profiles=[STRAP])

            def __reduce__(self) -> tuple[type, tuple[()]]:
                return Ours, ()
    """

    __slots__ = ("_sessions",)

    def __init__(
        self,
        recipe: Recipe = DEFAULT,
        *,
        calibrations: Mapping[str, Calibration] = {},
        floorplan: FloorPlan | IndexedPlan | None = None,
        profiles: Iterable[Driver] = (),
        parts: Iterable[type] = (),
        window: int = 256,
        poses: bool = False,
        pressures: bool = False,
    ) -> None:
        if not isinstance(calibrations, Mapping):
            raise TypeError(f"calibrations is a mapping by wearer, not a {type(calibrations).__name__}")
        if type(window) is not int or window < 0:
            raise ValueError(f"window is {window}; it is a number of rows")
        plan = IndexedPlan(floorplan) if isinstance(floorplan, FloorPlan) else floorplan
        own = (tuple(profiles), tuple(parts))
        self._sessions = Sessions(recipe, calibrations, plan, *own, poses, pressures, window)
        # what is wrong for all is wrong here, and not in a worker
        self._sessions.unpack(self._sessions.fresh("", calibrated=False).pack())

    def step(
        self, wearer: str, state: bytes | None, sent: Iterable[Sent | Unreadable]
    ) -> tuple[bytes, list[NumberedEvent]]:
        """The state and the events of `wearer` after `sent`, given the state before; None for a wearer who is new.

        Pure: the same in gives the same out, on every machine, however it is cut into calls, where parts of the app's
        own can be saved at any moment. One that cannot, since it holds an infinity just then, costs its wearer the
        session (WearerFailed) where a state is taken at that moment, and nothing where none is.

        It never raises, whatever phones sent; a state that cannot be used gives StateRejected and a fresh start.
        TypeError, since the job itself is wrong, for a state that is neither bytes nor None and for a `sent` that
        cannot be gone through. MemoryError where memory runs out.
        """
        keyed = self.open(wearer, state)
        told = keyed.feed(sent)
        return keyed.state(), told

    def open(self, wearer: str, state: bytes | None) -> Keyed:
        """The same in memory, for engines that keep objects between their snapshots. It raises as `step` does."""
        return Keyed(self._sessions, wearer, state)

    def adopt(self, snapshot: Any) -> bytes:
        """A state that goes on from a Session.snapshot taken elsewhere: a phone hands its wearer over, and begins to
        send at number 0 of a run. Events are numbered from 0. The settings of the job's recipe hold from here on, not
        those in the snapshot. SnapshotError when it cannot go on here (Session.unpack) or is finished."""
        session = self._sessions.restored(snapshot)
        now = session.now
        identity = Identity(-1, 0, 0, 0.0 if now is None else now)
        return write_state(identity, OtherState(session=session.pack()))
