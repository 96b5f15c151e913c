"""The Running Speed and Cadence Service over the virtual radio: clients without solepath's parser read its values.

The independent clients are plain bleak with the standard library's struct, and the parser of the package
bluetooth-sig."""

from __future__ import annotations

import asyncio
import json
import struct
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import pytest
import walks
from bleak import BleakClient, BleakScanner
from bleak.exc import BleakGATTProtocolError
from here import PROTOCOL
from virtual import now, virtually

from solepath import GaitCycleMeasured, Session
from solepath.ble import Backend
from solepath.ble.running import RunningSensor
from solepath.emulate.controllers import virtual_link
from solepath.emulate.devices.peripheral import Placement
from solepath.emulate.devices.running import RunningPeripheral
from solepath.emulate.devices.running_meter import ReplayedMeter
from solepath.emulate.routes.route import Route
from solepath.types import Foot, Site
from solepath.wire.running import RscMeasurement

LONG = Route().stand(1.5).walk(12.0, 1.3).stop(6.0)
"""A walk of about 9 s, and then standing for longer than a measurement of speed lasts."""
SERVICE, MEASUREMENT, FEATURE, LOCATION, CONTROL = (
    f"0000{number:04x}-0000-1000-8000-00805f9b34fb" for number in (0x1814, 0x2A53, 0x2A54, 0x2A5D, 0x2A55)
)


def sensor(**given: object) -> RunningPeripheral:
    source = ReplayedMeter(walks.insoles(LONG).packets)
    return RunningPeripheral(source, Placement(Site.RIGHT_FOOT, "F0:5E:00:00:00:0A", started_at=1.0), **given)


@asynccontextmanager
async def plain_client(backend: Backend) -> AsyncIterator[BleakClient]:
    """Yield a client that found the sensor by its service, as a watch does."""
    device = await BleakScanner.find_device_by_filter(
        lambda _, advertised: SERVICE in advertised.service_uuids, backend=backend.scanner
    )
    assert device is not None and device.name == "solepath RSC"
    async with BleakClient(device, backend=backend.client) as client:
        yield client


@virtually
async def test_a_plain_client_reads_what_the_session_measured() -> None:
    """Bytes are taken apart by struct alone; numbers are compared with those of a session over the same packets."""
    async with virtual_link([sensor()]) as backend, plain_client(backend) as client:
        assert await client.read_gatt_char(FEATURE) == b"\x07\x00"
        assert await client.read_gatt_char(LOCATION) == b"\x01"
        received: list[tuple[float, bytes]] = []
        await client.start_notify(MEASUREMENT, lambda _, data: received.append((now(), bytes(data))))
        await asyncio.sleep(17.0)
    assert [round(at - 1.0) for at, _ in received] == list(range(len(received)))
    session, packets, walked = Session(), walks.insoles(LONG).packets, 0
    newest: dict[Foot, GaitCycleMeasured] = {}
    for second, (_, data) in enumerate(received):
        events = session.feed([packet for packet in packets if second - 1 < packet.t <= second])
        newest |= {event.foot: event for event in events if isinstance(event, GaitCycleMeasured)}
        flags, speed, cadence, length, distance = struct.unpack("<BHBHI", data)
        assert flags in (3, 7)
        if speed:
            walked += 1
            means = [
                sum(getattr(c, name) for c in newest.values()) / 2 for name in ("speed", "stride_length", "cadence")
            ]
            assert [speed / 256, length / 100] == pytest.approx(means[:2], abs=0.01) and cadence == round(means[2])
    assert walked > 5 and (speed, cadence) == (0, 0), "the wearer stands at the end"
    assert distance / 10 == pytest.approx(12.0, rel=0.1)


@virtually
async def test_the_reader_reads_what_the_sensor_sends() -> None:
    served = sensor()
    async with virtual_link([served]) as backend, RunningSensor(backend=backend, search_time=1.0) as reader:
        assert (reader.name, reader.address, reader.location) == ("solepath RSC", "F0:5E:00:00:00:0A", 1)
        assert reader.feature is not None and reader.feature.running and reader.feature.distance
        found: list[RscMeasurement] = []
        async for _, measurement in reader:
            found.append(measurement)
            if len(found) == 10:
                break
        assert max(measurement.speed for measurement in found) == pytest.approx(1.3, abs=0.15)
        await reader.set_distance(1000.0)
        first = served.measure(now() - 1.0).distance
        async for _, measurement in reader:
            if measurement.distance is not None and measurement.distance > 900.0:
                assert first is not None and measurement.distance >= first > 999.9
                break
    assert reader.rejected == 0


@virtually
async def test_the_control_point_answers_by_the_rules_of_the_service() -> None:
    async with virtual_link([sensor()]) as backend, plain_client(backend) as client:
        with pytest.raises(BleakGATTProtocolError) as raised:
            await client.write_gatt_char(CONTROL, b"\x01\x00\x00\x00\x00", response=True)
        assert raised.value.code == 0xFD
        answers: list[bytes] = []
        await client.start_notify(CONTROL, lambda _, data: answers.append(bytes(data)))
        for request in (b"\x01\x10\x27\x00\x00", b"\x02", b"\x04", b"\x01\x00", b"\x63"):
            await client.write_gatt_char(CONTROL, request, response=True)
            await asyncio.sleep(0.1)
        assert [answer.hex() for answer in answers] == ["100101", "100202", "100402", "100103", "106302"]


def test_the_package_bluetooth_sig_reads_every_valid_vector_alike() -> None:
    module = pytest.importorskip(
        "bluetooth_sig.gatt.characteristics.rsc_measurement", reason="bluetooth-sig is not installed"
    )
    theirs = module.RSCMeasurementCharacteristic()
    file = json.loads((PROTOCOL / "vectors" / "rsc-measurement.json").read_text())
    compared = 0
    for vector in file["vectors"]:
        if vector["result"] != "valid" or vector["fields"]["reserved"]:
            continue
        found, fields = theirs.parse_value(bytearray.fromhex(vector["hex"])), vector["fields"]
        assert found.instantaneous_speed == pytest.approx(fields["speed"])
        assert found.instantaneous_cadence == fields["cadence"]
        assert (found.instantaneous_stride_length is None) == (fields["stride_length"] is None)
        assert found.instantaneous_stride_length == pytest.approx(fields["stride_length"])
        assert found.total_distance == pytest.approx(fields["distance"])
        assert found.is_running is fields["running"]
        compared += 1
    assert compared >= 8
