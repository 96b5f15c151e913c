"""A reader of packed bodies that was written from protocol/snapshot.md alone, without any module of solepath."""

from __future__ import annotations

import base64
import struct
import zlib
from math import isfinite
from typing import Any


def streams(body: bytes) -> tuple[list[float], list[int], list[int], bytes]:
    """Return the body's floats, ints, flags and remaining bytes; ValueError when it is malformed."""
    inflater = zlib.decompressobj()
    try:
        content = inflater.decompress(body)
    except zlib.error as error:
        raise ValueError("not of zlib") from error
    if not inflater.eof or inflater.unused_data:
        raise ValueError("too short, or too long")
    position = 0

    def take(length: int) -> bytes:
        nonlocal position
        if position + length > len(content):
            raise ValueError("too short")
        position += length
        return content[position - length : position]

    floats, ints, flags, large_words = struct.unpack("<4I", take(16))
    if floats + ints + flags > 1_048_576:
        raise ValueError("too many")
    numbers = list(struct.unpack(f"<{floats}d", take(8 * floats)))
    if not all([isfinite(number) for number in numbers]):
        raise ValueError("not finite")
    whole_numbers = list(struct.unpack(f"<{ints}q", take(8 * ints)))
    flag_values = list(take(flags))
    if not {*flag_values} <= {0, 1}:
        raise ValueError("not a flag")
    large_ints = [int(word) for word in take(large_words).split(b" ")] if large_words else []
    if whole_numbers.count(-(2**63)) != len(large_ints):
        raise ValueError("too many large ints, or too few")
    if max([len(str(abs(n))) for n in large_ints], default=0) > 309:
        raise ValueError("too many digits")
    large_ints.reverse()
    return numbers, [large_ints.pop() if n == -(2**63) else n for n in whole_numbers], flag_values, content[position:]


class Tree:
    """Reads the content of a body by its schema; `parts` has the schemas of open records by description."""

    def __init__(self, schema: dict[str, Any], parts: dict[str, Any], body: bytes) -> None:
        self.schema, self.parts = schema, parts
        floats, ints, flags, self.data = streams(body)
        self.scalars = {"float": iter(floats), "int": iter(ints), "bool": map(bool, flags)}

    def roots(self) -> list[dict[str, Any]]:
        return [self.record(name) for name in self.schema["roots"]]

    def record(self, name: str) -> dict[str, Any]:
        return {field: self.value(kind) for field, kind in self.schema["records"][name].items()}

    def read_list(self, kind: Any) -> list[Any]:
        return [self.value(kind) for _ in range(self.value("int"))]

    def open(self, names: list[str]) -> dict[str, Any]:
        k = self.value("int")
        if k < len(names):
            return {"kind": names[k].removeprefix("state of ").split(" ")[0], "is": self.record(names[k])}
        large_words = self.value("str")
        outer_schema, self.schema = self.schema, self.parts[large_words]
        (fields,) = self.roots()
        self.schema = outer_schema
        return {"kind": large_words.split(" ")[0], "is": fields}

    def value(self, kind: Any) -> Any:
        if kind in ("str", "bytes"):
            length = self.value("int")
            large_words, self.data = self.data[:length], self.data[length:]
            return large_words.decode() if kind == "str" else base64.b64encode(large_words).decode()
        if isinstance(kind, str):
            return next(self.scalars[kind])
        match kind:
            case {"enum": name}:
                return self.schema["enums"][name][self.value("int")]
            case {"record": name}:
                return self.record(name)
            case {"one of": names}:
                return self.open(names)
            case {"maybe": inner}:
                return self.value(inner) if self.value("bool") else None
            case {"tuple": items}:
                return [self.value(item) for item in items]
            case {"row": inner} | {"list": inner}:
                return self.read_list(inner)
            case {"deque": inner}:
                max_length = self.value({"maybe": "int"})
                items = self.read_list(inner)
                return items if max_length is None else {"maxlen": max_length, "is": items}
            case {"dict": item_types}:
                return {str(key): value for key, value in self.read_list({"tuple": item_types})}
        raise ValueError(f"{kind} is no type")

    def left(self) -> Any:
        """Return the bytes that were not read."""
        return self.data or [number for scalar in self.scalars.values() for number in scalar]
