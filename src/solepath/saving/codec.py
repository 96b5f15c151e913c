"""Saving and restoring as JSON: a record becomes an object of its fields (schema.py defines the types of fields).

Tuples, lists and deques become lists; a deque with a maxlen becomes {"maxlen": n, "is": list}, an open record {"kind":
name of the class, "is": fields}, an enum member its value, bytes a base64 string, and a dict whose keys are neither
strings nor enum members a list of pairs. Loaded values are checked against the annotations. A saver turns a value into
JSON, a loader turns JSON into a value; a codec is the pair of both."""

from __future__ import annotations

import json
import re
from base64 import b64decode, b64encode
from binascii import crc32
from collections import deque
from collections.abc import Callable
from enum import Enum
from functools import partial
from math import isfinite
from typing import Any, TypeVar

from .limits import check_rows, check_size, shorten
from .nodes import DictNode, EnumNode, MaybeNode, Node, OpenNode, RecordNode, ScalarNode, SequenceNode, TupleNode
from .schema import is_record, locate_error, record_of

T = TypeVar("T")

Json = None | bool | int | float | str | list["Json"] | dict[str, "Json"]
Classes = Callable[[str], type | None]
"""Function, such as a dict's `get`, that returns the class of an open record by its name, or None."""
_Saver = Callable[[Any], Json]
_Loader = Callable[[Any, Classes], Any]


class SnapshotError(ValueError):
    """Error for a value that is no snapshot, has another version, or does not fit this release's records."""


def no_class(name: str) -> None:
    """Return None for every name; as `classes` of `load`, this forbids open records of unknown classes."""


def save(record: object) -> Json:
    """Return a copy of `record` that can be written as JSON.

    Raises TypeError for a field whose type cannot be saved and SnapshotError for a value that cannot be saved; both
    name the class and the field."""
    return _codec(record_of(type(record)))[0](record)


def load(cls: type[T], value: Json, classes: Classes = no_class) -> T:
    """Return the record of class `cls` that `save` turned into `value`.

    `classes` looks up the classes of open records. Raises SnapshotError when the value does not fit, and
    TypeError when `cls` is not a record. limits.py bounds the size of a value."""
    loader = _codec(record_of(cls))[1]
    try:
        check_size(value)
        loaded: T = loader(value, classes)
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

_CODECS: dict[RecordNode, tuple[_Saver, _Loader]] = {}


def _codec(node: Node) -> tuple[_Saver, _Loader]:
    match node:
        case ScalarNode(kind, row_size):
            return _scalar_codec(kind, row_size)
        case EnumNode(cls):
            return (lambda word: word.value), partial(_load_enum, cls)
        case MaybeNode(of):
            return _maybe_codec(*_codec(of))
        case TupleNode(items, make) if make is tuple and {*map(_is_float, items)} == {True}:
            return partial(_save_floats, len(items)), partial(_load_floats, tuple, len(items))
        case TupleNode(items, make):
            return _tuple_codec(make, [_codec(item) for item in items])
        case SequenceNode(kind, of) if kind is not deque and _is_float(of):
            return partial(_save_floats, None), partial(_load_floats, kind, None)
        case SequenceNode(kind, of):
            return _deque_codec(*_codec(of)) if kind is deque else _sequence_codec(kind, *_codec(of))
        case DictNode(key, of, kind):
            codecs = (*_codec(key), *_codec(of))
            return _dict_codec(kind, *codecs) if node.has_text_keys else _pairs_codec(kind, *codecs)
        case OpenNode():
            return _open_codec(node)
        case RecordNode():
            if node not in _CODECS:
                _CODECS[node] = _record_codec(node)
            return _CODECS[node]


def _scalar_codec(kind: type, size: int) -> tuple[_Saver, _Loader]:
    if kind is float:
        return _save_float, _load_float
    if kind is bytes:
        return (lambda of: b64encode(of).decode()), (lambda text, _: check_rows(b64decode(text, validate=True), size))

    def check(value: Any, _: object = None) -> Any:
        if type(value) is not kind:
            raise SnapshotError(f"expected {kind.__name__}, found {shorten(value)}")
        return value

    return check, check


def _load_enum(cls: type[Enum], value: Any, _: object) -> Enum:
    try:
        return cls(value)
    except (TypeError, ValueError):
        raise SnapshotError(f"{shorten(value)} is no {cls.__name__}") from None


def _save_float(value: Any) -> Json:
    number = float(value)
    if not isfinite(number):
        raise SnapshotError(f"{number}")
    return number


def _load_float(value: Any, _: object) -> float:
    if type(value) is not float and type(value) is not int:
        raise SnapshotError(f"expected a number, found {shorten(value)}")
    return float(value)


def _is_float(node: Node) -> bool:
    return isinstance(node, ScalarNode) and node.kind is float


def _save_floats(count: int | None, values: Any) -> Json:
    """Save many floats at once, in a third of the time of single calls; `count` is the required number or None."""
    numbers: list[Json] = [*map(float, values)]
    if count is not None and len(numbers) != count:
        raise SnapshotError(f"{len(numbers)} items of {count}")
    if not all(map(isfinite, values)):
        raise SnapshotError(f"{[value for value in values if not isfinite(value)][0]}")
    return numbers


def _load_floats(kind: type, count: int | None, values: Any, _: object) -> Any:
    if count is not None and len(_check_list(values)) != count:
        raise SnapshotError(f"expected {count} items, found {len(values)}")
    if {*map(type, _check_list(values))} - {float, int}:
        found = next(value for value in values if type(value) not in (float, int))
        raise SnapshotError(f"expected numbers, found {shorten(found)}")
    return kind(map(float, values))


def _check_list(value: Any) -> list[Any]:
    if not isinstance(value, list):
        raise SnapshotError(f"expected a list, found {type(value).__name__}")
    return value


def _maybe_codec(save_item: _Saver, load_item: _Loader) -> tuple[_Saver, _Loader]:
    return (
        lambda value: None if value is None else save_item(value),
        lambda value, classes: None if value is None else load_item(value, classes),
    )


def _tuple_codec(make: Any, codecs: list[tuple[_Saver, _Loader]]) -> tuple[_Saver, _Loader]:
    savers, loaders = [save_item for save_item, _ in codecs], [load_item for _, load_item in codecs]

    def load_tuple(value: Any, classes: Classes) -> Any:
        if len(_check_list(value)) != len(loaders):
            raise SnapshotError(f"expected {len(loaders)} items, found {len(value)}")
        return make([load_item(item, classes) for load_item, item in zip(loaders, value, strict=True)])

    return (lambda value: [save_item(item) for save_item, item in zip(savers, value, strict=True)]), load_tuple


def _sequence_codec(kind: type, save_item: _Saver, load_item: _Loader) -> tuple[_Saver, _Loader]:
    return (
        lambda value: [save_item(item) for item in value],
        lambda value, classes: kind([load_item(item, classes) for item in _check_list(value)]),
    )


def _deque_codec(save_item: _Saver, load_item: _Loader) -> tuple[_Saver, _Loader]:
    """Return a codec that saves a list; for a deque with a maxlen, which annotations cannot declare, a dict."""

    def save_deque(value: Any) -> Json:
        items: list[Json] = [save_item(item) for item in value]
        max_length = getattr(value, "maxlen", None)
        return items if max_length is None else {"maxlen": max_length, "is": items}

    def load_deque(value: Any, classes: Classes) -> deque[Any]:
        max_length = None
        if isinstance(value, dict):
            max_length, items = value["maxlen"], _check_list(value["is"])
            if type(max_length) is not int or max_length < len(items) or value.keys() != {"maxlen", "is"}:
                raise SnapshotError("a deque does not have the length that it may have")
            value = items
        return deque([load_item(item, classes) for item in _check_list(value)], max_length)

    return save_deque, load_deque


def _dict_codec(
    kind: type, save_key: Any, load_key: _Loader, save_item: _Saver, load_item: _Loader
) -> tuple[_Saver, _Loader]:
    return (
        lambda value: {save_key(key): save_item(item) for key, item in value.items()},
        lambda value, classes: kind({load_key(key, classes): load_item(item, classes) for key, item in value.items()}),
    )


def _pairs_codec(
    kind: type, save_key: _Saver, load_key: _Loader, save_item: _Saver, load_item: _Loader
) -> tuple[_Saver, _Loader]:
    """Return a codec that saves a dict as a list of pairs, since the keys of an object of JSON are strings."""
    load_pairs = _sequence_codec(list, *_tuple_codec(tuple, [(save_key, load_key), (save_item, load_item)]))[1]
    return (
        lambda value: [[save_key(key), save_item(item)] for key, item in value.items()],
        lambda value, classes: kind(dict(load_pairs(value, classes))),
    )


def _record_codec(node: RecordNode) -> tuple[_Saver, _Loader]:
    cls = node.cls
    make: Any = cls.__new__  # object's own makes no compiled classes
    fields = [(name, *_codec(of)) for name, of in node.fields.items()]
    names = set(node.fields)

    def save_record(record: Any) -> Json:
        saved: dict[str, Json] = {}
        for name, save_field, _ in fields:
            try:
                saved[name] = save_field(getattr(record, name))
            except TypeError as error:
                raise TypeError(locate_error(error, cls, name)) from error
            except ValueError as error:
                raise SnapshotError(locate_error(error, cls, name)) from error
        return saved

    def load_record(value: Any, classes: Classes) -> Any:
        if not isinstance(value, dict):
            raise SnapshotError(f"expected {cls.__name__}, found {type(value).__name__}")
        if value.keys() != names:
            unknown = next((key for key in value if key not in names), None)
            lacks = "no field" if unknown is not None else "not the field"
            which = unknown if unknown is not None else min(names - value.keys())
            raise SnapshotError(f"{cls.__name__} has {lacks} {shorten(which)}")
        record: Any = make(cls)
        for name, _, load_field in fields:
            object.__setattr__(record, name, load_field(value[name], classes))
        for name, default in node.defaults.items():
            object.__setattr__(record, name, default)
        return record

    return save_record, load_record


def _open_codec(node: OpenNode) -> tuple[_Saver, _Loader]:
    def save_open(value: Any) -> Json:
        cls = type(value)
        check_open(node, cls)
        return {"kind": cls.__name__, "is": _codec(record_of(cls))[0](value)}

    def load_open(value: Any, classes: Classes) -> Any:
        return _codec(record_of(class_in(node, value["kind"], classes)))[1](value["is"], classes)

    return save_open, load_open


def check_open(node: OpenNode, cls: type) -> None:
    """Raise TypeError when a record of class `cls` may not be saved in this open node."""
    if node.known.get(cls.__name__) is cls:
        return
    if not node.others:
        raise TypeError(f"a {cls.__name__} where {' or '.join(node.known)} is known")
    if not is_record(cls):
        raise TypeError(f"{cls.__name__} is no attrs class")
    if cls.__name__ in node.known:
        raise TypeError(f"it could not tell this {cls.__name__} from solepath's own: give it another name")


def class_in(node: OpenNode, kind: Any, classes: Classes) -> type:
    """Return the class with the name `kind`; raise SnapshotError when it is unknown."""
    cls = node.known.get(kind)
    if cls is None and node.others and isinstance(kind, str):
        cls = classes(kind)
    if cls is None:
        raise SnapshotError(f"a snapshot of a part {shorten(kind)} that is not known here")
    return cls
