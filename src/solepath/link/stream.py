"""The link of one declared device (driver.py): its readings to Samples on one clock and events.

Times come from the best source that the device has, by the rules of protocol/clock.md:

- The device's own time, where it has one, as with an insole. Without sequence numbers the ticks show losses, at the
  rate of the profile or of a value; six packets in a row at another, steady distance show that the rate was wrong.
- Else its sequence numbers: they count the samples, and the count is the time. A coarse device time beside them, or a
  silence of 5 s, shows when counting stopped.
- Else arrivals alone (periodic.py)."""

from __future__ import annotations

from ..events import BatteryLevel, KeysChanged, LayoutKnown, Limitation, Rejection
from ..types import Sample, Site, Vec3
from ..types.attrs import define, field
from ..types.vector import GRAVITY, unit
from ..wire.error import WireError
from ..wire.fields import malformed
from .counters import PacketPosition, PacketRun, SampleTimes, signed
from .device_link import DeviceLink, Output
from .driver import MIN_TICKS, Driver, DriverSignature, Reading, TimeAxis
from .periodic import PeriodicClock, make_periodic_clock
from .reading_check import MIN_RATE, check_reading
from .rest import RestCheck

MAX_WAIT = 1.0
"""Time without samples after which air pressure no longer waits for one, s."""
TICKS_PER_SAMPLE = 100
"""Ticks of a counted sample: a pause is no whole number of samples."""
PAUSE_LEAD = 0.25
"""Seconds (and a tenth of the time) by which a device's coarse time is ahead of its count after a pause."""
MAX_BEHIND, MAX_AHEAD = 2.0, 0.25
"""Seconds by which a device's coarse time may be behind the arrivals, or ahead; beyond, it was set."""
SILENCE, LATE_AFTER_SILENCE, LATE_AFTER_CONNECTION = 5.0, 2.5, 0.5
"""Silence after which counting may have stopped, and lateness of the next packet that shows it, s.

LATE_AFTER_CONNECTION is that lateness right after a new connection, which delivers nothing from before."""
LOSS_GAP = 1.5
"""Packet intervals between two packets from which on some were lost, where only ticks show it."""
STEADY_PACKETS = 6
"""Number of packets in a row at another distance after which the rate is taken to have been wrong."""
RATE_TOLERANCE = 0.2
"""Relative difference of that distance from the nominal one, and the spread of the six packets' distances."""


@define
class StreamLink(DeviceLink):
    """The link of one declared device at one site.

    `feed` raises WireError for values that cannot be used, and then nothing has changed. Latency none."""

    site: Site
    name: str
    """Name of the driver."""
    signature: DriverSignature
    """Numbers of the driver with which the link started."""
    rate: float
    """Nominal rate, samples a second."""
    rest: RestCheck
    """Check of the accelerometer's scale."""
    known: dict[str, float] = field(factory=dict)
    """Numbers from earlier values that later ones are read with."""
    may_be_silent: bool = False
    run: PacketRun = field(factory=PacketRun)
    coarse: int = 0
    """Device time of the newest packet in ticks as sent, where it stands beside a sequence number."""
    off_rate_packets: int = 0
    """Number of packets in a row at another distance than the rate predicts."""
    off_rate_interval: float = 1.0
    """Distance of those packets, ticks a sample."""
    periodic: PeriodicClock | None = None
    arrived: float | None = None
    """Newest arrival with samples, s."""
    last_t: float | None = None
    """Time of the newest sample, s; sample times strictly increase."""
    mag: Vec3 | None = None
    """Magnetometer value that waits for the next sample, T."""
    air_pressure: float | None = None
    """Air pressure that waits for the next sample, Pa."""
    limitation_reported: bool = False
    """True if the driver's limitation was reported."""

    @property
    def unsettled_until(self) -> float | None:
        """Newest time that is not comparable with those of other devices (clock.py), s."""
        clock = self.run.clock if self.periodic is None else self.periodic.clock
        return None if clock is None else clock.unsettled_until

    def feed(self, channel: str, data: bytes, arrival: float, driver: Driver) -> Output:
        """Return the samples and events of one value that arrived at `arrival`, s."""
        reading = check_reading(driver.read(channel, data, self.known))
        self._check(driver, channel, reading)
        out = self._make_samples(driver, channel, reading, arrival) if reading.samples else []
        self._update_settings(driver, reading)
        return self._make_events(reading, arrival) + out + self._take_slow_values(reading, arrival)

    def driver_signature(self) -> DriverSignature:
        """Return the signature of the driver with which the link started."""
        return self.signature

    def restart_clock(self) -> None:
        """Restart the clock fit and the times, because the receiver's clock was set back."""
        self.run.clock, self.arrived, self.last_t = None, None, None
        if self.periodic is not None:
            self.periodic = make_periodic_clock(self.periodic.period)

    def handle_reconnection(self) -> None:
        """Expect counters to have restarted; after a new connection nothing can be overtaken."""
        self.run.after_reconnection = True

    def flush(self, known_at: float) -> Output:
        return []

    def _check(self, driver: Driver, channel: str, reading: Reading) -> None:
        """Raise WireError when a reading cannot be used."""
        if reading.foot is not None and reading.foot is not self.site.foot:
            raise WireError(Rejection.WRONG_SITE, f"of a {reading.foot.value} foot")
        if reading.samples and channel not in driver.profile.streams:
            raise malformed(f"samples on {channel!r}, which is no stream")
        axis = self.signature.axis
        if reading.period is not None and axis is not TimeAxis.ARRIVAL:
            raise malformed("a period, of a device that counts")
        if reading.rate is not None and axis is TimeAxis.TICKS and reading.rate * MIN_TICKS > driver.tick_rate:
            detail = f"{reading.rate:g} samples a second, too many for {driver.tick_rate:g} ticks a second"
            raise WireError(Rejection.ABSURD, detail)
        if reading.interval is not None and reading.interval * MIN_RATE > driver.tick_rate > 0.0:
            raise WireError(Rejection.ABSURD, f"an interval of {reading.interval} ticks")

    def _update_settings(self, driver: Driver, reading: Reading) -> None:
        if reading.known:
            before = self._acc_range(driver)
            self.known = {**self.known, **{name: float(value) for name, value in reading.known.items()}}
            if self._acc_range(driver) != before:
                self.rest = RestCheck(self._acc_range(driver) * GRAVITY / 32768)
        if reading.silent is not None:
            self.may_be_silent = reading.silent
        if reading.rate is not None and not reading.samples:
            if self.signature.axis is TimeAxis.TICKS:
                self.run.packet_ticks *= self.rate / reading.rate
            self._set_rate(reading.rate)
        if reading.period is not None:
            if self.periodic is None:
                self.periodic = make_periodic_clock(reading.period)
            elif reading.period != self.periodic.period:
                self.periodic.set_period(reading.period)

    def _acc_range(self, driver: Driver) -> float:
        return self.known.get("acc_range", driver.acc_range)

    def _set_rate(self, rate: float) -> None:
        if rate != self.rate:
            if self.periodic is not None:
                self.periodic.set_period(self.periodic.period * self.rate / rate)
            self.rate, self.off_rate_packets = rate, 0

    def _make_events(self, reading: Reading, arrival: float) -> Output:
        out: Output = []
        if reading.layout is not None:
            out.append(LayoutKnown(t=arrival, known_at=arrival, site=self.site, layout=reading.layout))
        if reading.battery is not None:
            out.append(BatteryLevel(t=arrival, known_at=arrival, site=self.site, level=float(reading.battery)))
        if reading.keys is not None:
            out.append(KeysChanged(t=arrival, known_at=arrival, site=self.site, down=reading.keys))
        return out

    def _take_slow_values(self, reading: Reading, arrival: float) -> Output:
        if reading.mag is not None:
            self.mag = reading.mag
        if reading.air_pressure is None:
            return []
        if self.arrived is not None and arrival - self.arrived <= MAX_WAIT:
            self.air_pressure = reading.air_pressure
            return []
        t = self._make_increasing(arrival)
        return [Sample(t, self.site, air_pressure=reading.air_pressure, known_at=max(arrival, t))]

    def _make_samples(self, driver: Driver, channel: str, reading: Reading, arrival: float) -> Output:
        axis = self.signature.axis
        rate = self.rate if reading.rate is None else reading.rate
        if axis is TimeAxis.ARRIVAL:
            self._set_rate(rate)
            taken = self._by_arrival(len(reading.samples), rate, arrival)
        elif axis is TimeAxis.TICKS:
            counted = self._by_ticks(driver, reading, rate)
            taken = self.run.accept(counted, driver.tick_rate, arrival)
            self._set_rate(rate)
            self._correct_rate(driver, reading, counted)
        else:
            counted = self._by_count(driver, reading, rate, arrival)
            taken = self.run.accept(counted, rate * TICKS_PER_SAMPLE, arrival, new_fit=self._stopped(driver, arrival))
            self._set_rate(rate)
            self.coarse = int(reading.ticks or 0)
        out: Output = [*taken.make_events(self.site, channel, arrival)]
        if driver.limitation and not self.limitation_reported:
            self.limitation_reported = True
            out.append(Limitation(t=arrival, known_at=arrival, site=self.site, what=driver.limitation))
        self.arrived = arrival
        for raw, taken_at in zip(reading.samples, taken.times, strict=True):
            t = self._make_increasing(taken_at)
            mag, air_pressure = raw.mag, raw.air_pressure
            if mag is None:
                mag, self.mag = self.mag, None
            if air_pressure is None:
                air_pressure, self.air_pressure = self.air_pressure, None
            quat = None if raw.quat is None else unit(raw.quat)
            known_at = arrival if arrival > t else t
            sample = Sample(
                t, self.site, raw.acc, raw.gyro, raw.pressure, quat, mag, air_pressure, known_at, raw.saturated
            )
            out.append(sample)
            if raw.acc is not None and not self.rest.done:
                out += self.rest.check(sample, self._acc_range(driver))
        return out

    def _by_ticks(self, driver: Driver, reading: Reading, rate: float) -> PacketPosition:
        run, count = self.run, len(reading.samples)
        if reading.ticks is None or (driver.sequence and reading.sequence is None):
            raise malformed("no device time or no sequence number, which this device has")
        interval = driver.tick_rate / rate if reading.interval is None else reading.interval
        e = signed(reading.ticks - run.ticks, driver.tick_modulus)
        if reading.sequence is not None and driver.sequence:
            d, m = run.count_packets(reading.sequence, driver.sequence, e / run.packet_ticks)
            return PacketPosition(int(reading.sequence), int(reading.ticks), interval, count, d, m, e)
        if e > 0:  # ticks were cut to whole ones: the true distance may be up to one tick less
            m = max(1, round(e / run.packet_ticks)) if e - 1 >= LOSS_GAP * run.packet_ticks else 1
        else:
            m = 0 if e == 0 else min(-1, round(e / run.packet_ticks))
        return PacketPosition(0, int(reading.ticks), interval, count, m, m, e)

    def _by_count(self, driver: Driver, reading: Reading, rate: float, arrival: float) -> PacketPosition:
        """Return a packet's position by its number, nearest to the elapsed time; the samples are the ticks."""
        run, count = self.run, len(reading.samples)
        if reading.sequence is None:
            raise malformed("no sequence number, which this device has")
        elapsed = 0.0 if self.arrived is None else arrival - self.arrived
        device_elapsed: float | None = None
        if driver.tick_modulus and reading.ticks is not None:
            device_elapsed = signed(reading.ticks - self.coarse, driver.tick_modulus) / driver.tick_rate
            device_elapsed = device_elapsed if -MAX_BEHIND <= device_elapsed - elapsed <= MAX_AHEAD else None
        ticks = (elapsed if device_elapsed is None else device_elapsed) * rate * TICKS_PER_SAMPLE
        d, m = run.count_packets(reading.sequence, driver.sequence, ticks / run.packet_ticks)
        e = round(m * run.packet_ticks)
        if m >= 1 and device_elapsed is not None and ticks > 1.1 * e + PAUSE_LEAD * rate * TICKS_PER_SAMPLE:
            e = round(ticks)
        return PacketPosition(int(reading.sequence), 0, TICKS_PER_SAMPLE, count, d, m, e)

    def _stopped(self, driver: Driver, arrival: float) -> bool:
        """Return whether a packet after a silence is too late to be counted on from the one before it."""
        clock, run = self.run.clock, self.run
        if clock is None or self.arrived is None or driver.tick_modulus:
            return False
        silence, delay = arrival - self.arrived, arrival - clock.fit_time(run.ticks + run.packet_ticks)
        return (
            delay > LATE_AFTER_CONNECTION
            if run.after_reconnection
            else silence > SILENCE and delay > LATE_AFTER_SILENCE
        )

    def _correct_rate(self, driver: Driver, reading: Reading, counted: PacketPosition) -> None:
        """Correct the rate when the ticks show that it was wrong."""
        if driver.sequence or reading.interval is not None or counted.ticks_after <= 0:
            return
        distance = counted.ticks_after / counted.samples
        if abs(distance - counted.interval) <= RATE_TOLERANCE * counted.interval + 1.0 / counted.samples:
            self.off_rate_packets = 0
            return
        same = (
            self.off_rate_packets > 0
            and abs(distance - self.off_rate_interval) <= RATE_TOLERANCE * self.off_rate_interval
        )
        self.off_rate_packets, self.off_rate_interval = self.off_rate_packets + 1 if same else 1, distance
        if self.off_rate_packets >= STEADY_PACKETS:
            self.rate, self.off_rate_packets, self.run.packet_ticks = (
                driver.tick_rate / distance,
                0,
                float(counted.ticks_after),
            )

    def _by_arrival(self, count: int, rate: float, arrival: float) -> SampleTimes:
        if self.periodic is None:
            self.periodic = make_periodic_clock(count / rate)
        taken = self.periodic.add_packet(arrival, counts_losses=not self.may_be_silent)
        (last,), interval = taken.times, self.periodic.period / count
        times = [last - (count - 1 - j) * interval for j in range(count)]
        return SampleTimes(times, taken.lost, taken.t_missing)

    def _make_increasing(self, t: float) -> float:
        if self.last_t is not None and t <= self.last_t:
            t = self.last_t + 1e-6
        self.last_t = t
        return t


def make_stream_link(driver: Driver, built_in: bool, site: Site, firmware: str) -> StreamLink:
    """Return a fresh link of this kind of device at `site`."""
    rest = RestCheck(driver.acc_range * GRAVITY / 32768)
    return StreamLink(site, driver.name, driver.signature(built_in), driver.profile.nominal_rate, rest)
