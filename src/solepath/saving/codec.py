"""Saving and restoring: every machine is a plain record, and a plain record is JSON.

A machine is an attrs class whose fields are floats, ints, strings, booleans, None, bytes, enums, tuples, lists, deques,
dicts with string or enum keys, and other such records. `save` turns it into a JSON-able value, `load` builds it again
from the type annotations, which say what is in it (deque[float], not deque); a deque with a maxlen carries it; a field
typed as a union of records carries the class name. A union with a Protocol in it is
open: it also takes records of an app's own, whose classes are to be named again to load them. Nothing else may be held
across two samples: no generators, closures, rebound methods or arrays.

    feed(...) -> list of what came out     advance(now) -> the same     finish() -> the same
"""

from __future__ import annotations

import json
import re
import types
import typing
from base64 import b64decode, b64encode
from binascii import crc32
from collections import deque
from collections.abc import Callable, Iterable
from enum import Enum
from math import isfinite
from typing import Any, TypeVar

import attrs

T = TypeVar("T")

Json = None | bool | int | float | str | list["Json"] | dict[str, "Json"]
_Saver = Callable[[Any], Json]
_Loader = Callable[[Any], Any]


class SnapshotError(ValueError):
    """A snapshot is not one of ours, is of another version, or does not fit the records of this release."""


def save(record: object) -> Json:
    """A JSON-able copy of `record`, an attrs instance. TypeError when a field is of a kind that cannot be saved,
    SnapshotError when it holds a value that cannot; both name its class and the field."""
    return _codec(type(record))[0](record)


def load(cls: type[T], value: Json, own: Iterable[type] = ()) -> T:
    """The record of class `cls` that `save` turned into `value`. `own`: classes that an open union may hold besides
    those that it names. SnapshotError when it does not fit; TypeError for what is no attrs class, ValueError for two of
    one name."""
    codec = _codec(cls, _distinct(own))
    try:
        loaded: T = codec[1](value)
    except SnapshotError:
        raise
    except (TypeError, ValueError, KeyError, IndexError, AttributeError, OverflowError, RecursionError) as error:
        raise SnapshotError(f"not a snapshot of {cls.__name__}: {error}") from error
    return loaded


def load_value(annotation: Any, value: Json) -> Any:
    """What a field of this type holds. ValueError, TypeError and the like when it does not fit."""
    return _codec(annotation)[1](value)


def checksum(value: Json) -> int:
    """CRC-32 of what `save` gave, whatever the order of its keys; minus zero counts as zero: some encoders lose it."""
    text = json.dumps(value, sort_keys=True, separators=(",", ":"))
    return crc32(_MINUS_ZERO.sub("0.0", text).encode())


_MINUS_ZERO = re.compile(r"-0\.0(?=[],}])")

_CANNOT = "a snapshot cannot hold "


def _placed(error: Exception, cls: type, name: str) -> Exception:
    """The same with the class and the field, once: those of the innermost record are what is to be mended."""
    if str(error).startswith(_CANNOT):
        return error
    kind = TypeError if isinstance(error, TypeError) else SnapshotError
    return kind(f"{_CANNOT}{cls.__name__}.{name}: {error}")


_Own = frozenset[type]
"""What open unions may hold besides what they name."""


def _distinct(own: Iterable[type]) -> _Own:
    classes = frozenset(own)
    for cls in classes:
        if not (isinstance(cls, type) and attrs.has(cls)):
            raise TypeError(f"a part is an attrs class, and {cls!r} is none")
    if len({cls.__name__ for cls in classes}) != len(classes):
        raise ValueError("two parts have one name")
    return classes


_CODECS: dict[tuple[Any, _Own], tuple[_Saver, _Loader]] = {}


def _codec(annotation: Any, own: _Own = frozenset()) -> tuple[_Saver, _Loader]:
    codec = _CODECS.get((annotation, own))
    if codec is None:
        codec = _CODECS[annotation, own] = _make_codec(annotation, own)
    return codec


def _make_codec(annotation: Any, own: _Own) -> tuple[_Saver, _Loader]:
    origin, arguments = typing.get_origin(annotation), typing.get_args(annotation)
    if annotation is float:
        return _save_float, _load_float
    if annotation in (int, str, bool):
        return _exactly(annotation), _exactly(annotation)
    if annotation is None or annotation is type(None):
        return _exactly(type(None)), _exactly(type(None))
    if annotation is bytes:
        return (lambda v: b64encode(v).decode()), (lambda text: b64decode(text, validate=True))
    if isinstance(annotation, type) and issubclass(annotation, Enum):
        return (lambda member: member.value), annotation
    if isinstance(annotation, type) and attrs.has(annotation):
        return _record_codec(annotation, own)
    if isinstance(annotation, type) and origin is None and annotation.__module__.startswith("solepath."):
        return _open_codec({}, own)
    if origin in (typing.Union, types.UnionType):
        return _union_codec(arguments, own)
    if origin is tuple and len(arguments) == 2 and arguments[1] is Ellipsis:
        save_item, load_item = _codec(arguments[0], own)
        return (lambda v: [save_item(i) for i in v]), (lambda v: tuple([load_item(i) for i in _list(v)]))
    if origin is tuple:
        return _fixed_tuple_codec(arguments, own)
    if origin is list:
        save_item, load_item = _codec(arguments[0], own)
        return (lambda v: [save_item(i) for i in v]), (lambda v: [load_item(i) for i in _list(v)])
    if origin is deque:
        return _deque_codec(arguments[0], own)
    if origin is dict:
        (save_key, load_key), (save_item, load_item) = _codec(arguments[0], own), _codec(arguments[1], own)
        return (
            lambda v: {typing.cast(str, save_key(k)): save_item(i) for k, i in v.items()},
            lambda v: {load_key(k): load_item(i) for k, i in v.items()},
        )
    if annotation in (tuple, list, deque, dict):
        what = "dict[str, float]" if annotation is dict else f"{annotation.__name__}[float]"
        raise TypeError(f"its type does not say what is in it; write {what}, or whatever it is")
    raise TypeError(f"{annotation!r} is no number, string, enum, bytes, tuple, list, deque, dict or attrs class")


def _list(value: Any) -> list[Any]:
    if not isinstance(value, list):
        raise SnapshotError(f"expected a list, found {type(value).__name__}")
    return value


def _exactly(kind: type) -> Callable[[Any], Any]:
    def check(value: Any) -> Any:
        if type(value) is not kind:
            raise SnapshotError(f"expected {kind.__name__}, found {value!r}")
        return value

    return check


def _save_float(value: Any) -> Json:
    number = float(value)
    if not isfinite(number):
        raise SnapshotError(f"{number}")
    return number


def _load_float(value: Any) -> float:
    if type(value) is not float and type(value) is not int:
        raise SnapshotError(f"expected a number, found {value!r}")
    return float(value)


def _deque_codec(item: Any, own: _Own) -> tuple[_Saver, _Loader]:
    """A list; where the deque has a maxlen, which the annotation does not tell, a dict with both."""
    save_item, load_item = _codec(item, own)

    def save_deque(value: Any) -> Json:
        items: list[Json] = [save_item(i) for i in value]
        most = getattr(value, "maxlen", None)
        return items if most is None else {"maxlen": most, "is": items}

    def load_deque(value: Any) -> deque[Any]:
        if not isinstance(value, dict):
            return deque([load_item(i) for i in _list(value)])
        most, items = value["maxlen"], _list(value["is"])
        if type(most) is not int or most < len(items) or value.keys() != {"maxlen", "is"}:
            raise SnapshotError(f"not a deque: {value!r:.80}")
        return deque([load_item(i) for i in items], most)

    return save_deque, load_deque


def _fixed_tuple_codec(arguments: tuple[Any, ...], own: _Own) -> tuple[_Saver, _Loader]:
    codecs = [_codec(a, own) for a in arguments]

    def load_tuple(value: Any) -> tuple[Any, ...]:
        if len(_list(value)) != len(codecs):
            raise SnapshotError(f"expected {len(codecs)} items, found {len(value)}")
        return tuple([load_item(i) for (_, load_item), i in zip(codecs, value, strict=True)])

    return (lambda value: [save_item(i) for (save_item, _), i in zip(codecs, value, strict=True)]), load_tuple


def _record_codec(cls: type, own: _Own) -> tuple[_Saver, _Loader]:
    hints = typing.get_type_hints(cls)
    fields: list[tuple[str, _Saver, _Loader]] = []
    for field in attrs.fields(cls):
        if not field.metadata.get("saved", True):
            continue
        try:
            fields.append((field.name, *_codec(hints[field.name], own)))
        except TypeError as error:
            raise _placed(error, cls, field.name) from error

    def save_record(record: Any) -> Json:
        saved: dict[str, Json] = {}
        for name, save_field, _ in fields:
            try:
                saved[name] = save_field(getattr(record, name))
            except (TypeError, ValueError) as error:
                raise _placed(error, cls, name) from error
        return saved

    def load_record(value: Any) -> Any:
        if not isinstance(value, dict):
            raise SnapshotError(f"expected {cls.__name__}, found {type(value).__name__}")
        unknown = value.keys() - {name for name, *_ in fields}
        missing = {name for name, *_ in fields} - value.keys()
        if unknown or missing:
            raise SnapshotError(f"{cls.__name__} does not have the fields {sorted(unknown | missing)}")
        record: Any = object.__new__(cls)
        for name, _, load_field in fields:
            object.__setattr__(record, name, load_field(value[name]))
        for field in attrs.fields(cls):
            if not field.metadata.get("saved", True):
                object.__setattr__(record, field.name, None)
        return record

    return save_record, load_record


def _union_codec(arguments: tuple[Any, ...], own: _Own) -> tuple[_Saver, _Loader]:
    """None | float and the like are told apart by their JSON type, records by the name of their class."""
    records = {a.__name__: a for a in arguments if isinstance(a, type) and attrs.has(a)}
    others = [a for a in arguments if a is not type(None) and a not in records.values()]
    if any([getattr(a, "_is_protocol", False) for a in others]):
        return _open_codec(records, own)
    if len(others) > 1 or (others and records):
        raise TypeError(f"it could not tell apart {arguments!r}")

    def save_union(value: Any) -> Json:
        if value is None:
            return None
        if others:
            return _codec(others[0])[0](value)
        if type(value) not in records.values():
            raise TypeError(f"a {type(value).__name__} where {' or '.join(records)} is known")
        saved = _codec(type(value))[0](value)
        return {"kind": type(value).__name__, "is": saved} if len(records) > 1 else saved

    def load_union(value: Any) -> Any:
        if value is None:
            return None
        if others:
            return _codec(others[0], own)[1](value)
        if len(records) == 1:
            return _codec(next(iter(records.values())), own)[1](value)
        return _codec(records[value["kind"]], own)[1](value["is"])

    return save_union, load_union


def _open_codec(records: dict[str, type], own: _Own) -> tuple[_Saver, _Loader]:
    """A union with a Protocol in it: what an app has made may stand where ours do, under a name that is not ours."""
    known = {cls.__name__: cls for cls in own} | records

    def save_open(value: Any) -> Json:
        cls = type(value)
        if not attrs.has(cls):
            raise TypeError(f"{cls.__name__} is no attrs class")
        if records.get(cls.__name__, cls) is not cls:
            raise TypeError(f"it could not tell this {cls.__name__} from solepath's own: give it another name")
        return {"kind": cls.__name__, "is": _codec(cls)[0](value)}

    def load_open(value: Any) -> Any:
        kind = value["kind"]
        cls = known.get(kind)
        if cls is None:
            from ..recipes import part_class

            cls = part_class(kind)
        return _codec(cls, own)[1](value["is"])

    return save_open, load_open
