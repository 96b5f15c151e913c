"""The Arrow C data and stream interfaces: structs of pointers in capsules, made with ctypes alone.

Sources: https://arrow.apache.org/docs/format/CDataInterface.html, CStreamInterface.html and
CDataInterface/PyCapsuleInterface.html. The reader of a struct calls its `release` when it needs the memory no longer.
Until then `_ALIVE` holds what the pointers lead to. A reader may take a child out of a struct and keep it longer, so
each struct holds its own memory only, and releases those children that are still there."""

from __future__ import annotations

import ctypes
from array import array
from collections.abc import Callable
from itertools import count
from typing import Any

from .nodes import EMPTY, Node

NULLABLE = 2
"""Flag of a field that may have missing values (ARROW_FLAG_NULLABLE)."""
FAILED = 5
"""Status of a call that failed (EIO)."""

_ALIVE: dict[int, Any] = {}
_numbers = count(1)


def _keep(value: Any) -> int:
    number = next(_numbers)
    _ALIVE[number] = value
    return number


class ArrowSchema(ctypes.Structure):
    """The type of an array, struct ArrowSchema."""


class ArrowArray(ctypes.Structure):
    """The memory of an array, struct ArrowArray."""


class ArrowArrayStream(ctypes.Structure):
    """A source of batches, struct ArrowArrayStream."""


_Release = ctypes.CFUNCTYPE(None, ctypes.c_void_p)
_Call = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)
_LastError = ctypes.CFUNCTYPE(ctypes.c_void_p, ctypes.c_void_p)
_Destructor = ctypes.PYFUNCTYPE(None, ctypes.c_void_p)

ArrowSchema._fields_ = [
    ("format", ctypes.c_char_p),
    ("name", ctypes.c_char_p),
    ("metadata", ctypes.c_char_p),
    ("flags", ctypes.c_int64),
    ("n_children", ctypes.c_int64),
    ("children", ctypes.POINTER(ctypes.POINTER(ArrowSchema))),
    ("dictionary", ctypes.c_void_p),
    ("release", _Release),
    ("private_data", ctypes.c_void_p),
]
ArrowArray._fields_ = [
    ("length", ctypes.c_int64),
    ("null_count", ctypes.c_int64),
    ("offset", ctypes.c_int64),
    ("n_buffers", ctypes.c_int64),
    ("n_children", ctypes.c_int64),
    ("buffers", ctypes.POINTER(ctypes.c_void_p)),
    ("children", ctypes.POINTER(ctypes.POINTER(ArrowArray))),
    ("dictionary", ctypes.c_void_p),
    ("release", _Release),
    ("private_data", ctypes.c_void_p),
]
ArrowArrayStream._fields_ = [
    ("get_schema", _Call),
    ("get_next", _Call),
    ("get_last_error", _LastError),
    ("release", _Release),
    ("private_data", ctypes.c_void_p),
]


def _releaser(struct: Any, alive: dict[int, Any] = _ALIVE, null: Any = _Release()) -> Any:  # noqa: B008
    """Return the callback that releases structs of one type.

    It needs no global name, because a reader may call it while Python shuts down and modules are empty already."""

    def release(address: int) -> None:
        one = struct.from_address(address)
        for place in range(getattr(one, "n_children", 0)):
            child = one.children[place]
            if child.contents.release:
                child.contents.release(child)
        one.release = null
        alive.pop(one.private_data, None)

    return _forever(_Release(release))


def _forever(callback: Any) -> Any:
    """Return the callback, whose machine code stays in memory until the process ends: readers have its address."""
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(callback))
    return callback


def _fill_schema(one: ArrowSchema, node: Node) -> None:
    children = _children(ArrowSchema, node, _fill_schema)
    one.format, one.name, one.metadata = node.format.encode(), node.name.encode(), node.metadata
    one.flags = NULLABLE if node.nullable else 0
    one.n_children, one.children, one.dictionary = len(node.children), children, None
    # the texts are kept by the struct itself: a struct that is moved to another place needs them as long
    one.private_data = _keep((one.format, one.name, one.metadata, one._objects, children))
    one.release = _release_schema


def _fill_array(one: ArrowArray, node: Node) -> None:
    held = [_address(buffer) for buffer in node.buffers]
    buffers = (ctypes.c_void_p * len(held))(*[address for address, _ in held])
    children = _children(ArrowArray, node, _fill_array)
    one.length, one.null_count, one.offset = node.length, node.nulls, 0
    one.n_buffers, one.buffers = len(held), buffers
    one.n_children, one.children, one.dictionary = len(node.children), children, None
    one.private_data = _keep((held, buffers, children))
    one.release = _release_array


def _children(struct: Any, node: Node, fill: Callable[[Any, Node], None]) -> Any:
    """Return an array of pointers to the structs of the children, which it holds."""
    made = [struct() for _ in node.children]
    for one, child in zip(made, node.children, strict=True):
        fill(one, child)
    return (ctypes.POINTER(struct) * len(made))(*[ctypes.pointer(one) for one in made])


def _address(buffer: bytearray | array[Any] | None) -> tuple[int | None, object]:
    """Return where a buffer is, and what keeps it there."""
    if buffer is None:
        return None, None
    view = ctypes.c_char.from_buffer(buffer if len(buffer) else EMPTY)
    return ctypes.addressof(view), view


_release_schema, _release_array = _releaser(ArrowSchema), _releaser(ArrowArray)
_release_stream = _releaser(ArrowArrayStream)


def _get_schema(stream: int, out: int) -> int:
    return _give(stream, lambda node, _: _fill_schema(ArrowSchema.from_address(out), node))


def _get_next(stream: int, out: int) -> int:
    def batch(node: Node, done: list[bool]) -> None:
        one = ArrowArray.from_address(out)
        if done:
            one.release = _Release()  # the end of the stream
        else:
            _fill_array(one, node)
            done.append(True)

    return _give(stream, batch)


def _give(stream: int, fill: Callable[[Node, list[bool]], None]) -> int:
    """Fill a struct of the reader's; an exception may not pass through the reader's code, which asks for its text."""
    node, done, faults = _ALIVE[ArrowArrayStream.from_address(stream).private_data]
    try:
        fill(node, done)
    except Exception as error:
        faults.append(ctypes.create_string_buffer(repr(error).encode()))
        return FAILED
    return 0


def _get_last_error(stream: int) -> int | None:
    """Return the address of the text of the last fault, which is kept until the stream is released."""
    _, _, faults = _ALIVE[ArrowArrayStream.from_address(stream).private_data]
    return ctypes.addressof(faults[-1]) if faults else None


_calls = _forever(_Call(_get_schema)), _forever(_Call(_get_next)), _forever(_LastError(_get_last_error))

_new_capsule = ctypes.PYFUNCTYPE(ctypes.py_object, ctypes.c_void_p, ctypes.c_char_p, _Destructor)(
    ("PyCapsule_New", ctypes.pythonapi)
)


def _destroy(capsule: int, alive: dict[int, Any] = _ALIVE, address_of: Any = ctypes.addressof) -> None:
    """Release the struct of a capsule if no reader has taken it; `capsule` is the address of a deleted object.

    A limit of ctypes: where a reader deletes the capsule while it raises an exception, as pyarrow does with a schema
    that does not fit, Python code cannot run, and the caller sees SystemError in place of the reader's error."""
    one, _ = alive.pop(-capsule)
    if one.release:
        one.release(address_of(one))


_destructor = _forever(_Destructor(_destroy))


def schema_capsule(node: Node) -> object:
    """Return a capsule named "arrow_schema" with the type of an array."""
    one = ArrowSchema()
    _fill_schema(one, node)
    return _capsule(one, b"arrow_schema")


def stream_capsule(node: Node) -> object:
    """Return a capsule named "arrow_array_stream" with one batch."""
    one = ArrowArrayStream(*_calls)
    one.private_data, one.release = _keep((node, [], [])), _release_stream
    return _capsule(one, b"arrow_array_stream")


def _capsule(one: ctypes.Structure, name: bytes) -> object:
    made: object = _new_capsule(ctypes.addressof(one), name, _destructor)
    _ALIVE[-id(made)] = one, name  # the identity of an object is its address
    return made
