"""Devices on the virtual radio, reached by plain bleak: advertisements, attributes and notifications."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable

import pytest
from bleak.exc import BleakError, BleakGATTProtocolError
from strap import BEAT, BOOK, CONTROL, LEVEL, PAGE
from virtual import linked, strap, virtually


@pytest.mark.parametrize(("of_device", "of_host", "agreed"), [(247, 185, 185), (185, 247, 185), (23, 247, 23)])
@virtually
async def test_the_smaller_mtu_holds_and_a_longer_notification_is_cut_without_an_error(
    of_device: int, of_host: int, agreed: int
) -> None:
    device = strap(mtu=of_device)
    device.size = 240
    async with linked(device, of_host) as (host, _):
        assert host.client.mtu_size == agreed
        assert await host.client.read_gatt_char(PAGE) == BOOK
        await host.count(50)
        await asyncio.sleep(1.0)
        assert len(host.received) >= 50
        assert {len(value) for _, value in host.received} == {agreed - 3}


@virtually
async def test_the_device_obeys_writes_with_and_without_response() -> None:
    device = strap()
    async with linked(device) as (host, _):
        await host.count(10)
        assert await host.client.read_gatt_char(CONTROL) == b"\x0a"
        await asyncio.sleep(10.0)
        assert len(host.received) in (100, 101)
        await host.client.write_gatt_char(CONTROL, b"\x00", response=False)
        await asyncio.sleep(10.0)
        assert len(host.received) in (100, 101)
        assert device.rate == 0
        with pytest.raises(BleakError, match="do not fit"):
            await host.client.write_gatt_char(CONTROL, bytes(245), response=False)


@virtually
async def test_a_rejected_request_is_an_att_error_and_the_link_stays_up() -> None:
    async with linked(strap(faults="0 * refuse strap/control 2")) as (host, _):
        codes = []
        requests: list[Callable[[], Awaitable[object]]] = [
            lambda: host.client.write_gatt_char(CONTROL, b"\x01", response=True),
            lambda: host.client.read_gatt_char(CONTROL),
            lambda: host.client.write_gatt_char(CONTROL, b"\x01\x02", response=True),
            lambda: host.client.write_gatt_char(LEVEL, b"\x01", response=True),
            lambda: host.client.read_gatt_char(BEAT),
        ]
        for request in requests:
            with pytest.raises(BleakGATTProtocolError) as rejected:
                await request()
            codes.append(int(rejected.value.code))
        assert codes == [0x80, 0x80, 0x0D, 0x03, 0x02]
        assert await host.client.read_gatt_char(LEVEL) == b"\x57"
        assert not host.lost
