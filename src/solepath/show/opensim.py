"""Writes the attitudes or positions of the feet as a storage file (.sto) of OpenSim 4, which `OpenSense` reads.

    writer = OpensimWriter(Quantity.ATTITUDES)
    for item in source:
        posed.session.feed(item)
        for one in posed.take():
            writer.add(one)
    writer.write("walk.sto")

The header is that of OpenSim's STOFileAdapter, version 3: DataRate (1/s), DataType (Quaternion or Vec3), and how the
poses were computed (`solepath`, JSON). Then there is one row for each instant. It has the time, s, and one value for
each foot, whose numbers are separated by commas: w,x,y,z of a unit quaternion that turns sensor coordinates into ground
coordinates, or x,y,z, m. Ground is OpenSim's frame: x as in the world frame, along the first heading; y up; z to the
right. OpenSense therefore needs no further rotation (`sensor_to_opensim_rotations` is 0 0 0). Attitudes are named as
OpenSense expects them, calcn_l_imu and calcn_r_imu.

All feet of a row are at one instant, and their sensors are not. The rows are spaced by the usual interval of the first
foot; between two samples of a foot, positions are interpolated linearly, and attitudes along the shortest turn. Nothing
is interpolated over a gap: its rows are left out."""

from __future__ import annotations

import json
from array import array
from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from enum import Enum
from itertools import pairwise
from math import acos, floor, sin, sqrt
from pathlib import Path
from statistics import median_high
from typing import Any

from attrs import define, field

from ..recording.errors import RecordingError
from ..recording.posed import PosedSample
from ..types import Foot, Quat
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

    def at(self, t: float) -> Sequence[float] | None:
        """Return the pose at `t`, s; None outside the samples, and within a gap."""
        times, row = self.t, bisect_right(self.t, t) - 1
        if row < 0 or t > times[-1]:
            return None
        before = self._pose(row)
        if t == times[row]:
            return before
        interval = times[row + 1] - times[row]
        return (
            None
            if interval > LONGEST_INTERVAL
            else interpolate(before, self._pose(row + 1), (t - times[row]) / interval)
        )

    def _pose(self, row: int) -> Sequence[float]:
        width = len(self.numbers) // len(self.t)
        return self.numbers[width * row : width * (row + 1)]


@define
class OpensimWriter:
    """Collects the poses of the feet and writes one quantity of them; 40 bytes are kept for each sample."""

    quantity: Quantity
    made_by: Mapping[str, Any] = field(factory=dict)
    """How the poses were computed, as `provenance` says it (saving/provenance.py), for the header."""
    _feet: dict[Foot, _Poses] = field(factory=dict, init=False)

    def add(self, posed: PosedSample) -> None:
        """Add a sample; one without a pose, or not later than the one before it, is left out."""
        foot, state = posed.sample.site.foot, posed.state
        if foot is None or state is None:
            return
        poses = self._feet.setdefault(foot, _Poses())
        if not poses.t or posed.sample.t > poses.t[-1]:
            poses.t.append(posed.sample.t)
            x, y, z = state.position
            attitudes = self.quantity is Quantity.ATTITUDES
            poses.numbers.extend(multiply(WORLD_TO_GROUND, state.attitude) if attitudes else (x, z, -y))

    def write(self, path: Path | str) -> int:
        """Write the file and return the number of its rows; RecordingError when no instant has a pose of every foot."""
        feet = [foot for foot in Foot if foot in self._feet]
        intervals = [b - a for foot in feet[:1] for a, b in pairwise(self._feet[foot].t)]
        rate = 1.0 / median_high(intervals) if intervals else 0.0
        suffix = "_imu" if self.quantity is Quantity.ATTITUDES else ""
        rows = 0
        with Path(path).open("w", encoding="ascii", newline="\n") as file:
            file.write(f"DataRate={rate:.6f}\nDataType={self.quantity.value}\nversion=3\nOpenSimVersion=4.1\n")
            file.write(f"solepath={json.dumps(self.made_by)}\nendheader\n" if self.made_by else "endheader\n")
            file.write("\t".join(["time", *[BODIES[foot] + suffix for foot in feet]]) + "\n")
            for t in self._instants(rate):
                values = [poses.at(t) for poses in (self._feet[foot] for foot in feet)]
                if values and None not in values:
                    file.write("\t".join([repr(t), *[",".join(map(repr, value or ())) for value in values]]) + "\n")
                    rows += 1
        if not rows:
            raise RecordingError(path, "no instant has a pose of every foot, so that there is nothing to write")
        return rows

    def _instants(self, rate: float) -> Iterator[float]:
        """Yield evenly spaced times, s, at which every foot may have a pose."""
        times = [poses.t for poses in self._feet.values()]
        start = max([one[0] for one in times], default=0.0)
        for number in range(floor((min([one[-1] for one in times], default=0.0) - start) * rate) + 1):
            yield start + number / (rate or 1.0)


def interpolate(a: Sequence[float], b: Sequence[float], share: float) -> Sequence[float]:
    """Return the value at `share` of the way from `a` to `b`; of attitudes, along the shortest turn (Shoemake 1985)."""
    first, second = 1.0 - share, share
    if len(a) == 4:
        cosine = sum([x * y for x, y in zip(a, b, strict=True)])
        sign = -1.0 if cosine < 0.0 else 1.0  # q and -q are one attitude
        angle = acos(min(1.0, abs(cosine)))
        if angle > SMALL_ANGLE:
            first, second = sin(first * angle) / sin(angle), sin(share * angle) / sin(angle)
        second *= sign
    return [first * x + second * y for x, y in zip(a, b, strict=True)]
