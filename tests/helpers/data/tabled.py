"""Columns of a foot at rest, and files of samples made of columns."""

from __future__ import annotations

from pathlib import Path

import numpy as np

Columns = dict[str, np.ndarray]


def still(n: int = 20) -> Columns:
    """Return the columns of a foot at rest with two pressure cells, at 100 Hz."""
    acc, gyro = np.tile([0.25, -0.5, 9.75], (n, 1)), np.tile([0.125, 0.0, -0.0625], (n, 1))
    return {"t": np.arange(n) / 100.0, "acc": acc, "gyro": gyro, "pressure": np.tile([100.0, 200.0], (n, 1))}


def saved(path: Path, columns: Columns) -> Path:
    """Write columns, also such as acc_left, as .npz or .csv."""
    if path.suffix == ".npz":
        np.savez(path, **columns)
        return path
    names, values = [], []
    for key, value in columns.items():
        quantity, _, foot = key.partition("_")
        for c, column in enumerate([value] if value.ndim == 1 else value.T):
            axis = [] if value.ndim == 1 else [str(c) if quantity == "pressure" else "xyz"[c]]
            names.append("_".join([quantity, *axis, *([foot] if foot else [])]))
            values.append(column)
    rows = [",".join([repr(float(value)) for value in row]) for row in zip(*values, strict=True)]
    path.write_text("\n".join([",".join(names), *rows]) + "\n")
    return path
