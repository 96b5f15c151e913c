"""A pressure insole with an IMU that speaks protocol/insole.md."""

from __future__ import annotations

from math import radians

import numpy as np
from attrs import frozen

from ..link.profile import INSOLE
from ..types import Layout, Quat, Site
from ..vector import GRAVITY, from_rotation_vector, multiply
from ..wire.device import build_battery, build_firmware
from ..wire.fragment import FRAME_IDS, split
from ..wire.insole import InsoleFrame, InsoleSample, build_frame
from ..wire.insole_info import InsoleInfo, build_info
from .device import Notification, foot_of, prepared, read_imu, samplings, started, triples
from .insoles import SCALE, layout
from .parts import LSM6DSOX, RESISTIVE, CellPart, Imu
from .sensors import Reading, read_cells
from .shoe import IN_SOLE, Mounting
from .walker import Walker

TICK_RATE = 32768
ACC_COUNT = 0.488e-3 * GRAVITY
"""m/s^2 per count at +-16 g (ST DS12814, table 2)."""
GYRO_COUNT = radians(0.070)
"""rad/s per count at +-2000 degrees/s (the same)."""
_HANDLING = 1e-3
"""s from a frame's last sample until the radio has it."""


@frozen
class Insole:
    """`cells` of 12 bits and an IMU at `rate` Hz (rounded to whole ticks), `batch` samples a frame.

    `mtu`: of the link; frames that do not fit go in fragments. `ppm` and `ticks`: rate error and reading of the clock
    at its first sample; drawn when None. `quaternion`: send the device's own attitude too.
    """

    cells: int = 96
    rate: float = 100.0
    batch: int = 1
    mtu: int = 247
    imu: bool = True
    quaternion: bool = False
    mounting: Mounting = IN_SOLE
    part: Imu = LSM6DSOX
    cell_part: CellPart = RESISTIVE
    ppm: float | None = None
    ticks: int | None = None
    firmware: str = "emulated 1"

    def emit(self, walker: Walker, site: Site, rng: np.random.Generator) -> list[Notification]:
        foot = foot_of(site)
        interval = round(TICK_RATE / self.rate)
        clock = started(rng, interval / TICK_RATE, self.ppm)
        when = samplings(walker, clock, interval / TICK_RATE)
        drawn, sequence, serial = (int(n) for n in rng.integers(0, (2**32, 2**16, 2**24)))
        ticks = drawn if self.ticks is None else self.ticks
        shape = layout(self.cells, foot, walker.wearer.shoe.length, walker.wearer.shoe.width)

        motion = walker.kinematics(foot, when.fine, self.mounting)
        acc, gyro = read_imu(motion, when, self.part, ACC_COUNT, GYRO_COUNT, rng, bandwidth=0.5 * self.rate)
        loads = read_cells(walker.cell_loads(shape, when.taken), when.taken, self.cell_part, SCALE, rng)
        attitude = self._attitudes(motion.attitude[when.before :: when.every], rng)
        samples = self._samples(loads, acc, gyro, attitude)
        full = (acc.saturated | gyro.saturated | loads.saturated).tolist()

        sent = self._setup(shape, interval, serial)
        for number, k in enumerate(range(0, len(samples) - self.batch + 1, self.batch)):
            frame = InsoleFrame(
                foot=foot,
                layout=shape.id,
                sequence=(sequence + number) % 2**16,
                ticks=(ticks + k * interval) % 2**32,
                interval=interval,
                samples=tuple(samples[k : k + self.batch]),
                saturated=any(full[k : k + self.batch]),
            )
            ready = float(when.taken[k + self.batch - 1]) + _HANDLING
            for piece in split(build_frame(frame), self.mtu - 3, number % FRAME_IDS):
                sent.append(Notification(ready, "insole/frame", piece))
        return sent

    def _setup(self, shape: Layout, interval: int, serial: int) -> list[Notification]:
        info = InsoleInfo(
            foot=shape.foot,
            layout=shape.id,
            serial=serial,
            tick_rate=TICK_RATE,
            interval=interval,
            acc_scale=ACC_COUNT,
            gyro_scale=GYRO_COUNT,
            pressure_scale=SCALE,
            length=shape.length,
            cells=shape.cells,
            firmware=self.firmware,
        )
        own = {
            "insole/info": build_info(info),
            "device/firmware": build_firmware(self.firmware),
            "device/battery": build_battery(87),
        }
        return prepared(INSOLE, own)

    def _attitudes(
        self, true: np.ndarray[tuple[int, ...], np.dtype[np.float64]], rng: np.random.Generator
    ) -> list[Quat]:
        """The device's own idea of its attitude: half a degree off in tilt, with a heading of its own."""
        if not self.quaternion:
            return []
        tilt = radians(0.5) * rng.standard_normal(2)
        off = from_rotation_vector((float(tilt[0]), float(tilt[1]), float(rng.uniform(-3.0, 3.0))))
        return [multiply(off, (w, x, y, z)) for w, x, y, z in true.tolist()]

    def _samples(self, loads: Reading, acc: Reading, gyro: Reading, attitude: list[Quat]) -> list[InsoleSample]:
        imu = [(*a, *g) if self.imu else None for a, g in zip(triples(acc.counts), triples(gyro.counts), strict=True)]
        cells = [tuple(row) for row in loads.counts.tolist()]
        quats = [_q14(q) for q in attitude] if self.quaternion else [None] * len(cells)
        return [InsoleSample(c, i, q) for c, i, q in zip(cells, imu, quats, strict=True)]


def _q14(q: Quat) -> tuple[int, int, int, int]:
    w, x, y, z = (round(16384 * v) for v in q)
    return (w, x, y, z)
