"""The state of a session as plain data for JSON, and the conditions for a state to continue."""

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
from .wearer import sort_by_key

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan


def take_snapshot(state: SessionState) -> dict[str, Json]:
    """Return the state with a checksum: a session of damaged numbers could do anything later."""
    check_names(state.wearer.settings.recipe)
    saved_state = save(state)
    return {"solepath": VERSION, "check": checksum(saved_state), "state": saved_state}


def restore_state(saved: Any, parts: Iterable[type]) -> SessionState:
    """Return the state of a snapshot; raise SnapshotError, TypeError and ValueError as `Session.restore` does."""
    classes = make_class_lookup(parts)
    if not isinstance(saved, dict) or not saved.keys() >= {"solepath", "check", "state"}:
        raise SnapshotError("not a snapshot of a session")
    version = saved["solepath"]
    if type(version) is not int or version != VERSION:
        raise SnapshotError(f"a snapshot of version {version!r:.80}; this release reads version {VERSION} alone")
    state = load(SessionState, saved["state"], classes)
    state.decoders = sort_by_key(state.decoders, Site)
    state.wearer.feet = sort_by_key(state.wearer.feet, Foot)
    if checksum(save(state)) != saved["check"]:
        raise SnapshotError("the snapshot was damaged: its checksum is another")
    settings = state.wearer.settings
    state.wearer.settings = evolve(settings, recipe=own(settings.recipe))
    return state


def check_names(recipe: Recipe) -> None:
    """Raise TypeError for a part of the app's own with the name of one of ours: it would be restored as that."""
    for part in (recipe.detector, recipe.corrector, recipe.cues, *recipe.parts, recipe.place):
        name = type(part).__name__
        if name in PARTS and part_class(name) is not type(part):
            raise TypeError(f"it could not tell this {name} from solepath's own: give it another name")


def make_class_lookup(parts: Iterable[type]) -> Classes:
    """Return a lookup of classes of parts, the app's first.

    Raises TypeError for a class that is no record, ValueError for two of one name."""
    classes = list(dict.fromkeys(parts))
    for cls in classes:
        if not is_record(cls):
            raise TypeError(f"a part is an attrs class, and {cls!r} is none")
    named = {cls.__name__: cls for cls in classes}
    if len(named) != len(classes):
        raise ValueError("two parts have one name")
    return lambda name: named.get(name) or part_class(name)


def check_fit(state: SessionState, known: DeviceKinds, plan: IndexedPlan | None) -> None:
    """Raise SnapshotError if the state needs another floor plan than `plan`, or a device that is not `known`."""
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
