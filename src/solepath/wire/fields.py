"""Additions to the library construct: several numbers in one call, bytes as hexadecimal digits, whole values.

`Fields` parses several plain numbers with one call of `struct`; a construct for each number would be slow.
`parse_whole` and `build_whole` turn construct's exceptions into WireError and ValueError."""

from __future__ import annotations

import struct
from collections.abc import Callable
from io import BytesIO
from math import isfinite
from typing import TYPE_CHECKING, Any

from construct import Adapter, Construct, ConstructError, FormatFieldError, StreamError, TerminatedError

from ..events import Rejection
from .error import WireError

if TYPE_CHECKING:  # construct's classes have type arguments in its stubs only
    from typing import IO

    Definition = Construct[Any, Any]
    AnyAdapter = Adapter[Any, Any, Any, Any]
else:
    Definition = Construct
    AnyAdapter = Adapter

LONGEST_VALUE = 512
"""Largest size of an attribute value, bytes (Bluetooth Core, vol 3 part F, 3.2.9); no frame or text is larger."""


class Fields(Definition):
    """A construct for several numbers in `struct` notation, which parses to a tuple or to `make(*numbers)`.

    It builds bytes from a tuple."""

    def __init__(self, layout: str, make: Callable[..., Any] | None = None) -> None:
        super().__init__()
        self.notation, self._struct = layout, struct.Struct(layout)
        self._make = make

    def _parse(self, stream: IO[bytes], context: Any, path: str) -> Any:
        data = stream.read(self._struct.size)
        if len(data) != self._struct.size:
            raise StreamError(f"needs {self._struct.size} bytes, has {len(data)}", path=path)
        values = self._struct.unpack(data)
        return values if self._make is None else self._make(*values)

    def _build(self, obj: Any, stream: IO[bytes], context: Any, path: str) -> Any:
        try:
            stream.write(self._struct.pack(*obj))
        except (struct.error, OverflowError) as error:  # OverflowError: a float too large for binary32
            raise FormatFieldError(f"{obj} do not fit: {error}", path=path) from error
        return obj

    def _sizeof(self, context: Any, path: str) -> int:
        return self._struct.size


class Hex(AnyAdapter):
    """A construct that turns bytes which are not interpreted into hexadecimal digits."""

    def _decode(self, obj: Any, context: Any, path: str) -> str:
        return bytes(obj).hex()

    def _encode(self, obj: Any, context: Any, path: str) -> bytes:
        return bytes.fromhex(obj)


def parse_whole(definition: Definition, data: bytes) -> Any:
    """Return the value that `definition` parses from all of `data`; WireError when `data` does not fit."""
    try:
        stream = BytesIO(data)
        parsed = definition.parse_stream(stream)
    except StreamError as error:
        raise WireError(Rejection.TRUNCATED, f"{len(data)} bytes are too few") from error
    except TerminatedError as error:
        raise WireError(Rejection.OVERSIZED, f"{len(data)} bytes are too many") from error
    except ConstructError as error:
        raise WireError(Rejection.MALFORMED, str(error).strip().splitlines()[-1]) from error
    if stream.read(1):  # a definition that does not end in Terminated may leave bytes
        raise WireError(Rejection.OVERSIZED, f"{len(data)} bytes are too many")
    return parsed


def build_whole(definition: Definition, value: Any) -> bytes:
    """Return the bytes of `value`; ValueError when it does not fit."""
    try:
        return bytes(definition.build(value))
    except (ConstructError, OverflowError) as error:  # OverflowError: an infinite number was rounded
        raise ValueError(str(error).strip().splitlines()[-1]) from error


def to_counts(value: float, per_unit: int) -> int:
    """Return a number in whole counts, rounded; ValueError when it is not finite."""
    if not isfinite(value):
        raise ValueError(f"{value} is not finite")
    return round(value * per_unit)


def malformed(detail: str) -> WireError:
    """Return a WireError for a malformed packet."""
    return WireError(Rejection.MALFORMED, detail)


def decode(data: bytes, subject: str = "") -> str:
    """Return the text of UTF-8 bytes, which may be none; `subject` begins the WireError for other bytes."""
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise malformed(f"{subject}not UTF-8: {error}") from error


def parse_text(data: bytes) -> str:
    """Return the text of 1 to LONGEST_VALUE bytes of UTF-8, with a trailing NUL if it has one; WireError otherwise."""
    if not data:
        raise WireError(Rejection.TRUNCATED, "no text")
    check_length(data)
    return decode(bytes(data))


def check_length(data: bytes) -> None:
    """Raise WireError for more bytes than a value may have."""
    if len(data) > LONGEST_VALUE:
        raise WireError(Rejection.OVERSIZED, f"{len(data)} bytes, at most {LONGEST_VALUE}")


def build_text(text: str) -> bytes:
    """Return the bytes of a text; ValueError when it is empty or too long."""
    data = text.encode("utf-8")
    if not 0 < len(data) <= LONGEST_VALUE:
        raise ValueError(f"a text of {len(data)} bytes")
    return data
