"""The state of a session as plain data for JSON, and what must be there for a state to go on."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..floorplan.index import IndexedPlan
from ..link.known import Kinds
from ..recipes import own
from ..session.state import VERSION, SessionState
from ..session.wearer import in_order
from ..types import Foot, Site
from . import parts as _parts  # noqa: F401  the codec knows the classes of solepath from there
from .codec import Json, SnapshotError, checksum, load, save


def taken(state: SessionState) -> dict[str, Json]:
    """It carries a checksum of itself: a session made of damaged numbers could do anything later."""
    told = save(state)
    return {"solepath": VERSION, "check": checksum(told), "state": told}


def restored(saved: Any, parts: Iterable[type]) -> SessionState:
    """The state that was taken. SnapshotError, TypeError and ValueError as `Session.restore`
    has them."""
    if not isinstance(saved, dict) or not saved.keys() >= {"solepath", "check", "state"}:
        raise SnapshotError("not a snapshot of a session")
    version = saved["solepath"]
    if type(version) is not int or version != VERSION:
        raise SnapshotError(f"a snapshot of version {version!r:.80}; this release reads version {VERSION} alone")
    state = load(SessionState, saved["state"], parts)
    state.decoders = in_order(state.decoders, Site)
    state.wearer.feet = in_order(state.wearer.feet, Foot)
    if checksum(save(state)) != saved["check"]:
        raise SnapshotError("the snapshot was damaged: its checksum is another")
    state.wearer.recipe = own(state.wearer.recipe)
    return state


def must_fit(state: SessionState, known: Kinds, plan: IndexedPlan | None) -> None:
    """SnapshotError where the state needs another floor plan than `plan`, or a device that is not `known`."""
    if state.plan != (None if plan is None else plan.fingerprint):
        with_one = "with the floor plan that it had" if state.plan is not None else "without a floor plan"
        raise SnapshotError(f"a snapshot of a session is restored {with_one}")
    for decoder in state.decoders.values():
        if decoder.link is None:
            continue
        kind = known.get(decoder.link.name)
        if kind is None:
            raise SnapshotError(f"a snapshot of a device {decoder.link.name!r}: restore it with its profile")
        if not kind.fits(decoder.link):
            raise SnapshotError(f"a snapshot of a device {decoder.link.name!r} as another driver declared it")
