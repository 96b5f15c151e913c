"""Feeds samples of your own sensor in SI units, one at a time, without packets and radio.

    python examples/own_samples.py              emulated samples
    python examples/own_samples.py walk.csv     a file with the columns t,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z

For whole files `solepath track walk.csv` is easier. This program shows the loop for data from any other source.
"""

import csv
import sys
from collections.abc import Iterator

from solepath import Foot, Sample, SampleGap, SampleRejected, Session, Site, StrideTaken
from solepath.emulate import Route, Walker


def samples_of(path: str) -> Iterator[Sample]:
    """Yield one Sample for every row. Strides need only t, acc and gyro; pressure=(...) may be added."""
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            yield Sample(
                t=float(row["t"]),  # s
                site=Site.RIGHT_FOOT,
                acc=(float(row["acc_x"]), float(row["acc_y"]), float(row["acc_z"])),  # m/s^2, +9.81 upwards at rest
                gyro=(float(row["gyro_x"]), float(row["gyro_y"]), float(row["gyro_z"])),  # rad/s
            )


def emulated_samples() -> Iterator[Sample]:
    """Yield the samples of the right foot of an emulated walk at 100 Hz."""
    yield from Walker(Route().stand(2).walk(12).stop(2)).samples(Foot.RIGHT, 100.0)


session = Session()
for sample in samples_of(sys.argv[1]) if len(sys.argv) > 1 else emulated_samples():
    for event in session.feed(sample):
        match event:
            case StrideTaken(t=t, number=number, length=length, position=(x, y, z)):
                print(f"{t:7.2f} s  stride {number}: {length:.2f} m, foot at ({x:.2f}, {y:.2f}, {z:.2f})")
            case SampleGap(t=t, duration=duration):
                print(f"{t:7.2f} s  nothing for {duration:.2f} s; this stride is marked degraded")
            case SampleRejected(t=t, reason=reason, detail=detail):
                print(f"{t:7.2f} s  sample not used: {reason.value}, {detail}")
session.finish()
