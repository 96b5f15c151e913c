"""The link of one declared device (driver.py), which turns readings into events, and into Samples on one clock.

Times come from the best source that the device has, by the rules of protocol/clock.md:

- The device's own time, if its ticks are fine enough. Without sequence numbers, a larger distance between two packets
  than the rate predicts is a loss. Six packets in a row at another, steady distance show that the rate was wrong.
- Else the device's sequence numbers, which count the samples. If the device also has a coarse time, that time shows
  when counting stopped; otherwise a silence of 5 s does.
- Else arrivals alone (periodic.py)."""

from __future__ import annotations

from binascii import crc32

from ..events import BatteryLevel, KeysChanged, LayoutKnown, Limitation, Rejection
from ..types import Layout, Sample, Site, Vec3
from ..types.attrs import define, field
from ..types.vector import unit
from ..wire.error import WireError
from ..wire.fields import malformed
from .clock import LARGE_ERROR, MAX_DRIFT, MIN_INCREMENT, Clock
from .counters import (
    MIN_GAP,
    REMEMBERED_PACKETS,
    Backlog,
    Numbering,
    PacketPosition,
    PacketRun,
    SampleTimes,
    signed_difference,
)
from .driver import MIN_RATE, MIN_SAMPLE_TICKS, MOST_KNOWN, Driver, Reading, TimeAxis
from .kinds import MAX_PRESSURE_WAIT, DeviceLink, Output
from .periodic import OTHER_RATE, PeriodicClock, other_rate

TICKS_PER_SAMPLE = 100
"""Ticks that stand for one sample of a device that only counts; more than one, as a pause may end between samples."""
PAUSE_LEAD, PAUSE_RATIO = 0.25, 1.1
"""A coarse device time shows a pause when it is over PAUSE_RATIO times the counted time plus PAUSE_LEAD s."""
MAX_DEVICE_LAG, MAX_DEVICE_LEAD = 2.0, 0.25
"""Largest time by which a device's coarse time may be behind or ahead of the arrivals, s; otherwise it was set."""
LONG_SILENCE, MIN_DELAY_AFTER_SILENCE, MIN_DELAY_AFTER_CONNECTION = 5.0, 2.5, 0.5
"""Silence after which a device may have stopped counting, and delays of the next packet that show that it did, s.

After a new connection, which delivers no old packets, MIN_DELAY_AFTER_CONNECTION is enough, without a silence."""
PACE_TIME, PACE_WINDOW = 3.0, 0.1
"""Time of the newest arrivals that show another rate, s, and length of their windows, device seconds: a quarter of the
rate still fills seven windows."""
STEADY_PACKETS = 6
"""Number of packets in a row at a steady distance that shows that the rate is wrong."""
TICKS_TIME, MAX_TICKS_SILENCE = 3.0, 0.5
"""Time of arrivals without a silence that shows how fast a device's clock goes, s, and shortest such silence, s."""
USUAL_CLOCKS = (100.0, 1000.0, 1024.0, 4096.0, 8000.0, 8192.0, 1e4, 16384.0, 32768.0, 1e5, 1e6, 1e9)
"""Ticks a second of clocks that boards have; a count of ticks within MAX_DRIFT of one of them is of this one."""
RATE_TOLERANCE = 0.2
"""Largest relative deviation of a packet's distance from the predicted one, and of a steady distance from the last."""
UNUSED_TICKS = "the ticks of this device are not used, because its driver has no tick_rate and tick_modulus"
"""Limitation of a reader that gives ticks which nobody can convert to seconds."""


@define
class StreamLink(DeviceLink):
    """The link of one declared device at one site, without latency."""

    name: str
    """Name of the driver."""
    signature: str
    """Numbers of the driver that the link was made with."""
    rate: float
    """Nominal rate, samples a second."""
    site: Site
    known: dict[str, float] = field(factory=dict)
    """Numbers from earlier values that are passed to the readers of later values."""
    may_be_silent: bool = False
    packet_run: PacketRun = field(factory=PacketRun)
    numbering: Numbering = field(factory=Numbering)
    pace: Clock | None = None
    """Fit of the newest PACE_TIME of arrivals, whose slope shows another rate, for a device that only counts."""
    late_arrival: float | None = None
    """Arrival of the newest packet that was late by LARGE_ERROR, s: packets that catch up after it show no rate."""
    coarse_ticks: int = 0
    """Device time of the newest packet as sent, ticks, for a device that has sequence numbers as well."""
    tick_rate: float = 0.0
    """Ticks a second of the device's clock as they arrive, if they are others than were declared; else 0."""
    reported_rate: float = 0.0
    """Rate that was declared or reported last, samples a second; 0 before the first packet."""
    counted_since: float | None = None
    """Arrival since which ticks and packets are counted, s."""
    counted_ticks: int = 0
    counted_packets: int = 0
    unsure: int = 0
    """Number of lost packets that are none if the rate is wrong; they are reported when it proves to be right."""
    off_rate_packets: int = 1
    """Number of packets in a row at one steady distance that differs from the distance which the rate predicts."""
    off_rate_interval: float = 0.0
    """Distance of the newest of those packets, ticks; 0 before any."""
    backlog: Backlog = field(factory=Backlog)
    """Packets whose count goes on after a long silence, until they come at their own pace."""
    periodic: PeriodicClock | None = None
    newest_arrival: float | None = None
    """Arrival of the newest packet with samples, s."""
    recent: list[tuple[int, int]] = field(factory=list)
    """Sequence number and checksum of the newest packets with samples, oldest first, of which no number is twice."""
    last_t: float | None = None
    """Time of the newest sample, s; sample times strictly increase."""
    mag: Vec3 | None = None
    """Magnetometer value that waits for the next sample, T."""
    layout: Layout | None = None
    """Layout of the pressure cells as it was last reported; None before any."""
    air_pressure: float | None = None
    """Air pressure that waits for the next sample, Pa."""
    limitation_reported: bool = False
    """True if the driver's limitation, or ticks that cannot be used, were reported."""

    @property
    def unsettled_until(self) -> float | None:
        """Newest time that is not comparable with times of other devices (clock.py), s."""
        clock = self.packet_run.clock if self.periodic is None else self.periodic.clock
        return None if clock is None else clock.unsettled_until

    @property
    def interval(self) -> float:
        return 0.0 if self.periodic is None else self.periodic.period

    def feed(self, channel: str, data: bytes, arrival: float, driver: Driver) -> Output:
        """Return the samples and events of one value that arrived at `arrival`, s."""
        reading = driver.read(channel, data, self.known)
        self._check(driver, channel, reading)
        out = self._make_samples(driver, data, reading, arrival) if reading.samples else []
        self._update_settings(driver, reading)
        return self._make_events(reading, arrival) + out + self._take_slow_values(reading, arrival)

    def restart_clock(self) -> None:
        """Restart the clock fit and the times, because the receiver's clock restarted."""
        self.packet_run.clock, self.newest_arrival, self.last_t, self.counted_since = None, None, None, None
        self.backlog.since = None
        if self.periodic is not None:
            self.periodic = PeriodicClock(self.periodic.period)

    def handle_reconnection(self) -> None:
        """Take counters that go back in the next packet as restarted: no packet is overtaken across two connections.

        Without counters, the slots restart with the next packet."""
        self.packet_run.after_reconnection, self.backlog.since = True, None
        if self.periodic is not None:
            self.periodic.newest_arrival = None

    def _check(self, driver: Driver, channel: str, reading: Reading) -> None:
        """Raise WireError when a reading cannot be used."""
        if reading.foot is not None and reading.foot is not self.site.foot:
            raise WireError(Rejection.WRONG_SITE, f"of a {reading.foot.value} foot")
        if reading.known and len(self.known.keys() | reading.known) > MOST_KNOWN:
            raise WireError(Rejection.ABSURD, f"more than {MOST_KNOWN} known numbers")
        if reading.samples and channel not in driver.profile.streams:
            raise malformed(f"samples on {channel!r}, which is no stream")
        axis = driver.axis
        if reading.period is not None and axis is not TimeAxis.ARRIVAL:
            raise malformed("a period, of a device that counts")
        if reading.rate is not None and axis is TimeAxis.TICKS and reading.rate * MIN_SAMPLE_TICKS > driver.tick_rate:
            detail = f"{reading.rate:g} samples a second, too many for {driver.tick_rate:g} ticks a second"
            raise WireError(Rejection.ABSURD, detail)
        if reading.interval is not None and reading.interval * MIN_RATE > driver.tick_rate > 0.0:
            raise WireError(Rejection.ABSURD, f"an interval of {reading.interval} ticks")

    def _update_settings(self, driver: Driver, reading: Reading) -> None:
        if reading.known:
            self.known = {**self.known, **{name: float(value) for name, value in reading.known.items()}}
        if reading.silent is not None:
            self.may_be_silent = reading.silent
        if reading.rate is not None and not reading.samples:
            if driver.axis is TimeAxis.TICKS:
                self.packet_run.packet_ticks *= self.rate / reading.rate
            self._set_rate(reading.rate)
        if reading.period is not None:
            if self.periodic is None:
                self.periodic = PeriodicClock(reading.period)
            self.periodic.set_period(reading.period)

    def _set_rate(self, rate: float) -> None:
        if rate != self.rate:
            if self.periodic is not None:
                self.periodic.set_period(self.periodic.period * self.rate / rate)
            self.rate, self.off_rate_packets = rate, 0

    def _make_events(self, reading: Reading, arrival: float) -> Output:
        out: Output = []
        if reading.layout is not None and reading.layout != self.layout:
            self.layout = reading.layout
            out.append(LayoutKnown(t=arrival, site=self.site, layout=reading.layout))
        if reading.battery is not None:
            out.append(BatteryLevel(t=arrival, site=self.site, level=float(reading.battery)))
        if reading.keys is not None:
            out.append(KeysChanged(t=arrival, site=self.site, down=reading.keys))
        return out

    def _take_slow_values(self, reading: Reading, arrival: float) -> Output:
        if reading.mag is not None:
            self.mag = reading.mag
        if reading.air_pressure is None:
            return []
        if self.newest_arrival is not None and arrival - self.newest_arrival <= MAX_PRESSURE_WAIT:
            self.air_pressure = reading.air_pressure
            return []
        t = self._make_increasing(arrival)
        return [Sample(t, self.site, air_pressure=reading.air_pressure, known_at=max(arrival, t))]

    def _make_samples(self, driver: Driver, data: bytes, reading: Reading, arrival: float) -> Output:
        axis, run, other_slope = driver.axis, self.packet_run, 0.0
        found: Output = []
        position: PacketPosition | None = None
        is_first = run.clock is None
        rate = self.rate if reading.rate is None else reading.rate
        checksum = crc32(data)
        if self.recent and checksum == self.recent[-1][1] and run.after_reconnection and axis is not TimeAxis.ARRIVAL:
            raise WireError(Rejection.DUPLICATE, "the newest packet again, after a new connection")
        if axis is TimeAxis.ARRIVAL:
            self._set_rate(rate)
            longest_loss = 0.0 if self.may_be_silent else driver.profile.stale_after
            sample_times = self._time_by_arrival(len(reading.samples), rate, arrival, longest_loss, data)
        elif axis is TimeAxis.TICKS:
            tick_rate = self.tick_rate or driver.tick_rate
            position = self._locate_by_ticks(driver, reading, rate, checksum)
            packet_ticks = run.packet_ticks
            sample_times = run.accept(position, tick_rate, arrival)
            self._set_rate(rate)
            if reading.interval is None and not is_first:
                self._correct_rate(tick_rate, position, sample_times, packet_ticks, driver.sequence > 0)
            found = self._judge_ticks(driver, position, arrival)
        else:
            position = self._locate_by_count(driver, reading, rate, arrival, checksum)
            sample_times = self.packet_run.accept(
                position,
                rate * TICKS_PER_SAMPLE,
                arrival,
                new_fit=self._has_stopped(driver, position, arrival) or self._is_another(driver, position, checksum),
            )
            self._set_rate(rate)
            self.coarse_ticks = int(reading.ticks or 0)
            if reading.rate is None:
                other_slope = self._find_other_slope(rate, arrival, is_first or sample_times.restarted is not None)
        number = 0 if position is None else position.sequence
        kept = min(REMEMBERED_PACKETS, driver.sequence or 1)
        self.recent = [*self.recent[-kept + 1 :], (number, checksum)] if kept > 1 else [(number, checksum)]
        out: Output = [*sample_times.make_events(self.site, arrival)]
        if position is not None and driver.sequence and reading.sequence is not None:
            what = self.numbering.accept(
                int(reading.sequence), driver.sequence, position.samples, position.sequence_difference, is_first
            )
            out += [Limitation(t=arrival, site=self.site, what=what)] if what else []
        if self.periodic is not None:
            out += self.periodic.report_rate(len(reading.samples), self.site, arrival)
        if other_slope:  # the next packet starts a fit at the rate that arrives
            self._set_rate(rate / (1.0 + other_slope))
            out.append(other_rate(self.site, arrival, f"{self.rate:.3g} samples a second", rate))
        out += found
        if not self.limitation_reported:
            unused = UNUSED_TICKS if reading.ticks is not None and not driver.tick_rate else ""
            out += self.report_limitation("; ".join(filter(None, (driver.limitation, unused))), arrival)
        self.newest_arrival = arrival
        for raw, assigned_t in zip(reading.samples, sample_times.times, strict=True):
            t = self._make_increasing(assigned_t)
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
        return out

    def _locate_by_ticks(self, driver: Driver, reading: Reading, rate: float, checksum: int) -> PacketPosition:
        run, count = self.packet_run, len(reading.samples)
        if reading.ticks is None or (driver.sequence and reading.sequence is None):
            raise malformed("no device time or no sequence number, which this device has")
        interval = (self.tick_rate or driver.tick_rate) / rate if reading.interval is None else reading.interval
        ticks = signed_difference(reading.ticks - run.ticks, driver.tick_modulus)
        if reading.sequence is not None and driver.sequence:
            sequence = int(reading.sequence)
            sequence, modulus = self._number(driver, sequence, count, ticks, checksum)
            difference, packets = run.count_packets(sequence, modulus, ticks)
            return PacketPosition(sequence, int(reading.ticks), interval, count, difference, packets, ticks)
        if ticks > 0:  # ticks were cut to whole ones: the true distance may be up to one tick less
            packets = round(ticks / run.packet_ticks) if ticks - 1 >= MIN_GAP * run.packet_ticks else 1
        else:
            packets = 0 if ticks == 0 else min(-1, round(ticks / run.packet_ticks))
        return PacketPosition(0, int(reading.ticks), interval, count, packets, packets, ticks)

    def _locate_by_count(
        self, driver: Driver, reading: Reading, rate: float, arrival: float, checksum: int
    ) -> PacketPosition:
        """Return a packet's position by its sequence number; the elapsed time gives the counter's whole rounds."""
        run, count = self.packet_run, len(reading.samples)
        if reading.sequence is None:
            raise malformed("no sequence number, which this device has")
        elapsed = 0.0 if self.newest_arrival is None else arrival - self.newest_arrival
        device_time: float | None = None
        if driver.tick_modulus and reading.ticks is not None:
            device_time = signed_difference(reading.ticks - self.coarse_ticks, driver.tick_modulus) / driver.tick_rate
            device_time = device_time if -MAX_DEVICE_LAG <= device_time - elapsed <= MAX_DEVICE_LEAD else None
        ticks = (elapsed if device_time is None else device_time) * rate * TICKS_PER_SAMPLE
        sequence, modulus = self._number(driver, int(reading.sequence), count, ticks, checksum)
        difference, packets = run.count_packets(sequence, modulus, ticks)
        if difference == 1 and device_time is None and elapsed > driver.profile.stale_after:
            packets = 1  # held back, more likely than a loss of exactly so many rounds
        ticks_after = round(packets * run.packet_ticks)
        if (
            packets >= 1
            and device_time is not None
            and ticks > PAUSE_RATIO * ticks_after + PAUSE_LEAD * rate * TICKS_PER_SAMPLE
        ):
            ticks_after = round(ticks)
        return PacketPosition(sequence, 0, TICKS_PER_SAMPLE, count, difference, packets, ticks_after)

    def _number(self, driver: Driver, number: int, samples: int, ticks_after: float, checksum: int) -> tuple[int, int]:
        """Return the number of a packet among packets, whatever the device counts, and their number in a round."""
        run = self.packet_run
        if run.clock is None:
            return number, driver.sequence
        is_copy = bool(self.recent) and checksum == self.recent[-1][1]
        packets, modulus = self.numbering.count_packets(
            number, driver.sequence, samples, ticks_after / run.packet_ticks, is_copy
        )
        return (run.sequence + packets) % modulus, modulus

    def _find_other_slope(self, rate: float, arrival: float, restarts: bool) -> float:
        """Return the slope of the newest arrivals minus 1 if the rate is surely another one; else 0."""
        run, pace = self.packet_run, self.pace
        if pace is None or restarts:
            self.late_arrival = None
            pace = self.pace = Clock(rate * TICKS_PER_SAMPLE, window_length=PACE_WINDOW)
        ticks = run.ticks + run.packet_ticks - run.interval
        if run.clock is not None and arrival - run.clock.fit_time(ticks) > LARGE_ERROR:
            self.late_arrival = arrival
        pace.observe(ticks, arrival)
        while arrival - pace.origin - (pace.windows[0][0] + pace.windows[0][1]) > PACE_TIME and len(pace.windows) > 1:
            del pace.windows[0]
        if pace.other_slope >= 0.0:
            return pace.other_slope
        if self.late_arrival is not None and arrival - self.late_arrival <= PACE_TIME:
            return 0.0  # packets catch up
        if arrival - pace.origin > PACE_TIME:  # the slope is a mean with that of the rate before
            self.pace = Clock(rate * TICKS_PER_SAMPLE, window_length=PACE_WINDOW)
            return 0.0
        return pace.other_slope

    def _has_stopped(self, driver: Driver, position: PacketPosition, arrival: float) -> bool:
        """Return whether a packet is so late that the device must have stopped counting before it.

        A phone may have held back packets whose numbers go on. Then they come faster than they were measured."""
        clock, run = self.packet_run.clock, self.packet_run
        if clock is None or self.newest_arrival is None or driver.tick_modulus:
            return False
        silence, delay = arrival - self.newest_arrival, arrival - clock.fit_time(run.ticks + run.packet_ticks)
        if run.after_reconnection:
            return delay > MIN_DELAY_AFTER_CONNECTION
        if self.backlog.since is not None:
            is_over = self.backlog.is_over(arrival, run.packet_ticks / clock.rate)
            return is_over and delay > MIN_DELAY_AFTER_CONNECTION
        is_late = silence > LONG_SILENCE and delay > MIN_DELAY_AFTER_SILENCE
        half_round = 0.5 * driver.sequence * run.packet_ticks / clock.rate
        may_be_rounds = position.sequence_difference == 1 and silence > max(half_round, driver.profile.stale_after)
        if not is_late and not (may_be_rounds and delay > MIN_DELAY_AFTER_CONNECTION):
            return False
        if position.packets_after > 0:
            self.backlog.hold(arrival)
        return self.backlog.since is None

    def _is_another(self, driver: Driver, position: PacketPosition, checksum: int) -> bool:
        """Return whether a packet has a number of a recent one and other bytes, so that the count started again.

        A clock of the device would show it, so that the number is damaged."""
        is_known = [number == position.sequence and known != checksum for number, known in self.recent]
        return position.packets_after <= 0 and not driver.tick_modulus and any(is_known)

    def _correct_rate(
        self, tick_rate: float, position: PacketPosition, sample_times: SampleTimes, predicted: float, has_number: bool
    ) -> None:
        """Correct the rate when packets come at another, steady distance than `predicted`, ticks, and what was lost."""
        if position.ticks_after <= 0 or sample_times.restarted is not None:
            return
        lost = sample_times.lost_count
        # without a number, another distance may be the rate or a loss; a number tells how many packets it is of
        distance = position.ticks_after / (position.packets_after if has_number else 1)
        if abs(distance - predicted) <= RATE_TOLERANCE * predicted + 1.0:
            if self.unsure and sample_times.gap_start is None:
                sample_times.gap_start = self.last_t
            sample_times.lost_count, self.off_rate_packets, self.unsure = lost + self.unsure, 0, 0
            return
        steady = abs(distance - self.off_rate_interval) <= RATE_TOLERANCE * self.off_rate_interval
        may_be_rate = self.off_rate_packets > 0 and (steady or self.off_rate_interval == 0.0)
        if may_be_rate and not (has_number and lost):
            sample_times.lost_count, sample_times.gap_start, self.unsure = 0, None, self.unsure + lost
        self.off_rate_packets = self.off_rate_packets + 1 if steady and self.off_rate_packets > 0 else 1
        self.off_rate_interval = distance
        if self.off_rate_packets >= STEADY_PACKETS:
            self.rate, self.off_rate_packets, self.unsure = tick_rate * position.samples / distance, 0, 0
            self.packet_run.packet_ticks = distance

    def _judge_ticks(self, driver: Driver, position: PacketPosition, arrival: float) -> Output:
        """Return which clock or rate of the device arrives when it is another one than was declared.

        Ticks that are others by the same factor from packet to packet and from arrival to arrival have another unit;
        packets that catch up, or a clock that was set, do not agree in that."""
        silence = 0.0 if self.newest_arrival is None else arrival - self.newest_arrival
        reported = self.reported_rate = self.reported_rate or driver.profile.nominal_rate
        if self.counted_since is None or position.ticks_after <= 0 or silence > MAX_TICKS_SILENCE:
            self.counted_since, self.counted_ticks, self.counted_packets = arrival, 0, 0
            return []
        self.counted_ticks, self.counted_packets = self.counted_ticks + position.ticks_after, self.counted_packets + 1
        elapsed = arrival - self.counted_since
        if elapsed < TICKS_TIME:
            return []
        self.counted_since = None
        declared, nominal = self.tick_rate or driver.tick_rate, driver.profile.nominal_rate
        counted, arriving = self.counted_ticks / elapsed, self.counted_packets * position.samples / elapsed
        is_steady = _is_near(position.ticks_after, self.counted_ticks / self.counted_packets, RATE_TOLERANCE)
        if (
            is_steady
            and _is_near(arriving, nominal, RATE_TOLERANCE)
            and not _is_near(counted, declared, RATE_TOLERANCE)
        ):
            near = [clock for clock in USUAL_CLOCKS if _is_near(counted, clock, 0.5 * MAX_DRIFT)]
            self.tick_rate = min(near, key=lambda clock: abs(counted / clock - 1.0), default=counted)
            self.rate, self.off_rate_packets = nominal, 1
            return [other_rate(self.site, arrival, f"{self.tick_rate:.6g} ticks a second", declared, 6)]
        if _is_near(self.rate, reported, OTHER_RATE) or not _is_near(arriving, self.rate, RATE_TOLERANCE):
            return []
        self.reported_rate = self.rate
        return [other_rate(self.site, arrival, f"{self.rate:.3g} samples a second", reported)]

    def _time_by_arrival(
        self, count: int, rate: float, arrival: float, longest_loss: float, data: bytes
    ) -> SampleTimes:
        if self.periodic is None:
            self.periodic = PeriodicClock(count / rate)
        sample_times = self.periodic.add_packet(arrival, longest_loss, data)
        (last,), interval = sample_times.times, self.periodic.period / count
        sample_times.times = [last - (count - 1 - j) * interval for j in range(count)]
        sample_times.lost_count *= count
        return sample_times

    def _make_increasing(self, t: float) -> float:
        if self.last_t is not None and t <= self.last_t:
            t = self.last_t + MIN_INCREMENT
        self.last_t = t
        return t


def _is_near(value: float, other: float, share: float) -> bool:
    return abs(value / other - 1.0) <= share
