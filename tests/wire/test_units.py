"""The physical values that the vectors name, against the scales that the link applies to counts."""

from __future__ import annotations

import json
from math import degrees
from typing import Any

import pytest
from here import PROTOCOL

from solepath.link.decoder import Decoder
from solepath.link.devices import cc2541 as old_tag
from solepath.link.devices import cc2650 as new_tag
from solepath.types import Packet, Sample, Site
from solepath.types.vector import GRAVITY
from solepath.wire.cc2541 import parse_accelerometer, parse_gyroscope, parse_magnetometer
from solepath.wire.cc2650 import MovementConfig, build_movement_config

VECTORS = PROTOCOL / "vectors"


def physical(name: str) -> list[Any]:
    file = json.loads((VECTORS / f"{name}.json").read_text("utf-8"))
    return [pytest.param(v, id=v["id"]) for v in file["vectors"] if "physical" in v]


def near(expected: list[float], tolerance: float) -> Any:
    return pytest.approx(tuple(expected), abs=tolerance)


@pytest.mark.parametrize("g", [2, 4, 8, 16])
@pytest.mark.parametrize("vector", physical("cc2650-movement"))
def test_a_movement_packet_becomes_the_units_of_its_vector(vector: Any, g: int) -> None:
    decoder = Decoder(site=Site.LEFT_FOOT)
    config = build_movement_config(MovementConfig(range=g))
    decoder.feed(Packet(0.0, Site.LEFT_FOOT, "cc2650/movement-config", config))
    out = decoder.feed(Packet(0.1, Site.LEFT_FOOT, "cc2650/movement", bytes.fromhex(vector["hex"])))
    (sample,) = [item for item in out if isinstance(item, Sample)]
    values, tolerance = vector["physical"], vector["physical"]["tolerance"]
    assert sample.gyro is not None and sample.acc is not None and sample.mag is not None
    assert tuple(map(degrees, sample.gyro)) == near(values["gyro_dps"], tolerance)
    if f"acc_g_at_{g}g" in values:
        assert tuple(a / GRAVITY for a in sample.acc) == near(values[f"acc_g_at_{g}g"], tolerance)
    if "mag_ut" in values:
        x, y, z = values["mag_ut"]  # of the magnetometer's own axes; in terms of the others it is (y, x, -z)
        assert tuple(m * 1e6 for m in sample.mag) == near([y, x, -z], tolerance)


def test_both_tags_count_angular_rate_alike() -> None:
    assert old_tag.GYRO == new_tag.GYRO


@pytest.mark.parametrize("vector", physical("cc2541-gyroscope"))
def test_an_old_tags_gyroscope_counts_are_worth_what_the_vector_says(vector: Any) -> None:
    counts = parse_gyroscope(bytes.fromhex(vector["hex"])).gyro
    values = vector["physical"]
    assert tuple(degrees(c * old_tag.GYRO) for c in counts) == near(values["gyro_dps"], values["tolerance"])


@pytest.mark.parametrize("vector", physical("cc2541-magnetometer"))
def test_an_old_tags_magnetometer_counts_are_worth_what_the_vector_says(vector: Any) -> None:
    counts = parse_magnetometer(bytes.fromhex(vector["hex"])).mag
    values = vector["physical"]
    assert tuple(c * old_tag.MAG * 1e6 for c in counts) == near(values["mag_ut"], values["tolerance"])


@pytest.mark.parametrize(
    ("firmware", "code", "key"), [("1.4 (x)", 3, "64"), ("1.5 (x)", 1, "64"), ("1.5 (x)", 3, "16")]
)
@pytest.mark.parametrize("vector", physical("cc2541-accelerometer"))
def test_an_old_tags_acceleration_depends_on_firmware_and_range(
    vector: Any, firmware: str, code: int, key: str
) -> None:
    counts = parse_accelerometer(bytes.fromhex(vector["hex"])).acc
    values, per_g = vector["physical"], old_tag.counts_per_g(firmware, code)
    assert tuple(c / per_g for c in counts) == near(values[f"acc_g_at_{key}"], values["tolerance"])
