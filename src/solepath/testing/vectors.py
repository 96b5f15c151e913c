"""Check of a device's driver against its test vectors (protocol/README.md, "Vectors")."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isclose
from typing import Any

import attrs

from ..link.driver import Driver, Reading
from ..wire.error import WireError

SCHEMA = "solepath vectors 1"
_OTHER_KEYS = ("tolerance", "known")
"""Keys of `physical` in a vector that are not fields of a Reading."""


def disagreements(driver: Driver, file: Mapping[str, Any]) -> list[str]:
    """Return a sentence for every disagreement between a vector file and a driver, and for every mistake in the file.

    `file` is the result of json.load. The bytes of a valid vector must parse to its `fields`, by the construct of the
    channel, and `fields` must build the same bytes. `physical` may contain expected fields of the Reading; they must
    agree within `tolerance`, and `known` is passed to the driver's `read`. An invalid vector must be rejected for its
    `reason`: by the construct, by the reader, or because no device can send it (`Driver.read`)."""
    if not isinstance(file, Mapping):
        return ["a vector file is an object"]
    sentences = [] if file.get("schema") == SCHEMA else [f"the schema is {SCHEMA!r}, not {file.get('schema')!r}"]
    channel, vectors = file.get("channel"), file.get("vectors")
    if not isinstance(channel, str) or channel not in driver.formats:
        return [*sentences, f"no channel {channel!r}"]
    if not isinstance(vectors, list):
        return [*sentences, "'vectors' is no list"]
    if file.get("count") != len(vectors):
        sentences.append(f"{len(vectors)} vectors, not {file.get('count')}")
    ids = set[str]()
    for k, vector in enumerate(vectors):
        if not isinstance(vector, Mapping) or not isinstance(vector.get("id"), str):
            sentences.append(f"vector {k} is no object with an id")
            continue
        if vector["id"] in ids:
            sentences.append(f"{vector['id']}: it is there twice")
        ids.add(vector["id"])
        sentences += [f"{vector['id']}: {sentence}" for sentence in _check_vector(driver, channel, vector)]
    return sentences


def _check_vector(driver: Driver, channel: str, vector: Mapping[str, Any]) -> Iterator[str]:
    result, physical = vector.get("result"), vector.get("physical", {})
    try:
        data = bytes.fromhex(vector.get("hex"))  # type: ignore[arg-type]
    except (TypeError, ValueError):
        yield f"no bytes in hexadecimal digits: 'hex' is {vector.get('hex')!r}"
        return
    if result not in ("valid", "invalid"):
        yield f"'result' is 'valid' or 'invalid', not {result!r}"
        return
    if result == "invalid" and not isinstance(vector.get("reason"), str):
        yield "no 'reason' that it is rejected for"
        return
    if not isinstance(physical, Mapping) or not _has_numbers(physical.get("known", {})):
        yield "'physical' is no object of values, with numbers in its 'known'"
        return
    try:
        parsed = plain(driver.parse(channel, data))
        reading = driver.read(channel, data, physical.get("known", {}))
    except WireError as error:
        if result == "valid" or error.reason.value != vector["reason"]:
            yield str(error)
        return
    if result != "valid":
        yield f"taken, and should be {vector['reason']}"
        return
    yield from _check_build(driver, channel, vector, parsed, data)
    yield from _check_physical(reading, physical)


def _check_build(driver: Driver, channel: str, vector: Mapping[str, Any], parsed: Any, data: bytes) -> Iterator[str]:
    if "fields" not in vector:
        yield "no 'fields' that it says"
        return
    if parsed != vector["fields"]:
        yield f"says {parsed}"
    try:
        built = driver.write(channel, vector["fields"])
    except ValueError as error:
        yield f"its fields cannot be built: {error}"
        return
    if built != data:
        yield f"is built as {built.hex()}"


def _check_physical(reading: Reading, physical: Mapping[str, Any]) -> Iterator[str]:
    tolerance = physical.get("tolerance")
    if physical and not _has_numbers({"tolerance": tolerance}):
        yield f"'physical' has a 'tolerance' that is a number, not {tolerance!r}"
        return
    for name, value in physical.items():
        if name in _OTHER_KEYS:
            continue
        if name not in attrs.fields_dict(Reading):
            yield f"a Reading has no {name!r}"
        elif not _close(plain(getattr(reading, name)), value, physical["tolerance"]):
            yield f"{name} is {plain(getattr(reading, name))}"


def _has_numbers(named: Any) -> bool:
    return isinstance(named, Mapping) and all([isinstance(value, int | float) for value in named.values()])


def plain(value: Any) -> Any:
    """Convert a value to JSON's types: records and construct's Containers become dicts, enums their values."""
    if attrs.has(type(value)):
        return plain(attrs.asdict(value, recurse=False))
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items() if not str(key).startswith("_")}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return getattr(value, "value", value)


def _close(actual: Any, expected: Any, tolerance: float) -> bool:
    """Return whether `actual` has all entries of `expected`, with numbers equal within `tolerance`."""
    if isinstance(expected, Mapping):
        return isinstance(actual, dict) and all(
            [name in actual and _close(actual[name], item, tolerance) for name, item in expected.items()]
        )
    if isinstance(expected, list):
        return (
            isinstance(actual, list)
            and len(actual) == len(expected)
            and all([_close(a, b, tolerance) for a, b in zip(actual, expected, strict=True)])
        )
    if isinstance(expected, int | float) and not isinstance(expected, bool):
        return isinstance(actual, int | float) and isclose(actual, expected, rel_tol=0.0, abs_tol=tolerance)
    return bool(actual == expected)
