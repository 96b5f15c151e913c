"""How the sessions of a fleet are made: the same recipe for every wearer, and what is known of each."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from attrs import astuple, field, frozen

from ...calibration import Calibration
from ...floorplan.index import IndexedPlan
from ...link.driver import Driver
from ...recipes import Recipe, own
from ...saving.codec import SnapshotError
from ...session import Session


@frozen
class Sessions:
    """Fresh ones, and bytes of them. It holds nothing of any wearer."""

    recipe: Recipe = field(converter=own)
    """Nobody changes it, so that no session has to look whether somebody did."""
    calibrations: Mapping[str, Calibration]
    floorplan: IndexedPlan | None
    profiles: tuple[Driver, ...]
    parts: tuple[type, ...]
    poses: bool
    pressures: bool
    window: int

    def __reduce__(self) -> tuple[type[Sessions], tuple[Any, ...]]:
        return Sessions, astuple(self, recurse=False)  # to be converted where it comes to

    def fresh(self, wearer: str, calibrated: bool = True) -> Session:
        """A session that heard nothing yet. `calibrated`: with what is known of the wearer."""
        return Session(
            self.recipe,
            calibration=self.calibrations.get(wearer) if calibrated else None,
            poses=self.poses,
            pressures=self.pressures,
            profiles=self.profiles,
            floorplan=self.floorplan,
        )

    def unpack(self, data: bytes) -> Session:
        """SnapshotError when it cannot go on here."""
        own: Any = {"profiles": self.profiles, "parts": self.parts, "floorplan": self.floorplan}
        session = Session.unpack(data, self.recipe, **own)
        try:
            session.feed(())
        except ValueError as error:  # finished
            raise SnapshotError(str(error)) from None
        return session

    def restored(self, snapshot: Any) -> Session:
        """The same of a JSON snapshot."""
        own: Any = {"profiles": self.profiles, "parts": self.parts, "floorplan": self.floorplan}
        return self.unpack(Session.restore(snapshot, **own).pack())
