"""The insole (protocol/insole.md): frames become samples (protocol/clock.md), INFO gives scales and cell layout.

It has its own link class and no Driver, because frames may come in fragments and must have the layout of INFO."""

from __future__ import annotations

from hashlib import blake2b
from math import radians
from operator import itemgetter
from typing import ClassVar

from ...events import LayoutKnown, PacketRejected, Rejection
from ...types import Floats, Layout, Sample, Site, shared
from ...types.attrs import define, field
from ...types.vector import GRAVITY, unit
from ...wire.envelope import MAGIC
from ...wire.error import WireError
from ...wire.fragment import Reassembly, is_fragment, parse_fragment
from ...wire.insole import InsoleFrame, parse_frame
from ...wire.insole_control import StartSampling, build_control, parse_control
from ...wire.insole_info import InsoleInfo, parse_info
from ..counters import PacketPosition, PacketRun, signed_difference
from ..driver import FULL_SCALE_COUNTS
from ..kinds import DeviceKind, DeviceLink, Output
from ..profile import BATTERY, FIRMWARE, Access, Channel, Profile, Write

ASSUMED_ACC_SCALE = 16.0 * GRAVITY / FULL_SCALE_COUNTS
"""Accelerometer scale before INFO comes, m/s^2 per count: 16 g full scale."""
ASSUMED_GYRO_SCALE = radians(2000.0) / FULL_SCALE_COUNTS
"""Gyroscope scale before INFO comes, rad/s per count: 2000 degrees/s full scale."""
TICK_RATE = 32768
"""Ticks per second before INFO comes (protocol/clock.md)."""
NO_INFO = "no INFO from the insole: 16 g and 2000 degrees/s full scale assumed, pressure in counts"
"""Limitation of an insole whose INFO did not come."""
SEQUENCE_MODULUS, TICK_MODULUS = 1 << 16, 1 << 32
"""Values at which a frame's sequence and ticks wrap to 0."""
WHOLE_FRAME_START = bytes([MAGIC])
"""First byte of a frame that is not fragmented."""
FULL_PRESSURE_COUNTS = 4095.0
"""Counts of a pressure cell at full scale."""
MOST_TABLES = 16
"""Largest number of scales whose forces are in a table: 131 kB each, shared by all insoles with this scale.

To make a table takes as long as 50 samples of 96 cells. A look-up then takes less than a product for each cell, with
which the forces of further scales are computed."""
_TABLES: dict[float, Floats] = {}
"""Force of each count, N, by scale, N per count."""


def _uuid(short: int) -> str:
    return f"6016{short:04x}-c8fb-4908-9b03-31fbe15925c4"


PROFILE = Profile(
    name="insole",
    names=(),
    services=(_uuid(1),),
    channels=(
        Channel("insole/frame", _uuid(1), _uuid(2), Access.NOTIFY),
        Channel("insole/info", _uuid(1), _uuid(3), Access.READ),
        Channel("insole/control", _uuid(1), _uuid(4), Access.WRITE),
        BATTERY,
        FIRMWARE,
    ),
    setup=(Write("insole/control", build_control(StartSampling())),),
    reads=("insole/info", "device/firmware", "device/battery"),
    nominal_rate=100.0,
    streams=("insole/frame",),
    stale_after=1.0,
)


@define
class InsoleLink(DeviceLink):
    """The link of an insole: channels insole/frame, insole/info and insole/control of one foot.

    `feed` raises WireError for a value that cannot be used, and then changes nothing. There is no latency.
    Before INFO comes, full scales of 16 g and 2000 degrees/s are assumed, pressure stays in counts, and only frames
    with the layout of the first frame are accepted."""

    name: ClassVar[str] = "insole"
    may_be_silent: ClassVar[bool] = False

    site: Site
    info_digest: bytes = b""
    """Digest (eight bytes) of the newest INFO record; empty before the first."""
    layout: int | None = None
    """Id of the cell layout; None before INFO or a frame."""
    cells: int = 0
    """Number of pressure cells."""
    rate: int = TICK_RATE
    """Ticks per second."""
    acc_scale: float = ASSUMED_ACC_SCALE
    gyro_scale: float = ASSUMED_GYRO_SCALE
    pressure_scale: float = 0.0
    """Force of one count, N; 0 while pressure stays in counts."""
    limitation_reported: bool = False
    """True if the Limitation about missing INFO was reported."""
    packet_run: PacketRun = field(factory=PacketRun)
    reassembly: Reassembly = field(factory=Reassembly)

    @property
    def unsettled_until(self) -> float | None:
        """Newest time that is not comparable with times of other devices (clock.py), s."""
        return None if self.packet_run.clock is None else self.packet_run.clock.unsettled_until

    def feed(self, channel: str, data: bytes, arrival: float) -> Output:
        if channel == "insole/frame":
            if data[:1] != WHOLE_FRAME_START and is_fragment(data):
                return self._read_fragment(data, arrival)
            out = self._read_frame(parse_frame(data), arrival)
            if self.reassembly.newest_fragment is None:
                return out
            return [*self._report_dropped(self.reassembly.drop(), arrival), *out]
        if channel == "insole/info":
            return self._read_info(data, arrival)
        parse_control(data)  # a command to the insole, whose effect shows in frames and INFO
        return []

    def restart_clock(self) -> None:
        """Discard the clock fit, because the receiver's clock restarted."""
        self.packet_run.clock = None

    def handle_reconnection(self) -> None:
        """Discard an incomplete frame, and prepare for counters that restarted."""
        self.reassembly.drop()
        self.packet_run.after_reconnection = True

    def _read_fragment(self, data: bytes, arrival: float) -> Output:
        frame_data, drop_reason = self.reassembly.feed(parse_fragment(data))
        dropped = self._report_dropped(drop_reason, arrival)
        try:
            return [*dropped, *(self._read_frame(parse_frame(frame_data), arrival) if frame_data else ())]
        except WireError as error:  # the packet is rejected with its frame, and only the fragments are gone
            raise WireError(error.reason, error.detail, tuple(dropped)) from None

    def _report_dropped(self, detail: str | None, arrival: float) -> list[PacketRejected]:
        if detail is None:
            return []
        t, channel, reason = arrival, "insole/frame", Rejection.TRUNCATED
        return [PacketRejected(t=t, site=self.site, channel=channel, reason=reason, detail=detail)]

    def _read_info(self, data: bytes, arrival: float) -> Output:
        info = parse_info(data)
        if info.foot is not self.site.foot:
            raise WireError(Rejection.WRONG_SITE, f"INFO of a {info.foot.value} insole")
        _check_scales(info)
        digest = blake2b(data, digest_size=8).digest()
        if digest == self.info_digest:
            return []
        self.info_digest = digest
        self.layout, self.cells, self.rate = info.layout, len(info.cells), info.tick_rate
        self.acc_scale, self.gyro_scale, self.pressure_scale = info.acc_scale, info.gyro_scale, info.pressure_scale
        scale = info.pressure_scale or None  # 0 if pressure is not calibrated
        layout = Layout(
            id=info.layout,
            foot=info.foot,
            cells=info.cells,
            length=info.length,
            scale=scale,
            full_scale=FULL_PRESSURE_COUNTS * (scale or 1.0),
        )
        return [LayoutKnown(t=arrival, site=self.site, layout=shared(layout))]

    def _read_frame(self, frame: InsoleFrame, arrival: float) -> Output:
        if frame.foot is not self.site.foot:
            raise WireError(Rejection.WRONG_SITE, f"a frame of a {frame.foot.value} insole")
        cells = len(frame.samples[0].cells)
        if self.layout is not None and (frame.layout != self.layout or cells != self.cells):
            raise WireError(
                Rejection.WRONG_LAYOUT,
                f"layout {frame.layout} of {cells} cells, not layout {self.layout} of {self.cells}",
            )
        run, count = self.packet_run, len(frame.samples)
        ticks_after = signed_difference(frame.ticks - run.ticks, TICK_MODULUS)
        difference, packets = run.count_packets(frame.sequence, SEQUENCE_MODULUS, ticks_after)
        position = PacketPosition(
            frame.sequence, frame.ticks, frame.interval, count, difference, packets, ticks_after, frame.retransmitted
        )
        sample_times = run.accept(position, float(self.rate), arrival)
        out: Output = []
        if sample_times.gap_start is not None or sample_times.restarted is not None:
            out += sample_times.make_events(self.site, arrival)
        if self.layout is None:
            self.layout, self.cells = frame.layout, cells
        if not self.info_digest:
            out += self.report_limitation(NO_INFO, arrival)
        a, g, n = self.acc_scale, self.gyro_scale, self.pressure_scale
        for raw, t in zip(frame.samples, sample_times.times, strict=True):
            acc = gyro = pressure = quat = None
            if raw.imu is not None:
                ax, ay, az, gx, gy, gz = raw.imu
                if a > 0.0:
                    acc = (ax * a, ay * a, az * a)
                if g > 0.0:
                    gyro = (gx * g, gy * g, gz * g)
            if raw.cells:
                pressure = _pressures(raw.cells, n)
            if raw.quat is not None:
                quat = unit(raw.quat)
            known_at = arrival if arrival > t else t
            sample = Sample(t, self.site, acc, gyro, pressure, quat, known_at=known_at, saturated=frame.saturated)
            out.append(sample)
        return out


def _pressures(counts: tuple[int, ...], scale: float) -> Floats:
    """Return the force of each cell, N, or its count if `scale`, N per count, is 0."""
    scale = scale or 1.0
    table = _TABLES.get(scale)
    if table is None and len(_TABLES) < MOST_TABLES:
        table = _TABLES[scale] = tuple([count * scale for count in range(int(FULL_PRESSURE_COUNTS) + 1)])
    if table is None or len(counts) < 2:
        return tuple([count * scale for count in counts])
    return itemgetter(*counts)(table)  # type: ignore[no-any-return]


def _check_scales(info: InsoleInfo) -> None:
    """Raise WireError for scales or a tick rate that no insole has.

    Full scales must be from 1 to 1000 g, from 10 to 100,000 degrees/s, and up to 100 kN a cell; the tick rate must be
    at least 100 Hz. A scale of 0 is allowed: there is no such sensor, or pressure is not calibrated."""
    full_acc = info.acc_scale * FULL_SCALE_COUNTS / GRAVITY
    full_gyro = info.gyro_scale * FULL_SCALE_COUNTS
    if (
        (full_acc != 0.0 and not 0.99 <= full_acc <= 1000.0)
        or (full_gyro != 0.0 and not radians(10.0) <= full_gyro <= radians(1e5))
        or info.pressure_scale * FULL_PRESSURE_COUNTS > 1e5
        or info.tick_rate < 100
    ):
        raise WireError(
            Rejection.ABSURD,
            f"scales of {info.acc_scale:g} m/s^2, {info.gyro_scale:g} rad/s, {info.pressure_scale:g} N per count "
            f"and {info.tick_rate} ticks per second",
        )


KIND = DeviceKind(PROFILE, InsoleLink, InsoleLink.feed)
