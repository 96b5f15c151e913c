"""Conversion of a phone's items and a session's events to rows of tables and lines of files, and back.

protocol/fleet.md describes every column."""

from __future__ import annotations

import json
from binascii import unhexlify
from collections.abc import Mapping
from contextlib import suppress
from operator import index
from typing import Any, SupportsIndex

from ..types import Packet, Site
from .events import SentRejection
from .step.order import RejectedItem, check_payload
from .step.sent import MAX_COUNT, MAX_NAME_LENGTH, End, NumberedEvent, Sent, Tick, Unreadable

SENT_COLUMNS: Mapping[str, type] = {
    "wearer": str, "run": int, "number": int, "t": float, "site": str, "channel": str, "data": bytes, "device": str,
}  # fmt: skip
"""Columns of `sent_row` with their types; t, site, data and device may be None."""
EVENT_COLUMNS: Mapping[str, type] = {
    "wearer": str, "number": int, "event": str, "t": float, "known_at": float, "final": bool, "foot": str,
    "fields": str,
}  # fmt: skip
"""Columns of `event_row` with their types; t, known_at and foot may be None."""

_SITES = {site.value: site for site in Site}
MAX_LINE_LENGTH = 65_536
"""Longest line without its line feed, bytes."""
MAX_LINES = 4096
"""Largest number of lines in one message.

A message with more is rejected as a whole, since every line that cannot be read is reported."""


class _RowFlaw(Exception):
    """Raised with the reason why a row cannot be read."""


def sent_row(sent: Sent) -> dict[str, Any]:
    """Return an item that a phone sends as a row with the columns of SENT_COLUMNS."""
    row = {**dict.fromkeys(SENT_COLUMNS), "wearer": sent.wearer, "run": sent.run, "number": sent.number}
    match sent.what:
        case Packet(t, site, channel, data, device):
            return row | {"t": t, "site": site.value, "channel": channel, "data": data, "device": device or None}
        case Tick(t):
            return row | {"t": t, "channel": "tick"}
        case End():
            return row | {"channel": "end"}


def read_sent(row: Any) -> Sent | Unreadable:
    """Return the item in a row, or Unreadable with the reason and the fields that can be read; never raise."""
    wearer, number, run = "", None, 0
    try:
        if not isinstance(row, Mapping):
            raise _RowFlaw(f"a row is a mapping, not a {type(row).__name__}")
        wearer = _check_text(row.get("wearer"), "wearer")
        run = _read_count(row, "run", 0)
        number = _read_count(row, "number", None)
        what = _read_payload(row)
        checked = check_payload(what)
        if not isinstance(checked, RejectedItem):
            what = checked
        elif checked.reason is not SentRejection.NOT_FINITE:  # which is reported in its turn
            raise _RowFlaw(checked.detail)
        return Sent(wearer, number, what, run)
    except _RowFlaw as flaw:
        return Unreadable(wearer, str(flaw), run, number)


def _read_payload(row: Mapping[str, Any]) -> Packet | Tick | End:
    """Return the payload of a row; its values may be of wrong types."""
    values: Any = [row.get(key) for key in ("channel", "site", "t", "data")]
    channel, site, t, data = values
    if site is None and channel == "end":
        return End()
    if site is None and channel == "tick":
        return Tick(t)
    if not isinstance(site, str) or site not in _SITES:
        raise _RowFlaw(f"site is not one of {', '.join(_SITES)}")
    device = "" if row.get("device") is None else row["device"]
    return Packet(t, _SITES[site], _check_text(channel, "channel"), data, _check_text(device, "device"))


def _check_text(value: Any, key: str) -> str:
    if not isinstance(value, str):
        raise _RowFlaw(f"{key} is no text but a {type(value).__name__}")
    if len(value) > MAX_NAME_LENGTH:
        raise _RowFlaw(f"{key} of {len(value)} characters; {MAX_NAME_LENGTH} are the most")
    try:
        value.encode()
    except UnicodeEncodeError:
        raise _RowFlaw(f"{key} holds half a character") from None
    return value


def _read_count(row: Mapping[str, Any], key: str, default: int | None) -> int:
    value = row.get(key)
    if value is None and default is not None:
        return default
    if isinstance(value, bool) or not isinstance(value, SupportsIndex):
        raise _RowFlaw(f"{key} is no whole number but a {type(value).__name__}")
    value = index(value)
    if not 0 <= value <= MAX_COUNT:
        raise _RowFlaw(f"{key} is not from 0 to 2**53 - 1")
    return value


def sent_line(sent: Sent) -> bytes:
    """Return an item as one line of JSON with its line feed; raise ValueError for a time that is not finite."""
    row = sent_row(sent)
    if row["data"] is not None:
        row["data"] = row["data"].hex()
    fields = {key: value for key, value in row.items() if value is not None and (key != "run" or value != 0)}
    return _ENCODER.encode(fields).encode() + b"\n"


def read_line(line: Any) -> Sent | Unreadable:
    """Return the item in a line, or Unreadable with the reason; never raise."""
    try:
        row = _parse_object(line)
    except _RowFlaw as flaw:
        return Unreadable("", str(flaw))
    data = row.get("data")
    if isinstance(data, str):
        with suppress(ValueError):
            row["data"] = unhexlify(data)
    return read_sent(row)


def read_message(wearer: str, value: Any) -> list[Sent | Unreadable]:
    """Return the items in a message of `wearer`, the lines of bytes, or Unreadable with the reason; never raise.

    A line of another wearer is Unreadable without a number, so that it takes no place in the order of this one."""
    lines = [line for line in value.split(b"\n") if line.strip()] if isinstance(value, bytes | bytearray) else []
    if not 0 < len(lines) <= MAX_LINES:
        return [Unreadable(wearer, f"a message of {len(lines)} lines; 1 to {MAX_LINES} can be read")]
    mismatched = Unreadable(wearer, "a line of another wearer than its message")
    return [item if item.wearer in (wearer, "") else mismatched for item in map(read_line, lines)]


def _parse_object(line: Any) -> dict[str, Any]:
    if not isinstance(line, bytes | bytearray):
        raise _RowFlaw(f"a line is bytes, not a {type(line).__name__}")
    if len(line) > MAX_LINE_LENGTH:
        raise _RowFlaw(f"a line of {len(line)} bytes; {MAX_LINE_LENGTH} are the most")
    try:
        value = _DECODER.decode(line.decode())
    except (ValueError, RecursionError):
        raise _RowFlaw("a line that is not JSON") from None
    if not isinstance(value, dict):
        raise _RowFlaw("a line that is not a JSON object")
    return value


def _reject_constant(name: str) -> None:
    raise _RowFlaw(f"a line with {name}, which is not JSON")


_DECODER = json.JSONDecoder(parse_constant=_reject_constant)
_ENCODER = json.JSONEncoder(allow_nan=False, separators=(",", ":"))


def event_row(numbered: NumberedEvent) -> dict[str, Any]:
    r"""Return an event as a row with the columns of EVENT_COLUMNS.

    `fields` holds the other fields of the event as JSON, with the names of events.jsonl. An unpaired surrogate in the
    wearer's name is written `\\ud800`, since a table holds UTF-8."""
    record = numbered.event.to_dict()
    columns = {name: record.pop(name, None) for name in EVENT_COLUMNS if name not in ("wearer", "number", "fields")}
    wearer = numbered.wearer.encode("utf-8", "backslashreplace").decode()
    return {"wearer": wearer, "number": numbered.number, **columns, "fields": json.dumps(record)}
