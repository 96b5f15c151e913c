"""An emulated pressure insole with an IMU (protocol/insole.md)."""

from __future__ import annotations

from math import radians

import numpy as np
from attrs import frozen

from ...link.devices.insole import PROFILE as INSOLE
from ...types import Foot, Layout, Sample, Site
from ...types.vector import GRAVITY, from_rotation_vector, multiply, rotate_back
from ...wire.device import build_battery
from ...wire.fields import build_text
from ...wire.fragment import FRAME_ID_COUNT, split
from ...wire.insole import InsoleFrame, InsoleSample, build_frame
from ...wire.insole_info import InsoleInfo, build_info
from ..wearers.curves import Array, Rng
from ..wearers.shoe import IN_SOLE, Mounting, Shoe
from ..wearers.walker import Walker
from .device import Notification, device_rng, draw_clock, foot_of, make_sampling, measure_field, setup_notifications
from .insoles import FULL_COUNT, LOAD_PER_COUNT, layout
from .parts import LSM6DSOX, RESISTIVE, AttitudeErrors, CellErrors, Imu, TriadErrors
from .sensors import instants, measure_imu, read_attitudes, read_cells, samples_of, take_samples, to_counts

HANDLING_TIME = 1e-3
"""Time from a frame's last sample until the radio has the frame, s."""

Counts = np.ndarray[tuple[int, ...], np.dtype[np.int16]]


@frozen(eq=False)
class InsoleSignal:
    """The counts that an insole measures over a walk; sample k is taken at true time `first` + k `step`, s.

    Frame numbers below 0 and after the end of the walk are valid. The wearer then stands as at the start or the end,
    and the device continues to count."""

    layout: Layout
    """Layout of the cells."""
    interval: int
    """Time between samples, ticks."""
    first: float
    """True time of sample 0, s."""
    step: float
    """True time between samples, s."""
    sequence: int
    """Sequence number of frame 0."""
    ticks: int
    """Ticks of sample 0."""
    serial: int
    """Serial number of the device."""
    cells: Counts
    """Counts of the cells, (N, cells)."""
    imu: Counts | None
    """Counts of accelerometer and gyroscope, (N, 6); None when they are not sent."""
    quats: Counts | None
    """Attitude in units of 2^-14, (N, 4), w x y z; None when it is not sent."""
    saturated: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    """True where the device reports that a sensor was at the end of its range, (N)."""

    def frames(self, batch: int) -> int:
        """Return the number of whole frames of `batch` samples in the walk."""
        return len(self.cells) // batch

    def frame(self, number: int, batch: int = 1) -> InsoleFrame:
        """Return the frame of this number when each has `batch` samples."""
        start, last = number * batch, len(self.cells) - 1
        rows = [min(max(row, 0), last) for row in range(start, start + batch)]
        return InsoleFrame(
            foot=self.layout.foot,
            layout=self.layout.id,
            sequence=(self.sequence + number) % 2**16,
            ticks=(self.ticks + start * self.interval) % 2**32,
            interval=self.interval,
            samples=tuple([self._sample(row) for row in rows]),
            saturated=any(bool(self.saturated[row]) for row in rows),
        )

    def ready(self, number: int, batch: int = 1) -> float:
        """Return the true time at which the radio has a frame, s."""
        return self.first + self.step * (number * batch + batch - 1) + HANDLING_TIME

    def _sample(self, row: int) -> InsoleSample:
        return InsoleSample(
            tuple(self.cells[row].tolist()),
            None if self.imu is None else tuple(self.imu[row].tolist()),
            None if self.quats is None else tuple(self.quats[row].tolist()),
        )


TICK_RATE = 32768
"""Rate of the device's clock, ticks per s."""
ACC_COUNT = 0.488e-3 * GRAVITY
"""Specific force per count at +-16 g, m/s^2 (ST DS12814, table 2)."""
GYRO_COUNT = radians(0.070)
"""Angular rate per count at +-2000 degrees/s, rad/s (ST DS12814, table 2)."""
BATTERY = 87
"""Battery level, percent."""


@frozen
class Insole:
    """A pressure insole with cells of 12 bits and an IMU."""

    cells: int | Layout = 96
    """Number of cells over the whole sole, or a layout for the foot that wears the insole.

    The cells of a layout without a scale are read at the default scale and sent as counts."""
    rate: float = 100.0
    """Sampling rate, Hz; rounded to whole ticks."""
    batch: int = 1
    """Samples per frame."""
    mtu: int = 247
    """ATT MTU of the link, bytes; larger frames are sent in fragments."""
    imu: bool = True
    """True when acceleration and angular rate are sent."""
    quaternion: bool = False
    """True when the attitude that the device estimates is sent too."""
    attitude: AttitudeErrors | None = None
    """Attitude errors; None: a constant tilt (standard deviation 0.5 degrees about each axis) and a random heading."""
    north: float = 0.0
    """Yaw of the device's world frame in the walk's world frame, rad; it is used only with `attitude`."""
    mounting: Mounting = IN_SOLE
    """Position and attitude of the IMU on the foot."""
    bandwidth: float | None = None
    """Bandwidth of the low pass before the IMU is sampled, Hz; None: half of the rate. With `inf` the signal passes the
    chip's own low pass only, so what is faster than half of the rate aliases."""
    chip: Imu = LSM6DSOX
    """Chip of the IMU, with its errors."""
    mag: TriadErrors | None = None
    """Errors of a magnetometer, iron of the shoe included; None without one. Frames have no field for it, so only
    `samples` has its values."""
    cell_part: CellErrors = RESISTIVE
    """Errors of the cells."""
    borne_share: float = 1.0
    """Share of the load above the cells that they bear; the rest passes beside them through the shoe."""
    ppm: float | None = None
    """Rate error of the clock, ppm; None: random."""
    ticks: int | None = None
    """Ticks at the first sample; None: random."""
    firmware: str = "emulated 1"
    """Firmware version that the device reports."""
    reports_saturation: bool = True
    """True when a saturated cell sets the flag of its frame; False for devices whose cells are a separate unit."""
    broken: tuple[tuple[int, int], ...] = ()
    """Broken cells: pairs of the cell's index and its constant count."""

    def emit(self, walker: Walker, site: Site, rng: Rng) -> list[Notification]:
        """Return everything that the insole sends over the walk, in the order of sending."""
        signal = self.measure(walker, site, rng)
        device_values = {
            "insole/info": build_info(self.info(signal)),
            "device/firmware": build_text(self.firmware),
            "device/battery": build_battery(BATTERY),
        }
        sent = setup_notifications(INSOLE, device_values)
        for number in range(signal.frames(self.batch)):
            frame, ready = build_frame(signal.frame(number, self.batch)), signal.ready(number, self.batch)
            for piece in split(frame, self.mtu - 3, number % FRAME_ID_COUNT):
                sent.append(Notification(ready, "insole/frame", piece))
        return sent

    def measure(self, walker: Walker, site: Site, rng: Rng) -> InsoleSignal:
        """Return the counts that the insole measures over the walk."""
        foot = foot_of(site)
        clock = draw_clock(rng, self.interval / TICK_RATE, self.ppm)
        sampling = make_sampling(walker, clock, self.interval / TICK_RATE)
        random_ticks, sequence, serial = (int(n) for n in rng.integers(0, (2**32, 2**16, 2**24)))
        cell_layout = self._layout(foot, walker.wearer.shoe)

        kinematics = walker.kinematics(foot, sampling.fine_times, self.mounting)
        bandwidth = 0.5 * self.rate if self.bandwidth is None else self.bandwidth
        measured, gyro_measured = measure_imu(kinematics, sampling, self.chip, rng, bandwidth)
        acc, gyro = to_counts(measured, self.chip.acc, ACC_COUNT), to_counts(gyro_measured, self.chip.gyro, GYRO_COUNT)
        upward_force = take_samples(kinematics.force, sampling) @ np.array(
            rotate_back(self.mounting.attitude, (0.0, 0.0, 1.0))
        )
        loads = read_cells(
            self.borne_share * walker.cell_loads(cell_layout, sampling.times),
            sampling.times,
            self.cell_part,
            cell_layout.scale or LOAD_PER_COUNT,
            rng,
            upward_force=upward_force,
        )
        saturated = loads.saturated
        for cell, count in self.broken:
            loads.counts[:, cell] = count
            saturated = saturated | (count >= FULL_COUNT)
        attitude = self._attitudes(take_samples(kinematics.attitude, sampling), sampling.times, rng)
        return InsoleSignal(
            layout=cell_layout,
            interval=self.interval,
            first=clock.first,
            step=clock.interval(self.interval / TICK_RATE),
            sequence=sequence,
            ticks=random_ticks if self.ticks is None else self.ticks,
            serial=serial,
            cells=loads.counts.astype(np.int16),
            imu=np.concatenate((acc.counts, gyro.counts), axis=1).astype(np.int16) if self.imu else None,
            quats=attitude,
            saturated=acc.saturated | gyro.saturated | (saturated & self.reports_saturation),
        )

    def samples(self, walker: Walker, site: Site, rng: Rng) -> list[Sample]:
        """Return the samples of the walk without packets and radio, on the true clock."""
        signal = self.measure(walker, site, rng)
        mag = None if self.mag is None else self._measure_field(walker, site, self.mag, signal)
        t = signal.first + signal.step * np.arange(len(signal.cells), dtype=np.float64)
        acc = gyro = None
        if signal.imu is not None:
            acc, gyro = signal.imu[:, :3] * ACC_COUNT, signal.imu[:, 3:] * GYRO_COUNT
        quats = None if signal.quats is None else signal.quats / 2.0**14
        cells = (signal.layout.scale or 1.0) * signal.cells
        return samples_of(site, t, acc, gyro, cells, quats, signal.saturated, mag)

    def _measure_field(self, walker: Walker, site: Site, chip: TriadErrors, signal: InsoleSignal) -> Array:
        """Return the flux density at the samples, (N, 3), T; its random numbers are apart from those of `measure`."""
        sampling = instants(signal.first, signal.step, len(signal.cells))
        kinematics = walker.kinematics(foot_of(site), sampling.fine_times, self.mounting)
        return measure_field(kinematics, walker.field, sampling, chip, device_rng(walker.seed, site, 9))

    @property
    def interval(self) -> int:
        """Time between samples, ticks."""
        return round(TICK_RATE / self.rate)

    def info(self, signal: InsoleSignal) -> InsoleInfo:
        """Return the INFO of the insole while it measures this signal."""
        return InsoleInfo(
            foot=signal.layout.foot,
            layout=signal.layout.id,
            serial=signal.serial,
            tick_rate=TICK_RATE,
            interval=signal.interval,
            acc_scale=ACC_COUNT,
            gyro_scale=GYRO_COUNT,
            pressure_scale=signal.layout.scale or 0.0,
            length=signal.layout.length,
            cells=signal.layout.cells,
            firmware=self.firmware,
        )

    def _layout(self, foot: Foot, shoe: Shoe) -> Layout:
        if not isinstance(self.cells, Layout):
            return layout(self.cells, foot, shoe.length, shoe.width)
        if self.cells.foot is not foot:
            raise ValueError(f"the {foot.value} foot cannot wear cells of the {self.cells.foot.value} foot")
        return self.cells

    def _attitudes(self, true: Array, t: Array, rng: Rng) -> Counts | None:
        """Return the attitude that the device estimates, in units of 2^-14, (N, 4); None when it is not sent."""
        if not self.quaternion:
            return None
        if self.attitude is not None:
            measured = read_attitudes(true, t, self.attitude, self.north, rng)
        else:
            tilt = radians(0.5) * rng.standard_normal(2)
            off = from_rotation_vector((float(tilt[0]), float(tilt[1]), float(rng.uniform(-3.0, 3.0))))
            measured = np.array([multiply(off, (w, x, y, z)) for w, x, y, z in true.tolist()])
        quats: Counts = np.rint(2**14 * measured).astype(np.int16)
        return quats
