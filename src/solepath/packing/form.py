"""A session's state as bytes, and back.

    magic  version  spare  shape  check  body        protocol/snapshot.md

`shape` is the CRC-32 of the shape that the body has, `check` that of all the rest. The recipe is not in it, nor what it
makes: unpacking begins a session of the recipe that is given, and fills in what was remembered.
"""

from __future__ import annotations

from binascii import crc32
from collections.abc import Iterable
from copy import deepcopy
from functools import lru_cache
from struct import Struct
from typing import Any

import attrs

from ..calibration import Calibration
from ..machine import SnapshotError
from ..recipes import Recipe
from ..state import State
from ..types import Foot
from ..wearer import Wearer
from .reading import Own, Reader, readers
from .shape import Shape, name_of, shape_of
from .streams import Units, from_bytes, to_bytes
from .writing import Writer, writers

MAGIC = b"sole"
HEADER = Struct("<4sHHII")
VERSION = 1
"""Of the state. It is one more where the shape is another."""
KEPT = 16
"""So many begun sessions are kept, to be filled in."""


@attrs.define
class Head:
    """What a session is begun with, beside its recipe."""

    recipe: str
    """Its name."""
    calibration: Calibration
    poses: bool
    pressures: bool


@attrs.define
class Packed:
    """All that is written."""

    head: Head
    state: State


_ODD = {
    ("State", "wearer"): "made",
    ("Wearer", "recipe"): "given",
    ("Wearer", "calibration"): "given",
    ("Wearer", "poses"): "given",
    ("Wearer", "pressures"): "given",
    ("Wearer", "feet"): "made",
    ("LowerLimbs", "facing"): "whole",
}
"""What the rules of shape.py do not say: feet are begun by their wearer, and which way somebody faces is a setting that
is found out where it was not set."""


@lru_cache(maxsize=1)
def shape() -> Shape:
    """Of a state of this release."""
    return shape_of(Packed, _ODD)


@lru_cache(maxsize=1)
def _check() -> int:
    return shape().check


@lru_cache(maxsize=1)
def _writer() -> Writer:
    return writers(shape(), _own_writer)[name_of(Packed)]


@lru_cache(maxsize=1)
def _readers() -> tuple[Reader, Reader]:
    made = readers(shape(), _own_reader)
    return made[name_of(Head)], made[name_of(State)]


def pack(state: State) -> bytes:
    """The state as bytes. TypeError when a part of the app's own has a field of a kind that cannot be saved,
    SnapshotError when it holds a value that cannot."""
    wearer = state.wearer
    head = Head(wearer.recipe.name, wearer.calibration, wearer.poses, wearer.pressures)
    floats: list[float] = []
    ints: list[int] = []
    flags: list[bool] = []
    data: list[bytes] = []
    try:
        _writer()(Packed(head, state), floats, ints, flags, data)
        body = to_bytes(floats, ints, flags, data, _units(wearer))
    except (ValueError, KeyError, OverflowError) as error:
        raise SnapshotError(f"a packed session cannot hold this: {error}") from error
    start = HEADER.pack(MAGIC, VERSION, 0, _check(), 0)
    return HEADER.pack(MAGIC, VERSION, 0, _check(), crc32(body, crc32(start))) + body


def _units(wearer: Wearer) -> Units:
    """What a count weighs: its cells' loads are multiples of that."""
    feet = [wearer.feet.get(foot) for foot in Foot]
    layouts = [None if foot is None else foot.insole.layout for foot in feet]
    left, right = [0.0 if layout is None or layout.scale is None else layout.scale for layout in layouts]
    return left, right


def unpack(data: Any, recipe: Recipe, parts: Iterable[type] = ()) -> State:
    """The state that was packed, of a session of this recipe. SnapshotError for anything else."""
    body = memoryview(_body(data))
    own = {cls.__name__: cls for cls in (type(recipe.detector), *parts)}
    try:
        floats, ints, flags, told = from_bytes(body)
        f, n, m, b = iter(floats), iter(ints), iter(flags), _Bytes(told)
        streams = f.__next__, n.__next__, m.__next__, b, f, own
        read_head, read_state = _readers()
        head: Head = read_head(None, *streams)
        if head.recipe != recipe.name:
            raise SnapshotError(f"packed with the recipe {head.recipe!r}, and this is {recipe.name!r}")
        state: State = read_state(_begun(recipe, head), *streams)
        if [*f, *n, *m] or b.at != len(told):
            raise SnapshotError("more is packed than a session holds")
    except SnapshotError:
        raise
    except Exception as error:
        raise SnapshotError(f"not a packed session: {error or type(error).__name__}") from error
    return state


def _body(data: Any) -> bytes:
    if not isinstance(data, bytes | bytearray | memoryview):
        raise SnapshotError("not a packed session")
    data = bytes(data)
    if len(data) < HEADER.size or not data.startswith(MAGIC):
        raise SnapshotError("not a packed session")
    _, version, spare, made_with, check = HEADER.unpack_from(data)
    if version != VERSION:
        raise SnapshotError(f"packed by version {version}; this release reads {VERSION}")
    body: bytes = data[HEADER.size :]
    if crc32(body, crc32(HEADER.pack(MAGIC, version, spare, made_with, 0))) != check:
        raise SnapshotError("the packed session was damaged: its checksum is another")
    if made_with != _check():
        raise SnapshotError("packed by another release of the same version: its shape is another")
    return body


class _Bytes:
    """Gives so many bytes at a time."""

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0

    def __call__(self, count: int) -> bytes:
        taken = self.data[self.at : self.at + count] if count >= 0 else b""
        if len(taken) != count:
            raise SnapshotError("it was cut short")
        self.at += count
        return taken


# --- records of an app's own ------------------------------------------------------------------------------------------


@lru_cache(maxsize=64)
def _own_shape(cls: type) -> tuple[str, Shape]:
    """What is told of a class, by which it is known again: its name and how it looks."""
    found = shape_of(cls)
    return f"{cls.__name__} {found.check:08x}", found


@lru_cache(maxsize=64)
def _own_writer(cls: type) -> tuple[str, Writer]:
    if not attrs.has(cls):
        raise TypeError(f"{cls.__name__} is no attrs class")
    if any([cls.__name__ == one.__name__ for one in shape().classes.values()]):
        raise TypeError(f"it could not tell this {cls.__name__} from solepath's own: give it another name")
    told, found = _own_shape(cls)
    return told, writers(found, _own_writer)[found.root]


def _own_reader(told: str, own: Own) -> Reader:
    name = told.partition(" ")[0]
    if name not in own:
        raise SnapshotError(f"packed with a part {name!r} that is not known here")
    if _own_shape(own[name])[0] != told:
        raise SnapshotError(f"packed with a part {name!r} that had other fields")
    return _reader_of(own[name])


@lru_cache(maxsize=64)
def _reader_of(cls: type) -> Reader:
    found = _own_shape(cls)[1]
    return readers(found, _own_reader)[found.root]


# --- sessions that were just begun ------------------------------------------------------------------------------------

_Kept = tuple[Recipe, Head, State]
_kept: tuple[_Kept, ...] = ()


def _begun(recipe: Recipe, head: Head) -> State:
    """A session of the recipe to which nothing has happened: what is unpacked has its settings, which never change.
    Making one takes longer than all the rest, so the newest are kept; nobody else holds them."""
    global _kept
    for known, begun_with, state in _kept:
        if begun_with == head and known == recipe:
            return state
    state = State(Wearer(deepcopy(recipe), head.calibration, head.poses, head.pressures))
    state.wearer.feet = {foot: state.wearer._tracker(foot) for foot in Foot}
    _kept = ((state.wearer.recipe, head, state), *_kept[: KEPT - 1])
    return state
