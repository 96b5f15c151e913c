"""Saving and restoring as JSON: a record becomes an object of its fields (schema.py defines the types of fields).

Tuples, lists and deques become lists; a deque with a maxlen becomes {"maxlen": n, "is": list}, an open record {"kind":
name of the class, "is": fields}, an enum member its value, bytes a base64 string, and a dict whose keys are neither
strings nor enum members a list of pairs. Loaded values are checked against the annotations."""

from __future__ import annotations

import json
import re
from binascii import crc32
from typing import TypeVar

from .limits import Classes, Json, SnapshotError, check_size
from .schema import record_of

__all__ = ["Classes", "Json", "SnapshotError", "checksum", "load", "no_class", "save"]

T = TypeVar("T")


def no_class(name: str) -> None:
    """Return None for every name; as `classes` of `load`, this forbids open records of unknown classes."""


def save(record: object) -> Json:
    """Return a copy of `record` that can be written as JSON, equal for equal records.

    Recipes are compared by it, and fingerprints of plans and checksums of snapshots are made of it.

    Raises TypeError for a field whose type cannot be saved and SnapshotError for a value that cannot be saved; both
    name the class and the field."""
    return record_of(type(record)).save(record)


def load(cls: type[T], value: Json, classes: Classes = no_class) -> T:
    """Return the record of class `cls` that `save` turned into `value`.

    `classes` looks up the classes of open records. Raises SnapshotError when the value does not fit, and
    TypeError when `cls` is not a record. limits.py bounds the size of a value."""
    record = record_of(cls)
    try:
        check_size(value)
        loaded: T = record.load(value, classes)
    except SnapshotError:
        raise
    except (TypeError, ValueError, KeyError, IndexError, AttributeError, OverflowError, RecursionError) as error:
        raise SnapshotError(f"not a snapshot of {cls.__name__}: {error}") from error
    return loaded


def checksum(value: Json) -> int:
    """Return the CRC-32 of a saved value, independent of the order of its keys.

    -0.0 counts as 0.0, because some JSON encoders lose its sign."""
    text = json.dumps(value, sort_keys=True, separators=(",", ":"))
    return crc32(_MINUS_ZERO.sub("0.0", text).encode())


_MINUS_ZERO = re.compile(r"-0\.0(?=[],}])")
