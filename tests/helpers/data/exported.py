"""An emulated walk written as the programs of known devices write it (solepath.recording.exports has the sources)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache
from pathlib import Path

import numpy as np

from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot, Sample

G = 9.80665
LENGTH = 12.0
"""Length of the walk, m."""
ROUTE = Route().stand(2.0).walk(LENGTH, speed=1.3).stop(1.5)


@cache
def walked(foot: Foot, rate: float = 100.0, cells: int = 0) -> tuple[Sample, ...]:
    """Return the samples of one foot of the walk, with the errors of an LSM6DSOX."""
    where = layout(cells, foot) if cells else None
    return tuple(Walker(ROUTE, seed=3).samples(foot, rate, LSM6DSOX, layout=where))


def columns(samples: Sequence[Sample]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return times (s), specific force (g) and angular rate (deg/s)."""
    t, acc, gyro = (np.array([getattr(s, name) for s in samples]) for name in ("t", "acc", "gyro"))
    return t, acc / G, np.degrees(gyro)


def write(path: Path, lines: Iterable[str], encoding: str = "utf-8") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(line + "\n" for line in lines), encoding=encoding)
    return path


def texts(values: Iterable[float], form: str) -> str:
    return ",".join(form % value for value in values)


def movella_dot(folder: Path, feet: Sequence[Foot] = tuple(Foot)) -> list[Path]:
    """Write a recording on two DOTs at 120 Hz, whose counter of microseconds starts again in the middle."""
    paths = []
    for foot in feet:
        head = [
            "sep=,",
            f"DeviceTag:,{foot.value},,,,,,,,,,,,,,,,,",
            "FirmwareVersion:,3.0.0,,,,,,,,,,,,,,,,,",
            "AppVersion:,2023.6.0,,,,,,,,,,,,,,,,,",
            "SyncStatus:,Synced,,,,,,,,,,,,,,,,,",
            "OutputRate:,120Hz,,,,,,,,,,,,,,,,,",
            "FilterProfile:,Dynamic,,,,,,,,,,,,,,,,,",
            "Measurement Mode:,Custom Mode 5,,,,,,,,,,,,,,,,,",
            "StartTime:,2026-03-01 09:30:00.086 +0100,,,,,,,,,,,,,,,,,",
            "Movella Technologies B. V. 2005-2026,,,,,,,,,,,,,,,,,,,",
            "",
            "PacketCounter,SampleTimeFine,Quat_W,Quat_X,Quat_Y,Quat_Z,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z",
        ]
        t, acc, gyro = columns(walked(foot, 120.0))
        ticks = (2**32 - 10_000_000 + np.round(1e6 * t).astype(np.int64)) % 2**32
        rows = (
            f"{number},{tick},1.000000,0.000000,0.000000,0.000000,{texts(G * a, '%.6f')},{texts(w, '%.6f')}"
            for number, (tick, a, w) in enumerate(zip(ticks, acc, gyro, strict=True), 1)
        )
        paths.append(write(folder / f"{foot.value}_20260301_093000_086.csv", [*head, *rows]))
    return paths


def mbientlab(folder: Path, feet: Sequence[Foot] = tuple(Foot)) -> list[Path]:
    """Write the four files of two MetaMotions: acceleration at 100 Hz, angular rate at 200 Hz, from other moments."""
    paths = []
    for foot in feet:
        side, mac = foot.value.capitalize(), {"left": "C0FFEE000001", "right": "C0FFEE000002"}[foot.value]
        for sensor, unit, rate, late in (("Accelerometer", "g", 100.0, 0), ("Gyroscope", "deg/s", 200.0, 37)):
            t, acc, gyro = columns(walked(foot, rate))
            axes = ",".join(f"{axis}-axis ({unit})" for axis in "xyz")
            ms = np.round(1e3 * t[late:]).astype(np.int64)
            rows = (
                f"{1772353800000 + m},2026-03-01T09:30:{m / 1e3:06.3f},{(m - ms[0]) / 1e3:.3f},{texts(v, '%.3f')}"
                for m, v in zip(ms, (acc if unit == "g" else gyro)[late:], strict=True)
            )
            name = f"{side}_MetaWear_2026-03-01T09.30.00.000_{mac}_{sensor}_{rate:.3f}Hz_1.7.3.csv"
            paths.append(write(folder / name, [f"epoch (ms),time (01:00),elapsed (s),{axes}", *rows]))
    return paths


def physilog(folder: Path, feet: Sequence[Foot] = tuple(Foot)) -> list[Path]:
    """Write the exports of two Physilogs at 128 Hz, with a barometer at 1 Hz."""
    paths = []
    for foot in feet:
        t, acc, gyro = columns(walked(foot, 128.0))
        head = [
            "Gait Up - Physilog data export",
            "Created on: 2026-03-01 09:30:00",
            f"Total data points: {len(t)}",
            "",
            "Time [128 hz],Gyro [128 hz],,,Accel [128 hz],,,Baro [1 hz],,Event [128 hz],Quaternion [128 hz],,,,",
            "Time,Gyro X,Gyro Y,Gyro Z,Accel X,Accel Y,Accel Z,Pressure,Temperature,Quat W,Quat X,Quat Y,Quat Z,",
            "[s],[deg/s],[deg/s],[deg/s],[g],[g],[g],[mBar],[degree C],[],[],[],[],",
        ]
        rows = (
            f"{s:.5f},{texts(w, '%.5f')},{texts(a, '%.5f')},{',' if k % 128 else '1013.250,21.5'},1,0,0,0,"
            for k, (s, a, w) in enumerate(zip(t, acc, gyro, strict=True))
        )
        paths.append(write(folder / f"{foot.value[0].upper()}F.csv", [*head, *rows]))
    return paths


def moticon(folder: Path) -> list[Path]:
    """Write the text export of two insoles with 16 cells at 100 Hz; the left one starts half a second later."""
    names = ["# time"]
    for foot in ("left", "right"):
        names += [f"{foot} pressure {cell}[N/cm²]" for cell in range(1, 17)]
        names += [f"{foot} acceleration {axis}[g]" for axis in "XYZ"] + [
            f"{foot} angular {axis}[dps]" for axis in "XYZ"
        ]
        names += [f"{foot} total force[N]"]
    head = [
        "# Start time: 01.03.2026 09:30:00.086",
        "# Duration: 00:27.000",
        "# Sensor insoles: Left SN1234, Right SN5678",
        "# Size: 7",
        "# Recording type: normal",
        "\t".join(names),
    ]
    both = [walked(foot, 100.0, 16) for foot in Foot]
    rows = []
    for pair in zip(*both, strict=True):
        cells = [f"{pair[0].t:.2f}"]
        for foot, sample in zip(Foot, pair, strict=True):
            _, (acc,), (gyro,) = columns([sample])
            values = [f"{p / 12.5:.2f}" for p in sample.pressure or ()] + [f"{v:.6f}" for v in (*acc, *gyro)]
            values.append(f"{sum(sample.pressure or ()):.2f}")
            cells += [""] * len(values) if foot is Foot.LEFT and sample.t < 0.5 else values
        rows.append("\t".join(cells))
    return [write(folder / "normal walk.txt", [*head, *rows])]


def ngimu(folder: Path, feet: Sequence[Foot] = tuple(Foot)) -> list[Path]:
    """Write the folders of two devices of a session at 100 Hz."""
    axes = [f"{name} {axis} ({unit})" for name, unit in (("Gyroscope", "deg/s"), ("Accelerometer", "g"),
                                                         ("Magnetometer", "uT")) for axis in "XYZ"]  # fmt: skip
    paths = []
    for foot in feet:
        t, acc, gyro = columns(walked(foot))
        rows = (
            f"{s:.9f},{texts((*w, *a), '%.7g')},-0.5,-19.5,-40.75,1013.25" for s, a, w in zip(t, acc, gyro, strict=True)
        )
        serial = {"left": "0029AAAA", "right": "0029BBBB"}[foot.value]
        path = folder / "My Session" / f"NGIMU-{foot.value.capitalize()} - {serial}" / "sensors.csv"
        paths.append(write(path, [",".join(["Time (s)", *axes, "Barometer (hPa)"]), *rows]))
    return paths


VENDORS: dict[str, Callable[[Path], list[Path]]] = {
    "movella-dot": movella_dot,
    "mbientlab": mbientlab,
    "physilog": physilog,
    "moticon": moticon,
    "ngimu": ngimu,
}
"""Writers of the walk by the name of the format; each returns the paths of its files."""


def strange(
    folder: Path, foot: Foot, *, acc_factor: float = 1.0, **changed: Callable[[np.ndarray], np.ndarray]
) -> Path:
    """Write a table of no known format: semicolons, decimal commas, ms, g and deg/s, with other axes and lines above.

    `acc`, `gyro`: functions that change the columns before they are written."""
    t, acc, gyro = columns(walked(foot))
    acc, gyro = (changed.get(name, lambda same: same)(values) for name, values in (("acc", acc), ("gyro", gyro)))
    head = ["Labor 7;;;;;;", "Proband;S 12;;;;;", "Zeit;Beschl X;Beschl Y;Beschl Z;Gyro X;Gyro Y;Gyro Z"]
    rows = (
        ";".join(f"{v:.5f}" for v in (1e3 * s, *(acc_factor * a), *w)).replace(".", ",")
        for s, a, w in zip(t, acc, gyro, strict=True)
    )
    return write(folder / f"{foot.value}.csv", [*head, *rows], "latin-1")
