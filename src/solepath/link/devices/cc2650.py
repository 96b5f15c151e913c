"""One CC2650 SensorTag: movement, its configuration and period, barometer and keys to samples and events."""

from __future__ import annotations

from math import radians

from attrs import define, field

from ...events import KeysChanged, LinkEvent, PacketsLost, ScaleSuspect
from ...types import Sample, Site
from ...types.vector import GRAVITY
from ...wire.cc2650 import parse_barometer, parse_barometer_config, parse_keys, parse_movement, parse_movement_config
from ...wire.period import parse_period
from ..periodic import Periodic, periodic
from ..rest import RestCheck, suggestion

PERIOD = 0.1
"""s, what the profile writes."""
RANGE = 8
"""g, what the profile writes."""
GYRO = radians(500.0 / 65536.0)
"""rad/s per count: +-250 degrees/s (TI, CC2650 SensorTag user's guide)."""
MAG = 4912.0 / 32760.0 * 1e-6
"""T per count (InvenSense, MPU-9250 product specification: 4912 uT full scale, 32760 counts)."""
FULL_SCALE = 32767
"""Counts at which a sensor is at the end of its range."""
APART = 1.0
"""Seconds without movement after which air pressure no longer waits for a movement sample to ride on."""

Output = list[Sample | LinkEvent]


@define
class Cc2650Link:
    """Feeds on the channels cc2650/... of one site.

    `feed` raises WireError for what cannot be used, and then nothing has changed. Latency none. There is no counter on
    the wire: see periodic.py for times and losses. Air pressure rides on the next movement sample, once.
    """

    site: Site
    movement: Periodic = field(factory=lambda: periodic(PERIOD))
    range: int = RANGE
    has_acc: bool = True
    has_gyro: bool = True
    has_mag: bool = True
    wake_on_motion: bool = False
    switched_off: bool = False
    air_pressure: float | None = None
    last_t: float | None = None
    """Of the newest sample; they strictly increase."""
    rest: RestCheck = field(factory=lambda: RestCheck(RANGE * GRAVITY / 32768))

    @property
    def name(self) -> str:
        return "cc2650"

    @property
    def silence_is_legal(self) -> bool:
        return self.wake_on_motion or self.switched_off

    @property
    def doubt(self) -> float | None:
        """The newest time that is not to be compared with those of other devices (clock.py), s."""
        return self.movement.clock.doubt

    def feed(self, channel: str, data: bytes, arrival: float) -> Output:
        match channel:
            case "cc2650/movement":
                return self._movement(data, arrival)
            case "cc2650/movement-config":
                self._configure(data)
            case "cc2650/movement-period":
                period = parse_period(data)
                if period != self.movement.period:
                    self.movement.change(period)
            case "cc2650/barometer":
                return self._barometer(data, arrival)
            case "cc2650/barometer-config":
                parse_barometer_config(data)
            case "cc2650/barometer-period":
                parse_period(data)
            case "cc2650/keys":
                down = parse_keys(data).down
                return [KeysChanged(t=arrival, known_at=arrival, site=self.site, down=down)]
        return []

    def forget_clock(self) -> None:
        """The receiver's clock was set back: fit anew, and let times begin anew too."""
        self.movement = periodic(self.movement.period)
        self.last_t = None

    def reconnected(self) -> None:
        """A new connection: nothing was under way that could end with the old one."""

    def flush(self, known_at: float) -> Output:
        return []

    def _configure(self, data: bytes) -> None:
        config = parse_movement_config(data)
        self.has_acc, self.has_gyro, self.has_mag = all(config.acc_axes), all(config.gyro_axes), config.mag
        self.wake_on_motion = config.wake_on_motion
        self.switched_off = not (any(config.acc_axes) or any(config.gyro_axes) or config.mag)
        if config.range != self.range:
            self.range = config.range
            self.rest = RestCheck(config.range * GRAVITY / 32768)

    def _movement(self, data: bytes, arrival: float) -> Output:
        raw = parse_movement(data)
        slot = self.movement.arrive(arrival, counts_losses=not self.silence_is_legal)
        out: Output = []
        if slot.lost:
            known_at = max(arrival, slot.t_missing)
            out.append(
                PacketsLost(
                    t=slot.t_missing, known_at=known_at, site=self.site, channel="cc2650/movement", count=slot.lost
                )
            )
        a = self.range * GRAVITY / 32768
        acc = (raw.acc[0] * a, raw.acc[1] * a, raw.acc[2] * a) if self.has_acc else None
        gyro = (raw.gyro[0] * GYRO, raw.gyro[1] * GYRO, raw.gyro[2] * GYRO) if self.has_gyro else None
        # The MPU-9250's magnetometer has axes of its own: (y, x, -z) in those of its accelerometer and gyroscope.
        mag = (raw.mag[1] * MAG, raw.mag[0] * MAG, -raw.mag[2] * MAG) if self.has_mag else None
        air_pressure, self.air_pressure = self.air_pressure, None
        t = self._in_order(slot.t)
        known_at = max(arrival, t)
        largest = max(map(abs, (*raw.acc, *raw.gyro)))
        out.append(
            Sample(
                t,
                self.site,
                acc,
                gyro,
                mag=mag,
                air_pressure=air_pressure,
                known_at=known_at,
                saturated=largest >= FULL_SCALE,
            )
        )
        if acc is not None and not self.rest.done:
            magnitude = self.rest.feed(t, acc)
            if magnitude is not None:
                words = suggestion(magnitude, float(self.range))
                out.append(ScaleSuspect(t=t, known_at=known_at, site=self.site, magnitude=magnitude, suggestion=words))
        return out

    def _barometer(self, data: bytes, arrival: float) -> Output:
        pressure = parse_barometer(data).pressure
        if self.movement.arrived is not None and arrival - self.movement.arrived <= APART:
            self.air_pressure = pressure
            return []
        t = self._in_order(arrival)
        return [Sample(t, self.site, air_pressure=pressure, known_at=t)]

    def _in_order(self, t: float) -> float:
        if self.last_t is not None and t <= self.last_t:
            t = self.last_t + 1e-6
        self.last_t = t
        return t
