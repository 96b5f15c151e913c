"""Packing of a session's state into bytes, and unpacking.

    magic  form  version  schema  check  body        protocol/snapshot.md

`form` is the version of the number format and `version` that of the state. `schema` is the CRC-32 of the body's schema.
`check` is the CRC-32 of all other bytes. The bytes do not hold the recipe: unpacking starts a session of the given
recipe and restores its state."""

from __future__ import annotations

from binascii import crc32
from collections.abc import Iterable
from functools import cache
from struct import Struct, error
from typing import Any

from ..calibration import Calibration
from ..recipes import Recipe, shared_copy
from ..saving.codec import SnapshotError
from ..saving.nodes import schema_check
from ..saving.schema import record_of
from ..saving.streams import Lists, Streams, from_bytes, to_bytes
from ..types import Foot, shared
from ..types.attrs import define
from ..types.checking import describe
from .snapshot import check_names, make_class_lookup
from .state import VERSION, SessionSettings, SessionState

MAGIC = b"sole"
FORM = 4
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
    losses: bool
    impacts: bool
    plan: int | None
    """Fingerprint of the floor plan; None without one."""


HEAD, STATE = record_of(Head), record_of(SessionState, made=True)
"""Schemas of a body: first the head, then the state."""


@cache
def _schema() -> int:
    return schema_check(HEAD, STATE)


def pack(state: SessionState) -> bytes:
    """Return the state as bytes.

    Raises TypeError when an app's part has a field of a type that cannot be saved, and SnapshotError when the field's
    value cannot be saved."""
    settings = state.settings
    check_names(settings.recipe)
    flags = settings.poses, settings.pressures, settings.losses, settings.impacts
    head = Head(settings.recipe.name, settings.calibration, *flags, settings.plan)
    lists = Lists([], [], [], [])
    try:
        HEAD.write(head, lists)
        STATE.write(state, lists)
        body = to_bytes(lists)
    except (ValueError, OverflowError, error) as fault:
        raise SnapshotError(f"a packed session cannot hold this: {fault}") from fault
    return _signed(HEADER.pack(MAGIC, FORM, VERSION, _schema(), 0) + body)


def _signed(data: bytes) -> bytes:
    """Return the bytes with the right checksum in their header."""
    start, body = data[:12], data[HEADER.size :]
    return start + crc32(start + bytes(4) + body).to_bytes(4, "little") + body


def unpack(data: Any, recipe: Recipe, parts: Iterable[type] = ()) -> SessionState:
    """Return the packed state of a session of this recipe.

    Raises SnapshotError for other data. Raises TypeError and ValueError for an invalid recipe, invalid parts, or two
    parts of one name."""
    own_recipe = shared_copy(recipe)
    classes = make_class_lookup(parts)
    body = _check_header(data)
    try:
        return _read_state(from_bytes(body, classes), own_recipe)
    except (SnapshotError, MemoryError, RecursionError):  # when memory runs out, the bytes may still be sound
        raise
    except Exception as fault:
        raise SnapshotError(f"not a packed session: {str(fault) or 'it was cut short'}") from fault


def _check_header(data: Any) -> memoryview:
    """Return the body after checking the header."""
    packed = bytes(data) if isinstance(data, bytes | bytearray | memoryview) else b""
    if len(packed) < HEADER.size or not packed.startswith(MAGIC):
        raise SnapshotError("not a packed session")
    _, form, version, packed_schema, _ = HEADER.unpack_from(packed)
    if (form, version) != (FORM, VERSION):
        raise SnapshotError(f"packed as version {version}, form {form}; this release reads {VERSION}, {FORM} alone")
    if packed != _signed(packed):
        raise SnapshotError("the packed session was damaged: its checksum is another")
    if packed_schema != _schema():
        raise SnapshotError(f"packed by another release of version {version}: its schema is another")
    return memoryview(packed)[HEADER.size :]


_templates: dict[tuple[int, str], SessionState] = {}


def _read_state(streams: Streams, recipe: Recipe) -> SessionState:
    """Return the state that the streams hold; `recipe` is a copy that nobody changes (recipes.shared_copy).

    Raises SnapshotError when the state was packed with another recipe."""
    head: Head = HEAD.read(None, streams)
    if head.recipe != recipe.name:
        raise SnapshotError(f"packed with the recipe {describe(head.recipe)}, and this is {recipe.name!r}")
    state: SessionState = STATE.read(_make_initial_state(recipe, head), streams)
    streams.end()
    for foot in state.feet.values():
        if foot.sole is not None and foot.sole.insole.layout is not None:
            foot.sole.insole.layout = shared(foot.sole.insole.layout)
    return state


def _make_initial_state(recipe: Recipe, head: Head) -> SessionState:
    """Return the state of a new session; the unpacked state shares its settings, which never change.

    Making it takes longer than the rest of unpacking, so the newest MAX_TEMPLATES are kept here and nowhere else."""
    global _templates
    key = id(recipe), repr(head)  # a template has its recipe, so that no other one gets its id
    state = _templates.get(key)
    if state is None:
        flags = head.poses, head.pressures, head.losses, head.impacts
        state = SessionState(SessionSettings(recipe, head.calibration, *flags, head.plan))
        state.feet = {foot: state._tracker(foot) for foot in Foot}
        for tracker in state.feet.values():
            tracker.make_sole()
        _templates = dict([*_templates.items(), (key, state)][-MAX_TEMPLATES:])
    return state
