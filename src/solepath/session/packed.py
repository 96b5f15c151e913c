"""Packing of a session's state into bytes, and unpacking.

    magic  form  version  schema  check  body        protocol/snapshot.md

`form` is the version of the number format and `version` that of the state. `schema` is the CRC-32 of the body's schema.
`check` is the CRC-32 of all other bytes. The bytes do not hold the recipe: unpacking starts a session of the given
recipe and restores its state."""

from __future__ import annotations

from binascii import crc32
from collections.abc import Iterable
from functools import lru_cache
from struct import Struct
from typing import Any

from ..calibration import Calibration
from ..recipes import Recipe, own
from ..saving.codec import Classes, SnapshotError
from ..saving.limits import MAX_SIZE, shorten
from ..saving.packed import Lists, Streams, read, write
from ..saving.schema import describe, record_of, schema_checksum
from ..saving.streams import from_bytes, to_bytes
from ..types import Foot, shared
from ..types.attrs import define
from .snapshot import check_names, make_class_lookup
from .state import VERSION, SessionSettings, SessionState

MAGIC = b"sole"
FORM = 3
HEADER = Struct("<4sHHII")

MAX_TEMPLATES = 16
"""Largest number of new sessions that are kept as templates for unpacking."""


@define
class Head:
    """The arguments of a session."""

    recipe: str
    """Name of the recipe."""
    calibration: Calibration
    poses: bool
    pressures: bool
    plan: int | None
    """Fingerprint of the floor plan; None without one."""


HEAD, STATE = record_of(Head), record_of(SessionState, made=True)
"""Schemas of a body: first the head, then the state."""


@lru_cache(maxsize=1)
def schema() -> dict[str, Any]:
    """Return the schema of a body as plain data."""
    return describe(HEAD, STATE)


@lru_cache(maxsize=1)
def _schema_check() -> int:
    return schema_checksum(schema())


def pack(state: SessionState) -> bytes:
    """Return the state as bytes.

    Raises TypeError when an app's part has a field of a type that cannot be saved, and SnapshotError when the field's
    value cannot be saved."""
    settings = state.settings
    check_names(settings.recipe)
    head = Head(settings.recipe.name, settings.calibration, settings.poses, settings.pressures, settings.plan)
    lists: Lists = ([], [], [], [])
    try:
        write(HEAD, head, lists)
        write(STATE, state, lists)
        body = to_bytes(*lists)
    except (ValueError, KeyError, OverflowError) as error:
        raise SnapshotError(f"a packed session cannot hold this: {error}") from error
    if HEADER.size + len(body) > MAX_SIZE:
        raise SnapshotError(f"a packed session cannot have more than {MAX_SIZE} bytes")
    start = HEADER.pack(MAGIC, FORM, VERSION, _schema_check(), 0)
    return HEADER.pack(MAGIC, FORM, VERSION, _schema_check(), crc32(body, crc32(start))) + body


def unpack(data: Any, recipe: Recipe, parts: Iterable[type] = ()) -> SessionState:
    """Return the packed state of a session of this recipe.

    Raises SnapshotError for other data. Raises TypeError and ValueError for an invalid recipe, invalid parts, or two
    parts of one name."""
    own_recipe = own(recipe)
    classes = make_class_lookup(parts)
    body = _check_header(data)
    try:
        return _read_state(Streams(*from_bytes(body)), own_recipe, classes)
    except (SnapshotError, MemoryError, RecursionError):  # when memory runs out, the bytes may still be sound
        raise
    except StopIteration:
        raise SnapshotError("not a packed session: it was cut short") from None
    except Exception as error:
        raise SnapshotError(f"not a packed session: {error}") from error


def _check_header(data: Any) -> memoryview:
    """Return the body after checking the header."""
    if not isinstance(data, bytes | bytearray | memoryview):
        raise SnapshotError("not a packed session")
    if memoryview(data).nbytes > MAX_SIZE:
        raise SnapshotError(f"not a packed session: it has more than {MAX_SIZE} bytes")
    packed = bytes(data)
    if len(packed) < HEADER.size or not packed.startswith(MAGIC):
        raise SnapshotError("not a packed session")
    _, form, version, packed_schema, packed_checksum = HEADER.unpack_from(packed)
    if (form, version) != (FORM, VERSION):
        raise SnapshotError(f"packed as version {version}, form {form}; this release reads {VERSION}, {FORM} alone")
    start = HEADER.pack(MAGIC, form, version, packed_schema, 0)
    body = memoryview(packed)[HEADER.size :]
    if crc32(body, crc32(start)) != packed_checksum:
        raise SnapshotError("the packed session was damaged: its checksum is another")
    if packed_schema != _schema_check():
        raise SnapshotError(f"packed by another release of version {version}: its schema is another")
    return body


_templates: tuple[tuple[Recipe, Head, SessionState], ...] = ()


def _read_state(streams: Streams, recipe: Recipe, classes: Classes) -> SessionState:
    """Return the state that the streams hold; `recipe` is a copy that nobody changes (recipes.own).

    Raises SnapshotError when the state was packed with another recipe."""
    head: Head = read(HEAD, streams, classes)
    if head.recipe != recipe.name:
        raise SnapshotError(f"packed with the recipe {shorten(head.recipe)}, and this is {recipe.name!r}")
    state: SessionState = read(STATE, streams, classes, _make_initial_state(recipe, head))
    streams.end()
    for foot in state.feet.values():
        layout = foot.sole.insole.layout
        if layout is not None:
            foot.sole.insole.layout = shared(layout)
    return state


def _make_initial_state(recipe: Recipe, head: Head) -> SessionState:
    """Return the state of a new session; the unpacked state shares its settings, which never change.

    Making it takes longer than the rest of unpacking, so the newest MAX_TEMPLATES are kept here and nowhere else."""
    global _templates
    for kept_recipe, kept_head, state in _templates:
        if kept_recipe is recipe and repr(kept_head) == repr(head):
            return state
    state = SessionState(SessionSettings(recipe, head.calibration, head.poses, head.pressures, head.plan))
    state.feet = {foot: state._tracker(foot) for foot in Foot}
    _templates = ((recipe, head, state), *_templates[: MAX_TEMPLATES - 1])
    return state
