"""Construction of the sessions of a fleet, with one recipe for all wearers and each wearer's calibration."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial
from typing import Any

from attrs import asdict, field, frozen
from attrs.validators import ge, instance_of

from ...calibration import Calibration
from ...floorplan.index import IndexedPlan
from ...floorplan.plan import FloorPlan
from ...link.driver import Driver
from ...recipes import DEFAULT, Recipe, shared_copy
from ...saving.codec import SnapshotError
from ...session import Session


def _indexed(plan: FloorPlan | IndexedPlan | None) -> IndexedPlan | None:
    return IndexedPlan(plan) if isinstance(plan, FloorPlan) else plan


def _drivers(profiles: Iterable[Driver]) -> tuple[Driver, ...]:
    return tuple(profiles)


def _classes(parts: Iterable[type]) -> tuple[type, ...]:
    return tuple(parts)


@frozen(eq=False)
class Sessions:
    """The maker of new and restored sessions; it holds no session."""

    recipe: Recipe = field(default=DEFAULT, converter=shared_copy)
    """A private copy of the recipe, which never changes, so no session has to check for changes."""
    calibrations: Mapping[str, Calibration] = field(
        factory=dict,
        kw_only=True,
        validator=instance_of(Mapping),  # type: ignore[type-abstract]
    )
    """Calibration of each wearer, looked up when a session of that wearer starts."""
    floorplan: IndexedPlan | None = field(default=None, kw_only=True, converter=_indexed)
    """Floor plan of all sessions, as for Session."""
    profiles: tuple[Driver, ...] = field(default=(), kw_only=True, converter=_drivers)
    """Drivers of the app's own devices, as for Session."""
    parts: tuple[type, ...] = field(default=(), kw_only=True, converter=_classes)
    """Classes of the app's own parts, as for Session.restore."""
    window: int = field(default=256, kw_only=True, validator=[instance_of(int), ge(0)])
    """Largest number of rows that may overtake a missing row before that row is given up."""
    poses: bool = field(default=False, kw_only=True)
    """Flag: sessions report positions, as for Session."""
    pressures: bool = field(default=False, kw_only=True)
    """Flag: sessions report the cells of insoles, as for Session."""

    def __attrs_post_init__(self) -> None:
        # an error that concerns all wearers is raised here, not in a worker
        self.unpack(self.make_session("", calibrated=False).pack())

    def __reduce__(self) -> tuple[Any, tuple[()]]:
        return partial(type(self), **asdict(self, recurse=False)), ()  # converted again where it is unpickled

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
