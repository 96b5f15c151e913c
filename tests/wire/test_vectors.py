"""Comparison of the wire package with the vectors of protocol/, which were made without it, in both directions."""

from __future__ import annotations

import json
from typing import Any

import pytest
from formats import DECLARED_FORMATS, FORMATS, VECTORS, Format

from solepath.events import Rejection
from solepath.link.driver import Driver
from solepath.testing.vectors import disagreements
from solepath.wire import fragment
from solepath.wire.envelope import seal
from solepath.wire.error import WireError

FILES = {path.stem: json.loads(path.read_text("utf-8")) for path in sorted(VECTORS.glob("*.json"))}


def vectors(result: str) -> list[Any]:
    return [
        pytest.param(FORMATS[name], vector, id=f"{name}:{vector['id']}")
        for name, file in FILES.items()
        for vector in file["vectors"]
        if vector["result"] == result
    ]


@pytest.mark.parametrize(("wire", "vector"), vectors("valid"))
def test_the_packet_parses_to_the_vector(wire: Format, vector: Any) -> None:
    assert wire.to_fields(wire.parse(bytes.fromhex(vector["hex"]))) == vector["fields"]


@pytest.mark.parametrize(("wire", "vector"), vectors("valid"))
def test_the_vector_builds_its_packet(wire: Format, vector: Any) -> None:
    assert wire.build(wire.from_fields(vector["fields"])).hex() == vector["hex"]


@pytest.mark.parametrize(("wire", "vector"), vectors("invalid"))
def test_an_invalid_packet_is_rejected_for_the_reason_named(wire: Format, vector: Any) -> None:
    with pytest.raises(WireError) as caught:
        wire.parse(bytes.fromhex(vector["hex"]))
    assert caught.value.reason == Rejection(vector["reason"])
    assert caught.value.detail


@pytest.mark.parametrize("case", [pytest.param(case, id=case["id"]) for case in FILES["insole-fragment"]["splits"]])
def test_a_frame_is_cut_into_the_notifications_of_the_vector(case: Any) -> None:
    frame = bytes.fromhex(case["frame"])
    notifications = fragment.split(frame, case["payload"], case["frame_id"])
    assert [n.hex() for n in notifications] == case["notifications"]
    assert all(len(n) <= case["payload"] for n in notifications)
    if len(notifications) > 1:
        assert all(fragment.is_fragment(n) for n in notifications)
        assert b"".join(fragment.parse_fragment(n).body for n in notifications) == frame


@pytest.mark.parametrize("name", DECLARED_FORMATS)
def test_a_declared_device_agrees_with_its_vectors(name: str) -> None:
    driver: Driver = DECLARED_FORMATS[name][0]
    assert disagreements(driver, FILES[name]) == []


def test_every_format_has_a_vector_file_and_the_other_way_round() -> None:
    assert set(FILES) == set(FORMATS)


@pytest.mark.parametrize("name", FORMATS)
def test_a_packet_with_a_changed_byte_is_rejected_or_is_another_record_of_the_same_bytes(name: str) -> None:
    wire = FORMATS[name]
    for data in [bytes.fromhex(vector["hex"]) for vector in FILES[name]["vectors"]][:8]:
        for at, change in [
            (at, change) for at in range(0, len(data), 1 + len(data) // 40) for change in (0x01, 0x80, 0xFF)
        ]:
            changed = bytearray(data)
            changed[at] ^= change
            for other in (
                bytes(changed),
                seal(bytes(changed[:-2])) if name in ("insole-frame", "insole-info") else b"",
            ):
                try:
                    record = wire.parse(other)
                except WireError:
                    continue
                assert name not in ("insole-frame", "insole-info") or other != changed, "its CRC is another"
                assert wire.build(record) == other
                assert wire.parse(bytearray(other)) == wire.parse(memoryview(other)) == record  # type: ignore[arg-type]
