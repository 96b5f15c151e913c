"""Streams of the lab streaming layer with what a session was fed and what it reported.

    outlets = LslOutlets(clock_offset(loop.time))
    posed = PosedSession(Session(poses=True))
    for packet in packets:
        events = posed.session.feed(packet)
        outlets.push(posed.take(), events)

| stream | type | content |
|---|---|---|
| `solepath markers` | Markers | one text for each gait event, stride, turn and activity: "HeelStrike left", "WALKING" |
| `solepath events` | Events | every event as in events.jsonl, one JSON object |
| `solepath SITE samples` | IMU | acc_x,y,z in m/s^2 and gyro_x,y,z in rad/s of each sample that has both |
| `solepath SITE pose` | MoCap | position, velocity, attitude (w, x, y, z) and number of the phase, world frame |

Every value has the time at which it happened, not that at which it was known: LSL takes time stamps in the past. All
streams are of irregular rate, for a device's own clock gives the time of each sample."""

from __future__ import annotations

import json
from collections.abc import Iterable

from pylsl import IRREGULAR_RATE, StreamInfo, StreamOutlet, cf_double64, cf_string

from ...events import ActivityChanged, Event, FootFlat, HeelOff, HeelStrike, LiveEvent, StrideTaken, ToeOff, TurnMade
from ...types import Phase, Site
from ..posed import PosedSample

SAMPLE_CHANNELS = tuple([(f"acc_{axis}", "m/s^2") for axis in "xyz"] + [(f"gyro_{axis}", "rad/s") for axis in "xyz"])
"""Label and unit of each channel of a stream of samples."""
POSE_CHANNELS = (
    *[(f"position_{axis}", "m") for axis in "xyz"],
    *[(f"velocity_{axis}", "m/s") for axis in "xyz"],
    *[(f"attitude_{component}", "1") for component in "wxyz"],
    ("phase", "1"),
)
"""Label and unit of each channel of a stream of poses."""
PHASE_NUMBERS = {phase: float(number) for number, phase in enumerate(Phase)}
"""Number of each phase in a pose: 0 LOADING, 1 STATIONARY, 2 PUSH_OFF, 3 SWING."""
MAX_BUFFERED = 360
"""Length of the queue of a receiver that does not read, s at 100 samples a second; older values are then lost."""


class LslOutlets:
    """The streams of one session; those of a sensor are made with its first sample.

    `offset` is the time to add to a time of the session, s, as `clock_offset` measures it. `name` starts the name of
    each stream; it has to differ between wearers in one network. `with_samples` says whether samples are sent too.
    `sent` counts the values by stream."""

    def __init__(self, offset: float, name: str = "solepath", *, with_samples: bool = True) -> None:
        self.offset, self.name, self.with_samples = offset, name, with_samples
        self.sent: dict[str, int] = {}
        self._outlets: dict[str, StreamOutlet] = {}
        self._open("markers", "Markers", (("marker", ""),))
        self._open("events", "Events", (("json", ""),))

    def push(self, samples: Iterable[PosedSample], events: Iterable[Event]) -> None:
        """Send samples, poses and events; receivers get them at once."""
        for posed in samples:
            sample, state, site = posed.sample, posed.state, posed.sample.site
            if self.with_samples and sample.acc is not None and sample.gyro is not None:
                self._send(
                    self._of_site(site, "samples", "IMU", SAMPLE_CHANNELS), [*sample.acc, *sample.gyro], sample.t
                )
            if state is not None:
                values = [*state.position, *state.velocity, *state.attitude, PHASE_NUMBERS[state.phase]]
                self._send(self._of_site(site, "pose", "MoCap", POSE_CHANNELS), values, sample.t)
        for event in events:
            if not isinstance(event, LiveEvent):
                self._send("events", [json.dumps(event.to_dict(), allow_nan=False)], event.t)
            if (text := marker_of(event)) is not None:
                self._send("markers", [text], event.t)

    def close(self) -> None:
        """End all streams."""
        self._outlets.clear()

    def _of_site(self, site: Site, content: str, kind: str, channels: tuple[tuple[str, str], ...]) -> str:
        name = f"{site.value} {content}"
        if name not in self._outlets:
            self._open(name, kind, channels)
        return name

    def _open(self, name: str, kind: str, channels: tuple[tuple[str, str], ...]) -> None:
        full_name = f"{self.name} {name}"
        form = cf_string if kind in ("Markers", "Events") else cf_double64
        # with an id of the source, a receiver finds the stream again after this program was started anew
        info = StreamInfo(full_name, kind, len(channels), IRREGULAR_RATE, form, full_name)
        info.set_channel_labels([label for label, _ in channels])
        info.set_channel_units([unit for _, unit in channels])
        info.set_channel_types(kind)
        info.desc().append_child_value("manufacturer", "solepath")
        self._outlets[name] = StreamOutlet(info, max_buffered=MAX_BUFFERED)
        self.sent[name] = 0

    def _send(self, name: str, values: list[float] | list[str], t: float) -> None:
        self._outlets[name].push_sample(values, t + self.offset)
        self.sent[name] += 1


def marker_of(event: Event) -> str | None:
    """Return the text of an event in the stream of markers; None for an event that is none, or not final."""
    if not event.final:
        return None
    if isinstance(event, HeelStrike | FootFlat | HeelOff | ToeOff | StrideTaken):
        return f"{type(event).__name__} {event.foot.value}"
    if isinstance(event, TurnMade):
        return None if event.turn is None else f"TurnMade {event.turn.value}"
    return event.activity.value if isinstance(event, ActivityChanged) else None
