"""Links on the virtual radio: start, end, and no remains after it."""

from __future__ import annotations

import asyncio

import pytest
from bleak import BleakClient
from bleak.exc import BleakError
from strap import CONTROL, LEVEL, PAGE
from virtual import ONE, TWO, Host, find, linked, now, strap, virtually

from solepath.emulate.controllers.server import virtual_link


@virtually
async def test_a_request_that_its_caller_gives_up_does_not_have_its_answer_taken_for_the_next() -> None:
    async with linked(strap()) as (host, _):
        given_up = asyncio.create_task(host.client.read_gatt_char(PAGE))
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        given_up.cancel()
        assert await host.client.read_gatt_char(LEVEL) == b"\x57"
        assert await host.client.read_gatt_char(CONTROL) == b"\x00"
        with pytest.raises(asyncio.CancelledError):
            await given_up


@virtually
async def test_a_connected_client_is_notified_when_the_radio_closes() -> None:
    device = strap()
    async with virtual_link([device]) as backend:
        host = Host(backend, await find(backend))
        await host.client.connect()
    await asyncio.sleep(0.1)
    assert len(host.lost) == 1
    assert not device.is_connected
    with pytest.raises(BleakError, match="closed"):
        await host.client.connect()


@virtually
async def test_a_connection_that_its_caller_gives_up_leaves_nothing_behind() -> None:
    absent, there = strap("one", ONE, "1 * vanish 10"), strap("two", TWO)
    async with virtual_link([absent, there]) as backend:
        first, second = await find(backend, "one"), await find(backend, "two")
        await asyncio.sleep(1.0)
        waiting = asyncio.create_task(BleakClient(first, backend=backend.client).connect())
        await asyncio.sleep(0.5)
        waiting.cancel()
        with pytest.raises(asyncio.CancelledError):
            await waiting
        t_request = now()
        async with BleakClient(second, backend=backend.client):
            assert now() - t_request < 0.5
        await asyncio.sleep(15.0)
        assert not absent.is_connected
