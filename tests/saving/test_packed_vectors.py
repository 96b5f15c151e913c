"""protocol/snapshot/states.json against the packer, and against a reader that knows protocol/snapshot.md alone."""

from __future__ import annotations

import json
import struct
import zlib
from collections import deque
from runpy import run_module
from typing import Any, Protocol

import pytest
from attrs import define, field
from here import PROTOCOL

from solepath import Foot, Phase, Session
from solepath.foot.navigate.error_state import ErrorStateFilter
from solepath.papers.shoe_sensing.short_time_energy import AccelerationMagnitude
from solepath.saving.packed import Lists, identify_record, write
from solepath.saving.schema import MADE_AGAIN, NOT_SAVED, describe, record_of, schema_checksum
from solepath.saving.streams import from_bytes, to_bytes

FILE = json.loads((PROTOCOL / "snapshot" / "states.json").read_text("utf-8"))
HEADER = struct.Struct("<4sHHII")


class Hat(Protocol):
    """The hat of a `Wardrobe`."""

    size: float


@define
class Cap:
    size: float = 57.0
    worn: int = field(default=0, init=False)


@define
class Bag:
    """No part: it has no state of its own."""

    size: float = 30.0
    holds: list[str] = field(factory=list)


class Tally:
    """A plain class."""

    count: int
    seen: dict[Foot, float]

    def __init__(self) -> None:
        self.count, self.seen = 0, {}


@define
class Wardrobe:
    name: str
    hats: tuple[Hat, ...] = ()
    limit: float = 0.5
    # state
    top: Hat = field(factory=Cap, init=False)
    lent: Hat | None = field(default=None, init=False)
    spare: dict[str, Cap] = field(factory=lambda: {"red": Cap(58.0)}, init=False, metadata=MADE_AGAIN)
    either: Cap | Bag | None = field(default=None, init=False)
    tally: Tally = field(factory=Tally, init=False)
    phase: Phase = field(default=Phase.SWING, init=False)
    raw: bytes = field(default=b"", init=False)
    place: tuple[float, int] | None = field(default=None, init=False)
    rows: deque[tuple[float, float]] = field(factory=lambda: deque(maxlen=3), init=False)
    flags: list[bool] = field(factory=list, init=False)
    plan: str | None = field(default=None, init=False, metadata=NOT_SAVED)


def used() -> Wardrobe:
    """A `Wardrobe` with something in every field."""
    one = Wardrobe("né", (Cap(1.5), Bag(2.5, ["a", "b"])))
    one.top.worn, one.lent, one.spare["red"].worn, one.either = 3, Cap(60.0), 2**70, Bag(4.0)
    one.tally.count, one.tally.seen, one.phase, one.raw = 7, {Foot.RIGHT: 0.1}, Phase.LOADING, b"\x00\xff"
    one.place, one.flags, one.plan = (-0.0, -3), [True, False], "not saved"
    one.rows.extend([(0.1, 0.2), (0.1, 1e-9)])
    return one


def body_of(one: Wardrobe, made: bool) -> bytes:
    lists: Lists = ([], [], [], [])
    write(record_of(Wardrobe, made), one, lists)
    return to_bytes(*lists)


def test_the_state_of_the_file_is_what_is_packed_today_and_its_schema() -> None:
    (state,) = FILE["states"]
    # another zlib may compress in another way
    assert zlib.decompress(bytes.fromhex(state["hex"])) == zlib.decompress(body_of(used(), made=True))
    assert state["schema"] == describe(record_of(Wardrobe, made=True))
    for record in (record_of(Cap, True), record_of(Bag)):
        assert state["parts"][identify_record(record)] == describe(record)


def test_a_packed_session_names_the_schema_that_the_command_prints(capsys: pytest.CaptureFixture[str]) -> None:
    run_module("solepath.session.schema", run_name="__main__")
    printed = json.loads(capsys.readouterr().out)
    data = Session().pack()
    magic, form, version, made_with, check = HEADER.unpack_from(data)
    assert (magic, form, version) == (b"sole", 3, printed["version"])
    assert made_with == zlib.crc32(json.dumps(printed["session"], separators=(",", ":")).encode())
    assert check == zlib.crc32(data[:12] + bytes(4) + data[16:])
    for part, has_state in ((ErrorStateFilter, True), (AccelerationMagnitude, False)):
        assert identify_record(record_of(part, made=has_state)) in printed["parts"]
    for name, schema in printed["parts"].items():
        assert name.split(" ")[1] == f"{schema_checksum(schema):08x}"


@pytest.mark.parametrize("body", FILE["bodies"], ids=lambda body: body["id"])
def test_a_body_holds_the_documented_values(body: dict[str, Any]) -> None:
    data = memoryview(bytes.fromhex(body["hex"]))
    if body["result"] == "valid":
        floats, ints, flags, rest = from_bytes(data)
        found = {"floats": floats, "ints": ints, "flags": flags, "bytes": rest.hex()}
        assert repr(found) == repr(body["streams"])
    else:
        # nothing but these, which unpacking turns into SnapshotError
        with pytest.raises((ValueError, struct.error, zlib.error)):
            from_bytes(data)
