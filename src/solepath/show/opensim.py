"""Writes the attitudes or positions of the feet as a storage file (.sto) of OpenSim 4, which `OpenSense` reads.

    writer = OpensimWriter(Quantity.ATTITUDES)
    for item in source:
        posed.session.feed(item)
        for one in posed.take():
            writer.add(one)
    writer.write("walk.sto")

The header is that of OpenSim's STOFileAdapter, version 3: DataRate (1/s), DataType (Quaternion or Vec3), then one row
for each instant. A row has the time, s, and one value for each foot, whose numbers are separated by commas: w,x,y,z of
a unit quaternion that turns sensor coordinates into ground coordinates, or x,y,z, m. Ground is OpenSim's frame: x as in
the world frame, along the first heading; y up; z to the right. OpenSense therefore needs no further rotation
(`sensor_to_opensim_rotations` is 0 0 0). Attitudes are named as OpenSense expects them, calcn_l_imu and calcn_r_imu.

All feet of a row are at one instant, and their sensors are not. The rows are spaced by the usual interval of the first
foot; between two samples of a foot, positions are interpolated linearly, and attitudes along the shortest turn. Nothing
is interpolated over a gap: its rows are left out."""

from __future__ import annotations

from array import array
from collections.abc import Iterator, Sequence
from enum import Enum
from math import acos, floor, sin, sqrt
from pathlib import Path

from attrs import define, field

from ..recording.errors import RecordingError
from ..recording.posed import PosedSample
from ..types import Foot, Quat, Vec3
from ..types.vector import multiply

WORLD_TO_GROUND: Quat = (sqrt(0.5), -sqrt(0.5), 0.0, 0.0)
"""Turn of the world frame (z up) into OpenSim's ground frame (y up): by -90 degrees about x."""
LONGEST_INTERVAL = 0.1
"""Longest time between two samples over which a pose is interpolated, s: as long as a foot needs for half a swing."""
SMALL_ANGLE = 1e-6
"""Angle between two attitudes below which they are interpolated linearly, rad; the error is below one in 10^12."""
BODIES = {Foot.LEFT: "calcn_l", Foot.RIGHT: "calcn_r"}
"""Name of each foot's body in the models of OpenSim."""


class Quantity(Enum):
    """The quantity of a storage file; the value is its DataType."""

    ATTITUDES = "Quaternion"
    POSITIONS = "Vec3"


@define
class _Poses:
    """Times, s, of the poses of one foot, with all their numbers one after the other, ground frame."""

    t: array[float] = field(factory=lambda: array("d"))
    numbers: array[float] = field(factory=lambda: array("d"))
    row: int = 0
    """Row at or before the instant that was requested last; instants are requested in order."""

    def at(self, t: float, quantity: Quantity) -> tuple[float, ...] | None:
        """Return the pose at `t`, s; None outside the samples, and within a gap."""
        times, last = self.t, len(self.t) - 1
        while self.row < last and times[self.row + 1] <= t:
            self.row += 1
        row = self.row
        if t < times[row] or (row == last and t > times[row]):
            return None
        if row == last or t == times[row]:
            return self._numbers(row, quantity)
        interval = times[row + 1] - times[row]
        if interval > LONGEST_INTERVAL:
            return None
        share = (t - times[row]) / interval
        return interpolate(self._numbers(row, quantity), self._numbers(row + 1, quantity), share, quantity)

    def _numbers(self, row: int, quantity: Quantity) -> tuple[float, ...]:
        width = 4 if quantity is Quantity.ATTITUDES else 3
        return tuple(self.numbers[width * row : width * (row + 1)])


@define
class OpensimWriter:
    """Collects the poses of the feet and writes one quantity of them; 40 bytes are kept for each sample."""

    quantity: Quantity
    _feet: dict[Foot, _Poses] = field(factory=dict, init=False)

    def add(self, posed: PosedSample) -> None:
        """Add a sample; one without a pose, or not later than the one before it, is left out."""
        foot, state = posed.sample.site.foot, posed.state
        if foot is None or state is None:
            return
        poses = self._feet.setdefault(foot, _Poses())
        if poses.t and posed.sample.t <= poses.t[-1]:
            return
        poses.t.append(posed.sample.t)
        attitudes = self.quantity is Quantity.ATTITUDES
        poses.numbers.extend(multiply(WORLD_TO_GROUND, state.attitude) if attitudes else to_ground(state.position))

    def write(self, path: Path | str) -> int:
        """Write the file and return the number of its rows; RecordingError when no instant has a pose of every foot."""
        feet = [foot for foot in Foot if foot in self._feet]
        rate = self._rate(feet)
        names = [BODIES[foot] + ("_imu" if self.quantity is Quantity.ATTITUDES else "") for foot in feet]
        rows = 0
        with Path(path).open("w", encoding="ascii", newline="\n") as file:
            file.write(f"DataRate={rate:.6f}\nDataType={self.quantity.value}\nversion=3\nOpenSimVersion=4.1\n")
            file.write("endheader\n" + "\t".join(["time", *names]) + "\n")
            for t, values in self._rows(feet, rate):
                texts = [",".join([repr(number) for number in value]) for value in values]
                file.write("\t".join([repr(t), *texts]) + "\n")
                rows += 1
        if not rows:
            raise RecordingError(path, "no instant has a pose of every foot, so that there is nothing to write")
        return rows

    def _rate(self, feet: Sequence[Foot]) -> float:
        """Return the usual rate of the first foot, 1/s; 0 when no foot has two poses."""
        for foot in feet:
            times = self._feet[foot].t
            intervals = sorted([later - earlier for earlier, later in zip(times, times[1:], strict=False)])
            if intervals:
                return 1.0 / intervals[len(intervals) // 2]
        return 0.0

    def _rows(self, feet: Sequence[Foot], rate: float) -> Iterator[tuple[float, list[tuple[float, ...]]]]:
        if not rate:
            return
        start = max([self._feet[foot].t[0] for foot in feet])
        end = min([self._feet[foot].t[-1] for foot in feet])
        for number in range(floor((end - start) * rate) + 1):
            t = start + number / rate
            values = [value for foot in feet if (value := self._feet[foot].at(t, self.quantity)) is not None]
            if len(values) == len(feet):
                yield t, values


def to_ground(vector: Vec3) -> Vec3:
    """Return a vector of the world frame in OpenSim's ground frame: x ahead, y up, z to the right."""
    x, y, z = vector
    return x, z, -y


def interpolate(a: Sequence[float], b: Sequence[float], share: float, quantity: Quantity) -> tuple[float, ...]:
    """Return the value at `share` of the way from `a` to `b`; of attitudes, along the shortest turn (Shoemake 1985)."""
    first, second = 1.0 - share, share
    if quantity is Quantity.ATTITUDES:
        cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
        sign = -1.0 if cosine < 0.0 else 1.0  # q and -q are one attitude
        angle = acos(min(1.0, abs(cosine)))
        if angle > SMALL_ANGLE:
            first, second = sin(first * angle) / sin(angle), sin(share * angle) / sin(angle)
        second *= sign
    return tuple([first * x + second * y for x, y in zip(a, b, strict=True)])
