"""One insole: frames to samples, by the rules of protocol/clock.md; INFO to scales and layout."""

from __future__ import annotations

from math import radians, sqrt

from attrs import define, field

from ..events import (
    ClockReset,
    LayoutKnown,
    Limitation,
    LinkEvent,
    PacketRejected,
    PacketsLost,
    Rejection,
    ScaleSuspect,
)
from ..types import Layout, Quat, Sample, Site
from ..vector import GRAVITY
from ..wire.error import WireError
from ..wire.fragment import is_fragment, parse_fragment
from ..wire.insole import InsoleFrame, InsoleSample, parse_frame
from ..wire.insole_control import parse_control
from ..wire.insole_info import InsoleInfo, parse_info
from .clock import Clock
from .reassembly import Reassembly
from .rest import RestCheck, suggestion

COUNTS = 32768
"""Counts of a full scale, IMU."""
ASSUMED_ACC = 16.0 * GRAVITY / COUNTS
"""m/s^2 per count until INFO says otherwise."""
ASSUMED_GYRO = radians(2000.0) / COUNTS
"""rad/s per count until INFO says otherwise."""
TICK_RATE = 32768
"""Ticks per second until INFO says otherwise."""
REMEMBERED = 64
"""Sequence numbers of which it is known whether they were accepted."""
OVERTAKEN = 2.0
"""Seconds that a frame may be overtaken, in ticks and in delay; an older one is of a device that began anew."""
FULL_PRESSURE = 4095.0

Output = list[Sample | LinkEvent]


@define
class InsoleLink:
    """Feeds on the channels insole/frame, insole/info and insole/control of one foot.

    `feed` raises WireError for what cannot be used, and then nothing has changed but the fragments under way.
    Latency none. Before INFO came, counts are taken for 16 g and 2000 degrees/s full scale and pressure stays in
    counts; the layout of the first frame is then the only one accepted.
    """

    site: Site
    info: bytes = b""
    """The INFO record in force, as it came."""
    layout: int | None = None
    cells: int = 0
    rate: int = TICK_RATE
    acc_scale: float = ASSUMED_ACC
    gyro_scale: float = ASSUMED_GYRO
    pressure_scale: float = 0.0
    told: bool = False
    """The Limitation was said."""
    clock: Clock | None = None
    sequence: int = 0
    """Of the newest frame accepted."""
    ticks: int = 0
    """Unwrapped ticks of its first sample."""
    interval: int = 1
    covers: int = 1
    """Ticks that it covers."""
    seen: int = 0
    """Bit b: the frame b before the newest was accepted."""
    fresh: bool = False
    """No frame came yet since the device was connected again: counters that go back have begun anew."""
    fragments: Reassembly = field(factory=Reassembly)
    rest: RestCheck = field(factory=lambda: RestCheck(ASSUMED_ACC))

    @property
    def silence_is_legal(self) -> bool:
        return False

    def feed(self, channel: str, data: bytes, arrival: float) -> Output:
        if channel == "insole/frame":
            return self._fragment(data, arrival) if is_fragment(data) else self._whole(data, arrival)
        if channel == "insole/info":
            return self._info(data, arrival)
        parse_control(data)  # insole/control, as it was written: frames and INFO say what became of it
        return []

    def forget_clock(self) -> None:
        """The receiver's clock was set back: fit anew, and let times begin anew too."""
        self.clock = None

    def reconnected(self) -> None:
        """A new connection: the rest of a frame in fragments will not come, and nothing can be overtaken."""
        self.fragments.drop()
        self.fresh = True

    def flush(self, known_at: float) -> Output:
        return []

    def _fragment(self, data: bytes, arrival: float) -> Output:
        whole, dropped = self.fragments.feed(parse_fragment(data))
        out = self._dropped(dropped, arrival)
        if whole is not None:
            try:
                out += self._frame(parse_frame(whole), arrival)
            except WireError as error:
                out.append(self._rejected(error.reason, error.detail, arrival))
        return out

    def _whole(self, data: bytes, arrival: float) -> Output:
        out = self._frame(parse_frame(data), arrival)
        dropped = self.fragments.drop()
        return self._dropped(dropped, arrival) + out if dropped else out

    def _dropped(self, detail: str | None, arrival: float) -> Output:
        return [] if detail is None else [self._rejected(Rejection.TRUNCATED, detail, arrival)]

    def _rejected(self, reason: Rejection, detail: str, arrival: float) -> PacketRejected:
        return PacketRejected(
            t=arrival, known_at=arrival, site=self.site, channel="insole/frame", reason=reason, detail=detail
        )

    # --- INFO ---------------------------------------------------------------------------------------------------

    def _info(self, data: bytes, arrival: float) -> Output:
        info = parse_info(data)
        if info.foot is not self.site.foot:
            raise WireError(Rejection.WRONG_SITE, f"INFO of a {info.foot.value} insole")
        _check_scales(info)
        if data == self.info:
            return []
        self.info = bytes(data)
        self.layout, self.cells, self.rate = info.layout, len(info.cells), info.tick_rate
        if info.acc_scale != self.acc_scale:
            self.rest = RestCheck(info.acc_scale)
        self.acc_scale, self.gyro_scale, self.pressure_scale = info.acc_scale, info.gyro_scale, info.pressure_scale
        known = info.pressure_scale > 0.0
        layout = Layout(
            id=info.layout,
            foot=info.foot,
            cells=info.cells,
            length=info.length,
            scale=info.pressure_scale if known else None,
            full_scale=FULL_PRESSURE * info.pressure_scale if known else FULL_PRESSURE,
        )
        return [LayoutKnown(t=arrival, known_at=arrival, site=self.site, layout=layout)]

    # --- frames -------------------------------------------------------------------------------------------------

    def _frame(self, frame: InsoleFrame, arrival: float) -> Output:
        if frame.foot is not self.site.foot:
            raise WireError(Rejection.WRONG_SITE, f"a frame of a {frame.foot.value} insole")
        cells = len(frame.samples[0].cells)
        if self.layout is not None and (frame.layout != self.layout or cells != self.cells):
            raise WireError(
                Rejection.WRONG_LAYOUT,
                f"layout {frame.layout} of {cells} cells, not layout {self.layout} of {self.cells}",
            )
        covers = frame.interval * len(frame.samples)
        out: Output = []
        restarted: bool | None = None
        clock = self.clock
        if clock is None:
            clock = self._begin(frame.ticks, None)
        else:
            # "Both counters are compared as signed differences": d in frames, e in ticks, m the true difference.
            d = (frame.sequence - self.sequence + 0x8000 & 0xFFFF) - 0x8000
            e = (frame.ticks - self.ticks + 0x8000_0000 & 0xFFFF_FFFF) - 0x8000_0000
            m = d + 65536 * round((e / self.covers - d) / 65536)
            first, last = self.ticks + e, self.ticks + e + covers - frame.interval
            if e <= 0 or m <= 0:
                self._refuse_repeated(clock, m, e, arrival, frame.retransmitted)
            if e <= 0 or m <= 0 or clock.rate != self.rate or clock.jumped(last, arrival):
                restarted = not 1 <= d <= REMEMBERED
                clock = self._begin(frame.ticks, clock.last_t + self.interval / clock.rate)
            else:
                if m > 1:
                    t = clock.expected(self.ticks + self.covers)
                    known_at = max(arrival, t)
                    out.append(PacketsLost(t=t, known_at=known_at, site=self.site, channel="insole/frame", count=m - 1))
                self.ticks = first
                self.seen = (self.seen << m | 1) & (1 << REMEMBERED) - 1 if m < REMEMBERED else 1
        if self.layout is None:
            self.layout, self.cells = frame.layout, cells
        if not self.info and not self.told:
            self.told = True
            what = "no INFO from the insole: 16 g and 2000 degrees/s full scale assumed, pressure in counts"
            out.append(Limitation(t=arrival, known_at=arrival, site=self.site, what=what))
        self.fresh = False
        self.sequence, self.interval, self.covers = frame.sequence, frame.interval, covers
        clock.observe(self.ticks + covers - frame.interval, arrival)
        if restarted is not None:
            t = clock.expected(self.ticks)
            out.append(ClockReset(t=t, known_at=max(arrival, t), site=self.site, restarted=restarted))
        ticks = self.ticks
        for sample in frame.samples:
            self._sample(sample, clock.time(ticks), arrival, frame.saturated, out)
            ticks += frame.interval
        return out

    def _begin(self, ticks: int, floor: float | None) -> Clock:
        self.clock = Clock(float(self.rate), floor=floor)
        self.ticks, self.seen = ticks, 1
        return self.clock

    def _refuse_repeated(self, clock: Clock, m: int, e: int, arrival: float, retransmitted: bool) -> None:
        """WireError when a frame that is not newer is one that came already or was overtaken; else it began anew."""
        same_run = abs(m * self.covers - e) <= 2 * self.covers
        accepted = same_run and -REMEMBERED < m <= 0 and bool(self.seen >> -m & 1)
        if retransmitted and e < 0:
            if accepted:
                raise WireError(Rejection.DUPLICATE, f"sent again, and it came already, {-m} before the newest")
            raise WireError(Rejection.LATE, f"sent again, {-m} frames old")
        overtaken = (
            not self.fresh
            and same_run
            and e >= -OVERTAKEN * clock.rate
            and arrival - clock.fitted(self.ticks + e) <= OVERTAKEN + self.covers / clock.rate
        )
        if m == 0 and e == 0:
            raise WireError(Rejection.DUPLICATE, "the newest frame again")
        if not overtaken or m > 0:
            return
        if accepted:
            raise WireError(Rejection.DUPLICATE, f"a frame that came already, {-m} before the newest")
        raise WireError(Rejection.LATE, f"{-m} frames behind the newest")

    def _sample(self, raw: InsoleSample, t: float, arrival: float, saturated: bool, out: Output) -> None:
        acc = gyro = pressure = None
        if raw.imu is not None:
            ax, ay, az, gx, gy, gz = raw.imu
            a, g = self.acc_scale, self.gyro_scale
            if a > 0.0:
                acc = (ax * a, ay * a, az * a)
            if g > 0.0:
                gyro = (gx * g, gy * g, gz * g)
        if raw.cells:
            n = self.pressure_scale
            pressure = tuple([c * n for c in raw.cells]) if n > 0.0 else tuple(map(float, raw.cells))
        quat = None if raw.quat is None else _unit(raw.quat)
        known_at = arrival if arrival > t else t
        out.append(Sample(t, self.site, acc, gyro, pressure, quat, known_at=known_at, saturated=saturated))
        if acc is not None and not self.rest.done:
            magnitude = self.rest.feed(t, acc)
            if magnitude is not None:
                words = suggestion(magnitude, self.acc_scale * COUNTS / GRAVITY)
                out.append(ScaleSuspect(t=t, known_at=known_at, site=self.site, magnitude=magnitude, suggestion=words))


def _unit(quat: tuple[int, int, int, int]) -> Quat | None:
    """A Q14 quaternion at length 1; None for zero."""
    w, x, y, z = quat
    length = sqrt(w * w + x * x + y * y + z * z)
    return (w / length, x / length, y / length, z / length) if length > 0.0 else None


def _check_scales(info: InsoleInfo) -> None:
    """WireError for what no insole is: full scales out of 1 to 1000 g, 10 to 100,000 degrees/s, over 100 kN, a tick
    rate under 100 Hz. Zero is legal and says that there is no such sensor, or no calibration."""
    full_acc = info.acc_scale * COUNTS / GRAVITY
    full_gyro = info.gyro_scale * COUNTS
    if (
        (full_acc != 0.0 and not 0.99 <= full_acc <= 1000.0)
        or (full_gyro != 0.0 and not radians(10.0) <= full_gyro <= radians(1e5))
        or info.pressure_scale * FULL_PRESSURE > 1e5
        or info.tick_rate < 100
    ):
        raise WireError(
            Rejection.ABSURD,
            f"scales of {info.acc_scale:g} m/s^2, {info.gyro_scale:g} rad/s, {info.pressure_scale:g} N per count "
            f"and {info.tick_rate} ticks per second",
        )
