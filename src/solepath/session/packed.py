"""A session's state as bytes, and back.

    magic  form  version  schema  check  body        protocol/snapshot.md

`form` is how numbers are written, `version` that of the state, `schema` the CRC-32 of the schema that the body has,
`check` that of all the rest. The recipe is not in it, nor what it makes: unpacking begins a session of the recipe that
is given, and fills in what was remembered.
"""

from __future__ import annotations

from binascii import crc32
from collections.abc import Iterable
from functools import lru_cache
from struct import Struct
from typing import Any

from ..calibration import Calibration
from ..recipes import Recipe, own
from ..saving.codec import Classes, SnapshotError
from ..saving.packed import Lists, Streams, read, write
from ..saving.schema import check_of, described, record_of
from ..saving.streams import Units, from_bytes, to_bytes
from ..types import Foot, shared
from ..types.attrs import define
from .snapshot import by_name, check_names
from .state import VERSION, SessionState
from .wearer import WearerParts, WearerSettings

MAGIC = b"sole"
FORM = 2
HEADER = Struct("<4sHHII")

KEPT = 16
"""So many sessions that were just begun are kept, to be filled in again."""


@define
class Head:
    """What a session is begun with."""

    recipe: str
    """Its name."""
    calibration: Calibration
    poses: bool
    pressures: bool
    plan: int | None
    """Fingerprint of the floor plan; None without one."""


HEAD, STATE = record_of(Head), record_of(SessionState, made=True)
"""What is in a body: first the one, then the other."""


@lru_cache(maxsize=1)
def schema() -> dict[str, Any]:
    """Of a body, as plain data."""
    return described(HEAD, STATE)


@lru_cache(maxsize=1)
def _schema_check() -> int:
    return check_of(schema())


def pack(state: SessionState) -> bytes:
    """The state as bytes. TypeError when a part of the app's own has a field of a kind that cannot be saved,
    SnapshotError when it holds a value that cannot."""
    wearer = state.wearer
    known = wearer.settings
    check_names(known.recipe)
    head = Head(known.recipe.name, known.calibration, known.poses, known.pressures, known.plan)
    lists: Lists = ([], [], [], [])
    try:
        write(HEAD, head, lists)
        write(STATE, state, lists)
        body = to_bytes(*lists, _units(wearer))
    except (ValueError, KeyError, OverflowError) as error:
        raise SnapshotError(f"a packed session cannot hold this: {error}") from error
    start = HEADER.pack(MAGIC, FORM, VERSION, _schema_check(), 0)
    return HEADER.pack(MAGIC, FORM, VERSION, _schema_check(), crc32(body, crc32(start))) + body


def _units(wearer: WearerParts) -> Units:
    """What a count weighs: its cells' loads are multiples of that."""
    feet = [wearer.feet.get(foot) for foot in Foot]
    layouts = [None if foot is None else foot.sole.insole.layout for foot in feet]
    left, right = [0.0 if layout is None or layout.scale is None else layout.scale for layout in layouts]
    return left, right


def unpack(data: Any, recipe: Recipe, parts: Iterable[type] = ()) -> SessionState:
    """The state that was packed, of a session of this recipe. SnapshotError for anything else; TypeError and ValueError
    for a recipe or parts that are none, or two of one name."""
    held = own(recipe)
    classes = by_name(parts)
    body = _opened(data)
    try:
        return _filled(Streams(*from_bytes(body)), held, classes)
    except (SnapshotError, MemoryError, RecursionError):  # where room is short the state may be as good as ever
        raise
    except Exception as error:
        raise SnapshotError(f"not a packed session: {error or type(error).__name__}") from error


def _opened(data: Any) -> memoryview:
    """The body."""
    if not isinstance(data, bytes | bytearray | memoryview):
        raise SnapshotError("not a packed session")
    told = bytes(data)
    if len(told) < HEADER.size or not told.startswith(MAGIC):
        raise SnapshotError("not a packed session")
    _, form, version, made_with, found = HEADER.unpack_from(told)
    if (form, version) != (FORM, VERSION):
        raise SnapshotError(f"packed as version {version}, form {form}; this release reads {VERSION}, {FORM} alone")
    start = HEADER.pack(MAGIC, form, version, made_with, 0)
    body = memoryview(told)[HEADER.size :]
    if crc32(body, crc32(start)) != found:
        raise SnapshotError("the packed session was damaged: its checksum is another")
    if made_with != _schema_check():
        raise SnapshotError(f"packed by another release of version {version}: its schema is another")
    return body


_kept: tuple[tuple[Recipe, Head, SessionState], ...] = ()


def _filled(streams: Streams, recipe: Recipe, classes: Classes) -> SessionState:
    """The state that the streams hold, of a session of this recipe, which is one that nobody changes (recipes.own).
    SnapshotError where it was another's."""
    head: Head = read(HEAD, streams, classes)
    if head.recipe != recipe.name:
        raise SnapshotError(f"packed with the recipe {head.recipe!r}, and this is {recipe.name!r}")
    state: SessionState = read(STATE, streams, classes, _begun(recipe, head))
    streams.end()
    for foot in state.wearer.feet.values():
        layout = foot.sole.insole.layout
        if layout is not None:
            foot.sole.insole.layout = shared(layout)
    return state


def _begun(recipe: Recipe, head: Head) -> SessionState:
    """A session of the recipe to which nothing has happened: what is unpacked has its settings, which never change.
    Making one takes longer than all the rest, so the newest are kept; nobody else holds them."""
    global _kept
    for known, begun_with, state in _kept:
        if known is recipe and repr(begun_with) == repr(head):
            return state
    wearer = WearerParts(WearerSettings(recipe, head.calibration, head.poses, head.pressures, head.plan))
    state = SessionState(wearer)
    state.wearer.feet = {foot: state.wearer._tracker(foot) for foot in Foot}
    _kept = ((recipe, head, state), *_kept[: KEPT - 1])
    return state
