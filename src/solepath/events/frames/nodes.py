"""Columns in the memory format of Arrow: buffers of numbers, of bits that say what is missing, and of texts.

Source: Arrow Columnar Format 1.5, physical memory layout."""

from __future__ import annotations

from array import array
from itertools import accumulate, chain
from struct import pack
from typing import Any

from ...types.attrs import field, frozen
from .columns import ColumnTable, Form, Kind

FORMATS = {Kind.FLOAT: "g", Kind.INT: "l", Kind.BOOL: "b", Kind.TEXT: "u", Kind.LIST: "+l", Kind.RECORD: "+s"}
"""Format strings of the Arrow C data interface: float64, int64, bits, UTF-8, list, struct."""
EMPTY = bytearray(8)
"""What stands in for a buffer of no length, because some readers reject a null pointer."""


@frozen
class Node:
    """One array of Arrow with its type, and the arrays inside of it."""

    name: str
    format: str
    length: int
    buffers: tuple[bytearray | array[Any] | None, ...]
    nulls: int = 0
    children: tuple[Node, ...] = ()
    metadata: bytes | None = None
    nullable: bool = field(default=True)


def node_of(table: ColumnTable) -> Node:
    """Return a table as one array of records, which is what a batch of Arrow is."""
    children = [_array(column.name, column.form, column.values, column.unit) for column in table.columns]
    return Node("", "+s", table.rows, (None,), children=tuple(children), nullable=False)


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
        case Kind.FLOAT | Kind.INT:
            buffers = (array("d" if form.kind is Kind.FLOAT else "q", [0 if v is None else v for v in values]),)
        case Kind.BOOL:
            buffers = (_bits(values, missing=False),)
        case Kind.TEXT:
            texts = [b"" if value is None else value.encode() for value in values]
            buffers = (_offsets(texts), bytearray().join(texts) or EMPTY)
        case Kind.LIST:
            lists = [() if value is None else value for value in values]
            buffers = (_offsets(lists),)
            ((inner, of),) = form.inner
            children = (_array(inner, of, list(chain.from_iterable(lists))),)
        case Kind.RECORD:
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
