"""Comparison of the vectors' physical values with the scales that the link applies to counts."""

from __future__ import annotations

import json
from math import degrees
from typing import Any

import pytest
from here import PROTOCOL

from solepath.link.devices import cc2541, cc2650
from solepath.wire.fields import parse_whole

VECTORS = PROTOCOL / "vectors"


def physical(name: str) -> list[Any]:
    return [v for v in json.loads((VECTORS / f"{name}.json").read_text("utf-8"))["vectors"] if "physical" in v]


def counts_of(name: str, vector: Any) -> Any:
    return parse_whole(cc2541.FORMATS[f"cc2541/{name}"], bytes.fromhex(vector["hex"]))


def approx_values(expected: list[float], tolerance: float) -> Any:
    return pytest.approx(tuple(expected), abs=tolerance)


def test_both_tags_count_angular_rate_alike() -> None:
    assert cc2541.GYRO_SCALE == cc2650.GYRO_SCALE


AXES = {
    "gyroscope": ("gyro", degrees(cc2541.GYRO_SCALE), "gyro_dps"),
    "magnetometer": ("mag", 1e6 * cc2541.MAG_SCALE, "mag_ut"),
}
"""Field, value of a count, and quantity in the vector, by sensor."""


@pytest.mark.parametrize("sensor", AXES)
def test_scales_of_an_old_tag_agree_with_the_vectors(sensor: str) -> None:
    field, unit, quantity = AXES[sensor]
    for vector in physical(f"cc2541-{sensor}"):
        counts, values = getattr(counts_of(sensor, vector), field), vector["physical"]
        assert tuple(unit * c for c in counts) == approx_values(values[quantity], values["tolerance"]), vector["id"]


@pytest.mark.parametrize(
    ("firmware", "code", "key"), [("1.4 (x)", 3, "64"), ("1.5 (x)", 1, "64"), ("1.5 (x)", 3, "16")]
)
@pytest.mark.parametrize("vector", physical("cc2541-accelerometer"), ids=lambda vector: vector["id"])
def test_an_old_tags_acceleration_depends_on_firmware_and_range(
    vector: Any, firmware: str, code: int, key: str
) -> None:
    counts = counts_of("accelerometer", vector).acc
    values, per_g = vector["physical"], cc2541.counts_per_g(firmware, code)
    assert tuple(c / per_g for c in counts) == approx_values(values[f"acc_g_at_{key}"], values["tolerance"])
