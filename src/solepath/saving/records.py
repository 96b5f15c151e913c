"""What is packed of a session, and the code that does it: made once, when it is first asked for."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache

import attrs

from ..calibration import Calibration
from ..recipes import Recipe
from ..session.state import SessionState
from .codec import SnapshotError
from .reading import Own, Reader, readers
from .shape import Shape, shape_of
from .writing import Writer, writer


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
    """All that is packed."""

    head: Head
    state: SessionState


_ODD = {
    ("SessionState", "wearer"): "made",
    ("WearerParts", "recipe"): "given",
    ("WearerParts", "calibration"): "given",
    ("WearerParts", "poses"): "given",
    ("WearerParts", "pressures"): "given",
    ("WearerParts", "feet"): "made",
}
"""What the rules of shape.py do not say: what a wearer is begun with is in the head, and feet are begun by their
wearer."""


@lru_cache(maxsize=1)
def shape() -> Shape:
    """Of what is packed by this release."""
    return shape_of(Packed, _ODD)


def snapshot_shape() -> Shape:
    """Of a snapshot for JSON: everything, settings as well."""
    return shape_of(SessionState)


@lru_cache(maxsize=1)
def check() -> int:
    """CRC-32 of the shape."""
    return shape().check


@lru_cache(maxsize=1)
def packed_writer() -> Writer:
    """Writes a `Packed`."""
    return writer(shape(), _own_writer)


@lru_cache(maxsize=1)
def packed_readers() -> tuple[Reader, Reader]:
    """Read the head, and then the state."""
    made = readers(shape(), _own_reader)
    return made[Head.__name__], made[SessionState.__name__]


# --- records of an app's own ------------------------------------------------------------------------------------------


def own_classes(recipe: Recipe | None, parts: Iterable[type]) -> Own:
    """Those that a state may hold, by their names. TypeError and ValueError as `machine.load`."""
    ours = shape().classes.values()
    detector = () if recipe is None or type(recipe.detector) in ours else (type(recipe.detector),)
    own = {cls: cls.__name__ for cls in (*detector, *parts) if isinstance(cls, type)}
    if not all([attrs.has(cls) for cls in own]) or not all([isinstance(cls, type) for cls in parts]):
        raise TypeError("a part is an attrs class")
    if len(set(own.values())) != len(own):
        raise ValueError("two parts have one name")
    return {name: cls for cls, name in own.items()}


def own_shape(name: str, own: Own) -> tuple[str, Shape]:
    """What is told of a class, by which it is known again: its name and how it looks; and how it looks. `name`: the
    class's, or what was told of it."""
    known = own.get(name.partition(" ")[0])
    if known is None:
        raise SnapshotError(f"packed with a part {name.partition(' ')[0]!r} that is not known here")
    told, found = _shape_of_own(known)
    if name not in (known.__name__, told):
        raise SnapshotError(f"packed with a part {known.__name__!r} that had other fields")
    return told, found


@lru_cache(maxsize=64)
def _shape_of_own(cls: type) -> tuple[str, Shape]:
    found = shape_of(cls)
    return f"{cls.__name__} {found.check:08x}", found


@lru_cache(maxsize=64)
def _own_writer(cls: type) -> tuple[str, Writer]:
    if not attrs.has(cls):
        raise TypeError(f"{cls.__name__} is no attrs class")
    if any([cls.__name__ == one.__name__ for one in shape().classes.values()]):
        raise TypeError(f"it could not tell this {cls.__name__} from solepath's own: give it another name")
    told, found = _shape_of_own(cls)
    return told, writer(found, _own_writer)


def _own_reader(told: str, own: Own) -> Reader:
    own_shape(told, own)
    return _reader_of_own(own[told.partition(" ")[0]])


@lru_cache(maxsize=64)
def _reader_of_own(cls: type) -> Reader:
    found = _shape_of_own(cls)[1]
    return readers(found, _own_reader)[found.root]
