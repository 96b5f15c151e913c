"""Samples of a sensor on a foot from a stream of the lab streaming layer, whatever program sends it.

    inlet = LslInlet(Site.LEFT_FOOT, "my sensor", offset=clock_offset(loop.time))
    while True:
        for sample in inlet.pull():
            events = session.feed(sample)

The stream describes its channels by labels and units, as its metadata have them in XDF files: acc_x, AccX,
accelerometer 1 and the like, in m/s^2 or g; gyro in rad/s or deg/s. A stream without labels or units needs `channels`
and `units`. Time stamps are those of the sender, corrected to this machine's clock by LSL (`proc_clocksync`)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pylsl import StreamInfo, StreamInlet, local_clock, proc_clocksync, resolve_byprop, resolve_streams
from pylsl.util import LostError
from pylsl.util import TimeoutError as LslTimeout

from ...types import Sample, Site, Vec3
from ..mapping.units import UNITS, unit_of
from ..mapping.words import key_of_name

SEARCH_TIME = 15.0
"""Time of the search for a stream, s; streams of an idle machine answer within 0.1 s, of a busy one in seconds."""
MAX_CHUNK = 1024
"""Number of samples that are taken from the queue at a time."""


class LslError(Exception):
    """Error for a stream that is not there, or that has no samples of an inertial sensor; its text is a sentence."""


class LslInlet:
    """The samples of the stream with this name, on `site`; the stream has to exist.

    `offset` is the time to add to a time of the session, s, to get one of LSL (`clock_offset`). `channels` are the
    labels of the stream's channels in order, such as acc_x, with any other text for a channel that is not used;
    `units`: the unit of "acc" and of "gyro". Without them the stream has to say both. LslError when there is no such
    stream within `timeout`, s, when there are several, and when its channels are not known."""

    def __init__(
        self,
        site: Site,
        name: str,
        *,
        offset: float = 0.0,
        channels: Sequence[str] | None = None,
        units: Mapping[str, str] | None = None,
        timeout: float = SEARCH_TIME,
    ) -> None:
        self.site, self.name, self.offset = site, name, offset
        self.received = 0
        """Number of samples that were received."""
        for quantity, unit in (units or {}).items():
            _find_factor(quantity, unit, quantity)
        found = resolve_byprop("name", name, minimum=1, timeout=timeout)
        if not found:
            others = ", ".join(sorted({info.name() for info in resolve_streams()})) or "none"
            raise LslError(f"there is no stream {name!r}; there are: {others}")
        if len({info.uid() for info in found}) > 1:
            hosts = ", ".join(sorted({info.hostname() for info in found}))
            raise LslError(f"there are {len(found)} streams {name!r}, on {hosts}: their names have to differ")
        self._inlet = StreamInlet(found[0], processing_flags=proc_clocksync)
        try:
            described = self._inlet.info(timeout)
            self._columns = _find_columns(described, channels, units or {})
            self._inlet.open_stream(timeout)
            self._inlet.time_correction(timeout)  # the first one takes longest, before samples wait for it
        except (LslTimeout, LostError):
            raise LslError(f"the stream {name!r} does not answer") from None

    def pull(self) -> list[Sample]:
        """Return the samples that came since the last call, without waiting; LslError when the stream has ended."""
        samples: list[Sample] = []
        while True:
            try:
                values, times = self._inlet.pull_chunk(timeout=0.0, max_samples=MAX_CHUNK)
            except LostError:
                raise LslError(f"the stream {self.name!r} has ended") from None
            if not times:
                self.received += len(samples)
                return samples
            known_at = local_clock() - self.offset
            for row, stamp in zip(values, times, strict=True):
                acc, gyro = (_vector(row, *columns) for columns in self._columns)
                t = stamp - self.offset
                samples.append(Sample(t, self.site, acc, gyro, known_at=max(t, known_at)))

    def close(self) -> None:
        """End the reception."""
        self._inlet.close_stream()


def stream_names() -> list[str]:
    """Return the names of the streams in the network that are not of markers, in alphabetical order."""
    return sorted({info.name() for info in resolve_streams() if info.type() not in ("Markers", "Events")})


def _vector(row: Sequence[float], numbers: Sequence[int], scale: float) -> Vec3:
    x, y, z = [scale * float(row[number]) for number in numbers]
    return x, y, z


def _find_columns(
    info: StreamInfo, channels: Sequence[str] | None, units: Mapping[str, str]
) -> list[tuple[list[int], float]]:
    """Return the channels x, y and z of specific force and angular rate, and the value of the unit in SI units."""
    labels = channels if channels is not None else info.get_channel_labels() or []
    kinds, stated = info.get_channel_types() or [], info.get_channel_units() or []
    found: dict[str, dict[str, int]] = {"acc": {}, "gyro": {}}
    for number, label in enumerate(labels):
        meanings = [key_of_name(text) for text in (label or "", f"{kinds[number] if kinds else ''} {label}")]
        key, axis = next((one for one in meanings if one[1]), ("", ""))
        found.get(key.partition("_")[0], {}).setdefault(axis, number)
    columns = []
    for quantity, numbers in found.items():
        if set(numbers) != {*"xyz"}:
            texts = ", ".join([label or "-" for label in labels]) or f"{info.channel_count()} without labels"
            raise LslError(f"the stream {info.name()!r} has no {quantity}_x, _y and _z; its channels are: {texts}")
        unit = units.get(quantity) or next(filter(None, [stated[k] for k in numbers.values() if stated]), "none")
        factor = _find_factor(quantity, unit, f"{quantity} of the stream {info.name()!r}")
        columns.append(([numbers[axis] for axis in "xyz"], factor))
    return columns


def _find_factor(quantity: str, unit: str, whose: str) -> float:
    """Return the value of a unit in SI units; raise LslError, which says whose unit it is, when it is not known."""
    known = unit_of(unit, quantity)
    if known is None:
        raise LslError(f"the unit of {whose} is {unit}, not one of {', '.join(UNITS[quantity])}")
    return UNITS[quantity][known]
