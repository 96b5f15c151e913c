"""Conversion of a session's state to plain data for JSON and back, and checks that a restored state can continue."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from ..link.kinds import DeviceKinds
from ..recipes import Recipe, part_class, shared_copy
from ..saving.codec import Classes, Json, SnapshotError, checksum, load, save
from ..saving.limits import check_size
from ..saving.schema import is_record
from ..types import Foot, Site
from ..types.attrs import evolve
from ..types.checking import describe
from ..types.registry import TABLE
from .state import VERSION, SessionState, sort_by_key

if TYPE_CHECKING:
    from ..floorplan.index import IndexedPlan


def take_snapshot(state: SessionState) -> dict[str, Json]:
    """Return the state with a checksum, since damaged numbers could cause any fault later."""
    check_names(state.settings.recipe)
    saved_state = save(state)
    try:
        check_size(saved_state)
    except ValueError as error:
        raise SnapshotError(f"this state cannot be saved: {error}") from None
    return {"solepath": VERSION, "check": checksum(saved_state), "state": saved_state}


def restore_state(saved: Any, parts: Iterable[type]) -> SessionState:
    """Return the state of a snapshot; raise SnapshotError, TypeError and ValueError as `Session.restore` does."""
    classes = make_class_lookup(parts)
    if not isinstance(saved, dict) or not saved.keys() >= {"solepath", "check", "state"}:
        raise SnapshotError("not a snapshot of a session, which is a dict with solepath, check and state")
    version = saved["solepath"]
    if version != VERSION:
        wrong = f"a snapshot of version {describe(version)}; this release reads version {VERSION} alone"
        raise SnapshotError(f"{wrong}: feed the recording again")
    state = load(SessionState, saved["state"], classes)
    state.decoders = sort_by_key(state.decoders, Site)
    state.feet = sort_by_key(state.feet, Foot)
    if checksum(save(state)) != saved["check"]:
        raise SnapshotError("the snapshot was damaged: its checksum is another")
    settings = state.settings
    state.settings = evolve(settings, recipe=shared_copy(settings.recipe))
    return state


def own_classes(state: SessionState) -> tuple[type, ...]:
    """Return the classes of the parts of a session that are those of an app."""
    return tuple([cls for cls in _classes(state.settings.recipe) if cls.__name__ not in TABLE["part"]])


def check_names(recipe: Recipe) -> None:
    """Raise TypeError for an app's part that has the name of a part of solepath: it would be restored as that."""
    for cls in _classes(recipe):
        if cls.__name__ in TABLE["part"] and part_class(cls.__name__) is not cls:
            raise TypeError(f"it could not tell this {cls.__name__} from solepath's own: give it another name")


def _classes(recipe: Recipe) -> list[type]:
    """Return the classes of a recipe's parts, each once."""
    parts = (recipe.detector, recipe.corrector, recipe.cues, *recipe.parts, recipe.place)
    return list(dict.fromkeys([type(part) for part in parts if part is not None]))


def make_class_lookup(parts: Iterable[type]) -> Classes:
    """Return a function from a name to the class of a part; the app's classes come first.

    Raises TypeError for a class that is no record, and ValueError when two classes have one name."""
    classes = list(dict.fromkeys(parts))
    for cls in classes:
        if not is_record(cls):
            raise TypeError(f"a part is an attrs class, and {cls!r} is none")
    by_name = {cls.__name__: cls for cls in classes}
    if len(by_name) != len(classes):
        raise ValueError("two parts have one name")
    return lambda name: by_name.get(name) or part_class(name)


def check_fit(state: SessionState, kinds: DeviceKinds, plan: IndexedPlan | None) -> None:
    """Raise SnapshotError if the state needs another floor plan than `plan`, or a device that is not in `kinds`."""
    saved_plan = state.settings.plan
    if saved_plan != (None if plan is None else plan.fingerprint):
        condition = "with the floor plan that it had" if saved_plan is not None else "without a floor plan"
        raise SnapshotError(f"a snapshot of a session is restored {condition}")
    for link in [decoder.link for decoder in state.decoders.values() if decoder.link is not None]:
        kind = kinds.get(link.name)
        if kind is None or not kind.accepts(link):
            what = "restore it with its profile" if kind is None else "another driver declared it"
            raise SnapshotError(f"a snapshot of a device {describe(link.name)}: {what}")
