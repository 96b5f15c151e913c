"""A session's state as bytes, and back.

    magic  form  version  shape  check  body        protocol/snapshot.md

`form` is how numbers are written, `version` that of the state, `shape` the CRC-32 of the shape that the body has,
`check` that of all the rest. The recipe is not in it, nor what it makes: unpacking begins a session of the recipe that
is given, and fills in what was remembered.
"""

from __future__ import annotations

from binascii import crc32
from collections.abc import Iterable
from struct import Struct
from typing import Any

from ..recipes import Recipe, own
from ..session.state import VERSION, SessionState
from ..session.wearer import WearerParts
from ..types import Foot
from .begun import filled
from .codec import SnapshotError
from .records import Head, Packed, check, own_classes, packed_writer
from .streams import Units, from_bytes, to_bytes
from .tree import Streams

MAGIC = b"sole"
FORM = 1
HEADER = Struct("<4sHHII")


def pack(state: SessionState) -> bytes:
    """The state as bytes. TypeError when a part of the app's own has a field of a kind that cannot be saved,
    SnapshotError when it holds a value that cannot."""
    wearer = state.wearer
    head = Head(wearer.recipe.name, wearer.calibration, wearer.poses, wearer.pressures)
    floats: list[float] = []
    ints: list[int] = []
    flags: list[bool] = []
    data: list[bytes] = []
    try:
        packed_writer()(Packed(head, state), floats, ints, flags, data)
        body = to_bytes(floats, ints, flags, data, _units(wearer))
    except (ValueError, KeyError, OverflowError) as error:
        raise SnapshotError(f"a packed session cannot hold this: {error}") from error
    start = HEADER.pack(MAGIC, FORM, VERSION, check(), 0)
    return HEADER.pack(MAGIC, FORM, VERSION, check(), crc32(body, crc32(start))) + body


def _units(wearer: WearerParts) -> Units:
    """What a count weighs: its cells' loads are multiples of that."""
    feet = [wearer.feet.get(foot) for foot in Foot]
    layouts = [None if foot is None else foot.insole.layout for foot in feet]
    left, right = [0.0 if layout is None or layout.scale is None else layout.scale for layout in layouts]
    return left, right


def unpack(data: Any, recipe: Recipe, parts: Iterable[type] = ()) -> SessionState:
    """The state that was packed, of a session of this recipe. SnapshotError for anything else; TypeError and ValueError
    for a recipe or parts that are none, or two of one name."""
    held = own(recipe)
    classes = own_classes(held, parts)
    body = _opened(data)
    try:
        return filled(Streams(*from_bytes(body)), held, classes)
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
    if made_with != check():
        raise SnapshotError(f"packed by another release of version {version}: its shape is another")
    return body
