"""Export to MCAP, a file format of robotics recordings (mcap.dev), for viewers such as Foxglove; needs `mcap`.

Every message is JSON with a JSON schema, and has `t`, the exact time on the recording's clock, s. Topics:

| topic | content | log time |
|---|---|---|
| `/SITE/packets/CHANNEL` | packets as they arrived, `data` in base64 | arrival |
| `/SITE/samples` | samples that the session used, SI units | sample time |
| `/SITE/EVENT`, or `/EVENT` | each event as in `events.jsonl`; `FootMoved` is the live pose | event time |

The publish time is `known_at`. Log times count from 1970 if the recording has its start time, else from the zero of the
receiver's clock. The metadata record `solepath` holds the keys of the recording's header."""

from __future__ import annotations

import json
from base64 import b64encode
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from datetime import UTC, datetime, timedelta
from importlib.metadata import version
from io import BufferedWriter
from math import isfinite
from pathlib import Path
from typing import Any

from mcap.writer import CompressionType, Writer

from ..events import Event
from ..events.happening import json_ready
from ..link.driver import Driver
from ..session import Session
from ..types import SITE_OF_FOOT, Foot, Packet
from ..types.records import MAX_TIME
from .errors import RecordingError, os_error_text
from .packet_writer import open_target
from .packets import FORMAT, VERSION, read_start_time
from .posed import PosedSession

CHUNK_SIZE = 8192
"""Size of a chunk before compression, bytes; a file that was cut off loses one chunk, about 1 s of two insoles."""
MAX_TOPICS = 1000
"""Largest number of topics; packets of further channels have one topic per site."""
MAX_LOG_TIME = 2**63 - 1
"""Largest log time, ns; a log time has 64 bits without sign, but viewers accept only the lower half."""
EPOCH, MICROSECOND = datetime(1970, 1, 1, tzinfo=UTC), timedelta(microseconds=1)


class McapWriter:
    """Writes packets, and the samples and events that a session computes from them, as MCAP.

        with McapWriter("walk.mcap", read_header("walk.jsonl")) as writer:
            for packet in read_packets("walk.jsonl"):
                writer.write(packet)

    A file with content is not replaced: RecordingError is raised at once. From the start to `close` the file is locked,
    as by PacketWriter. `header`: header of the recording that the packets come from. `profiles`: drivers of an app's
    own devices, as for Session. `count`: number of packets written. A time outside the range of log times is replaced
    by the nearest log time. RecordingError when the file cannot be written, ValueError for a packet whose time is not
    finite. `close` writes the session's last results, and the index; a file that was never closed has complete chunks
    but no index."""

    def __init__(self, path: Path | str, header: Mapping[str, Any] = {}, *, profiles: Iterable[Driver] = ()) -> None:
        self.path, self.count = Path(path), 0
        self._header = {"format": FORMAT, "version": VERSION, **header}
        self._posed = PosedSession(Session(poses=True, profiles=profiles))
        self._channels: dict[str, int] = {}
        self._sequences = Counter[int]()
        self._zero_time: int | None = None
        """Time since 1970 at `t` = 0, ns; None until the first packet."""
        file, _ = open_target(self.path, "remove it, or name another")
        self._file = BufferedWriter(file)
        self._writer = Writer(self._file, chunk_size=CHUNK_SIZE, compression=CompressionType.ZSTD)
        texts = {key: value if isinstance(value, str) else json.dumps(value) for key, value in self._header.items()}
        with self._as_recording_error():
            self._writer.start(profile="", library=f"solepath {version('solepath')}")
            self._writer.add_metadata("solepath", {_valid_utf8(key): _valid_utf8(text) for key, text in texts.items()})
            self._file.flush()

    def write(self, packet: Packet) -> None:
        """Write the packet, its samples and its events."""
        if not isfinite(packet.t):
            raise ValueError(f"a packet at {packet.t} s cannot be recorded")
        if self._zero_time is None:
            self._zero_time = _find_zero_time(self._header, packet.t)
        site, channel = packet.site.value, _valid_utf8(packet.channel)
        topic = f"/{site}/packets/{channel}"
        if topic not in self._channels and len(self._channels) >= MAX_TOPICS:
            topic = f"/{site}/packets"  # the number of channels in a damaged recording is not limited
        data = {"t": packet.t, "device": packet.device, "data": b64encode(packet.data).decode()}
        with self._as_recording_error():
            self._write_message(topic, packet.t, packet.t, data, {"site": site, "channel": channel})
            self.count += 1
            self._write_results(self._posed.session.feed(packet))

    def close(self) -> None:
        """Write the session's last results, and the index."""
        if self._file.closed:
            return
        with self._as_recording_error():
            self._write_results(self._posed.session.finish())
            self._writer.finish()  # type: ignore[no-untyped-call]
            self._file.close()

    def __enter__(self) -> McapWriter:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def _write_results(self, events: Iterable[Event]) -> None:
        """Write the new samples of the session, and then its events."""
        for sample in [posed.sample for posed in self._posed.take()]:
            present = {key: value for key, value in json_ready(sample).items() if value is not None}
            self._write_message(f"/{sample.site.value}/samples", sample.t, sample.known_at, present)
        for event in events:
            data = event.to_dict()
            place = f"/{SITE_OF_FOOT[Foot(data['foot'])].value}" if data.get("foot") else ""
            self._write_message(f"{place}/{data['event']}", event.t, event.known_at, data)

    def _write_message(
        self, topic: str, t: float, known_at: float, data: dict[str, Any], metadata: Mapping[str, str] = {}
    ) -> None:
        if topic not in self._channels:
            kind = f"solepath{topic.replace('/', '.')}"
            schema = self._writer.register_schema(kind, "jsonschema", json.dumps(_schema_of(data)).encode())
            self._channels[topic] = self._writer.register_channel(topic, "json", schema, dict(metadata))
        channel = self._channels[topic]
        self._sequences[channel] += 1
        times = self._to_log_time(t), self._to_log_time(known_at)
        text = json.dumps(data, allow_nan=False).encode()
        self._writer.add_message(channel, times[0], text, times[1], self._sequences[channel] & 0xFFFF_FFFF)

    def _to_log_time(self, t: float) -> int:
        return max(0, min(MAX_LOG_TIME, (self._zero_time or 0) + _nanoseconds(t)))

    @contextmanager
    def _as_recording_error(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            with suppress(OSError):
                self._file.close()
            raise RecordingError(self.path, f"{os_error_text(error)}; {self.count} packets were taken") from error


def _nanoseconds(t: float) -> int:
    return round(max(-MAX_TIME, min(MAX_TIME, t)) * 1e9)


def _find_zero_time(header: Mapping[str, Any], first_t: float) -> int:
    """Return the time since 1970 at `t` = 0, ns, of a recording whose first packet is at `first_t`, s; 0 if unknown."""
    start = read_start_time(header)
    if start is None:
        return 0
    moment, t = start
    return (moment - EPOCH) // MICROSECOND * 1000 - _nanoseconds(first_t if t is None else t)


def _schema_of(value: Any) -> dict[str, Any]:
    """Return the JSON schema of values like this one; a value that may be null has no type."""
    match value:
        case dict():
            return {"type": "object", "properties": {key: _schema_of(one) for key, one in value.items()}}
        case list():
            return {"type": "array", "items": _schema_of(value[0]) if value else {}}
        case bool() | str():
            return {"type": "boolean" if isinstance(value, bool) else "string"}
        case _:
            return {} if value is None else {"type": "number"}


def _valid_utf8(text: str) -> str:
    """Return `text` without characters that UTF-8 cannot encode; JSON may hold half a surrogate pair."""
    return text.encode("utf-8", "replace").decode("utf-8")
