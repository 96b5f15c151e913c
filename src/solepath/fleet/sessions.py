"""How the sessions of a fleet are made: the same recipe for every wearer, and what is known of each."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from attrs import field, frozen

from ..calibration import Calibration
from ..floorplan.index import IndexedPlan
from ..link.driver import Driver
from ..recipes import Recipe
from ..session import Session


@frozen
class Sessions:
    """Fresh ones, and bytes of them. It holds nothing of any wearer."""

    recipe: Recipe
    calibrations: Mapping[str, Calibration]
    floorplan: IndexedPlan | None
    profiles: tuple[Driver, ...]
    parts: tuple[type, ...]
    poses: bool
    pressures: bool
    window: int
    _blank: bytes = field(init=False)
    """A session that heard nothing yet and knows nothing of its wearer."""

    @_blank.default
    def _begin(self) -> bytes:
        return self._session(None).pack()

    def fresh(self, wearer: str, calibrated: bool = True) -> Session:
        """A session that heard nothing yet. `calibrated`: with what is known of the wearer."""
        calibration = self.calibrations.get(wearer) if calibrated else None
        # unpacked ones share all that never changes, and are made in a tenth of the time
        return self.unpack(self._blank) if calibration is None else self._session(calibration)

    def _session(self, calibration: Calibration | None) -> Session:
        return Session(
            self.recipe,
            calibration=calibration,
            poses=self.poses,
            pressures=self.pressures,
            profiles=self.profiles,
            floorplan=self.floorplan,
        )

    def pack(self, session: Session) -> bytes:
        """SnapshotError or TypeError when a part of the app's own holds what cannot be saved."""
        return session.pack()

    def unpack(self, data: bytes) -> Session:
        """SnapshotError when it cannot go on here."""
        own: Any = {"profiles": self.profiles, "parts": self.parts, "floorplan": self.floorplan}
        return Session.unpack(data, self.recipe, **own)

    def restored(self, snapshot: Any) -> Session:
        """The same of a JSON snapshot."""
        own: Any = {"profiles": self.profiles, "parts": self.parts, "floorplan": self.floorplan}
        return self.unpack(Session.restore(snapshot, **own).pack())
