"""The physical values that the vectors name, against the scales that the link applies to counts."""

from __future__ import annotations

import json
from math import degrees
from typing import Any

import pytest
from here import PROTOCOL

from solepath.link.devices import cc2541 as old_tag
from solepath.link.devices import cc2650 as new_tag
from solepath.wire.fields import parse_whole

VECTORS = PROTOCOL / "vectors"


def physical(name: str) -> list[Any]:
    return [v for v in json.loads((VECTORS / f"{name}.json").read_text("utf-8"))["vectors"] if "physical" in v]


def counts_of(name: str, vector: Any) -> Any:
    return parse_whole(old_tag.FORMATS[f"cc2541/{name}"], bytes.fromhex(vector["hex"]))


def near(expected: list[float], tolerance: float) -> Any:
    return pytest.approx(tuple(expected), abs=tolerance)


def test_both_tags_count_angular_rate_alike() -> None:
    assert old_tag.GYRO_SCALE == new_tag.GYRO_SCALE


AXES = {
    "gyroscope": ("gyro", degrees(old_tag.GYRO_SCALE), "gyro_dps"),
    "magnetometer": ("mag", 1e6 * old_tag.MAG_SCALE, "mag_ut"),
}
"""Sensor -> its field, what a count is worth, and the quantity in the vector."""


@pytest.mark.parametrize("sensor", AXES)
def test_scales_of_an_old_tag_agree_with_the_vectors(sensor: str) -> None:
    field, unit, quantity = AXES[sensor]
    for vector in physical(f"cc2541-{sensor}"):
        counts, values = getattr(counts_of(sensor, vector), field), vector["physical"]
        assert tuple(unit * c for c in counts) == near(values[quantity], values["tolerance"]), vector["id"]


@pytest.mark.parametrize(
    ("firmware", "code", "key"), [("1.4 (x)", 3, "64"), ("1.5 (x)", 1, "64"), ("1.5 (x)", 3, "16")]
)
@pytest.mark.parametrize("vector", physical("cc2541-accelerometer"), ids=lambda vector: vector["id"])
def test_an_old_tags_acceleration_depends_on_firmware_and_range(
    vector: Any, firmware: str, code: int, key: str
) -> None:
    counts = counts_of("accelerometer", vector).acc
    values, per_g = vector["physical"], old_tag.counts_per_g(firmware, code)
    assert tuple(c / per_g for c in counts) == near(values[f"acc_g_at_{key}"], values["tolerance"])
