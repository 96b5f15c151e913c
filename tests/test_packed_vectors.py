"""protocol/snapshot/states.json against the packer, and against a reader that was written after protocol/snapshot.md
alone: with the standard library, the shape's file, and none of solepath."""

from __future__ import annotations

import base64
import json
import struct
import zlib
from math import isfinite
from pathlib import Path
from typing import Any

import pytest

from solepath import Session, recipes
from solepath.saving import pin
from solepath.saving.form import HEADER
from solepath.saving.records import shape
from solepath.saving.rows import ROWS
from solepath.saving.shape import kind_of
from solepath.saving.streams import from_bytes

ROOT = Path(__file__).parent.parent
FILE = json.loads((ROOT / "protocol" / "snapshot" / "states.json").read_text("utf-8"))
SHAPES = ROOT / "src" / "solepath" / "packing" / "shapes"


# --- a reader of its own ----------------------------------------------------------------------------------------------


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

    floats, ints, flags, told, left, right = struct.unpack("<4I2d", take(32))
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
    large = [int(word) for word in take(told).split()]
    if whole.count(-(2**63)) != len(large):
        raise ValueError("too many large ints, or too few")
    large.reverse()
    return found[:floats], [large.pop() if n == -(2**63) else n for n in whole], true, body[at:]


class Tree:
    """What a state holds, by its shape."""

    def __init__(self, of: dict[str, Any], body: bytes) -> None:
        self.of = of
        floats, ints, flags, self.data = streams(body)
        self.scalars = {"float": iter(floats), "int": iter(ints), "bool": map(bool, flags)}

    def record(self, name: str) -> dict[str, Any]:
        return {field: self.value(kind) for field, kind in self.of["records"][name].items()}

    def some(self, kind: Any) -> list[Any]:
        return [self.value(kind) for _ in range(self.value("int"))]

    def value(self, kind: Any) -> Any:
        if kind in ("str", "bytes"):
            length = self.value("int")
            told, self.data = self.data[:length], self.data[length:]
            return told.decode() if kind == "str" else base64.b64encode(told).decode()
        if isinstance(kind, str):
            return next(self.scalars[kind])
        match kind:
            case {"enum": name}:
                return self.of["enums"][name][self.value("int")]
            case {"record": name}:
                return self.record(name)
            case {"one of": names}:
                name = names[self.value("int")]
                return {"kind": name.removeprefix("state of ").split(" ")[0], "is": self.record(name)}
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


@pytest.mark.parametrize("state", FILE["states"], ids=lambda state: state["id"])
def test_a_state_is_read_by_its_shape_alone(state: dict[str, Any]) -> None:
    data = bytes.fromhex(state["hex"])
    magic, form, version, made_with, check = struct.unpack("<4sHHII", data[:16])
    told = json.loads((SHAPES / f"{version}.json").read_text("utf-8"))["packed"]
    told = {key: told[key] for key in ("root", "records", "enums")}
    assert (magic, form) == (b"sole", 1)
    assert made_with == zlib.crc32(json.dumps(told, separators=(",", ":")).encode())
    assert check == zlib.crc32(data[:12] + bytes(4) + data[16:])
    tree = Tree(told, data[16:])
    assert repr(tree.record(told["root"])) == repr(state["tree"])
    assert not tree.data and not any([[*left] for left in tree.scalars.values()])


@pytest.mark.parametrize("state", FILE["states"], ids=lambda state: state["id"])
def test_a_session_goes_on_with_it(state: dict[str, Any]) -> None:
    session = Session.unpack(bytes.fromhex(state["hex"]), recipes.BY_NAME[state["recipe"]])
    assert session.now == state["tree"]["state"]["now"]
    assert session.advance(1e6) != []


@pytest.mark.parametrize("body", FILE["bodies"], ids=lambda body: body["id"])
def test_a_body_holds_what_it_is_said_to_hold(body: dict[str, Any]) -> None:
    data = bytes.fromhex(body["hex"])
    if body["result"] == "valid":
        expected = {**body["streams"], "bytes": bytes.fromhex(body["streams"]["bytes"])}
        for floats, ints, flags, rest in (streams(data), from_bytes(memoryview(data))):
            found = {"floats": floats, "ints": ints, "flags": [bool(flag) for flag in flags], "bytes": rest}
            assert repr(found) == repr(expected)
        return
    with pytest.raises(ValueError, match="too|not|no double"):
        streams(data)
    # nothing but these, which unpacking turns into SnapshotError
    with pytest.raises((ValueError, IndexError, StopIteration)):
        from_bytes(memoryview(data))


def test_every_session_is_read_by_the_shape_alone() -> None:
    told = json.loads(pin.as_text())["packed"]
    for recipe in recipes.BY_NAME.values():
        data = Session(recipe).pack()
        tree = Tree(told, data[HEADER.size :])
        assert tree.record(told["root"])["head"]["recipe"] == recipe.name
        assert not tree.data


# --- what is in bytes -------------------------------------------------------------------------------------------------


def test_of_every_field_of_bytes_it_is_said_what_is_in_it() -> None:
    fields = {
        f"{kind_of(record)}.{field}"
        for record, kinds in shape().records.items()
        for field, kind in kinds.items()
        if kind == "bytes"
    }
    assert fields == ROWS.keys()


@pytest.mark.parametrize("field", ["Stride.rows", "Heard.rows", "Turned.rows", "Particles.crowd"])
def test_a_row_that_changed_without_the_version_is_told_with_what_to_do(field: str) -> None:
    assert pin.changed(pin.as_text()) is None
    other = pin.as_text().replace(f'"{field}": "{ROWS[field]}"', f'"{field}": "<99d"', 1)
    assert "raise VERSION in state.py to" in str(pin.changed(other))
