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
    file = json.loads((VECTORS / f"{name}.json").read_text("utf-8"))
    return [pytest.param(v, id=v["id"]) for v in file["vectors"] if "physical" in v]


def counts_of(name: str, vector: Any) -> Any:
    return parse_whole(old_tag.FORMATS[f"cc2541/{name}"], bytes.fromhex(vector["hex"]))


def near(expected: list[float], tolerance: float) -> Any:
    return pytest.approx(tuple(expected), abs=tolerance)


def test_both_tags_count_angular_rate_alike() -> None:
    assert old_tag.GYRO == new_tag.GYRO


@pytest.mark.parametrize("vector", physical("cc2541-gyroscope"))
def test_an_old_tags_gyroscope_counts_are_worth_what_the_vector_says(vector: Any) -> None:
    counts = counts_of("gyroscope", vector).gyro
    values = vector["physical"]
    assert tuple(degrees(c * old_tag.GYRO) for c in counts) == near(values["gyro_dps"], values["tolerance"])


@pytest.mark.parametrize("vector", physical("cc2541-magnetometer"))
def test_an_old_tags_magnetometer_counts_are_worth_what_the_vector_says(vector: Any) -> None:
    counts = counts_of("magnetometer", vector).mag
    values = vector["physical"]
    assert tuple(c * old_tag.MAG * 1e6 for c in counts) == near(values["mag_ut"], values["tolerance"])


@pytest.mark.parametrize(
    ("firmware", "code", "key"), [("1.4 (x)", 3, "64"), ("1.5 (x)", 1, "64"), ("1.5 (x)", 3, "16")]
)
@pytest.mark.parametrize("vector", physical("cc2541-accelerometer"))
def test_an_old_tags_acceleration_depends_on_firmware_and_range(
    vector: Any, firmware: str, code: int, key: str
) -> None:
    counts = counts_of("accelerometer", vector).acc
    values, per_g = vector["physical"], old_tag.counts_per_g(firmware, code)
    assert tuple(c / per_g for c in counts) == near(values[f"acc_g_at_{key}"], values["tolerance"])
