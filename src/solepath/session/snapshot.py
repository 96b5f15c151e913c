"""The state of a session as plain data for JSON, and what must be there for a state to go on."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from ..link.kinds import DeviceKinds
from ..recipes import PARTS, Recipe, own, part_class
from ..saving.codec import Classes, Json, SnapshotError, checksum, load, save
from ..saving.schema import is_record
from ..types import Foot, Site
from ..types.attrs import evolve
from .state import VERSION, SessionState
from .wearer import in_order

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan


def taken(state: SessionState) -> dict[str, Json]:
    """It carries a checksum of itself: a session made of damaged numbers could do anything later."""
    check_names(state.wearer.settings.recipe)
    told = save(state)
    return {"solepath": VERSION, "check": checksum(told), "state": told}


def restored(saved: Any, parts: Iterable[type]) -> SessionState:
    """The state that was taken. SnapshotError, TypeError and ValueError as `Session.restore` has them."""
    classes = by_name(parts)
    if not isinstance(saved, dict) or not saved.keys() >= {"solepath", "check", "state"}:
        raise SnapshotError("not a snapshot of a session")
    version = saved["solepath"]
    if type(version) is not int or version != VERSION:
        raise SnapshotError(f"a snapshot of version {version!r:.80}; this release reads version {VERSION} alone")
    state = load(SessionState, saved["state"], classes)
    state.decoders = in_order(state.decoders, Site)
    state.wearer.feet = in_order(state.wearer.feet, Foot)
    if checksum(save(state)) != saved["check"]:
        raise SnapshotError("the snapshot was damaged: its checksum is another")
    settings = state.wearer.settings
    state.wearer.settings = evolve(settings, recipe=own(settings.recipe))
    return state


def check_names(recipe: Recipe) -> None:
    """TypeError for a part of an app's own that is called as one of ours: it would be restored as that."""
    for part in (recipe.detector, recipe.corrector, recipe.cues, *recipe.parts, recipe.place):
        name = type(part).__name__
        if name in PARTS and part_class(name) is not type(part):
            raise TypeError(f"it could not tell this {name} from solepath's own: give it another name")


def by_name(parts: Iterable[type]) -> Classes:
    """Looks classes of parts up, an app's first. TypeError for what is no record, ValueError for two of one name."""
    classes = list(dict.fromkeys(parts))
    for cls in classes:
        if not is_record(cls):
            raise TypeError(f"a part is an attrs class, and {cls!r} is none")
    named = {cls.__name__: cls for cls in classes}
    if len(named) != len(classes):
        raise ValueError("two parts have one name")
    return lambda name: named.get(name) or part_class(name)


def must_fit(state: SessionState, known: DeviceKinds, plan: IndexedPlan | None) -> None:
    """SnapshotError where the state needs another floor plan than `plan`, or a device that is not `known`."""
    had = state.wearer.settings.plan
    if had != (None if plan is None else plan.fingerprint):
        with_one = "with the floor plan that it had" if had is not None else "without a floor plan"
        raise SnapshotError(f"a snapshot of a session is restored {with_one}")
    for decoder in state.decoders.values():
        if decoder.link is None:
            continue
        kind = known.get(decoder.link.name)
        if kind is None:
            raise SnapshotError(f"a snapshot of a device {decoder.link.name!r}: restore it with its profile")
        if not kind.accepts(decoder.link):
            raise SnapshotError(f"a snapshot of a device {decoder.link.name!r} as another driver declared it")
