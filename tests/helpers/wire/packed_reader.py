"""A reader of packed bodies that was written after protocol/snapshot.md alone: with the standard library, a schema as
JSON, and none of solepath."""

from __future__ import annotations

import base64
import struct
from math import isfinite
from typing import Any


def bits(data: bytes, width: int, count: int) -> list[int]:
    whole = int.from_bytes(data, "little")
    return [whole >> width * k & (1 << width) - 1 for k in range(count)]


def streams(body: bytes) -> tuple[list[float], list[int], list[int], bytes]:
    """The body's floats, ints, flags and bytes. ValueError for none."""
    at = 0

    def take(length: int) -> bytes:
        nonlocal at
        if at + length > len(body):
            raise ValueError("too short")
        at += length
        return body[at - length : at]

    floats, ints, flags, large_words, left, right = struct.unpack("<4I2d", take(32))
    classes = bits(take(-(-(floats + ints) // 8) * 3), 3, floats + ints)

    def numbers(code: str, members: tuple[int, ...]) -> Any:
        count = sum([k in members for k in classes])
        return iter(struct.unpack(f"<{count}{code}", take(count * struct.calcsize("<" + code))))

    counts, singles, doubles = numbers("h", (4, 5, 6, 7)), numbers("f", (1,)), numbers("d", (2,))
    found: list[float] = []
    last: float | None = None
    for k in classes:
        if k == 0:
            found.append(0.0)
        elif k == 1:
            found.append(next(singles))
        elif k in (2, 3):
            last = next(doubles) if k == 2 else last
            if last is None:
                raise ValueError("no double before")
            found.append(last)
        else:
            count = float(next(counts))
            found.append({4: count, 5: count / 10_000, 6: count * left, 7: count * right}[k])
    if not all([isfinite(number) for number in found]) or any([number % 1.0 for number in found[floats:]]):
        raise ValueError("not finite, or not whole")
    whole = [int(number) for number in found[floats:]]
    true = bits(take(-(-flags // 8)), 1, flags)
    large = [int(word) for word in take(large_words).split()]
    if whole.count(-(2**63)) != len(large):
        raise ValueError("too many large ints, or too few")
    large.reverse()
    return found[:floats], [large.pop() if n == -(2**63) else n for n in whole], true, body[at:]


class Tree:
    """Reads the content of a body by its schema. `parts`: the schemas of open records, by their description."""

    def __init__(self, schema: dict[str, Any], parts: dict[str, Any], body: bytes) -> None:
        self.schema, self.parts = schema, parts
        floats, ints, flags, self.data = streams(body)
        self.scalars = {"float": iter(floats), "int": iter(ints), "bool": map(bool, flags)}

    def roots(self) -> list[dict[str, Any]]:
        return [self.record(name) for name in self.schema["roots"]]

    def record(self, name: str) -> dict[str, Any]:
        return {field: self.value(kind) for field, kind in self.schema["records"][name].items()}

    def some(self, kind: Any) -> list[Any]:
        return [self.value(kind) for _ in range(self.value("int"))]

    def open(self, names: list[str]) -> dict[str, Any]:
        k = self.value("int")
        if k < len(names):
            return {"kind": names[k].removeprefix("state of ").split(" ")[0], "is": self.record(names[k])}
        large_words = self.value("str")
        around, self.schema = self.schema, self.parts[large_words]
        (fields,) = self.roots()
        self.schema = around
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
                return self.some(inner)
            case {"deque": inner}:
                most = self.value({"maybe": "int"})
                items = self.some(inner)
                return items if most is None else {"maxlen": most, "is": items}
            case {"dict": both}:
                return {str(key): value for key, value in self.some({"tuple": both})}
        raise ValueError(f"{kind} is no type")

    def left(self) -> Any:
        """Return the bytes that were not read."""
        return self.data or [number for scalar in self.scalars.values() for number in scalar]
