"""Sessions that were just begun, and what was remembered filled in."""

from __future__ import annotations

from ..recipes import Recipe
from ..session.state import SessionState
from ..session.wearer import WearerParts
from ..types import Foot, shared
from .codec import SnapshotError
from .reading import Own
from .records import Head, packed_readers
from .tree import Streams

KEPT = 16
"""So many are kept, to be filled in again."""
_kept: tuple[tuple[Recipe, Head, SessionState], ...] = ()


def filled(streams: Streams, recipe: Recipe, parts: Own) -> SessionState:
    """The state that the streams hold, of a session of this recipe, which is one that nobody changes (recipes.own).
    SnapshotError where it was another's."""
    read_head, read_state = packed_readers()
    arguments = streams.f, streams.n, streams.m, streams.b, streams.floats, parts
    head: Head = read_head(None, *arguments)
    if head.recipe != recipe.name:
        raise SnapshotError(f"packed with the recipe {head.recipe!r}, and this is {recipe.name!r}")
    state: SessionState = read_state(_begun(recipe, head), *arguments)
    streams.end()
    for foot in state.wearer.feet.values():
        layout = foot.insole.layout
        if layout is not None:
            foot.insole.layout = shared(layout)
    return state


def _begun(recipe: Recipe, head: Head) -> SessionState:
    """A session of the recipe to which nothing has happened: what is unpacked has its settings, which never change.
    Making one takes longer than all the rest, so the newest are kept; nobody else holds them."""
    global _kept
    for known, begun_with, state in _kept:
        if known is recipe and begun_with == head:
            return state
    state = SessionState(WearerParts(recipe, head.calibration, head.poses, head.pressures))
    state.wearer.feet = {foot: state.wearer._tracker(foot) for foot in Foot}
    _kept = ((recipe, head, state), *_kept[: KEPT - 1])
    return state
