"""States of older versions: read by the shape that was pinned then, changed step by step, read as one of today."""

from __future__ import annotations

import json
import typing
from collections.abc import Mapping
from functools import lru_cache, partial
from importlib.resources import files
from typing import Any

import attrs

from .. import recipes
from ..recipes import Recipe
from ..session.state import VERSION, State
from ..session.wearer import in_order
from ..types import Foot, Site
from .begun import filled
from .codec import SnapshotError, checksum, load_value
from .reading import Own
from .records import own_classes, own_shape, shape
from .shape import Shape, alternatives
from .tree import Streams, from_tree, to_tree
from .upgrades import UPGRADES


@lru_cache(maxsize=4)
def pinned(version: int) -> tuple[Shape, Shape]:
    """The shapes of what this version packs, and of its snapshots."""
    told = json.loads((files(__package__) / "shapes" / f"{version}.json").read_text("utf-8"))
    return Shape(**told["packed"]), Shape(**told["snapshot"])


def upgraded(version: int, streams: Streams, own: Own) -> Streams:
    """What an older version packed, as this one would."""
    tree = to_tree(pinned(version)[0], streams, partial(own_shape, own=own))
    streams.end()
    return _stepped(version, tree, own)


def _stepped(version: int, tree: Any, own: Own) -> Streams:
    for step in range(version, VERSION):
        tree = UPGRADES[step](tree)
    return _cut(shape(), tree, own)


def _cut(known: Shape, tree: Any, own: Own, strict: bool = True) -> Streams:
    floats, ints, flags, data = from_tree(known, tree, partial(own_shape, own=own), strict)
    return Streams(floats, ints, flags, b"".join(data))


def restore(saved: Mapping[str, Any], parts: tuple[type, ...]) -> State:
    """The state that a snapshot of an older version holds. SnapshotError where it holds none."""
    version, own = saved["solepath"], own_classes(None, parts)
    try:
        return _restored(version, saved, own)
    except SnapshotError:
        raise
    except (TypeError, ValueError, KeyError, IndexError, AttributeError, OverflowError, RecursionError) as error:
        raise SnapshotError(f"not a snapshot of version {version}: {error}") from error


def _restored(version: int, saved: Mapping[str, Any], own: Own) -> State:
    packed, snapshot = pinned(version)
    # as it was saved, whatever an encoder made of it
    tree: Any = to_tree(snapshot, _cut(snapshot, saved["state"], own), partial(own_shape, own=own))
    if checksum(tree) != saved["check"]:
        raise SnapshotError("the snapshot was damaged: its checksum is another")
    recipe = recipes.own(_made_again(Recipe, tree["wearer"]["recipe"], own))
    head = {name: tree["wearer"][name] for name in ("calibration", "poses", "pressures")}
    whole = {"head": head | {"recipe": recipe.name}, "state": tree}
    less = to_tree(packed, _cut(packed, whole, own, strict=False), partial(own_shape, own=own))
    state = filled(_stepped(version, less, own), recipe, own)
    state.decoders = in_order(state.decoders, Site)
    state.wearer.feet = in_order(state.wearer.feet, Foot)
    return state


def _made_again(hint: Any, tree: Any, own: Own) -> Any:
    """A recipe, or a part of one, of its settings: those that are no more are left out, those that are new are as they
    are by default."""
    kinds = [a for a in alternatives(hint) if a is not type(None)]
    records = {a.__name__: a for a in kinds if attrs.has(a)}
    if tree is None or not records:
        return load_value(hint, tree)
    cls = records.get(next(iter(records)))
    if len(kinds) > 1:
        cls, tree = (own | records).get(tree["kind"]), tree["is"]
    if cls is None:
        raise SnapshotError("a snapshot of a part that is not known here")
    hints = typing.get_type_hints(cls)
    return cls(
        **{
            field.alias: _made_again(hints[field.name], tree[field.name], own)
            for field in attrs.fields(cls)
            if field.init and field.name in tree
        }
    )
