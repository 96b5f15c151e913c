"""Emulated walks as files of samples, and what a reference system would have measured of them."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path

from solepath import Foot
from solepath.emulate import Route, Walker

ROUTE = Route().stand(2.0).walk(12.0, 1.3).stop(2.0)
HEADER = "t,acc_x,acc_y,acc_z,gyro_x,gyro_y,gyro_z"
RATE = 100.0
"""Samples a second."""


def walker(seed: int = 3, route: Route = ROUTE) -> Walker:
    return Walker(route, seed=seed)


def samples_file(path: Path, who: Walker, foot: Foot) -> Path:
    """Write the samples of a foot."""
    rows = [",".join(map(repr, [one.t, *(one.acc or ()), *(one.gyro or ())])) for one in who.samples(foot, RATE)]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join([HEADER, *rows, ""]))
    return path


def both_feet(folder: Path, name: str, who: Walker) -> list[Path]:
    """Write the samples of both feet: NAME_left.csv and NAME_right.csv."""
    return [samples_file(folder / f"{name}_{foot}.csv", who, foot) for foot in Foot]


def contacts(who: Walker, foot: Foot) -> list[float]:
    """Return the times at which a foot touches the floor, s."""
    return [*who.truth().feet[foot].heel_strikes]


def strides(who: Walker, foot: Foot) -> Iterable[tuple[float, float, float]]:
    """Yield start, end, s, and length, m, of the strides of a foot from contact to contact."""
    for start, end in pairwise(contacts(who, foot)):
        yield (
            start,
            end,
            next(
                one.length
                for one in who.truth().feet[foot].strides
                if start < one.t_end and one.t_start < end < one.t_end
            ),
        )


def table(path: Path, header: str, rows: Iterable[Iterable[object]], separator: str = ",") -> Path:
    """Write a table of text."""
    lines = [header.replace(",", separator), *[separator.join(map(str, row)) for row in rows]]
    path.write_text("\n".join([*lines, ""]), encoding="utf-8")
    return path
