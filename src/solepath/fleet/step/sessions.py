"""Construction of the sessions of a fleet, with one recipe for all wearers and each wearer's calibration."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from attrs import astuple, field, frozen

from ...calibration import Calibration
from ...floorplan.index import IndexedPlan
from ...link.driver import Driver
from ...recipes import Recipe, shared_copy
from ...saving.codec import SnapshotError
from ...session import Session


@frozen
class Sessions:
    """The maker of new and restored sessions; it holds no session."""

    recipe: Recipe = field(converter=shared_copy)
    """A private copy of the recipe, which never changes, so no session has to check for changes."""
    calibrations: Mapping[str, Calibration]
    floorplan: IndexedPlan | None
    profiles: tuple[Driver, ...]
    parts: tuple[type, ...]
    poses: bool
    pressures: bool
    window: int

    def __reduce__(self) -> tuple[type[Sessions], tuple[Any, ...]]:
        return Sessions, astuple(self, recurse=False)  # converted again where it is unpickled

    def make_session(self, wearer: str, calibrated: bool = True) -> Session:
        """Return a session without any input; `calibrated` applies the wearer's calibration."""
        return Session(
            self.recipe,
            calibration=self.calibrations.get(wearer) if calibrated else None,
            poses=self.poses,
            pressures=self.pressures,
            profiles=self.profiles,
            floorplan=self.floorplan,
        )

    def unpack(self, data: bytes) -> Session:
        """Return the session of packed bytes; raise SnapshotError when it cannot continue here."""
        app_code: Any = {"profiles": self.profiles, "parts": self.parts, "floorplan": self.floorplan}
        session = Session.unpack(data, self.recipe, **app_code)
        try:
            session.feed(())  # raises if the session is finished
        except ValueError as error:
            raise SnapshotError(str(error)) from None
        return session

    def restore_session(self, snapshot: Any) -> Session:
        """Return the session of a JSON snapshot; raise SnapshotError when it cannot continue here."""
        app_code: Any = {"profiles": self.profiles, "parts": self.parts, "floorplan": self.floorplan}
        return self.unpack(Session.restore(snapshot, **app_code).pack())
