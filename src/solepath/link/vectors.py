"""A declared device against its vectors (protocol/README.md, "Vectors"): do they say the same?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isclose
from typing import Any

import attrs

from ..wire.error import WireError
from ..wire.fields import parse_whole
from .driver import Driver


def disagreements(driver: Driver, file: Mapping[str, Any]) -> list[str]:
    """A sentence for everything in which a vector file (as json.load gives it) and the driver disagree; none is good.

    `fields` of a valid vector are what the channel's construct parses, and build the same bytes again. `physical` may
    name fields of the Reading, to `tolerance`, read with `known`. An invalid vector is refused for its `reason`.
    """
    channel = file["channel"]
    if channel not in driver.formats:
        return [f"no channel {channel!r}"]
    found = [] if file["count"] == len(file["vectors"]) else [f"{len(file['vectors'])} vectors, not {file['count']}"]
    for vector in file["vectors"]:
        found += [f"{vector['id']}: {what}" for what in _differs(driver, channel, vector)]
    return found


def _differs(driver: Driver, channel: str, vector: Mapping[str, Any]) -> Iterator[str]:
    data = bytes.fromhex(vector["hex"])
    physical = vector.get("physical", {})
    try:
        parsed = plain(parse_whole(driver.formats[channel], data))
        reading = driver.read(channel, data, physical.get("known", {}))
    except WireError as error:
        if vector["result"] == "valid" or error.reason.value != vector["reason"]:
            yield str(error)
        return
    if vector["result"] != "valid":
        yield f"taken, and should be {vector['reason']}"
        return
    if parsed != vector["fields"]:
        yield f"says {parsed}"
    built = driver.write(channel, vector["fields"])
    if built != data:
        yield f"is built as {built.hex()}"
    for name, value in physical.items():
        if name not in ("tolerance", "known") and not _close(
            plain(getattr(reading, name)), value, physical["tolerance"]
        ):
            yield f"{name} is {plain(getattr(reading, name))}"


def plain(value: Any) -> Any:
    """As JSON has it: records and construct's Containers as dicts, sequences as lists, enums as their values."""
    if attrs.has(type(value)):
        return plain(attrs.asdict(value, recurse=False))
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items() if not str(key).startswith("_")}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return getattr(value, "value", value)


def _close(found: Any, expected: Any, tolerance: float) -> bool:
    """Whether `found` has all that `expected` names, numbers to `tolerance`."""
    if isinstance(expected, Mapping):
        return isinstance(found, dict) and all(
            [name in found and _close(found[name], item, tolerance) for name, item in expected.items()]
        )
    if isinstance(expected, list):
        return (
            isinstance(found, list)
            and len(found) == len(expected)
            and all([_close(a, b, tolerance) for a, b in zip(found, expected, strict=True)])
        )
    if isinstance(expected, int | float) and not isinstance(expected, bool):
        return isinstance(found, int | float) and isclose(found, expected, rel_tol=0.0, abs_tol=tolerance)
    return bool(found == expected)
