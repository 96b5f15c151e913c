"""Export to MCAP, a file format of robotics recordings (mcap.dev), for viewers such as Foxglove; needs `mcap`.

Every message is JSON with a JSON schema, and has `t`, the exact time on the recording's clock, s. Topics:

| topic | content | log time |
|---|---|---|
| `/SITE/packets/CHANNEL` | packets as they arrived, `data` in base64 | arrival |
| `/SITE/samples` | samples that the session used, SI units; `pressure` is the sum over the cells | sample time |
| `/SITE/pose` | position and velocity at each sample, world frame; phase by name and number | sample time |
| `/SITE/gait` | heel-strikes, foot-flats, heel-offs, toe-offs | event time |
| `/SITE/strides` | final strides | end of the stride |
| `/events` | every event as in `events.jsonl` | event time |

The publish time is `known_at`. Log times count from 1970 if the recording has its start time, else from the zero of the
receiver's clock. The metadata record `solepath` holds the keys of the recording's header."""

from __future__ import annotations

import json
from base64 import b64encode
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from datetime import UTC, datetime, timedelta
from importlib.metadata import version
from importlib.resources import files
from io import BufferedWriter
from math import isfinite
from pathlib import Path
from typing import Any

from mcap.writer import CompressionType, Writer

from ..events import Event, FootFlat, FootMoved, HeelOff, HeelStrike, LiveEvent, StrideTaken, ToeOff
from ..events.happening import json_ready
from ..link.driver import Driver
from ..session import Session
from ..types import SITE_OF_FOOT, Packet, Phase, Sample
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
PHASE_NUMBERS = {phase: number for number, phase in enumerate(Phase)}
"""Number of each phase."""
EPOCH, MICROSECOND = datetime(1970, 1, 1, tzinfo=UTC), timedelta(microseconds=1)


SCHEMAS: dict[str, Any] = json.loads(files("solepath.recording").joinpath("mcap.json").read_text("utf-8"))
"""JSON schema of each kind of message."""


class McapWriter:
    """Writes packets, and the samples and events that a session computes from them, as MCAP.

        with McapWriter("walk.mcap", read_header("walk.jsonl")) as writer:
            for packet in read_packets("walk.jsonl"):
                writer.write(packet)

    A file with content is not replaced: RecordingError is raised at once. With `replace=True` it is replaced when the
    first packet is written. From the start to `close` the file is locked, as by PacketWriter. `header`: header of the
    recording that the packets come from. `profiles`: drivers of an app's own devices, as for Session. `count`:
    number of packets written. `outside`: number of timestamps that were outside the range of log times, and replaced by
    the nearest log time. RecordingError when the file cannot be written, ValueError for a packet whose time is not
    finite. `close` writes the session's last results, and the index; a file that was never closed has complete chunks
    but no index."""

    def __init__(
        self,
        path: Path | str,
        header: Mapping[str, Any] = {},
        *,
        profiles: Iterable[Driver] = (),
        replace: bool = False,
    ) -> None:
        self.path, self.count, self.outside = Path(path), 0, 0
        self._header = dict(header)
        self._posed = PosedSession(Session(poses=True, profiles=profiles))
        self._session = self._posed.session
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self._sequences = Counter[int]()
        self._zero_time: int | None = None
        """Time since 1970 at `t` = 0, ns; None until the first packet."""
        file, self._had_content = open_target(self.path, "" if replace else "McapWriter")
        self._file = BufferedWriter(file)
        self._writer = Writer(self._file, chunk_size=CHUNK_SIZE, compression=CompressionType.ZSTD)
        if not self._had_content:
            with self._as_recording_error():
                self._start()

    def _start(self) -> None:
        """Write the start of the file, and the header of the recording."""
        self._writer.start(profile="", library=f"solepath {version('solepath')}")
        metadata = {"format": FORMAT, "version": VERSION, **self._header}
        texts = {key: value if isinstance(value, str) else json.dumps(value) for key, value in metadata.items()}
        self._writer.add_metadata("solepath", {_valid_utf8(key): _valid_utf8(text) for key, text in texts.items()})
        self._file.flush()

    def write(self, packet: Packet) -> None:
        """Write the packet, its samples and its events."""
        if not isfinite(packet.t):
            raise ValueError(f"a packet at {packet.t} s cannot be recorded")
        if self._zero_time is None:
            self._zero_time = _find_zero_time(self._header, packet.t)
        site = packet.site.value
        data: dict[str, Any] = {"t": packet.t, "data": b64encode(packet.data).decode()}
        if packet.device:
            data["device"] = packet.device
        with self._as_recording_error():
            if self._had_content:
                self._file.truncate(0)
                self._had_content = False
                self._start()
            topic = f"/{site}/packets/{_valid_utf8(packet.channel)}"
            if topic not in self._channels and len(self._channels) >= MAX_TOPICS:
                topic = f"/{site}/packets"  # the number of channels in a damaged recording is not limited
            metadata = {"site": site, "channel": _valid_utf8(packet.channel)}
            self._write_message(topic, "Packet", packet.t, packet.t, data, metadata)
            self.count += 1
            self._write_results(self._session.feed(packet))

    def close(self) -> None:
        """Write the session's last results, and the index; an earlier file that no packet replaced stays."""
        if self._file.closed:
            return
        if self._had_content:
            self._file.close()
            return
        try:
            with self._as_recording_error():
                self._write_results(self._session.finish())
                self._writer.finish()  # type: ignore[no-untyped-call]
                self._file.flush()
        finally:
            with suppress(OSError):  # the error was reported before
                self._file.close()

    def __enter__(self) -> McapWriter:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def _write_results(self, events: list[Event]) -> None:
        """Write the new samples of the session, and then its events."""
        for posed in self._posed.take():
            self._write_sample(posed.sample)
        for event in events:
            self._write_event(event)

    def _write_sample(self, sample: Sample) -> None:
        data = {
            "t": sample.t,
            "acc": _named("xyz", sample.acc),
            "gyro": _named("xyz", sample.gyro),
            "mag": _named("xyz", sample.mag),
            "quat": _named("wxyz", sample.quat),
            "pressure": None if sample.pressure is None else sum(sample.pressure),
            "air_pressure": sample.air_pressure,
            "saturated": sample.saturated or None,
        }
        present = {key: value for key, value in data.items() if value is not None}
        self._write_message(f"/{sample.site.value}/samples", "Sample", sample.t, sample.known_at, present)

    def _write_event(self, event: Event) -> None:
        if not isinstance(event, LiveEvent):
            self._write_message("/events", "Event", event.t, event.known_at, event.to_dict())
        data: dict[str, Any] = {"t": event.t}
        match event:
            case FootMoved(phase=phase):
                topic, kind = "pose", "Pose"
                data |= {"position": _named("xyz", event.position), "velocity": _named("xyz", event.velocity)}
                data |= {"phase": phase.value, "phase_number": PHASE_NUMBERS[phase]}
            case HeelStrike() | FootFlat() | HeelOff() | ToeOff():
                topic, kind, data["event"] = "gait", "Gait", type(event).__name__
            case StrideTaken(final=True):
                topic, kind = "strides", "Stride"
                data |= {"number": event.number, "t_start": event.t_start, "stride_length": event.length}
                data |= {"heading_change": event.heading_change, "height_change": event.height_change}
                data |= {"position": _named("xyz", event.position), "degraded": event.degraded}
            case _:
                return
        self._write_message(f"/{SITE_OF_FOOT[event.foot].value}/{topic}", kind, event.t, event.known_at, data)

    def _write_message(
        self, topic: str, kind: str, t: float, known_at: float, data: Any, metadata: dict[str, str] | None = None
    ) -> None:
        if topic not in self._channels:
            name = f"solepath.{kind}"
            if name not in self._schemas:
                definition = json.dumps({"title": name} | SCHEMAS[name]).encode()
                self._schemas[name] = self._writer.register_schema(name, "jsonschema", definition)
            self._channels[topic] = self._writer.register_channel(topic, "json", self._schemas[name], metadata or {})
        channel = self._channels[topic]
        self._sequences[channel] += 1
        try:
            text = json.dumps(data, allow_nan=False)
        except ValueError:  # a device may send a float that is not finite
            text = json.dumps(json_ready(data))
        times = self._to_log_time(t), self._to_log_time(known_at)
        self._writer.add_message(channel, times[0], text.encode(), times[1], self._sequences[channel] & 0xFFFF_FFFF)

    def _to_log_time(self, t: float) -> int:
        ns = (self._zero_time or 0) + round(max(-MAX_TIME, min(MAX_TIME, t)) * 1e9)
        if 0 <= ns <= MAX_LOG_TIME:
            return ns
        self.outside += 1
        return max(0, min(MAX_LOG_TIME, ns))

    @contextmanager
    def _as_recording_error(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            with suppress(OSError):
                self._file.close()
            raise RecordingError(self.path, f"{os_error_text(error)}; {self.count} packets were taken") from error


def _find_zero_time(header: Mapping[str, Any], first_t: float) -> int:
    """Return the time since 1970 at `t` = 0, ns, of a recording whose first packet is at `first_t`, s; 0 if unknown."""
    start = read_start_time(header)
    if start is None:
        return 0
    moment, t = start
    t_start = first_t if t is None else t
    return (moment - EPOCH) // MICROSECOND * 1000 - round(max(-MAX_TIME, min(MAX_TIME, t_start)) * 1e9)


def _named(names: str, values: Sequence[float] | None) -> dict[str, float] | None:
    """Return the components of a vector or quaternion by their names; None without one."""
    return None if values is None else dict(zip(names, values, strict=True))


def _valid_utf8(text: str) -> str:
    """Return `text` without characters that UTF-8 cannot encode; JSON may hold half a surrogate pair."""
    return text.encode("utf-8", "replace").decode("utf-8")
