"""Columns in the memory format of Arrow: buffers of numbers, of bits that say what is missing, and of texts.

Source: Arrow Columnar Format 1.5, physical memory layout."""

from __future__ import annotations

from array import array
from itertools import accumulate, chain
from struct import pack
from typing import Any

from ...types.attrs import frozen
from .forms import Form, TableColumn, ValueKind

FORMATS = {
    ValueKind.FLOAT: "g",
    ValueKind.INT: "l",
    ValueKind.BOOL: "b",
    ValueKind.TEXT: "u",
    ValueKind.LIST: "+l",
    ValueKind.RECORD: "+s",
}
"""Format strings of the Arrow C data interface: float64, int64, bits, UTF-8, list, struct."""
EMPTY = bytearray(8)
"""Stand-in for a buffer of no length, because some readers reject a null pointer."""


@frozen
class Node:
    """One array of Arrow with its type, and the arrays inside of it."""

    name: str
    """Name of the column, or of the field of a record."""
    format: str
    """Type in the notation of the C data interface."""
    length: int
    """Number of values."""
    buffers: tuple[bytearray | array[Any] | None, ...]
    """Bits that say which values are there, None if all are; then offsets and values."""
    nulls: int = 0
    """Number of missing values."""
    children: tuple[Node, ...] = ()
    """Arrays of the items of lists, or of the fields of records."""
    metadata: bytes | None = None
    """Keys and values in the binary form of the C data interface."""
    nullable: bool = True
    """True if values may be missing."""


def node_of(columns: tuple[TableColumn, ...], rows: int) -> Node:
    """Return columns as one array of records, which is what a batch of Arrow is."""
    children = [_array(column.name, column.form, column.values, column.unit) for column in columns]
    return Node("", "+s", rows, (None,), children=tuple(children), nullable=False)


def _metadata(unit: str) -> bytes:
    """Return key and value in the binary form of the C data interface: counts and lengths as int32, native order."""
    parts = [pack("=i", len(each)) + each for each in (b"unit", unit.encode())]
    return pack("=i", 1) + b"".join(parts)


def _array(name: str, form: Form, values: list[Any], unit: str | None = None) -> Node:
    nulls = values.count(None)
    valid = _bits(values, missing=None) if nulls else None
    children: tuple[Node, ...] = ()
    buffers: tuple[bytearray | array[Any] | None, ...]
    match form.kind:
        case ValueKind.FLOAT | ValueKind.INT:
            buffers = (array("d" if form.kind is ValueKind.FLOAT else "q", [0 if v is None else v for v in values]),)
        case ValueKind.BOOL:
            buffers = (_bits(values, missing=False),)
        case ValueKind.TEXT:
            texts = [b"" if value is None else value.encode() for value in values]
            buffers = (_offsets(texts), bytearray().join(texts) or EMPTY)
        case ValueKind.LIST:
            lists = [() if value is None else value for value in values]
            buffers = (_offsets(lists),)
            ((inner, of),) = form.inner
            children = (_array(inner, of, list(chain.from_iterable(lists))),)
        case ValueKind.RECORD:
            buffers = ()
            children = tuple(
                [_array(key, of, [None if v is None else v[key] for v in values]) for key, of in form.inner]
            )
    metadata = None if unit is None else _metadata(unit)
    return Node(name, FORMATS[form.kind], len(values), (valid, *buffers), nulls, children, metadata)


def _offsets(items: list[Any]) -> array[int]:
    """Return where each item starts, and where the last ends; int32 suffices for 2 GB."""
    return array("i", accumulate(map(len, items), initial=0))


def _bits(values: list[Any], missing: bool | None) -> bytearray:
    """Return a bit for each value, the first in the lowest bit of the first byte: 0 for None and for `missing`."""
    if not values:
        return EMPTY
    text = "".join(["0" if value is None or value is missing else "1" for value in reversed(values)])
    return bytearray(int(text, 2).to_bytes((len(values) + 7) // 8, "little"))
